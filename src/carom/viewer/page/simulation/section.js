// A section of the panel: hidden while there is nothing in it, and asked whether it is open.

import { element } from "../elements.js";

/** Time between two updates of numbers in a section [ms]. */
const PERIOD_MS = 100;

export class Section {
  /** @param {string} id of the section; what it shows is in the element `ID-list` */
  constructor(id) {
    this.root = element(id, HTMLDetailsElement);
    this.list = document.getElementById(`${id}-list`);
    this.shown = 0;
  }

  get isOpen() {
    return this.root.open && !this.root.hidden;
  }

  /** Whether it is time to update what it shows. */
  isDue() {
    const now = performance.now();
    if (!this.isOpen || now - this.shown < PERIOD_MS) return false;
    this.shown = now;
    return true;
  }
}

/** An element with a text and other properties. */
export function made(tag, textContent, facts = {}) {
  return Object.assign(document.createElement(tag), { textContent, ...facts });
}
