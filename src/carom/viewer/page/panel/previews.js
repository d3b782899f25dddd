// Previews of the script's last camera image: colours, depth and segmentation. Each is folded and enlarged by its
// buttons, and all are moved by their titles; the browser remembers it.

import { press, unfold } from "./states.js";
import { FromPage } from "../protocol.js";

/** @import { Memory } from "../memory.js" */

const KINDS = ["rgbPreview", "depthPreview", "segmentationPreview"];
const TITLES = ["colour", "depth", "segmentation"];
/** Width of images asked for, while one is enlarged and otherwise [pixels]. */
const LARGE = 480;
const SMALL = 200;

export class Previews {
  /**
   * @param {Memory} memory
   * @param {(message: MessageFromPage) => void} send
   */
  constructor(memory, send) {
    this.memory = memory;
    this.send = send;
    this.root = document.getElementById("previews");
    /** Titles of the folded and of the enlarged ones, and the place of the upper left corner; null for its own. */
    this.state = { folded: [], large: [], place: null };
    this.asked = SMALL;
    this.figures = TITLES.map((title) => this.make(title));
    this.clear();
    this.root.append(...this.figures);
    window.addEventListener("resize", () => this.put());
  }

  make(title) {
    const figure = document.createElement("figure");
    const caption = Object.assign(document.createElement("figcaption"), { title: "Drag to move; double-click to put back" });
    const buttons = [
      ["folded", "▾", `Fold the preview of ${title}`],
      ["large", "⤢", `Enlarge the preview of ${title}`],
    ].map(([name, textContent, text]) => {
      const button = Object.assign(document.createElement("button"), { className: `plain ${name}`, textContent, title: text });
      button.addEventListener("click", () => this.toggle(name, title));
      return button;
    });
    caption.append(Object.assign(document.createElement("span"), { textContent: title }), ...buttons);
    this.bindMoves(caption);
    figure.append(document.createElement("canvas"), caption);
    return figure;
  }

  bindMoves(caption) {
    let from = null;
    caption.addEventListener("pointerdown", (event) => {
      if (event.target.closest("button")) return;
      const { left, top } = this.root.getBoundingClientRect();
      from = [event.clientX - left, event.clientY - top];
      caption.setPointerCapture(event.pointerId);
    });
    caption.addEventListener("pointermove", (event) => {
      if (from) this.change({ place: [event.clientX - from[0], event.clientY - from[1]] });
    });
    for (const kind of ["pointerup", "pointercancel"]) caption.addEventListener(kind, () => (from = null));
    caption.addEventListener("dblclick", (event) => !event.target.closest("button") && this.change({ place: null }));
  }

  toggle(name, title) {
    const before = this.state[name];
    this.change({ [name]: before.includes(title) ? before.filter((each) => each !== title) : [...before, title] });
  }

  change(changes) {
    Object.assign(this.state, changes);
    this.memory.put("previews", this.state);
    this.arrange();
  }

  /** Shows what the browser has kept for the script. */
  recall() {
    Object.assign(this.state, this.memory.get("previews"));
    this.arrange();
  }

  clear() {
    this.taken = false;
    this.root.hidden = true;
    this.asked = SMALL;
  }

  /** Folds and enlarges the figures, and asks for images that are fine enough. */
  arrange() {
    const { folded, large } = this.state;
    this.figures.forEach((figure, index) => {
      const title = TITLES[index];
      const [fold, enlarge] = figure.querySelectorAll("button");
      figure.classList.toggle("folded", folded.includes(title));
      figure.classList.toggle("large", large.includes(title));
      fold.textContent = folded.includes(title) ? "▴" : "▾";
      unfold(fold, !folded.includes(title));
      press(enlarge, large.includes(title));
    });
    const wanted = large.some((title) => !folded.includes(title)) ? LARGE : SMALL;
    if (this.taken && wanted !== this.asked) {
      this.asked = wanted;
      this.send({ type: FromPage.PREVIEW_WIDTH, width: wanted });
    }
    this.put();
  }

  /** Moves them to their place, as far as the window is large enough. */
  put() {
    const { style } = this.root;
    const { place } = this.state;
    style.left = style.top = style.bottom = "";
    if (!place || this.root.hidden) return;
    const { width, height } = this.root.getBoundingClientRect();
    const [left, top] = [
      [place[0], window.innerWidth - width],
      [place[1], window.innerHeight - height],
    ].map(([wanted, most]) => Math.max(0, Math.min(wanted, most)));
    Object.assign(style, { left: `${left}px`, top: `${top}px`, bottom: "auto" });
  }

  take({ width, height }, payload) {
    const bytes = new Uint8Array(payload);
    this.figures.forEach((figure, index) => {
      const canvas = figure.querySelector("canvas");
      [canvas.width, canvas.height] = [width, height];
      const picture = new ImageData(width, height);
      let from = index * width * height * 3;
      for (let to = 0; to < picture.data.length; to += 4, from += 3) {
        picture.data.set([bytes[from], bytes[from + 1], bytes[from + 2], 255], to);
      }
      canvas.getContext("2d").putImageData(picture, 0, 0);
    });
    const first = !this.taken;
    this.taken = true;
    if (first) this.arrange();
  }

  show(options) {
    const before = this.root.hidden;
    this.root.hidden = !this.taken || !options.panel;
    this.figures.forEach((figure, index) => (figure.hidden = !options[KINDS[index]]));
    if (before && !this.root.hidden) this.put();
  }
}
