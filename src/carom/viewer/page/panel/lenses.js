// The list of cameras, of the script and of files: a click takes the view of one, another click gives the user's own
// view back.

import { Lens } from "../view/lens.js";
import { fileLens } from "../view/stage/file_cameras.js";

/** @import { Camera } from "../view/camera.js" */
/** @import { Stage } from "../view/stage/stage.js" */
/** @import { Views } from "../layout/views.js" */

export class Lenses {
  /**
   * @param {Views} views
   * @param {Stage} stage has the cameras of files
   * @param {() => void} changed called when another view is shown
   */
  constructor(views, stage, changed) {
    this.views = views;
    this.stage = stage;
    this.changed = changed;
    this.root = document.getElementById("lenses");
    this.previews = document.getElementById("previews");
    this.previews.addEventListener("click", () => this.newest !== null && this.toggle(this.newest));
    views.lenses = this;
    this.clear();
  }

  clear() {
    this.lenses = new Map();
    this.buttons = new Map();
    /** The camera of the script that took the last image. */
    this.newest = null;
    this.root.replaceChildren();
    for (const camera of this.views.cameras) camera.look(null);
    this.views.offer();
    this.show();
  }

  take(header) {
    this.newest = header.lens;
    this.add(header, "of the script");
    for (const camera of this.views.cameras) if (camera.lens?.key === header.lens) camera.look(new Lens(header));
  }

  add(header, origin) {
    const known = this.buttons.has(header.lens);
    this.lenses.set(header.lens, header);
    if (known) return;
    this.root.append(this.button(header, origin));
    this.views.offer();
  }

  /** Lists the cameras of files anew. */
  takeFiles() {
    for (const key of [...this.lenses.keys()].filter(isOfFile)) {
      this.buttons.get(key).remove();
      for (const known of [this.lenses, this.buttons]) known.delete(key);
    }
    const count = this.stage.facts?.cameras.length ?? 0;
    for (let number = 0; number < count; number++) {
      const { name, aspect } = this.stage.facts.cameras[number];
      this.add({ lens: `file ${number}`, name: name || `camera ${number}`, width: aspect, height: 1 }, "of the file");
    }
    for (const camera of this.views.cameras) if (camera.lens && !this.lenses.has(camera.lens.key)) camera.look(null);
    this.views.offer();
  }

  button({ lens, name, width, height }, origin) {
    const size = isOfFile(lens) ? "" : ` (${width} × ${height})`;
    const title = `Look through this camera ${origin}${size}; again, Esc or a drag to go back`;
    const button = Object.assign(document.createElement("button"), { textContent: name, title });
    button.addEventListener("click", () => this.toggle(lens));
    this.buttons.set(lens, button);
    return button;
  }

  get camera() {
    return this.views.chosen.camera;
  }

  /** Whether the chosen view is that of a camera in the list, and of which. */
  get looking() {
    return this.camera.lens !== null;
  }

  get chosen() {
    return this.camera.lens?.key ?? null;
  }

  toggle(key) {
    if (this.chosen === key) this.camera.look(null);
    else this.lookThrough(this.camera, key);
    this.views.moved();
    this.changed();
  }

  /**
   * Gives a camera the view of one in the list.
   *
   * @param {Camera} camera
   * @param {number | string} key as in the list, or as a text
   */
  lookThrough(camera, key) {
    const known = [...this.lenses.keys()].find((each) => String(each) === String(key));
    const facts = isOfFile(known) ? fileLens(this.stage, numberOf(known)) : this.lenses.get(known);
    if (facts) camera.look(new Lens(facts));
  }

  leave() {
    this.camera.look(null);
    this.views.moved();
    this.changed();
  }

  /** Moves the views through cameras of files along with their links. */
  follow() {
    for (const camera of this.views.cameras) if (isOfFile(camera.lens?.key)) this.lookThrough(camera, camera.lens.key);
  }

  /** Shows which camera is looked through, and covers what its image does not contain. */
  show() {
    for (const [key, button] of this.buttons) button.setAttribute("aria-pressed", key === this.chosen);
    for (const { camera, cover } of this.views.all) {
      cover.hidden = camera.lens === null;
      if (cover.hidden) continue;
      const [width, height] = camera.lens.shares.map((share, i) => share * [camera.width, camera.height][i]);
      const style = `width: ${width}px; height: ${height}px`;
      if (cover.getAttribute("style") !== style) cover.setAttribute("style", style);
    }
  }
}

const isOfFile = (key) => String(key).startsWith("file ");
const numberOf = (key) => Number(key.slice("file ".length));
