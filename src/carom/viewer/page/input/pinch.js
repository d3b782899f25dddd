// Two fingers on a touch screen: they zoom by their distance and move the view by their middle.

/** @import { Camera } from "../view/camera.js" */

export class Pinch {
  /** @param {Camera} camera */
  constructor(camera) {
    this.camera = camera;
    /** Pixels of the fingers that are down, by the number of their pointer. */
    this.fingers = new Map();
  }

  /** Whether two fingers or more are down. */
  get active() {
    return this.fingers.size > 1;
  }

  down(event) {
    if (event.pointerType === "touch") this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
  }

  up(event) {
    this.fingers.delete(event.pointerId);
  }

  /** Follows a finger. What is at the target's depth between the fingers stays between them. */
  move(event) {
    if (!this.fingers.has(event.pointerId)) return;
    const before = this.span();
    this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (!this.active) return;
    const after = this.span();
    const factor = before.spread / after.spread;
    const { camera } = this;
    const distance = camera.distance;
    camera.zoom(factor);
    // The camera may not go as near or as far as asked.
    const done = camera.distance / distance;
    const centre = [camera.left + camera.width / 2, camera.top + camera.height / 2];
    camera.pan(...after.middle.map((x, i) => x - centre[i] - (before.middle[i] - centre[i]) / done));
  }

  /** Middle of the first two fingers and their distance, at least 1 [pixels]. */
  span() {
    const [a, b = a] = this.fingers.values();
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], spread: Math.max(1, Math.hypot(b[0] - a[0], b[1] - a[1])) };
  }
}
