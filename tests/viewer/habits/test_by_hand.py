"""Joints in the hands of users: by position, velocity or torque, and given back to the script."""

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()
JOINT = 3
HAS_RANGE = """([wanted, key]) => {
  const { ranges, mode, element } = app.bodies.drives.sliders.get(key);
  const { min, max } = element.querySelector("[type=range]");
  return mode === wanted && [min, max].join() === ranges[mode].join();
}"""
SET = "(element, value) => { element.value = value; element.dispatchEvent(new Event('input')); }"


@pytest.fixture
def arm(page: Page) -> int:
    arm = p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    page.until("app.scene.bodies.size === 1")
    page.page.evaluate("app.bodies.select(0); document.getElementById('bodies').open = true")
    return arm


def set_by(page: Page, mode: str, value: float) -> None:
    page.page.get_by_title("What the slider of panda_joint4 sets").select_option(mode)
    # The slider has its range with the first frame that tells of the joint.
    wait_for(lambda: page.page.evaluate(HAS_RANGE, [mode, f"0,{JOINT}"]), page)
    page.page.locator(f"#joint-0-{JOINT}").evaluate(SET, value)


def steps(condition) -> bool:
    p.stepSimulation()
    return condition(p.getJointState(0, JOINT))


def test_a_joint_turns_at_the_speed_of_the_slider(page: Page, arm: int):
    p.resetJointState(arm, JOINT, -2)
    set_by(page, "velocity", 0.5)
    wait_for(lambda: steps(lambda state: state[1] == pytest.approx(0.5, abs=1e-3)), page)


@pytest.mark.long
def test_a_joint_has_the_torque_of_the_slider(page: Page, arm: int):
    p.resetJointState(arm, JOINT, -2)
    for joint in range(p.getNumJoints(arm)):
        if joint != JOINT:
            p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, 0)
    set_by(page, "torque", 2.0)
    wait_for(lambda: steps(lambda state: state[3] == pytest.approx(2.0, abs=1e-3)), page)
    wait_for(lambda: steps(lambda state: state[1] > 0.2), page)


@pytest.mark.long
def test_a_joint_is_given_back_to_the_script(page: Page, arm: int):
    p.setJointMotorControl2(arm, JOINT, p.POSITION_CONTROL, -1.0, force=200)
    wait_for(lambda: steps(lambda state: state[0] == pytest.approx(-1.0, abs=0.01)), page)
    button = page.page.get_by_title("Give panda_joint4 back to the script")
    assert button.is_disabled()
    set_by(page, "position", -2.0)
    wait_for(lambda: steps(lambda state: state[0] == pytest.approx(-2.0, abs=0.02)), page)
    set_by(page, "torque", 0.0)
    set_by(page, "torque", 1.0)
    button.click()
    wait_for(lambda: steps(lambda state: state[0] == pytest.approx(-1.0, abs=0.01)), page)
    assert button.is_disabled()


@pytest.mark.long
def test_what_the_script_has_commanded_since_stays(page: Page, arm: int):
    set_by(page, "position", -2.0)
    wait_for(lambda: steps(lambda state: state[0] == pytest.approx(-2.0, abs=0.02)), page)
    p.setJointMotorControl2(arm, JOINT, p.POSITION_CONTROL, -1.5, force=200)
    page.page.get_by_title("Give panda_joint4 back to the script").click()
    wait_for(lambda: steps(lambda state: state[0] == pytest.approx(-1.5, abs=0.01)), page)


@pytest.mark.long
def test_numbers_of_tiny_ranges_and_no_minus_before_zero(page: Page):
    slider = p.addUserDebugParameter("gain", 0, 1e-6, 2.5e-7)
    page.until("app.panel.controls.size === 1")
    typed = page.page.get_by_title("Value of gain")
    assert float(typed.input_value()) == pytest.approx(2.5e-7)
    typed.fill("7.5e-7")
    typed.press("Enter")
    wait_for(lambda: p.readUserDebugParameter(slider) == pytest.approx(7.5e-7), page)
    p.addUserDebugParameter("zero", -1, 1, -1e-9)
    page.until("app.panel.controls.size === 2")
    assert page.page.get_by_title("Value of zero").input_value() == "0.000"
