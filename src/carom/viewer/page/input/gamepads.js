// Gamepads: tells the simulation their axes and buttons when these change.

import { FromPage } from "../protocol.js";

/** Positions are told in steps of this size: sticks are never quite at rest. */
const STEP = 0.001;

/** @typedef {{name: string, axes: number[], buttons: number[], standard: boolean}} Pad */

export class Gamepads {
  /** @param {(message: MessageFromPage) => void} send */
  constructor(send) {
    this.send = send;
    /** Other devices that are told as gamepads, by what they are. @type {Map<unknown, Pad>} */
    this.others = new Map();
    this.begin();
  }

  /** Begins with a simulation that knows of no gamepads. */
  begin() {
    this.sent = "[]";
  }

  /**
   * Sets the state of another device, and tells it at once.
   *
   * @param {unknown} device
   * @param {Pad | null} pad null if it is gone
   */
  put(device, pad) {
    if (pad) this.others.set(device, pad);
    else this.others.delete(device);
    this.tell();
  }

  /** Tells what has changed; called for each picture, because browsers have no events for axes and buttons. */
  tell() {
    const gamepads = document.hidden ? [] : [...connected().map(state), ...this.others.values()];
    const text = JSON.stringify(gamepads);
    if (text === this.sent) return;
    this.sent = text;
    this.send({ type: FromPage.GAMEPADS, gamepads });
  }
}

function connected() {
  try {
    return [...navigator.getGamepads()].filter((pad) => pad?.connected);
  } catch {
    // A page inside another one may not be allowed to ask.
    return [];
  }
}

function state({ id, axes, buttons, mapping }) {
  const rounded = (value) => Math.round(value / STEP) * STEP;
  return { name: id, axes: axes.map(rounded), buttons: buttons.map(({ value }) => rounded(value)), standard: mapping === "standard" };
}
