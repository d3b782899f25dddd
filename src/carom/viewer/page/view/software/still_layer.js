// What does not move, kept as a picture with depths. If the CPU renders, pixels are what takes time: with this picture
// only the part of the view is drawn anew in which something moves, or its shadow.

import { boundsOfLink } from "../bounds.js";
import { dot, scale, subtract } from "../maths.js";
import { Picture } from "../gpu.js";
import { boxOfDrawings } from "./covered.js";

/** @import { Solids } from "../arrows/solids.js" */
/** @import { Lines } from "../lines.js" */

/** More moving links than this are not worth a box each. */
const MAX_LINKS = 200;
/** A larger part of the view is not worth copying the rest. */
const MAX_OF_VIEW = 0.75;
/** Margin about what moves [pixels], and in texels of the shadow map. */
const MARGIN = 3;
const MARGIN_TEXELS = 3;
/** Lights that stand lower cast shadows that are too long [sine of the height]. */
const LOWEST_LIGHT = 0.15;
/** Points nearer to the plane of the eye cannot be projected [m]. */
const NEAREST = 0.02;

export class StillLayer {
  constructor(gl) {
    this.gl = gl;
    this.still = new Picture(gl);
    this.present = new Picture(gl);
    this.key = "";
    /** Whether the picture is that of `key`. */
    this.made = false;
    /** The part of the last picture that is not that of what does not move; null for all of it. */
    this.spoilt = null;
    this.ground = Infinity;
    this.clear = false;
  }

  /**
   * The part of the view that has to be drawn anew: column and row of its lower left corner, width and height
   * [pixels]; null if the whole picture has to be drawn, as for the first picture from a camera.
   *
   * @param {number[]} towards unit vector to the light
   * @param {number} texel width of a texel of the shadow map [m]; 0 without shadows
   */
  window(scene, camera, options, canvas, towards, texel) {
    const { moving, poses } = parted(scene);
    if (moving.length > MAX_LINKS) return null;
    const look = JSON.stringify([canvas.width, canvas.height, [...camera.matrix], scene.looks, options, texel, poses]);
    if (look !== this.key) {
      this.key = look;
      this.made = false;
      return null;
    }
    if (!this.made) this.survey(scene, camera, options);
    if (this.clear) return null;
    const up = camera.yUp ? 1 : 2;
    if (texel > 0 && this.ground < Infinity && towards[up] < LOWEST_LIGHT) return null;
    const rectangle = [1, 1, -1, -1];
    for (const [body, link] of moving) {
      const box = boundsOfLink(scene, body, link, options.collisions);
      if (!box) continue;
      for (let corner = 0; corner < 8; corner++) {
        const point = [0, 1, 2].map((i) => (corner & (1 << i) ? box[1][i] + MARGIN_TEXELS * texel : box[0][i] - MARGIN_TEXELS * texel));
        if (!this.include(rectangle, point, camera.matrix)) return null;
        if (texel === 0 || point[up] <= this.ground) continue;
        const shadow = subtract(point, scale(towards, (point[up] - this.ground) / towards[up]));
        if (!this.include(rectangle, shadow, camera.matrix)) return null;
      }
    }
    return pixels(rectangle, canvas);
  }

  /**
   * The part of the view that is drawn over: column and row of its lower left corner, width and height [pixels].
   *
   * @param {{lines: Lines, solids: Solids, clouds: object[], selected: object}} drawings
   */
  covered({ lines, solids, clouds, selected }, camera, canvas) {
    const all = [0, 0, canvas.width, canvas.height];
    if (clouds.length > 0 || selected !== undefined) return all;
    if (lines.count + solids.count === 0) return [0, 0, 0, 0];
    const { lower, upper, width } = boxOfDrawings(lines, solids);
    const rectangle = [1, 1, -1, -1];
    for (let corner = 0; corner < 8; corner++) {
      const point = [0, 1, 2].map((i) => (corner & (1 << i) ? upper[i] : lower[i]));
      if (!this.include(rectangle, point, camera.matrix)) return all;
    }
    return pixels(rectangle, canvas, MARGIN + (width * canvas.width) / camera.width) ?? all;
  }

