// The views of the cameras of files.

import { cross, perspective, turned, unit, viewMatrix } from "../maths.js";

const NEAR = 0.01;
const FAR = 1000;

/** Where a camera of a file is and how it is turned: `at` is its place on its link, see `Stage.place`. */
export function frameOf(at) {
  if (!at.aimed) return { right: turned(at.orientation, [1, 0, 0]), up: turned(at.orientation, [0, 1, 0]) };
  const right = unit(cross(at.direction, Math.abs(at.direction[2]) < 0.999 ? [0, 0, 1] : [0, 1, 0]));
  return { right, up: cross(right, at.direction) };
}

/**
 * The facts of a lens that sees what a camera of a file sees now; null if its link is not there.
 *
 * @param {import("./stage.js").Stage} stage
 * @param {number} number of the camera
 */
export function fileLens(stage, number) {
  const camera = stage.facts?.cameras[number];
  const at = camera && stage.place(camera, [0, 0, -1]);
  if (!at) return null;
  const { right, up } = frameOf(at);
  const projection = perspective(camera.aspect, NEAR, FAR);
  const zoom = 1 / Math.tan((camera.angle * Math.PI) / 360);
  projection[0] *= zoom;
  projection[5] *= zoom;
  return {
    lens: `file ${number}`,
    name: camera.name || `camera ${number}`,
    view: [...viewMatrix(at.position, right, up, at.direction)],
    projection: [...projection],
    width: camera.aspect,
    height: 1,
  };
}
