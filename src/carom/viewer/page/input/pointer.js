// Mouse and touch input: moves the camera, selects, pulls and turns bodies, and is sent to the script. The left
// button pulls the body under the mouse, or else rotates the view; the middle button, or Shift and the left
// button, shifts the view; the right button or the wheel zooms; Ctrl or Alt and the left button always rotates the
// view, as in PyBullet's window, and with Shift as well it turns the body under the mouse. A finger does what the
// left button does; two fingers zoom and shift the view.

import { Pinch } from "./pinch.js";
import { FromPage } from "../protocol.js";

/** Motion of the mouse with a button down from which on it is a drag, not a click [pixels]. */
const CLICK_PIXELS = 3;

export class Pointer {
  constructor(canvas, camera, send, cameraMoved) {
    this.canvas = canvas;
    this.camera = camera;
    this.send = send;
    this.cameraMoved = cameraMoved;
    this.at = null;
    /** Pixel of the last event. */
    this.last = null;
    this.hovered = null;
    this.button = null;
    /** Called when the mouse has moved. */
    this.hoverChanged = () => {};
    /** Grabs a handle or a body under the mouse; see `Hands` in handles.js. */
    this.grasp = null;
    /** Called with the pixel of a click without a drag. */
    this.clicked = (_x, _y) => {};
    /** Pixel where the left button was pressed, until it is known to be a click or a drag. */
    this.pressed = null;
    /** Whether the drag that begins there is to turn the body. */
    this.turning = false;
    /** Called with the pixel where a press or a turn of the wheel begins, before it has an effect. */
    this.aim = (_x, _y) => {};
    this.pinch = new Pinch(camera);
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => this.up(event));
    canvas.addEventListener("pointerleave", () => {
      this.hovered = null;
      this.hoverChanged();
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  down(event) {
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    if (this.at === null && this.pinch.fingers.size === 0) this.aim(event.offsetX, event.offsetY);
    this.pinch.down(event);
    if (this.pinch.active) return this.release(event);
    this.at = this.last = [event.offsetX, event.offsetY];
    this.button = event.button;
    this.tell(event, { button: event.button, down: true });
    const turning = event.ctrlKey || event.altKey;
    if (event.button === 0 && turning === event.shiftKey) this.pressed = this.at;
    this.turning = turning;
  }

  move(event) {
    this.pinch.move(event);
    if (this.pinch.active) return this.cameraMoved();
    const [x, y] = [event.offsetX, event.offsetY];
    this.hovered = this.last = [x, y];
    this.hoverChanged();
    this.tell(event, {});
    if (this.at === null) return;
    if (this.pressed) {
      if (Math.hypot(x - this.pressed[0], y - this.pressed[1]) < CLICK_PIXELS) return;
      this.grasp?.begin(...this.pressed, this.turning);
      this.pressed = null;
    }
    const [dx, dy] = [x - this.at[0], y - this.at[1]];
    this.at = [x, y];
    if (this.grasp?.busy) {
      this.grasp.move(x, y);
      this.hoverChanged();
      return;
    }
    if (this.button === 0 && !event.shiftKey) this.camera.orbit(dx, dy);
    else if (this.button === 2) this.camera.zoom(Math.exp(dy * 0.01));
    else this.camera.pan(dx, dy);
    this.cameraMoved();
  }

  up(event) {
    // The last part of a motion may come with the release alone; a pointer that is cancelled has no place.
    if (event.type === "pointerup" && this.at !== null && !this.isAt(event)) this.move(event);
    this.pinch.up(event);
    if (this.pressed && !this.turning) this.clicked(...this.pressed);
    this.release(event);
  }

  isAt({ offsetX, offsetY }) {
    return offsetX === this.last[0] && offsetY === this.last[1];
  }

  /** Ends what a button or finger does, without a click. */
  release(event) {
    this.pressed = null;
    if (this.at === null) return;
    this.at = null;
    this.tell(event, { button: event.button, down: false });
    this.grasp?.end();
  }

  wheel(event) {
    event.preventDefault();
    if (this.at === null) this.aim(event.offsetX, event.offsetY);
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    this.camera.zoom(Math.exp(event.deltaY * lines * 0.001));
    this.cameraMoved();
  }

  tell(event, more) {
    this.send({ type: FromPage.MOUSE, x: event.offsetX, y: event.offsetY, ...more });
  }
}
