// The camera: it circles a target, as PyBullet's does. Angles in degrees.

import { add, cross, dot, multiply, perspective, scale, subtract, unit, viewMatrix } from "./maths.js";

const NEAR = 0.01;
const FAR = 1000;
const DEGREES_PER_PIXEL = 0.3;
const STEEPEST = 89.9;

export class Camera {
  constructor() {
    this.distance = 5;
    this.yaw = 50;
    this.pitch = -35;
    this.target = [0, 0, 0];
    this.yUp = false;
    this.width = 1;
    this.height = 1;
    this.update();
  }

  set(camera) {
    for (const name of ["distance", "yaw", "pitch", "target"]) this[name] = camera[name];
    this.update();
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.update();
  }

  orbit(dx, dy) {
    this.yaw -= dx * DEGREES_PER_PIXEL;
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.pitch - dy * DEGREES_PER_PIXEL));
    this.update();
  }

  /** Moves the target so that what is there follows the mouse. */
  pan(dx, dy) {
    const perPixel = (2 * this.distance) / this.height;
    const shift = add(scale(this.right, -dx * perPixel), scale(this.up, dy * perPixel));
    this.target = add(this.target, shift);
    this.update();
  }

  zoom(factor) {
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
  }

  /** Direction of unit length from the eye through a pixel. */
  ray(x, y) {
    const right = ((2 * x) / this.width - 1) * (this.width / this.height);
    const up = 1 - (2 * y) / this.height;
    return unit(add(this.forward, add(scale(this.right, right), scale(this.up, up))));
  }

  /** Pixel of a point and its distance along the view, or null for what is behind the eye. */
  pixel(point) {
    const offset = subtract(point, this.eye);
    const depth = dot(offset, this.forward);
    if (depth < NEAR) return null;
    const x = (dot(offset, this.right) / depth) * (this.height / this.width);
    const y = dot(offset, this.up) / depth;
    return [((x + 1) / 2) * this.width, ((1 - y) / 2) * this.height, depth];
  }

  /** The camera as it is seen in the ground through the origin, and what it sees there. */
  mirrored() {
    const axis = this.yUp ? 1 : 2;
    const flip = (vector) => vector.map((value, i) => (i === axis ? -value : value));
    const matrix = this.matrix.map((value, i) => (i >> 2 === axis ? -value : value));
    const { width, height, yUp, distance } = this;
    const [eye, forward, right, up] = [this.eye, this.forward, this.right, this.up].map(flip);
    return { eye, forward, right, up, matrix, width, height, yUp, distance };
  }

  state() {
    const { distance, yaw, pitch, target } = this;
    return { distance, yaw, pitch, target };
  }
}
