// Frames that the user can move for scripts. Each has an arrow along each axis to shift it, an arc about each
// axis to rotate it, and a centre to move it in the plane that faces the viewer.

import { add, dot, quaternionProduct, scale, subtract, turned } from "../view/maths.js";
import { FromPage } from "../protocol.js";

/** @import { Camera } from "../view/camera.js" */

const AXES = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const COLOURS = [
  [0.86, 0.16, 0.14],
  [0.13, 0.62, 0.22],
  [0.16, 0.36, 0.86],
];
const MIDDLE = [0.95, 0.62, 0.1];
/** Length of an arrow relative to the distance from the eye, and offset of an arc relative to an arrow. */
const REACH = 0.16;
const ARM = 0.6;
/** Maximum distance between the mouse and a knob that it grabs [pixels]. */
const NEAR = 14;

export class Handles {
  /**
   * @param {Camera} camera
   * @param {(message: MessageFromPage) => void} send
   */
  constructor(camera, send) {
    this.camera = camera;
    this.send = send;
    this.clear();
  }

  clear() {
    this.items = new Map();
    this.held = null;
  }

  /** Adds a handle, or updates its pose. */
  take(header) {
    // While the user moves a handle, the pose that the simulation sends back is out of date.
    if (this.held?.item.handle !== header.handle) this.items.set(header.handle, { ...header });
  }

  get busy() {
    return this.held !== null;
  }

  /** Grabs the nearest knob at a pixel, if there is one, unless a body is to be turned. */
  begin(x, y, turning = false) {
    if (turning) return;
    let nearest = NEAR;
    for (const item of this.items.values()) {
      for (const knob of this.knobs(item)) {
        const pixel = this.camera.pixel(knob.point);
        const distance = pixel ? Math.hypot(pixel[0] - x, pixel[1] - y) : Infinity;
        if (distance >= nearest) continue;
        nearest = distance;
        this.held = { item, ...knob, start: null, from: { position: item.position, orientation: item.orientation } };
      }
    }
    if (this.held) this.held.start = this.grip(x, y);
  }

  move(x, y) {
    const { item, kind, axis, from, start } = this.held;
    const now = this.grip(x, y);
    if (now === null || start === null) return;
    if (kind === "turn") {
      const half = 0.5 * (now - start);
      const turn = [...scale(AXES[axis], Math.sin(half)), Math.cos(half)];
      item.orientation = quaternionProduct(from.orientation, turn);
    } else {
      const shift = kind === "shift" ? scale(turned(from.orientation, AXES[axis]), now - start) : subtract(now, start);
      item.position = add(from.position, shift);
    }
    const { handle, position, orientation } = item;
    this.send({ type: FromPage.HANDLE, handle, position, orientation });
  }

  end() {
    this.held = null;
  }

  /**
   * Mouse position relative to the knob: distance along its axis, angle about it, or point in the plane.
   *
   * @returns {any} a number or, to carry, a vector; null if there is none
   */
  grip(x, y) {
    const { kind, axis, from } = this.held;
    const { eye, forward } = this.camera;
    const ray = this.camera.ray(x, y);
    const offset = subtract(from.position, eye);
    if (kind === "carry") return add(eye, scale(ray, dot(offset, forward) / dot(ray, forward)));
    const along = turned(from.orientation, AXES[axis]);
    if (kind === "shift") {
      // The point of the axis that is nearest to the ray.
      const slant = dot(ray, along);
      const room = 1 - slant * slant;
      return room < 1e-4 ? null : (slant * dot(offset, ray) - dot(offset, along)) / room;
    }
    const steep = dot(ray, along);
    if (Math.abs(steep) < 1e-3) return null;
    const spoke = subtract(scale(ray, dot(offset, along) / steep), offset);
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map((i) => turned(from.orientation, AXES[i]));
    return Math.atan2(dot(spoke, v), dot(spoke, u));
  }

  /** The knobs of a handle: points that the mouse can grab. */
  knobs({ position, orientation }, eye = this.camera.eye, forward = this.camera.forward) {
    const reach = REACH * Math.max(dot(subtract(position, eye), forward), 0.05);
    const at = (vector) => add(position, turned(orientation, scale(vector, reach)));
    const knobs = [{ kind: "carry", axis: null, point: position }];
    AXES.forEach((along, axis) => {
      const diagonal = scale(add(AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]), ARM);
      knobs.push({ kind: "shift", axis, point: at(along) }, { kind: "turn", axis, point: at(diagonal) });
    });
    return knobs;
  }

  /** Draws the handles, as large as they are in the view of a camera. */
  addLines(lines, eye, forward) {
    for (const item of this.items.values()) {
      for (const { kind, axis, point } of this.knobs(item, eye, forward)) {
        const arm = subtract(point, item.position);
        if (kind === "carry") lines.star(point, 0.02 * Math.hypot(...subtract(point, eye)), MIDDLE, 4);
        else if (kind === "shift") lines.arrow(item.position, arm, COLOURS[axis], 3);
        else {
          const along = turned(item.orientation, AXES[axis]);
          lines.arc(item.position, along, scale(arm, 1 / Math.hypot(...arm)), Math.hypot(...arm), -0.35, 0.35, COLOURS[axis], 4);
        }
      }
    }
  }

  /** Adds the names of the handles. */
  addLabels(labels, camera) {
    for (const { name, position } of this.items.values()) labels.add(camera, position, name, 12);
  }
}

/** Several tools that can grab: the first one that finds something at the mouse grabs it. */
export class Hands {
  constructor(...hands) {
    this.hands = hands;
  }

  get busy() {
    return this.hands.some((hand) => hand.busy);
  }

  begin(x, y, turning) {
    for (const hand of this.hands) {
      hand.begin(x, y, turning);
      if (hand.busy) return;
    }
  }

  move(x, y) {
    this.hands.find((hand) => hand.busy).move(x, y);
  }

  end() {
    for (const hand of this.hands) hand.end();
  }
}
