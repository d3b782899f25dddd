// Does with Rapier what heaps_engine.py does with the other engines: node heaps_rapier.mjs RAPIER SCENE
import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const [, , folder, file] = process.argv;
const module = `${folder}/node_modules/@dimforge/rapier3d-compat/dist/rapier.mjs`;
const { default: RAPIER } = await import(pathToFileURL(module).href);
await RAPIER.init();
const scene = JSON.parse(readFileSync(file, "utf8"));

// Its capsules and cylinders are along y.
const UPRIGHT = { x: Math.SQRT1_2, y: 0, z: 0, w: Math.SQRT1_2 };

function shapeOf(kind, size) {
  if (kind === "box") return RAPIER.ColliderDesc.cuboid(...size);
  if (kind === "sphere") return RAPIER.ColliderDesc.ball(size[0]);
  if (kind === "capsule") return RAPIER.ColliderDesc.capsule(size[1], size[0]).setRotation(UPRIGHT);
  return RAPIER.ColliderDesc.cylinder(size[1], size[0]).setRotation(UPRIGHT);
}

const world = new RAPIER.World({ x: 0, y: 0, z: -9.81 });
world.timestep = scene.time_step;
const floor = RAPIER.ColliderDesc.cuboid(500, 500, 1).setTranslation(0, 0, -1).setFriction(scene.friction);
world.createCollider(floor);
for (const [centre, half] of scene.walls) {
  const wall = RAPIER.ColliderDesc.cuboid(...half).setTranslation(...centre);
  world.createCollider(wall.setFriction(scene.friction));
}
const bodies = scene.bodies.map(([kind, size, position, [x, y, z, w]]) => {
  const described = RAPIER.RigidBodyDesc.dynamic().setTranslation(...position).setRotation({ x, y, z, w });
  // Nothing sleeps in the other engines either.
  const body = world.createRigidBody(described.setCanSleep(false));
  world.createCollider(shapeOf(kind, size).setMass(1).setFriction(scene.friction), body);
  return body;
});

let settled = false;
for await (const line of createInterface({ input: process.stdin })) {
  const before = process.cpuUsage();
  for (let left = Number(line); left > 0; left--) world.step();
  const used = process.cpuUsage(before);
  const answer = { processor: (used.user + used.system) / 1e6 };
  if (!settled) {
    answer.heights = bodies.map((body) => body.translation().z);
    answer.speeds = bodies.map((body) => Math.hypot(...Object.values(body.linvel())));
  }
  settled = true;
  console.log(`answer: ${JSON.stringify(answer)}`);
}