  /** Extends a rectangle in clip coordinates by a point; false if that is not in front of the eye. */
  include(rectangle, point, matrix) {
    const row = (i) => dot([matrix[i], matrix[4 + i], matrix[8 + i]], point) + matrix[12 + i];
    const w = row(3);
    if (w < NEAREST) return false;
    [0, 1].forEach((i) => {
      const at = Math.min(Math.max(row(i) / w, -1), 1);
      rectangle[i] = Math.min(rectangle[i], at);
      rectangle[2 + i] = Math.max(rectangle[2 + i], at);
    });
    return true;
  }

  /** Notes how deep shadows may fall, and whether there are transparent shapes, which need all that is behind them. */
  survey(scene, camera, options) {
    const up = camera.yUp ? 1 : 2;
    this.ground = Infinity;
    for (const body of scene.bodies.values()) {
      body.links.forEach((link, index) => {
        const bounds = !link.moves && !scene.hidden.has(body.body) && boundsOfLink(scene, body, index, options.collisions);
        if (bounds) this.ground = Math.min(this.ground, bounds[0][up]);
      });
    }
    this.clear = scene.groups.some((group) => group.clear);
  }

  /** Draws the picture of what does not move: `draw` is given a function that makes it the target. */
  keep(canvas, draw) {
    draw(() => this.still.begin(canvas.width, canvas.height));
    this.made = true;
    this.spoilt = null;
  }

  /**
   * Draws the part of the view that has changed over the last picture, after what had changed there is restored.
   *
   * @param {number[]} window the part: x, y, width and height [pixels]
   * @param {number[]} covered the part that is drawn over afterwards
   */
  compose(window, covered, canvas, draw) {
    const [x, y, width, height] = window;
    const gl = this.gl;
    const all = [0, 0, canvas.width, canvas.height];
    draw(() => {
      this.present.begin(canvas.width, canvas.height, false);
      const both = gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT;
      // Copying takes the CPU as long as drawing the sky.
      this.copy(this.still.target, this.present.target, this.spoilt ?? all, both);
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.present.target);
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(x, y, width, height);
      gl.clear(gl.DEPTH_BUFFER_BIT);
    });
    gl.disable(gl.SCISSOR_TEST);
    this.spoilt = together(window, covered);
  }

  /** Shows the composed picture in its part of the canvas. */
  show({ x, y, width, height }) {
    this.copy(this.present.target, null, [0, 0, width, height], this.gl.COLOR_BUFFER_BIT, x, y);
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, null);
  }

  copy(from, to, window, what, right = 0, up = 0) {
    const [x, y, width, height] = window;
    const gl = this.gl;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
    const [left, low] = [x + right, y + up];
    gl.blitFramebuffer(x, y, x + width, y + height, left, low, left + width, low + height, what, gl.NEAREST);
  }
}

/** The links that move, as pairs of body and index, and the poses of the bodies that have others. */
function parted(scene) {
  const moving = [];
  const poses = [];
  for (const body of scene.bodies.values()) {
    if (scene.hidden.has(body.body)) continue;
    body.links.forEach((link, index) => {
      if (link.moves) moving.push([body, index]);
      const at = link.moves ? -1 : scene.poseAt(body.body, index);
      if (at >= 0) poses.push(...scene.poses.subarray(at, at + 7));
    });
  }
  return { moving, poses };
}

/** The pixels of a rectangle in clip coordinates; null if it is most of the view. */
function pixels(rectangle, { width, height }, margin = MARGIN) {
  const [left, low, right, high] = rectangle;
  if (right < left) return [0, 0, 0, 0];
  const edge = (at, size, more) => Math.round(Math.min(Math.max(((at + 1) / 2) * size + more, 0), size));
  const [x, y] = [edge(left, width, -margin), edge(low, height, -margin)];
  const [w, h] = [edge(right, width, margin) - x, edge(high, height, margin) - y];
  return w * h > MAX_OF_VIEW * width * height ? null : [x, y, w, h];
}

/** The smallest part of the view that has two others in it. */
function together(one, other) {
  if (one[2] * one[3] === 0) return other;
  if (other[2] * other[3] === 0) return one;
  const [x, y] = [0, 1].map((i) => Math.min(one[i], other[i]));
  const [right, high] = [0, 1].map((i) => Math.max(one[i] + one[2 + i], other[i] + other[2 + i]));
  return [x, y, right - x, high - y];
}
