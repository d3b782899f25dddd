// Sections that the user takes out of the panel: they float over the view, are moved by their titles and sized by
// their corners. The browser remembers where they were.

import { made } from "../simulation/section.js";

/** @import { Memory } from "../memory.js" */

/** A pointer that moves less than this is a click, which folds the section [pixels]. */
const STILL = 4;
/** Part of a section that stays in the window [pixels]. */
const GRIP = 60;
/** Place of a section that is taken out first, and how much farther the next one is [pixels]. */
const [FIRST, STEP] = [70, 28];

export class Floating {
  /** @param {Memory} memory */
  constructor(memory) {
    this.memory = memory;
    /** Where each section belongs that is out of the panel. @type {Map<HTMLElement, Comment>} */
    this.homes = new Map();
    /** Sizes that change, by hand or with what is inside, are remembered. */
    this.sizes = new ResizeObserver(() => this.remember());
    for (const section of document.querySelectorAll("#rooms > details")) this.offer(/** @type {HTMLDetailsElement} */ (section));
    window.addEventListener("resize", () => this.keepInside());
  }

  /**
   * Lets a section be taken out; it is taken out at once if it was before.
   *
   * @param {HTMLDetailsElement} section
   */
  offer(section) {
    const title = section.querySelector("summary");
    const button = made("button", "⇱", { className: "plain undock", type: "button" });
    title.append(button);
    this.name(section);
    button.addEventListener("click", (event) => {
      // It would fold the section.
      event.preventDefault();
      this.toggle(section);
    });
    this.bind(section, title);
    const place = (this.memory.get("floating") ?? {})[section.id];
    if (place) this.takeOut(section, place);
  }

  /** @param {HTMLDetailsElement} section */
  name(section) {
    const out = this.homes.has(section);
    const button = /** @type {HTMLButtonElement} */ (section.querySelector(".undock"));
    const title = section.querySelector("summary").firstChild.textContent.trim();
    button.title = button.ariaLabel = out ? `Put ${title} back into the panel` : `Take ${title} out of the panel`;
    button.ariaPressed = String(out);
  }

  /** @param {HTMLDetailsElement} section */
  toggle(section) {
    if (this.homes.has(section)) this.putBack(section);
    else {
      const step = FIRST + STEP * this.homes.size;
      this.takeOut(section, { left: step, top: step });
      section.open = true;
    }
    this.remember();
  }

  /**
   * @param {HTMLDetailsElement} section
   * @param {{left: number, top: number, width?: number, height?: number}} place
   */
  takeOut(section, { left, top, width, height }) {
    if (!this.homes.has(section)) {
      const home = document.createComment("");
      section.before(home);
      this.homes.set(section, home);
      section.classList.add("floating");
      document.body.append(section);
      this.sizes.observe(section);
    }
    if (width && height) Object.assign(section.style, { width: `${width}px`, height: `${height}px` });
    this.move(section, left, top);
    this.name(section);
  }

  /** @param {HTMLDetailsElement} section */
  putBack(section) {
    const home = this.homes.get(section);
    this.sizes.unobserve(section);
    this.homes.delete(section);
    section.classList.remove("floating");
    section.removeAttribute("style");
    home.replaceWith(section);
    this.name(section);
  }

  /** A section is gone; if it comes again it is where it was. @param {HTMLDetailsElement} section */
  forget(section) {
    this.sizes.unobserve(section);
    this.homes.get(section)?.remove();
    this.homes.delete(section);
  }

  bind(section, title) {
    let start = null;
    title.addEventListener("pointerdown", (event) => {
      if (!this.homes.has(section) || event.target instanceof HTMLButtonElement) return;
      const { left, top } = section.getBoundingClientRect();
      start = { x: event.clientX, y: event.clientY, left, top, moved: false };
      title.setPointerCapture(event.pointerId);
    });
    title.addEventListener("pointermove", (event) => {
      if (!start || !event.buttons) return;
      const [dx, dy] = [event.clientX - start.x, event.clientY - start.y];
      start.moved ||= Math.hypot(dx, dy) >= STILL;
      if (start.moved) this.move(section, start.left + dx, start.top + dy);
    });
    title.addEventListener("click", (event) => {
      // A title that was dragged does not fold.
      if (start?.moved) event.preventDefault();
      if (start?.moved) this.remember();
      start = null;
    });
  }

  /** Moves a section, so that its title stays within the window. */
  move(section, left, top) {
    const x = Math.min(Math.max(left, GRIP - section.offsetWidth), window.innerWidth - GRIP);
    const y = Math.min(Math.max(top, 0), Math.max(0, window.innerHeight - GRIP));
    Object.assign(section.style, { left: `${x}px`, top: `${y}px` });
  }

  keepInside() {
    for (const section of this.homes.keys()) this.move(section, section.offsetLeft, section.offsetTop);
  }

  remember() {
    const places = [...this.homes.keys()].map((section) => {
      const { offsetLeft: left, offsetTop: top, style } = section;
      const size = style.width ? { width: section.offsetWidth, height: section.offsetHeight } : {};
      return [section.id, { left, top, ...size }];
    });
    // Those of panels that the script has not made yet stay.
    const absent = Object.entries(this.memory.get("floating") ?? {}).filter(([id]) => !document.getElementById(id));
    this.memory.put("floating", Object.fromEntries([...absent, ...places]));
  }

  /** Takes out what the browser has kept for the script. */
  recall() {
    for (const [id, place] of Object.entries(this.memory.get("floating") ?? {})) {
      const section = document.getElementById(id);
      if (section instanceof HTMLDetailsElement) this.takeOut(section, place);
    }
  }
}
