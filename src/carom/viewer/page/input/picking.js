// Picking: finding the shape under the mouse, and pulling or turning its body.

import { add, dot, quaternionProduct, scale, subtract, turned } from "../view/maths.js";
import { FromPage } from "../protocol.js";

/** The nearest shape hit by a ray: body, link, distance, and point in world and link; null without a hit. */
export function pick(scene, options, eye, direction) {
  let nearest = null;
  for (const group of scene.groups) {
    if (group.site || !options.shows(group)) continue;
    for (const { body, shape } of group.members) {
      if (scene.hidden.has(body.body)) continue;
      const pose = scene.inertialPose(body.body, shape.link);
      if (!pose) continue;
      const back = inverse(pose.orientation);
      const own = inverse(shape.orientation);
      // The ray in the frame of the link, then of the shape, then of its mesh.
      const start = turned(own, subtract(turned(back, subtract(eye, pose.position)), shape.position));
      const along = turned(own, turned(back, direction));
      const from = start.map((x, i) => x / shape.scale[i]);
      const way = along.map((x, i) => x / shape.scale[i]);
      const distance = hit(group.mesh, from, way, nearest?.distance ?? Infinity);
      if (distance === null) continue;
      const point = add(eye, scale(direction, distance));
      const local = turned(back, subtract(point, pose.position));
      nearest = { body: body.body, link: shape.link, distance, point, local };
    }
  }
  return nearest;
}

/** Bodies without shapes are chosen by a click so near to a link [pixels]. */
const NEAR = 12;

/**
 * The link nearest to a pixel of those whose bodies have no shapes, which crosses show: body and link; null if none is near.
 *
 * @param {Camera} camera
 */
export function pickShapeless(scene, camera, x, y) {
  let [nearest, least] = [null, NEAR];
  for (const { body, links, shapes } of scene.bodies.values()) {
    if (shapes.length > 0 || scene.hidden.has(body)) continue;
    for (let link = 0; link < links.length; link++) {
      const pose = scene.linkPose(body, link);
      const pixel = pose && camera.pixel(pose.position);
      const distance = pixel ? Math.hypot(pixel[0] - x, pixel[1] - y) : Infinity;
      if (distance < least) [nearest, least] = [{ body, link }, distance];
    }
  }
  return nearest;
}

/** Smallest ray parameter (factor of `way`) below `limit` at which a ray hits a mesh; null without a hit. */
function hit(mesh, from, way, limit) {
  if (!meetsBounds(mesh.bounds, from, way, limit)) return null;
  const { positions, indices } = mesh;
  let best = limit;
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [3 * indices[t], 3 * indices[t + 1], 3 * indices[t + 2]];
    const [ux, uy, uz] = [0, 1, 2].map((i) => positions[b + i] - positions[a + i]);
    const [vx, vy, vz] = [0, 1, 2].map((i) => positions[c + i] - positions[a + i]);
    const px = way[1] * vz - way[2] * vy;
    const py = way[2] * vx - way[0] * vz;
    const pz = way[0] * vy - way[1] * vx;
    const det = ux * px + uy * py + uz * pz;
    if (Math.abs(det) < 1e-20) continue;
    const [sx, sy, sz] = [0, 1, 2].map((i) => from[i] - positions[a + i]);
    const u = (sx * px + sy * py + sz * pz) / det;
    if (u < 0 || u > 1) continue;
    const qx = sy * uz - sz * uy;
    const qy = sz * ux - sx * uz;
    const qz = sx * uy - sy * ux;
    const v = (way[0] * qx + way[1] * qy + way[2] * qz) / det;
    if (v < 0 || u + v > 1) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / det;
    if (distance > 0 && distance < best) best = distance;
  }
  return best < limit ? best : null;
}

function meetsBounds({ lower, upper }, from, way, limit) {
  let [enter, leave] = [0, limit];
  for (let i = 0; i < 3; i++) {
    if (way[i] === 0) {
      if (from[i] < lower[i] || from[i] > upper[i]) return false;
      continue;
    }
    const [a, b] = [(lower[i] - from[i]) / way[i], (upper[i] - from[i]) / way[i]];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave;
}

/** @type {(quaternion: Quaternion) => Quaternion} */
const inverse = ([x, y, z, w]) => [-x, -y, -z, w];

/** @import { Camera } from "../view/camera.js" */
/** @import { Quaternion } from "../view/maths.js" */

/** Angle by which a body turns for a motion of the mouse [rad / pixel]. */
const TURN_PER_PIXEL = 0.01;

/** Grabs a body, and pulls its point in the plane that faces the viewer, or turns it. */
export class Grasp {
  constructor(scene, camera, options, send) {
    this.scene = scene;
    this.camera = camera;
    this.options = options;
    this.send = send;
    this.held = null;
  }

  get busy() {
    return this.held !== null;
  }

  /** The body and link that is being turned, if any. */
  get turned() {
    return this.held?.from ? this.held : null;
  }

  begin(x, y, turning = false) {
    if (!this.options.picking) return;
    const direction = this.camera.ray(x, y);
    const found = pick(this.scene, this.options, this.camera.eye, direction);
    if (!found || !this.scene.bodies.get(found.body).links[found.link].moves) return;
    const { body, link, local, point } = found;
    if (turning) {
      this.held = { body, link, start: [x, y], from: this.scene.inertialPose(body, link).orientation };
      return;
    }
    this.held = { body, link, local, target: point, depth: found.distance * dot(direction, this.camera.forward) };
    this.send({ type: FromPage.GRASP, body, link: link - 1, point: local, target: point });
  }

  move(x, y) {
    if (this.turned) return this.turn(x, y);
    const direction = this.camera.ray(x, y);
    const distance = this.held.depth / dot(direction, this.camera.forward);
    this.held.target = add(this.camera.eye, scale(direction, distance));
    this.send({ type: FromPage.PULL, target: this.held.target });
  }

  /** Turns the body about the upward axis of the view by motions to the side, and about the other one by those up. */
  turn(x, y) {
    const { body, link, start, from } = this.held;
    const [side, down] = [x - start[0], y - start[1]];
    const vector = add(scale(this.camera.up, side), scale(this.camera.right, down));
    const pixels = Math.hypot(...vector);
    if (pixels === 0) return;
    const half = (TURN_PER_PIXEL * pixels) / 2;
    const turn = [...scale(vector, Math.sin(half) / pixels), Math.cos(half)];
    this.send({ type: FromPage.TURN, body, link: link - 1, orientation: quaternionProduct(turn, from) });
  }

  end() {
    if (this.held) this.send({ type: FromPage.LET_GO });
    this.held = null;
  }

  /** Start and end of the line from the grabbed point to the target of the pull. */
  line() {
    const pose = this.held?.local && this.scene.inertialPose(this.held.body, this.held.link);
    return pose ? [add(pose.position, turned(pose.orientation, this.held.local)), this.held.target] : null;
  }
}
