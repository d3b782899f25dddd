"""Every row of the table beside other viewers is tried in a real browser."""

import ast
import re
from functools import cache
from pathlib import Path

from tests.each import each

FOLDER = Path(__file__).parent
PAGE = FOLDER.parents[1] / "docs" / "viewer.md"
# What a test has that opens a browser, or that of its own.
BROWSERS = ("page", "browser", "chromium", "firefox", "cell")
TRIED = {
    "runs in a browser, also from another machine": ["elsewhere.the_page_works_through_a_tunnel"],
    "pause, single step, slow motion": ["page.a_paused_simulation_goes_step_by_step", "time.slow_motion"],
    "reset, and going back to a marked state": [
        "time.reset_goes_back_to_the_state_before_the_first_step",
        "time.a_mark_can_be_gone_back_to",
    ],
    "pages that are opened later, or again, show everything": ["page.a_page_loaded_again_shows_it_all_again"],
    "scrub through the past while it goes on": ["time.the_past_is_seen_while_the_simulation_goes_on"],
    "play back at any speed, loop": ["replay.a_replay_is_scrubbed_played_and_looped"],
    "replay as one HTML file": ["time.a_replay_is_saved_from_the_page", "replay.firefox_plays_it_too"],
    "picture and film from the window": ["time.a_picture_and_a_film_are_saved_from_the_page"],
    "contact points and forces": ["panel.contacts_forces_and_cones_are_drawn"],
    "friction cones": ["panel.contacts_forces_and_cones_are_drawn"],
    "joint axes, torques, limits": ["panel.joints_and_masses_are_drawn"],
    "positions beside joints": ["panel.joints_and_masses_are_drawn"],
    "centres of mass, inertia boxes": ["panel.joints_and_masses_are_drawn"],
    "transparent bodies, collision shapes": [
        "panel.transparent_bodies_and_collision_shapes_of_each_body_in_a_colour"
    ],
    "shadows, wireframe, mirror, background": [
        "panel.keys_show_what_they_show_in_pybullets_window",
        "page.the_ground_mirrors_what_is_above_it",
        "page.shortcuts_change_the_view_unless_switched_off",
        "views.the_background_is_that_of_the_script",
    ],
    "colours by link, depth of the view": [
        "views.links_have_colours_of_their_own",
        "views.depth_is_seen",
    ],
    "constraints and rays": ["panel.constraints_and_rays_are_drawn"],
    "frames and names of links": [
        "panel.keys_show_what_they_show_in_pybullets_window",
        "views.links_are_named",
    ],
    "skeleton of a robot": ["views.the_skeleton_joins_links"],
    "trail of a link": ["views.the_selected_link_leaves_a_trail"],
    "lines, points and texts of a script": [
        "page.lines_points_and_texts_come_and_go",
        "page.texts_with_an_orientation_stand_in_the_world",
    ],
    "list of bodies, selection, mass and pose": [
        "panel.a_click_selects_a_body_and_its_joints_are_driven_without_code"
    ],
    "hide and show bodies": ["views.a_body_is_hidden_and_shown"],
    "copy the state as code": ["views.the_state_of_a_body_is_copied_as_code"],
    "sliders for all joints without code": [
        "panel.a_click_selects_a_body_and_its_joints_are_driven_without_code"
    ],
    "pull bodies with the mouse": [
        "page.a_body_is_dragged_with_the_mouse",
        "turning.a_body_is_turned_by_a_torque_and_comes_to_rest",
    ],
    "sliders and buttons of a script": ["page.a_slider_moves_what_the_script_reads"],
    "lists and boxes to check of a script": ["views.a_script_has_lists_and_boxes"],
    "frames of a script that the mouse moves": ["views.a_handle_is_shifted_carried_and_turned"],
    "gamepads": ["gamepads.a_script_reads_sticks_and_buttons_of_a_gamepad"],
    "keys and mouse events for a script": [
        "page.keys_are_down_triggered_and_released",
        "page.the_mouse_is_told_to_the_script",
    ],
    "list of keys over the view": ["views.keys_are_listed_over_the_view"],
    "timing profile of the steps": ["views.a_profile_is_recorded_while_its_key_is_held"],
    "plots of state, forces, sensors, own values": ["panel.everything_is_plotted_zoomed_and_saved"],
    "zoom in plots, export to CSV": ["panel.everything_is_plotted_zoomed_and_saved"],
    "camera: fit, follow, presets, numbers": ["panel.camera_presets_numbers_and_following"],
    "camera images of the script beside the view": ["page.plots_names_and_previews"],
    "view through a camera of the script": ["lenses.a_point_lies_where_the_image_of_the_script_has_it"],
    "cameras drawn in the scene": ["views.the_camera_of_a_script_is_drawn"],
    "in notebooks": [
        "notebooks.a_window_is_shown_below_the_cell",
        "editors.a_cell_of_vs_code_shows_the_window",
        "editors.a_cell_of_colab_shows_the_window_without_sockets",
    ],
}


def rows() -> list[list[str]]:
    """The cells of the table, row after row."""
    table = PAGE.read_text(encoding="utf-8").partition("## Beside other viewers")[2].partition("\n## ")[0]
    lines = re.findall(r"^\| \w.*\|$", table, re.MULTILINE)
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_every_row_has_a_test_and_every_test_a_row():
    assert [row[0] for row in rows()] == list(TRIED)


def test_nothing_is_missing_here_that_another_viewer_has():
    assert {row[1] for row in rows()} == {"●"}


@cache
def functions_of(module: str) -> dict[str, ast.FunctionDef]:
    source = ast.parse(next(FOLDER.rglob(f"test_{module}.py")).read_text(encoding="utf-8"))
    return {node.name: node for node in source.body if isinstance(node, ast.FunctionDef)}


@each("name", sorted({name for names in TRIED.values() for name in names}))
def test_the_test_of_a_row_opens_a_browser(name: str):
    module, _, function = name.partition(".")
    test = functions_of(module)[f"test_{function}"]
    used = {argument.arg for argument in test.args.args}
    used |= {node.id for node in ast.walk(test) if isinstance(node, ast.Name)}
    assert used & set(BROWSERS), f"{name} opens no browser"
