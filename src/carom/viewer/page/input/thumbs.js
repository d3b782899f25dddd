// A phone as a controller: two sticks for the thumbs, two buttons, and how the phone is tilted; told as a gamepad.

import { element } from "../elements.js";

/** @import { Gamepads } from "./gamepads.js" */

/** Way of a thumb to the end of a stick [pixels]. */
const REACH = 60;
/** Tilt at the end of its axis [degrees]. */
const FULL_TILT = 45;
/** The part of the address, after #, that opens a page as a controller. */
export const CONTROLLER = "#controller";
const KEY = "thumbs";

export class Thumbs {
  /**
   * @param {Gamepads} gamepads
   * @param {(text: string) => void} say
   */
  constructor(gamepads, say) {
    this.gamepads = gamepads;
    this.say = say;
    this.root = document.getElementById("thumbs");
    this.axes = [0, 0, 0, 0, 0, 0];
    this.buttons = [0, 0];
    /** Angles at which the phone is not tilted. @type {number[] | null} */
    this.level = null;
    this.tilting = (event) => this.tilt(event);
    ["left", "right"].forEach((side, i) => this.bindStick(document.getElementById(`thumb-${side}`), 2 * i));
    ["a", "b"].forEach((name, i) => this.bindButton(document.getElementById(`thumb-${name}`), i));
    document.getElementById("thumbs-close").addEventListener("click", () => this.close());
    element("thumbs-tilt", HTMLButtonElement).addEventListener("click", () => this.askForTilt());
  }

  get isOpen() {
    return !this.root.hidden;
  }

  open() {
    this.root.hidden = false;
    this.tell();
  }

  close() {
    this.root.hidden = true;
    removeEventListener("deviceorientation", this.tilting);
    [this.level, this.axes, this.buttons] = [null, [0, 0, 0, 0, 0, 0], [0, 0]];
    this.gamepads.put(KEY, null);
  }

  /** @param {HTMLElement} stick */
  bindStick(stick, axis) {
    const knob = /** @type {HTMLElement} */ (stick.firstElementChild);
    let start = null;
    const set = (x, y) => {
      const way = Math.max(1, Math.hypot(x, y) / REACH);
      [this.axes[axis], this.axes[axis + 1]] = [x / way / REACH, y / way / REACH];
      knob.style.transform = `translate(${x / way}px, ${y / way}px)`;
      this.tell();
    };
    stick.addEventListener("pointerdown", (event) => {
      stick.setPointerCapture(event.pointerId);
      start = [event.clientX, event.clientY];
      set(0, 0);
    });
    stick.addEventListener("pointermove", (event) => start && set(event.clientX - start[0], event.clientY - start[1]));
    for (const kind of ["pointerup", "pointercancel"]) {
      stick.addEventListener(kind, () => {
        start = null;
        set(0, 0);
      });
    }
  }

  /** @param {HTMLElement} button */
  bindButton(button, number) {
    const set = (value) => {
      this.buttons[number] = value;
      this.tell();
    };
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      set(1);
    });
    for (const kind of ["pointerup", "pointercancel"]) button.addEventListener(kind, () => set(0));
  }

  /** Reads how the phone is tilted from now on; as it is held now is the middle. */
  async askForTilt() {
    const events = /** @type {any} */ (window).DeviceOrientationEvent;
    if (!window.isSecureContext || !events) {
      this.say("Browsers tell how a phone is tilted only to pages by https, or from the same machine. The sticks work.");
      return;
    }
    const allowed = await (events.requestPermission?.() ?? "granted");
    if (allowed !== "granted") return;
    this.level = null;
    removeEventListener("deviceorientation", this.tilting);
    addEventListener("deviceorientation", this.tilting);
  }

  /** @param {DeviceOrientationEvent} event */
  tilt({ beta, gamma }) {
    if (beta === null || gamma === null) return;
    // Held sideways, as a controller is, the phone's own axes change places.
    const turned = (screen.orientation?.angle ?? 0) * (Math.PI / 180);
    const [side, forward] = [gamma * Math.cos(turned) + beta * Math.sin(turned), beta * Math.cos(turned) - gamma * Math.sin(turned)];
    this.level ??= [side, forward];
    [side, forward].forEach((angle, i) => {
      this.axes[4 + i] = Math.max(-1, Math.min(1, (angle - this.level[i]) / FULL_TILT));
    });
    this.tell();
  }

  tell() {
    if (this.isOpen) this.gamepads.put(KEY, { name: "Thumbs", axes: [...this.axes], buttons: [...this.buttons], standard: true });
  }
}
