// The list of contacts, the strongest first; a click chooses the link that is touched.

import { fixed } from "../panel/numbers.js";
import { made, Section } from "./section.js";

/** Contacts that are listed at most. */
const MAX_LISTED = 100;

export class Contacts extends Section {
  /** @param {(body: number, link: number) => void} choose called with the link that the user has chosen */
  constructor(scene, readings, choose) {
    super("touching");
    this.scene = scene;
    this.readings = readings;
    this.choose = choose;
    this.summary = document.getElementById("touching-sum");
  }

  clear() {
    this.list.replaceChildren();
    this.summary.textContent = "";
  }

  show() {
    if (!this.isDue()) return;
    const contacts = [...this.readings.contacts].sort((one, other) => other.pressure - one.pressure);
    const touching = contacts.filter(({ pressure }) => pressure > 0);
    const total = touching.reduce((sum, { pressure }) => sum + pressure, 0);
    this.summary.textContent = `${contacts.length} points, ${touching.length} with force, ${fixed(total, 2)} N in all`;
    const shown = contacts.slice(0, MAX_LISTED);
    while (this.list.children.length > shown.length) this.list.lastChild.remove();
    shown.forEach((contact, place) => this.fill(this.list.children[place] ?? this.add(), contact));
  }

  add() {
    const row = made("button", "", { className: "contact" });
    row.append(made("span", ""), made("small", ""));
    row.addEventListener("click", () => this.choose(Number(row.dataset.body), Number(row.dataset.link)));
    this.list.append(row);
    return row;
  }

  fill(row, { a, b, pressure, friction, distance }) {
    [row.dataset.body, row.dataset.link] = a;
    row.children[0].textContent = `${this.nameOf(a)} – ${this.nameOf(b)}`;
    row.children[1].textContent = `${fixed(pressure, 3)} N, friction ${fixed(Math.hypot(...friction), 3)} N, ${fixed(distance * 1000, 3)} mm`;
  }

  nameOf([number, link]) {
    const body = this.scene.bodies.get(number);
    const part = body?.links[link]?.name ?? String(link);
    return !body || body.name === part ? part : `${body.name}/${part}`;
  }
}
