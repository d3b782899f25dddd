// Panels of the script's own, and the texts and images in them and in the panel of the page.

import { FromPage } from "../protocol.js";
import { isSpectator } from "../spectating.js";
import { made } from "../simulation/section.js";

/** @import { Floating } from "./floating.js" */

export class OwnPanels {
  /**
   * @param {(message: MessageFromPage) => void} send
   * @param {Floating} floating takes sections out of the panel
   */
  constructor(send, floating) {
    this.send = send;
    this.floating = floating;
    this.usual = document.getElementById("sliders");
    /** @type {Map<number, HTMLDetailsElement>} */
    this.panels = new Map();
    /** Texts and images by number. @type {Map<number, {root: HTMLElement, show: (facts: any, payload?: ArrayBuffer) => void}>} */
    this.parts = new Map();
  }

  clear() {
    for (const panel of [...this.panels.keys()]) this.remove({ panel });
    for (const number of [...this.parts.keys()]) this.drop(number);
  }

  add({ panel, title }) {
    const root = this.panels.get(panel) ?? document.createElement("details");
    root.id = `own-${title}`;
    root.className = "own";
    root.open = true;
    root.replaceChildren(made("summary", title), made("div", ""));
    root.lastElementChild.toggleAttribute("inert", isSpectator());
    if (!this.panels.has(panel)) this.usual.after(root);
    this.panels.set(panel, root);
    this.floating.offer(root);
  }

  remove({ panel }) {
    const root = this.panels.get(panel);
    if (root) this.floating.forget(root);
    root?.remove();
    this.panels.delete(panel);
  }

  /** Puts what belongs to a panel where its number belongs: parts arrive in the order in which they last changed. */
  insert(number, panel, root) {
    const home = this.panels.get(panel)?.lastElementChild ?? this.usual;
    root.dataset.number = String(number);
    const later = [...home.children].find((other) => other instanceof HTMLElement && Number(other.dataset.number) > number);
    home.insertBefore(root, later ?? null);
  }

  takeField(facts) {
    const known = this.parts.get(facts.field) ?? this.makeField(facts);
    known.show(facts);
  }

  takeImage(facts, payload) {
    const known = this.parts.get(facts.image) ?? this.makeImage(facts);
    known.show(facts, payload);
  }

  drop(number) {
    this.parts.get(number)?.root.remove();
    this.parts.delete(number);
  }

  makeField({ field, name, panel, editable }) {
    if (!editable) {
      const line = made("div", name, { className: "row pair" });
      const output = made("output", "", { ariaLabel: name });
      line.append(output);
      return this.keep(field, panel, line, ({ text }) => (output.textContent = text));
    }
    const label = made("label", name, { className: "row pair" });
    const input = made("input", "", { type: "text", spellcheck: false });
    label.append(input);
    input.addEventListener("change", () => this.send({ type: FromPage.FIELD, field, text: input.value }));
    return this.keep(field, panel, label, ({ text }) => {
      // What is being typed stays.
      if (document.activeElement !== input) input.value = text;
    });
  }

  makeImage({ image, name, panel }) {
    const figure = made("figure", "");
    const picture = made("img", "", { alt: name });
    figure.append(made("figcaption", name), picture);
    let address = "";
    const show = ({ width, height }, payload) => {
      Object.assign(picture, { width, height });
      URL.revokeObjectURL(address);
      address = picture.src = URL.createObjectURL(new Blob([payload], { type: "image/png" }));
    };
    return this.keep(image, panel, figure, show);
  }

  keep(number, panel, content, show) {
    const root = made("div", "", { className: "slider" });
    root.append(content);
    this.insert(number, panel, root);
    const part = { root, show };
    this.parts.set(number, part);
    return part;
  }
}
