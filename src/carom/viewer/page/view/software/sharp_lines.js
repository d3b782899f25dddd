// Lines that are seen through bodies, drawn with all pixels over a picture that is drawn with fewer.

import { LINE_FLOATS } from "../lines.js";

/** @import { Camera } from "../camera.js" */
/** @import { Lines } from "../lines.js" */

const [COLOUR, WIDTH] = [6, 9];
/** Lines are cut off where they come nearer to the plane of the eye [m]. */
const NEAREST = 0.01;

export class SharpLines {
  /** @param {HTMLCanvasElement} view the canvas of the coarse picture */
  constructor(view) {
    this.view = view;
    /** Over the view, under the texts. */
    this.canvas = /** @type {HTMLCanvasElement} */ (document.getElementById("sharp-lines"));
    // It is drawn by the processor in any case.
    this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    this.clear();
  }

  clear() {
    if (this.canvas.hidden) return;
    this.canvas.hidden = true;
    [this.canvas.width, this.canvas.height] = [1, 1];
  }

  /**
   * Draws those of the lines that are visible through bodies.
   *
   * @param {Lines} lines
   * @param {Camera} camera
   * @param {boolean} first whether this is the first view of a picture
   */
  draw(lines, camera, first) {
    if (lines.outside === lines.count) return first ? this.clear() : undefined;
    const { canvas, context, view } = this;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [view.clientWidth, view.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    if (canvas.width !== width || canvas.height !== height) {
      [canvas.width, canvas.height] = [width, height];
      [canvas.style.width, canvas.style.height] = [`${view.clientWidth}px`, `${view.clientHeight}px`];
    } else if (first) context.clearRect(0, 0, width, height);
    canvas.hidden = false;
    context.lineCap = "round";
    let style = "";
    context.save();
    context.scale(ratio, ratio);
    context.beginPath();
    context.rect(camera.left, camera.top, camera.width, camera.height);
    context.clip();
    context.beginPath();
    for (let at = lines.outside * LINE_FLOATS; at < lines.used.length; at += LINE_FLOATS) {
      const numbers = lines.data.subarray(at, at + LINE_FLOATS);
      const ends = seen(numbers, camera.matrix);
      if (!ends) continue;
      const next = numbers.subarray(COLOUR).join();
      if (next !== style) {
        context.stroke();
        context.beginPath();
        context.strokeStyle = `rgb(${[...numbers.subarray(COLOUR, WIDTH)].map((part) => Math.round(255 * part)).join()})`;
        context.lineWidth = numbers[WIDTH];
        style = next;
      }
      const [x, y, toX, toY] = ends.map((part, i) => i % 2 ? camera.top + ((1 - part) * camera.height) / 2 : camera.left + ((1 + part) * camera.width) / 2);
      context.moveTo(x, y);
      context.lineTo(toX, toY);
    }
    context.stroke();
    context.restore();
  }
}

/**
 * Both ends of a line in clip coordinates: x, y, x, y; null for a line behind the eye.
 *
 * @param {Float32Array} line
 * @param {ArrayLike<number>} matrix
 */
function seen(line, matrix) {
  const [a, b] = [0, 3].map((at) =>
    [0, 1, 3].map((i) => matrix[i] * line[at] + matrix[4 + i] * line[at + 1] + matrix[8 + i] * line[at + 2] + matrix[12 + i]),
  );
  if (a[2] < NEAREST && b[2] < NEAREST) return null;
  const cut = (from, to) => {
    if (from[2] >= NEAREST) return from;
    const part = (NEAREST - from[2]) / (to[2] - from[2]);
    return from.map((x, i) => x + part * (to[i] - x));
  };
  return [cut(a, b), cut(b, a)].flatMap(([x, y, w]) => [x / w, y / w]);
}
