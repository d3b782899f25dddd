"""Every example runs, and shows what its text says it shows."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.cluster.small_ray import ray_here

import pybullet
from carom.viewer import Viewer
from pybullet._calls import errors

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def example(monkeypatch):
    """Imports an example as if it had been started from its own directory."""
    monkeypatch.syspath_prepend(str(EXAMPLES))

    def load(name: str) -> Any:
        return import_module(name)

    return load


def test_the_default_motor_holds_the_arm_and_without_it_the_arm_swings(example):
    record = example("default_motors").main(duration=1.0)
    assert np.allclose(record["default motor"], 1.0, atol=1e-6)
    assert min(record["motor off"]) < -0.5


def test_each_control_mode_does_what_it_is_for(example):
    record = example("control_modes").main(duration=3.0)
    assert record["POSITION"][-1] == pytest.approx(1.0, abs=1e-4)
    speed = np.diff(record["VELOCITY"]) * 240
    assert np.allclose(speed, 0.5, atol=1e-6)
    # A spring of 60 N m/rad against gravity: 60 (1 - θ) = m g r sin θ with m g r = 9.81 N m.
    angle = record["PD"][-1]
    assert 60 * (1 - angle) == pytest.approx(9.81 * np.sin(angle), rel=1e-3)
    assert max(record["TORQUE"]) > 1.0


def test_the_arm_rests_where_torque_and_gravity_balance(example):
    record = example("gravity_torque").main(duration=10.0)
    assert record["angle"][-1] == pytest.approx(record["balance"][-1], abs=1e-4)


def test_the_integral_closes_the_gap_that_pd_leaves(example):
    record = example("one_joint_pid").main(duration=4.0)
    assert record["PID"][-1] == pytest.approx(1.2, abs=1e-3)
    assert record["PD"][-1] < 1.1
    assert max(np.abs(record["torque of PID"])) <= 30.0


def test_the_slider_example_runs_headless_and_follows_its_start_values(example):
    record = example("pid_sliders").main(duration=2.0, real_time=False)
    assert record["angle"][-1] == pytest.approx(1.2, abs=0.05)


def test_the_panda_follows_its_path_under_every_kind_of_control(example):
    record = example("panda_control").main(duration=1.0)
    assert set(record) == {"effort", "velocity", "position"}
    for phase in record.values():
        assert np.abs(phase["wanted"] - phase["measured"])[:, :7].max() < 0.03
        assert np.abs(phase["wanted"] - phase["measured"])[-1, :7].max() < 0.005


def test_robot_info_lists_r2d2_and_lets_it_fall(example, capsys):
    record = example("robot_info").main(duration=0.1)
    output = capsys.readouterr().out
    for name in ("right_front_wheel_joint", "gripper_extension", "head_swivel", "prismatic"):
        assert name in output
    assert len(record["height"]) == 15


def test_the_cart_balances_the_pole(example):
    balance = example("balance_cartpole")
    record = balance.main()
    assert max(map(abs, record["pole"])) < 0.2
    assert abs(record["pole"][-1]) < 0.01
    assert abs(record["cart"][-1]) < 0.1


@pytest.mark.long
def test_the_cart_swings_up_the_pole_and_balances_it(example):
    record = example("swing_up").main(duration=10.0)
    assert max(map(abs, record["force"][:100])) == 8.0
    pole = np.abs(np.array(record["pole"]) - np.pi)
    assert pole[0] > 3.0
    assert pole[150:].max() < 0.1
    assert pole[-1] < 1e-3


@pytest.mark.long
def test_the_network_learns_to_push_by_gradients_through_the_contact(example):
    pytest.importorskip("torch")
    record = example("learn_push").main(iterations=8)
    # Only pushed balls move, and those with further targets are to go further.
    assert record["loss"][-1] < 0.4 * record["loss"][0]
    ends = [path[-1] for path in record["after"]]
    assert min(ends) > 0.4
    assert len(record["after"]) == len(record["targets"]) == 6


def test_the_mobile_manipulator_follows_the_circle_and_avoids_the_ball(example):
    pytest.importorskip("daqp")
    record = example("mobile_manipulator").main()
    assert max(record["error"][120:]) < 0.02
    # Without the limit the hand would touch the ball.
    assert 0.0299 < min(record["distance"]) < 0.05
    assert np.ptp(np.array(record["base"]), axis=0).max() > 0.05


@pytest.mark.long
def test_the_tool_and_the_friction_of_the_arm_are_found(example, capsys):
    record = example("identify_arm").main(duration=8.0)
    result, robot = record["result"], record["robot"]
    for number, joint in enumerate(robot.joints.movable[:7]):
        for name, value, true in (
            ("damping", joint.damping, 1.0 - 0.1 * number),
            ("joint_friction", joint.friction_loss, 0.8 - 0.08 * number),
        ):
            assert value == result.values[f"panda.{joint.name}.{name}"]
            assert abs(value - true) < result.bounds[f"panda.{joint.name}.{name}"] < 0.25
    # The arm feels the mass beyond the wrist as a whole.
    assert sum(robot.dynamics(robot.links[name].index).mass for name in ("panda_link7", "panda_hand")) > 1.2
    assert "Cannot be told apart" in capsys.readouterr().out


def test_the_modern_api_example_reaches_its_goal(example):
    record = example("modern_api").main(duration=2.0)
    assert record["shoulder"][-1] == pytest.approx(record["path"][-1], abs=0.01)


def test_the_camera_sees_many_colours_and_no_empty_picture(example):
    image = example("camera").main(size=(120, 80))["image"]
    assert image.shape == (80, 120, 3)
    assert len(np.unique(image.reshape(-1, 3), axis=0)) > 200


def test_r2d2_lands_on_its_wheels_and_balls_bounce_by_their_restitutions(example):
    record = example("dropping").main(duration=3.0)
    assert record["R2D2"][-1] == pytest.approx(0.471, abs=1e-3)
    ball_radius, fall = 0.09, 1.5 - 0.09
    for restitution in (0.5, 0.9):
        heights = np.array(record[f"restitution {restitution}"])
        landed = int(np.argmin(heights[:240]))
        # The rise after the first bounce is e² of the fall; a step is 1/240 s, and damping takes some.
        rise = heights[landed : landed + 240].max() - ball_radius
        assert rise == pytest.approx(restitution**2 * fall, rel=0.1)
    assert max(record["restitution 0.0"][240:]) == pytest.approx(ball_radius, abs=1e-3)


def test_the_tower_stands_until_the_ball_comes(example):
    record = example("stacking").main(duration=1.5)
    heights = np.array(record["heights"])
    assert heights[359] == pytest.approx(0.05 + 0.1 * np.arange(10), abs=2e-3)
    assert heights[-1].max() < 0.3


def test_the_panda_lifts_the_cube_with_the_force_of_its_fingers(example):
    record = example("grasping").main(duration=1.0)
    assert record["cube"][-1] == pytest.approx(0.3, abs=2e-3)
    assert record["press"][-1] == pytest.approx(20.0, rel=0.02)
    assert record["opening"][-1] == pytest.approx(0.05, abs=5e-3)


def test_the_vehicles_turn_to_their_sides(example):
    record = example("driving").main(duration=3.0)
    (rover_x, rover_y), (car_x, car_y) = record["rover"][-1], record["car"][-1]
    assert rover_x > 1.5
    assert rover_y > 0.9
    assert car_x > 1.5
    assert car_y < -1.0


def test_the_robot_stands_takes_the_push_and_sits_down(example):
    record = example("standing").main(duration=3.0)
    assert record["height"][239] == pytest.approx(0.313, abs=2e-3)
    assert 0.003 < max(record["way aside"]) < 0.05
    assert record["height"][-1] == pytest.approx(0.165, abs=5e-3)


def test_the_demo_writes_a_table_and_a_plot(example, tmp_path, capsys):
    pytest.importorskip("matplotlib", reason="draws the plot")
    results, plot = example("demo").main(duration=0.25, output=tmp_path)
    assert plot.read_bytes().startswith(b"\x89PNG")
    table = capsys.readouterr().out
    for result in results:
        assert result["name"] in table
        assert np.isfinite(result["measured"]).all()


def test_arguments_of_motors_do_what_the_table_says(example):
    main = example("motor_arguments").main
    assert main(duration=2, window=False)["angle"][-1] == pytest.approx(1.2, abs=1e-3)
    # Without brakes it overshoots; with too little force it hangs; the greatest velocity bounds it.
    assert max(main(duration=2, window=False, velocityGain=0.0)["angle"]) > 1.3
    assert main(duration=4, window=False, force=5)["angle"][-1] < 0.7
    assert main(duration=1, window=False, maxVelocity=0.5)["angle"][-1] == pytest.approx(0.5, abs=0.02)


def test_p_d_and_i_each_do_their_part(example):
    record = example("pid_terms").main(duration=4, window=False)
    swing = np.ptp(record["P"][480:])
    assert swing > 0.3
    assert np.ptp(record["PD"][480:]) < 0.05
    assert record["PD"][-1] < 1.15
    assert record["PID"][-1] == pytest.approx(1.2, abs=0.01)


def test_the_angle_is_written_beside_the_joint(example):
    shown = example("joint_angle").main(duration=2, window=False)["shown"]
    assert shown[-1] == pytest.approx(65, abs=0.1)


def test_the_needed_torque_holds_arm_and_panda(example):
    main = example("balance_torque").main
    record = main(duration=2, window=False)
    assert record["needed"] == pytest.approx(9.81 * np.sin(np.radians(65)), rel=1e-3)
    assert np.degrees(record["angle"][-1]) == pytest.approx(65, abs=0.01)
    assert record["elbow"][-1] == pytest.approx(-2, abs=1e-3)
    assert np.degrees(main(duration=1, window=False, torque=5)["angle"][-1]) < 30


def test_frames_agree(example):
    record = example("frames").main()
    assert record["composed"] == pytest.approx(record["by matrix"], abs=1e-7)
    assert record["back"] == pytest.approx(record["composed"], abs=1e-9)


def test_the_hand_follows_the_circle(example):
    record = example("inverse_kinematics").main(duration=4, window=False)
    assert max(record["error"][240:]) < 0.01
    positions = np.array(record["positions"])
    assert positions.shape[1] == len(record["lower"]) == 9
    assert (positions >= record["lower"]).all()
    assert (positions <= record["upper"]).all()


def test_limits_and_rest_poses_of_the_hand_are_not_ignored(example, caplog: pytest.LogCaptureFixture):
    hand = example("inverse_kinematics")
    # Warnings that another test has caused would not come again.
    errors.warn_once.cache_clear()
    pybullet.connect(pybullet.DIRECT)
    panda, _, lower, upper = hand.load()
    goal = [0.5, 0, 0.4]
    free = hand.solve(panda, goal, lower, upper)
    assert free[3] > -2.2
    limited = hand.solve(panda, goal, lower, [*upper[:3], -2.3, *upper[4:]])
    assert limited[3] == pytest.approx(-2.3, abs=2e-3)
    turned = hand.solve(panda, goal, lower, upper, [0.5, *hand.REST[1:]])
    assert turned[0] > free[0] + 0.01
    pybullet.disconnect()
    assert caplog.messages == []


def test_the_hand_comes_to_the_handle(example, monkeypatch):
    teleoperation = example("teleoperate_panda")
    world, arm = teleoperation.load()
    viewer = Viewer(world, port=0)
    hand = arm.links["panda_grasptarget"]
    try:
        teleoperation.teleoperate(world, arm, viewer, 0.5)
        still = hand.pose.position
        # As if the user had moved it at once.
        goal = viewer.handle("moved", still + np.array([-0.1, 0.1, -0.1]), hand.pose.orientation)
        monkeypatch.setattr(viewer, "handle", lambda name, position, orientation: goal)
        teleoperation.teleoperate(world, arm, viewer, 2.5)
    finally:
        viewer.close()
    assert np.allclose(hand.pose.position, goal.position, atol=0.002)
    assert np.linalg.norm(hand.pose.position - still) > 0.15


def test_rays_hit_the_box_and_it_presses_with_its_weight(example):
    record = example("rays_and_contacts").main(duration=1, window=False)
    assert record["hits"][-1] == 3
    assert record["normal"][-1] == pytest.approx(40, rel=1e-3)


def test_the_weight_swings_is_lifted_and_falls(example):
    height = example("constraints").main(duration=3, window=False)["height"]
    assert min(height[:240]) == pytest.approx(0.6, abs=0.01)
    assert height[479] - height[239] == pytest.approx(0.5, abs=0.02)
    assert height[-1] == pytest.approx(0.025, abs=1e-3)


def test_what_is_restored_goes_the_same_way(example):
    first, other, again = example("save_and_restore").main()["ends"]
    assert first == again
    assert other[0] > first[0]


def test_the_rollout_plays_all_episodes_and_leaning_is_better_than_guessing(example, tmp_path, capsys):
    pytest.importorskip("ray", reason="Ray has no wheel for this Python")
    with ray_here():
        plot = tmp_path / "returns.svg"
        returns = example("cluster_rollout").main(["--episodes", "12", "--envs", "4", "--plot", str(plot)])
    assert len(returns["lean"]) == len(returns["guess"]) == 12
    assert returns["lean"].mean() > 1.5 * returns["guess"].mean()
    assert plot.stat().st_size > 1000
    assert "12 episodes on" in capsys.readouterr().out


def test_every_example_is_tested():
    tests = (path for path in Path(__file__).parents[1].rglob("test_*.py"))
    tested = "".join(path.read_text(encoding="utf-8") for path in tests)
    for script in EXAMPLES.glob("[!_]*.py"):
        calls = (f'{how}("{script.stem}")' for how in ("example", "task", "__import__"))
        assert any(call in tested for call in calls), script.stem


def test_a_thousand_arms_come_to_their_targets_and_one_of_them_goes_on_alone(example):
    record = example("thousand_arms").main(count=12, duration=0.75)
    assert record["error"].max() < 0.02
    assert np.count_nonzero(record["away"] == 0.0) == 6
    assert record["same"]


def test_cubes_slide_as_far_as_their_friction_lets_them(example):
    record = example("domain_randomisation").main(count=50)
    assert np.allclose(record["distance"], record["expected"], rtol=0.1)
    assert np.allclose(record["weight"], record["bears"], rtol=1e-3)
    assert record["farther"][::2].min() > 1.0
    assert record["farther"][1::2].max() < 1e-3


def test_worlds_have_terrains_and_objects_of_their_own(example):
    record = example("differing_worlds").main(count=60)
    assert set(record) == {(number, name) for number in range(3) for name in ("ball", "box")}
    assert record[1, "ball"] > record[0, "ball"] + 0.2
    assert abs(record[0, "box"]) < 0.05


def test_an_environment_of_ones_own_can_be_solved(example):
    record = example("own_vector_env").main(count=5)
    assert record["return"].min() > 120.0
    assert record["off"].max() < 0.01


def test_soft_bodies_lie_give_way_and_hang(example):
    record = example("soft_bodies").main(duration=2.0)
    nodes = np.array(record["cloth"])
    # The ball keeps the middle of the cloth up, and the rest hangs down. PyBullet: 0.659.
    assert nodes[:, 2].max() == pytest.approx(0.655, abs=0.02)
    assert nodes[:, 2].min() < 0.5
    # 20 N on 0.04 m² of 10 kPa, and half of its own 10 N.
    assert record["height"] == pytest.approx(0.2 * (20 + 5) / 0.04 / 1e4, rel=0.4)
    # A catenary of 1 m between hooks 80 cm apart, but for what is left of a swing.
    assert record["rope"][:, 2].min() == pytest.approx(-0.265, abs=0.03)


@pytest.mark.long
def test_the_panda_takes_a_towel_and_squeezes_a_cube(example):
    record = example("towel").main(duration=1.0)
    towel, cube = record["towel"], record["cube"]
    edge, hand = np.array(towel["edge"]), np.array(towel["hand"])
    # Off its pins the towel goes where the hand goes, and does not slip between its fingers.
    assert edge[4] > 0.55
    assert (edge - hand)[3:] == pytest.approx(np.full(2, (edge - hand)[2]), abs=0.004)
    assert towel["lowest"][4] > edge[4] - 0.25
    # Each finger is pressed with 20 N.
    assert towel["press"][4] == pytest.approx(40.0, rel=0.3)
    assert cube["height"][4] == pytest.approx(0.25, abs=0.01)
    assert cube["width"][0] == 0.05
    assert 0.036 <= cube["width"][4] < 0.049
    assert cube["press"][4] > 5.0
