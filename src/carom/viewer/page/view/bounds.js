// Bounding boxes of links, bodies and the whole scene.

import { add, turned } from "./maths.js";

/** A box larger than this along two axes is a floor or a backdrop, and is not fitted into the view [m]. */
const FLOOR = 9;
/** A floor is below a body if the body is at most so deep in it [m]. */
const UNDER = 0.1;
/** Bodies that are higher above the floor than this multiple of their size (which counts as at least `LOW` [m]) are
 * shown without the floor. */
const HIGH = 20;
const LOW = 0.2;

/** Lower and upper corner of a link's bounding box, in the world; null for a link without shapes or pose. */
export function boundsOfLink(scene, body, link, collisions) {
  const pose = scene.inertialPose(body.body, link);
  const shapes = body.shapes.filter((shape) => shape.link === link && !!shape.collision === collisions && !shape.site);
  if (!pose || shapes.length === 0) return null;
  const box = emptyBox();
  for (const shape of shapes) {
    const mesh = scene.meshes.get(shape.meshes[0][0]);
    if (!mesh) continue;
    for (let corner = 0; corner < 8; corner++) {
      const local = [0, 1, 2].map((i) => (corner & (1 << i) ? mesh.bounds.upper : mesh.bounds.lower)[i] * shape.scale[i]);
      extend(box, add(pose.position, turned(pose.orientation, add(shape.position, turned(shape.orientation, local)))));
    }
  }
  return box[0][0] <= box[1][0] ? box : null;
}

/**
 * Bounding box of a body, or of those of its links for which `picked` is true; without floors. Of a body without shapes
 * it is that of the origins of its links.
 *
 * @param {(link: number) => boolean} picked
 */
export function boundsOfBody(scene, body, collisions, picked = (_link) => true) {
  const box = emptyBox();
  body.links.forEach((_, link) => {
    const bounds = picked(link) && (body.shapes.length > 0 ? boundsOfLink(scene, body, link, collisions) : boundsOfOrigin(scene, body, link));
    if (bounds && !isFloor(bounds)) bounds.forEach((corner) => extend(box, corner));
  });
  return box[0][0] <= box[1][0] ? box : null;
}

/** The origin of a link as a box; null while its pose is not known. */
function boundsOfOrigin(scene, body, link) {
  const pose = scene.linkPose(body.body, link);
  return pose && [pose.position, pose.position];
}

/** Bounding box of all visible bodies, without floors. */
export function boundsOfScene(scene, collisions) {
  const box = emptyBox();
  for (const body of scene.bodies.values()) {
    if (!scene.hidden.has(body.body)) boundsOfBody(scene, body, collisions)?.forEach((corner) => extend(box, corner));
  }
  return box[0][0] <= box[1][0] ? box : null;
}

/**
 * A box, extended to the floor that it is above, if there is one.
 *
 * @param {number[][]} box
 * @returns {number[][]}
 */
export function downToFloor(scene, box, collisions, axis) {
  const [lower, upper] = box;
  let ground = -Infinity;
  for (const body of scene.bodies.values()) {
    body.links.forEach((_, link) => {
      const bounds = boundsOfLink(scene, body, link, collisions);
      if (bounds && isFloor(bounds) && bounds[1][axis] <= lower[axis] + UNDER) ground = Math.max(ground, bounds[1][axis]);
    });
  }
  if (lower[axis] - ground > HIGH * Math.max(...upper.map((x, i) => x - lower[i]), LOW)) return [lower, upper];
  return [lower.map((x, i) => (i === axis ? Math.min(x, ground) : x)), upper];
}

/** @param {number[][]} box */
export function isFloor(box) {
  const [lower, upper] = box;
  return [0, 1, 2].filter((i) => upper[i] - lower[i] > FLOOR).length >= 2;
}

function emptyBox() {
  return [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
}

/**
 * @param {number[][]} box
 * @param {number[]} point
 */
function extend(box, point) {
  const [lower, upper] = box;
  for (let i = 0; i < 3; i++) {
    lower[i] = Math.min(lower[i], point[i]);
    upper[i] = Math.max(upper[i], point[i]);
  }
}
