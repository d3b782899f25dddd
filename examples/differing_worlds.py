"""Worlds with different terrains and objects: all are in the scene, and each world has some of them."""

import numpy as np

from carom import World, Worlds

STEPS = np.repeat(0.04 * np.arange(20.0), 3)[:40]


def main(count=300, episodes=3):
    world = World(time_step=1 / 240)
    world.gravity = (0.0, 0.0, -9.81)
    random = np.random.default_rng(0)
    x = np.linspace(0.0, 4.0, 40)
    flat, slope, stairs = np.zeros((40, 40)), np.tile(0.1 * x, (40, 1)), np.tile(STEPS, (40, 1))
    terrains = [world.add_heightfield(heights, (0.1, 0.1)) for heights in (flat, slope, stairs)]
    ball = world.add_sphere(0.1, (0.0, 0.0, 1.5), friction=0.5)
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 1.5), friction=0.5)

    worlds = Worlds(world, count)
    start = worlds.snapshot()
    rolled = {}
    for episode in range(episodes):
        # Each world begins anew; the terrains it may get become harder from episode to episode.
        worlds.restore(start)
        level = random.integers(0, min(episode + 1, len(terrains)), count)
        has_ball = random.random(count) < 0.5
        for number, terrain in enumerate(terrains):
            worlds[terrain].present = level == number
        worlds[ball].present = has_ball
        worlds[box].present = ~has_ball
        worlds.step(480)
        far = -np.where(has_ball, worlds[ball].pose.position[:, 0], worlds[box].pose.position[:, 0])
        for number in range(len(terrains)):
            for name, there in (("ball", has_ball), ("box", ~has_ball)):
                here = (level == number) & there
                if here.any():
                    rolled[number, name] = float(far[here].mean())
                    who = f"episode {episode}, terrain {number}: {here.sum()} with a {name}"
                    print(f"{who}, {far[here].mean():.2f} m down")
    return rolled


if __name__ == "__main__":
    main()
