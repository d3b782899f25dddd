// The section with what else can steer the script: a phone, and a SpaceMouse.

import { CONTROLLER, Thumbs } from "./thumbs.js";
import { SpaceMice } from "./space_mouse.js";
import { isSpectator } from "../spectating.js";

/** @import { Gamepads } from "./gamepads.js" */
/** @import { Notices } from "../panel/notices.js" */

export class Controllers {
  /**
   * @param {Gamepads} gamepads
   * @param {Notices} notices
   */
  constructor(gamepads, notices) {
    this.thumbs = new Thumbs(gamepads, (text) => notices.say(text));
    this.mice = new SpaceMice(gamepads);
    const root = document.getElementById("controllers");
    // A replay has no script to steer.
    root.hidden = isSpectator() || document.getElementById("recording") !== null;
    document.getElementById("thumbs-open").addEventListener("click", () => this.thumbs.open());
    const button = document.getElementById("space-mouse");
    button.hidden = !this.mice.hid;
    button.addEventListener("click", () => {
      this.mice.choose().catch((error) => notices.say(`The SpaceMouse cannot be opened: ${error.message}`));
    });
    // Once there is a connection to tell it by.
    if (location.hash === CONTROLLER && !root.hidden) queueMicrotask(() => this.thumbs.open());
  }
}
