// Where something has been.

import { POSE_FLOATS } from "../view/scene.js";

/** How long a trail is, as a time of the history's clock [s], and of how many pieces at most. */
const SECONDS = 5;
const MOST_PIECES = 600;

/**
 * Places of a link in the frames up to one of them, the oldest first.
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
  for (let i = index; i >= 0 && places.length <= MOST_PIECES; i--) {
    const { header, payload, clock } = history.frames[i];
    // Frames of other bodies have other things in this place.
    if (header.layout !== last.header.layout || clock < last.clock - SECONDS) break;
    if (at + POSE_FLOATS <= header.poses * POSE_FLOATS) places.push([...new Float32Array(payload, 4 * at, 3)]);
  }
  return places.reverse();
}
