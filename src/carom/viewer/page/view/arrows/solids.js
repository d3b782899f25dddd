// Solid arrows, rods and cones for forces and torques: the numbers of each, in one array that grows.

import { add, cross, scale } from "../maths.js";

/** Start, vector, colour with alpha, radius of the shaft, radius and length of the head. */
export const SOLID_FLOATS = 13;
const FIRST_ROOM = 64;
/** Length and radius of an arrow's head, in radii of its shaft; a head is at most half of a short arrow. */
const HEAD_LENGTH = 6;
const HEAD_RADIUS = 2.4;
/** Number of rods of a full circle. */
const PIECES = 32;

export class Solids {
  constructor() {
    this.data = new Float32Array(FIRST_ROOM * SOLID_FLOATS);
    this.clear();
  }

  clear() {
    this.count = 0;
    /** Number of opaque solids, the first ones. */
    this.opaque = 0;
    this.clouded = [];
  }

  arrow(start, vector, colour, radius) {
    const length = Math.hypot(...vector);
    // A short arrow is as thin as it is short: else its head would be a disc.
    const thin = Math.min(radius, (0.5 * length) / HEAD_LENGTH);
    if (length > 0) this.put(start, vector, [...colour, 1], thin, HEAD_RADIUS * thin, HEAD_LENGTH * thin);
  }

  /** An arc about an axis with a head at its end, from angle 0, which is along `zero`, to an angle [rad]. */
  arc(centre, axis, zero, size, angle, colour, radius) {
    const other = cross(axis, zero);
    const point = (at) => add(centre, add(scale(zero, size * Math.cos(at)), scale(other, size * Math.sin(at))));
    const pieces = Math.max(2, Math.ceil((Math.abs(angle) / (2 * Math.PI)) * PIECES));
    const step = angle / pieces;
    for (let i = 0; i < pieces; i++) {
      const [from, to] = [point(i * step), point((i + 1) * step)];
      this.put(from, to.map((x, k) => x - from[k]), [...colour, 1], radius, radius, 0);
    }
    const onward = add(scale(zero, -Math.sin(angle)), scale(other, Math.cos(angle)));
    this.put(point(angle), scale(onward, Math.sign(angle) * HEAD_LENGTH * radius), [...colour, 1], 0, HEAD_RADIUS * radius, HEAD_LENGTH * radius);
  }

  /** A cone with its tip at a point, which opens along an axis [m]; it is seen through. */
  cone(tip, axis, radius, colour, alpha) {
    const height = Math.hypot(...axis);
    if (height > 0) this.clouded.push([add(tip, axis), scale(axis, -1), [...colour, alpha], 0, radius, height]);
  }

  /** Puts what is seen through behind the opaque solids. Called once, when all are there. */
  end() {
    this.opaque = this.count;
    for (const cone of this.clouded) this.put(...cone);
  }

  put(start, vector, colour, shaft, head, headLength) {
    let at = this.count * SOLID_FLOATS;
    if (at === this.data.length) {
      const larger = new Float32Array(2 * this.data.length);
      larger.set(this.data);
      this.data = larger;
    }
    for (const part of [start, vector, colour]) for (const number of part) this.data[at++] = number;
    this.data.set([shaft, head, headLength], at);
    this.count += 1;
  }

  /** The numbers of all solids. */
  get used() {
    return this.data.subarray(0, this.count * SOLID_FLOATS);
  }
}
