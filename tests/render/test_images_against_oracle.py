"""Images agree with those PyBullet's software renderer took of the same scenes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from image_scenes import FAR, SCENES, Scene, take_picture
from record_oracle import DEPTH_STEP, IMAGES

import pybullet as p

Images = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def oracle() -> Images:
    with np.load(IMAGES) as archive:
        return dict(archive)


@pytest.fixture(scope="module", params=SCENES, ids=lambda scene: scene.name)
def pictures(request: pytest.FixtureRequest, oracle: Images) -> Iterator[tuple[Images, Images]]:
    """PyBullet's image and ours: colour, depth and label of each."""
    scene: Scene = request.param
    client = p.connect(p.DIRECT)
    rgba, depth, label = take_picture(p, scene)
    p.disconnect(client)
    theirs = {name: oracle[f"{scene.name}_{name}"] for name in ("colour", "depth", "label")}
    theirs["depth"] = theirs["depth"] * DEPTH_STEP
    ours = {"colour": rgba[:, :, :3], "depth": depth.astype(np.float64), "label": label}
    yield theirs, ours | {"near": np.array(scene.near), "alike": np.array(scene.alike)}


def test_the_same_links_are_seen_in_the_same_pixels(pictures):
    theirs, ours = pictures
    assert np.mean(theirs["label"] == ours["label"]) >= 0.995


def test_nothing_is_missing_or_made_up(pictures):
    theirs, ours = pictures
    labels, counts = np.unique(theirs["label"], return_counts=True)
    assert set(labels[counts > 8]) <= set(np.unique(ours["label"])) <= set(labels) | {-1}


def test_depths_agree(pictures):
    theirs, ours = pictures
    assert np.mean(np.abs(theirs["depth"] - ours["depth"]) < 1e-4) >= 0.995


def test_distances_agree_within_a_percent(pictures):
    theirs, ours = pictures
    near, far = ours["near"], FAR
    theirs_m, ours_m = (far * near / (far - (far - near) * image["depth"]) for image in (theirs, ours))
    seen = (theirs["label"] == ours["label"]) & (theirs["label"] >= 0)
    assert np.mean(np.abs(theirs_m - ours_m)[seen] < 0.01 * theirs_m[seen]) >= 0.999


def test_colours_look_the_same(pictures):
    theirs, ours = pictures
    difference = np.abs(theirs["colour"].astype(int) - ours["colour"]).max(axis=2)
    assert np.mean(difference <= 2) >= ours["alike"]
    assert structural_similarity(theirs["colour"], ours["colour"]) >= 0.95


def test_the_recording_names_its_version(oracle):
    assert oracle["pybullet"] == "3.2.7"


def structural_similarity(a: np.ndarray, b: np.ndarray) -> float:
    """Mean structural similarity of two images over windows of 8 x 8 pixels, of their brightness."""
    windows = [
        np.lib.stride_tricks.sliding_window_view(image.mean(axis=2), (8, 8)).reshape(-1, 64)
        for image in (a.astype(float), b.astype(float))
    ]
    x, y = windows
    mean_x, mean_y = x.mean(axis=1), y.mean(axis=1)
    covariance = ((x - mean_x[:, None]) * (y - mean_y[:, None])).mean(axis=1)
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    similarity = (2 * mean_x * mean_y + c1) * (2 * covariance + c2)
    similarity /= (mean_x**2 + mean_y**2 + c1) * (x.var(axis=1) + y.var(axis=1) + c2)
    return float(similarity.mean())
