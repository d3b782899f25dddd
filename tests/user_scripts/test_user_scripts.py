"""Scripts as users write them run, and pyright has nothing to say in its strict mode (`make types`)."""

from pathlib import Path

import pytest

from . import (
    camera_images,
    cartpole_env,
    dynamics_control,
    joint_sliders,
    lidar,
    many_questions,
    modern_world,
    pick_and_place,
    quickstart,
    shapes_and_kinematics,
    shapes_and_states,
)


def test_quickstart() -> None:
    assert 0.3 < quickstart.main()[-1] < 0.7


def test_joint_sliders() -> None:
    assert len(joint_sliders.main()) == 7


def test_camera_images() -> None:
    assert camera_images.main() == pytest.approx([0.9] * 4, abs=0.1)


def test_pick_and_place() -> None:
    error, height = pick_and_place.main()
    assert error < 0.02
    assert height > 0.3


def test_cartpole_env() -> None:
    assert all(total > 5 for total in cartpole_env.main())


def test_lidar() -> None:
    nearest, wheels = lidar.main()
    assert nearest == pytest.approx(1.9, abs=0.05)
    assert wheels == 4


def test_shapes_and_states() -> None:
    assert shapes_and_states.main()


def test_dynamics_control(tmp_path: Path) -> None:
    log = tmp_path / "arm.bin"
    assert dynamics_control.main(str(log), 1.0) < 0.03
    assert log.stat().st_size > 1000


def test_modern_world(tmp_path: Path) -> None:
    swung, held = modern_world.main(tmp_path)
    assert abs(swung) <= 0.51
    assert held == pytest.approx(0.2, abs=0.01)


def test_shapes_and_kinematics() -> None:
    away, height, images = shapes_and_kinematics.main()
    assert away < 1e-3
    assert height == pytest.approx(0.1)
    assert images == shapes_and_kinematics.COUNT


def test_many_questions() -> None:
    found = many_questions.main()
    assert found["force"] == pytest.approx(9.8, rel=0.01)
    assert found["height"] == pytest.approx(0.2, abs=0.05)
    assert found["friction"] == 0.8
    assert found["hit"] == 2.0
    assert found["red"] == 1.0
    assert len(found) == 19
