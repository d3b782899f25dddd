// The camera: it circles a target, as PyBullet's does. Angles in degrees.

import { add, cross, dot, multiply, perspective, scale, subtract, unit, viewMatrix } from "./maths.js";

/** @import { Vector } from "./maths.js" */

const NEAR = 0.01;
const FAR = 1000;
const DEGREES_PER_PIXEL = 0.3;
const STEEPEST = 89.9;

/** Distance of a camera that shows a sphere, in radii (1.41 would just do); and the smallest radius [m]. */
const FIT_MARGIN = 1.5;
const MIN_FIT = 0.15;
/** What is left free in a small window counts as this share of it at least: some of the view is then covered. */
const MIN_FREE = 0.75;
/** Yaw and pitch of the preset views [degrees]. */
export const PRESETS = {
  corner: [50, -35],
  front: [90, 0],
  back: [-90, 0],
  left: [180, 0],
  right: [0, 0],
  top: [0, -STEEPEST],
  below: [0, STEEPEST],
};

export class Camera {
  constructor() {
    this.distance = 5;
    this.yaw = 50;
    this.pitch = -35;
    /** @type {Vector} */
    this.target = [0, 0, 0];
    /** Last position of the point that the camera follows; null if there is none. */
    this.followed = null;
    this.yUp = false;
    /** The lens of a script's camera while the view is that camera's; null for the user's own view, which is kept. */
    this.lens = null;
    this.width = 1;
    this.height = 1;
    /** Where the view lies in the window [pixels]. */
    this.left = 0;
    this.top = 0;
    this.update();
  }

  set(camera) {
    for (const name of ["distance", "yaw", "pitch", "target"]) this[name] = camera[name];
    this.update();
  }

  /** Sets the size of the view, and where its upper left corner is in the window [pixels]. */
  resize(width, height, left = 0, top = 0) {
    Object.assign(this, { width, height, left, top });
    this.update();
  }

  /** Takes the view of a script's camera; null goes back to the user's own. */
  look(lens) {
    this.lens = lens;
    this.update();
  }

  orbit(dx, dy) {
    this.lens = null;
    this.yaw -= dx * DEGREES_PER_PIXEL;
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.pitch - dy * DEGREES_PER_PIXEL));
    this.update();
  }

  /** Moves the target so that objects there follow the mouse. */
  pan(dx, dy) {
    this.look(null);
    const perPixel = (2 * this.distance) / this.height;
    const shift = add(scale(this.right, -dx * perPixel), scale(this.up, dy * perPixel));
    this.target = add(this.target, shift);
    this.update();
  }

  zoom(factor) {
    this.lens = null;
    this.distance = Math.max(0.02, Math.min(500, this.distance * factor));
    this.update();
  }

  update() {
    const yaw = (this.yaw * Math.PI) / 180;
    const pitch = (this.pitch * Math.PI) / 180;
    const [s, c] = [Math.sin(yaw), Math.cos(yaw)];
    const [sp, cp] = [Math.sin(pitch), Math.cos(pitch)];
    if (this.yUp) {
      this.forward = [cp * s, sp, cp * c];
      this.right = [-c, 0, s];
    } else {
      this.forward = [-cp * s, cp * c, sp];
      this.right = [c, s, 0];
    }
    this.up = cross(this.right, this.forward);
    this.eye = subtract(this.target, scale(this.forward, this.distance));
    this.view = viewMatrix(this.eye, this.right, this.up, this.forward);
    this.projection = perspective(this.width / this.height, NEAR, FAR);
    this.matrix = multiply(this.projection, this.view);
    /** The point about which shadows are drawn, and how far it is. */
    this.centre = this.target;
    this.reach = this.distance;
    if (!this.lens) return;
    this.lens.fit(this.width, this.height);
    const { eye, forward, right, up, view, fitted, matrix } = this.lens;
    this.eye = eye;
    this.forward = forward;
    this.right = right;
    this.up = up;
    this.view = view;
    this.matrix = matrix;
    this.projection = fitted;
    // Where a script's camera, or that of a file, sees what the user's own view is of.
    this.reach = Math.max(dot(subtract(this.target, eye), forward), MIN_FIT);
    this.centre = add(eye, scale(forward, this.reach));
  }

  /** Directions: of the middle of the window, and from there to its right and to its upper edge. */
  get spread() {
    return this.lens?.spread ?? [this.forward, scale(this.right, this.width / this.height), this.up];
  }

  /**
   * Moves the camera so that a whole box is in view; its direction stays.
   *
   * @param {number[][]} box lower and upper corner
   * @param {{side: number, below: number}} insets what covers the view at its right and at its bottom [pixels]
   */
  fit([lower, upper], { side, below } = { side: 0, below: 0 }) {
    this.lens = null;
    this.target = scale(add(lower, upper), 0.5);
    const radius = Math.max(0.5 * Math.hypot(...subtract(upper, lower)), MIN_FIT);
    // The vertical field of view is 90 degrees; in a tall window the horizontal one is narrower.
    const whole = Math.min(this.width, this.height);
    const free = Math.max(Math.min(this.width - 2 * side, this.height - 2 * below), MIN_FREE * whole);
    this.distance = (FIT_MARGIN * radius * this.height) / Math.max(Math.min(free, whole), 1);
    this.update();
  }

  /** Sets the direction of a preset view. */
  preset(name) {
    this.lens = null;
    [this.yaw, this.pitch] = PRESETS[name];
    this.update();
  }

  /** Moves the camera along with a moving point; null ends that. */
  follow(point) {
    if (this.followed && point) {
      this.target = add(this.target, subtract(point, this.followed));
      this.update();
    }
    this.followed = point;
  }

  /** Unit vector from the eye through a pixel of the window. */
  ray(x, y) {
    const [middle, rightward, overhead] = this.spread;
    return unit(add(middle, add(scale(rightward, (2 * (x - this.left)) / this.width - 1), scale(overhead, 1 - (2 * (y - this.top)) / this.height))));
  }

  /** Pixel of a point in the window, and its depth along the view direction; null for points behind the eye. */
  pixel(point) {
    const offset = subtract(point, this.eye);
    const depth = dot(offset, this.forward);
    if (depth < NEAR) return null;
    const row = (i) => dot([this.matrix[i], this.matrix[4 + i], this.matrix[8 + i]], point) + this.matrix[12 + i];
    const [x, y] = [row(0) / row(3), row(1) / row(3)];
    return [this.left + ((x + 1) / 2) * this.width, this.top + ((1 - y) / 2) * this.height, depth];
  }

  /** The camera mirrored at a level plane of a height [m], which sees its reflections. */
  mirrored(level = 0) {
    const axis = this.yUp ? 1 : 2;
    const flip = (vector) => vector.map((value, i) => (i === axis ? -value : value));
    // A column of the matrix takes what is along an axis, the last one what is constant.
    const matrix = this.matrix.map((value, i) => (i >> 2 === axis ? -value : i >> 2 === 3 ? value + 2 * level * this.matrix[4 * axis + (i & 3)] : value));
    const { width, height, yUp, distance } = this;
    const [forward, right, up] = [this.forward, this.right, this.up].map(flip);
    const eye = flip(this.eye).map((value, i) => (i === axis ? value + 2 * level : value));
    const spread = this.spread.map(flip);
    return { eye, forward, right, up, matrix, width, height, yUp, distance, spread };
  }

  /** @returns {{distance: number, yaw: number, pitch: number, target: Vector}} */
  state() {
    const { distance, yaw, pitch, target } = this;
    return { distance, yaw, pitch, target };
  }
}
