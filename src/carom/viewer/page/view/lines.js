// Lines for the renderer: start, end, colour and width of each, in one array that grows.

import { add, cross, scale, subtract, unit } from "./maths.js";

export const LINE_FLOATS = 10;
const FIRST_ROOM = 256;
/** Length of an arrow's head, as a fraction of the arrow's length. */
const HEAD = 0.18;
/** Number of line segments of a full circle. */
const PIECES = 32;

export class Lines {
  constructor() {
    this.data = new Float32Array(FIRST_ROOM * LINE_FLOATS);
    this.count = 0;
    this.seenThrough = null;
  }

  clear() {
    this.count = 0;
    this.seenThrough = null;
  }

  /** Marks all lines added from now on as inside bodies: they are visible through the bodies. */
  goInside() {
    this.seenThrough = this.count;
  }

  /** Number of lines, the first ones, that are hidden by surfaces in front of them. */
  get outside() {
    return this.seenThrough ?? this.count;
  }

  /** The numbers of all lines. */
  get used() {
    return this.data.subarray(0, this.count * LINE_FLOATS);
  }

  line(start, end, colour, width = 1.5) {
    let at = this.count * LINE_FLOATS;
    if (at === this.data.length) {
      const larger = new Float32Array(2 * this.data.length);
      larger.set(this.data);
      this.data = larger;
    }
    for (const part of [start, end, colour]) for (let i = 0; i < 3; i++) this.data[at++] = part[i];
    this.data[at] = width;
    this.count += 1;
  }

  /** An arrow from a point along a vector. */
  arrow(from, vector, colour, width = 2.5) {
    const tip = add(from, vector);
    this.line(from, tip, colour, width);
    const [side, other] = across(vector);
    const size = Math.hypot(...vector) * HEAD;
    const back = subtract(tip, scale(vector, HEAD));
    for (const way of [side, scale(side, -1), other, scale(other, -1)]) {
      this.line(tip, add(back, scale(way, size * 0.5)), colour, width);
    }
  }

  /** An arc about an axis, from one angle to another [rad]; angle 0 is along `zero`. */
  arc(centre, axis, zero, radius, from, to, colour, width = 2) {
    const other = cross(axis, zero);
    const point = (angle) => add(centre, add(scale(zero, radius * Math.cos(angle)), scale(other, radius * Math.sin(angle))));
    const pieces = Math.max(2, Math.ceil((Math.abs(to - from) / (2 * Math.PI)) * PIECES));
    for (let i = 0; i < pieces; i++) {
      const at = (k) => from + ((to - from) * k) / pieces;
      this.line(point(at(i)), point(at(i + 1)), colour, width);
    }
  }

  /** A cross of three short lines. */
  star(point, size, colour, width = 2) {
    for (let i = 0; i < 3; i++) {
      const arm = [0, 1, 2].map((k) => (k === i ? size : 0));
      this.line(subtract(point, arm), add(point, arm), colour, width);
    }
  }

  /** The edges of a box between two corners; `place` transforms its corners into the world. */
  box(lower, upper, place, colour, width = 1) {
    const corner = (bits) => place([0, 1, 2].map((i) => (bits & (1 << i) ? upper[i] : lower[i])));
    for (let bits = 0; bits < 8; bits++) {
      for (let i = 0; i < 3; i++) if (!(bits & (1 << i))) this.line(corner(bits), corner(bits | (1 << i)), colour, width);
    }
  }
}

/** Two unit vectors, perpendicular to a vector and to each other. */
export function across(vector) {
  const along = unit(vector);
  const side = unit(cross(along, Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  return [side, cross(along, side)];
}
