// The list of the script's cameras: a click takes the view of one, another click gives the user's own view back.

import { Lens } from "../view/lens.js";

/** @import { Camera } from "../view/camera.js" */

export class Lenses {
  /**
   * @param {Camera} camera
   * @param {() => void} changed called when another view is shown
   */
  constructor(camera, changed) {
    this.camera = camera;
    this.changed = changed;
    this.root = document.getElementById("lenses");
    this.frame = document.getElementById("letterbox");
    this.previews = document.getElementById("previews");
    this.previews.addEventListener("click", () => this.newest !== null && this.toggle(this.newest));
    this.clear();
  }

  clear() {
    this.lenses = new Map();
    this.buttons = new Map();
    /** The camera that took the last image, and the one that is looked through. */
    this.newest = null;
    this.chosen = null;
    this.root.replaceChildren();
    this.camera.look(null);
    this.show();
  }

  take(header) {
    this.lenses.set(header.lens, header);
    this.newest = header.lens;
    if (!this.buttons.has(header.lens)) this.root.append(this.button(header));
    if (this.looking && this.chosen === header.lens) this.camera.look(new Lens(header));
  }

  button({ lens, name, width, height }) {
    const title = `Look through this camera of the script (${width} × ${height}); again, Esc or a drag to go back`;
    const button = Object.assign(document.createElement("button"), { textContent: name, title });
    button.addEventListener("click", () => this.toggle(lens));
    this.buttons.set(lens, button);
    return button;
  }

  /** Whether the view is that of a camera in the list. */
  get looking() {
    return this.camera.lens !== null;
  }

  toggle(number) {
    const again = this.looking && this.chosen === number;
    this.chosen = number;
    this.camera.look(again ? null : new Lens(this.lenses.get(number)));
    this.changed();
  }

  leave() {
    this.camera.look(null);
    this.changed();
  }

  /** Shows which camera is looked through, and covers what its image does not contain. */
  show() {
    for (const [number, button] of this.buttons) button.setAttribute("aria-pressed", this.looking && number === this.chosen);
    this.frame.hidden = !this.looking;
    if (!this.looking) return;
    const [width, height] = this.camera.lens.shares.map((share, i) => share * [this.camera.width, this.camera.height][i]);
    const style = `width: ${width}px; height: ${height}px`;
    if (this.frame.getAttribute("style") !== style) this.frame.setAttribute("style", style);
  }
}
