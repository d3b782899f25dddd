// The view of a script's camera: its projection, with the aspect of its image, in the middle of the window.

import { add, multiply, scale } from "./maths.js";

export class Lens {
  /** @param {{lens: number | string, view: number[], projection: number[], width: number, height: number}} facts matrices by columns */
  constructor({ lens, view, projection, width, height }) {
    /** What the list of cameras knows it by. */
    this.key = lens;
    this.view = view;
    this.projection = projection;
    this.aspect = width / height;
    const row = (i) => [view[i], view[4 + i], view[8 + i]];
    this.right = row(0);
    this.up = row(1);
    this.forward = scale(row(2), -1);
    this.eye = [0, 1, 2].map((i) => -(view[4 * i] * view[12] + view[4 * i + 1] * view[13] + view[4 * i + 2] * view[14]));
  }

  /** Fits the image into a window: shares of the window that it takes across and upright. */
  fit(width, height) {
    const ratio = this.aspect / (width / height);
    this.shares = [Math.min(ratio, 1), Math.min(1 / ratio, 1)];
    const [x, y] = this.shares;
    this.fitted = this.projection.map((value, i) => (i % 4 === 0 ? value * x : i % 4 === 1 ? value * y : value));
    this.matrix = multiply(this.fitted, this.view);
  }

  /** Directions: of the middle of the window, and from there to its right and to its upper edge. */
  get spread() {
    const p = this.fitted;
    const middle = add(this.forward, add(scale(this.right, p[8] / p[0]), scale(this.up, p[9] / p[5])));
    return [middle, scale(this.right, 1 / p[0]), scale(this.up, 1 / p[5])];
  }
}
