// The trail of a link: its recent positions.

import { POSE_FLOATS } from "../view/scene.js";

/** @import { History } from "./history.js" */
/** @import { Scene } from "../view/scene.js" */

/** Duration of a trail on the history's clock [s], and its maximum number of segments. */
const SECONDS = 5;
const MAX_PIECES = 600;

/**
 * Positions of a link in the frames up to a given one, the oldest first.
 *
 * @param {History} history
 * @param {number} index of the last frame
 * @param {Scene} scene
 * @param {?{body: number, link: ?number}} selection the link; null for the base
 */
export function trailOf(history, index, scene, selection) {
  const at = selection ? scene.poseAt(selection.body, selection.link ?? 0) : -1;
  const last = history.frames[index];
  if (at < 0 || !last) return [];
  const places = [];
  for (let i = index; i >= 0 && places.length <= MAX_PIECES; i--) {
    const { header, payload, clock } = history.frames[i];
    // Frames with another layout have the poses of other bodies at this index.
    if (header.layout !== last.header.layout || clock < last.clock - SECONDS) break;
    if (at + POSE_FLOATS <= header.poses * POSE_FLOATS) places.push([...new Float32Array(payload, 4 * at, 3)]);
  }
  return places.reverse();
}
