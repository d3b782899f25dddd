// The box in the world that lines and solids of a picture fill.

import { LINE_FLOATS } from "../lines.js";
import { SOLID_FLOATS } from "../arrows/solids.js";

/** @import { Solids } from "../arrows/solids.js" */
/** @import { Lines } from "../lines.js" */

/** Places in the numbers of a line and of a solid. */
const LINE_WIDTH = 9;
const [SOLID_SHAFT, SOLID_HEAD] = [10, 11];

/**
 * The box of all lines and solids, and the width of the widest line.
 *
 * @param {Lines} lines
 * @param {Solids} solids
 * @returns {{lower: number[], upper: number[], width: number}} corners [m], infinite if there is nothing; width in
 *   pixels of the screen
 */
export function boxOfDrawings(lines, solids) {
  const [lower, upper] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  let width = 0;
  const include = (axis, at, radius) => {
    if (at - radius < lower[axis]) lower[axis] = at - radius;
    if (at + radius > upper[axis]) upper[axis] = at + radius;
  };
  const numbers = lines.used;
  for (let at = 0; at < numbers.length; at += LINE_FLOATS) {
    for (let i = 0; i < 6; i++) include(i % 3, numbers[at + i], 0);
    width = Math.max(width, numbers[at + LINE_WIDTH]);
  }
  const rods = solids.used;
  for (let at = 0; at < rods.length; at += SOLID_FLOATS) {
    const radius = Math.max(rods[at + SOLID_SHAFT], rods[at + SOLID_HEAD]);
    for (let i = 0; i < 3; i++) {
      include(i, rods[at + i], radius);
      include(i, rods[at + i] + rods[at + 3 + i], radius);
    }
  }
  return { lower, upper, width };
}
