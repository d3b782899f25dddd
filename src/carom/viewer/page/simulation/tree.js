// What bodies consist of: links, joints and sites, as lines below the body, and the search for them.

import { unfold } from "../panel/states.js";
import { element } from "../elements.js";

/** @import { Scene } from "../view/scene.js" */

/** Lines of one body that are shown at most. */
const MAX_LINES = 500;

export class Tree {
  /**
   * @param {Scene} scene
   * @param {(body: number, link: number) => void} choose called with the link that the user has chosen
   */
  constructor(scene, choose) {
    this.scene = scene;
    this.choose = choose;
    this.open = new Set();
    this.find = element("find", HTMLInputElement);
    /** Called when other lines are to be shown. */
    this.changed = () => {};
    this.find.addEventListener("input", () => this.changed());
  }

  /** What the user is looking for. */
  get query() {
    return this.find.value.trim().toLowerCase();
  }

  /** What the lines depend on besides bodies. */
  get state() {
    return [this.query, [...this.open]];
  }

  /** Whether a body is, or has, what the user is looking for. */
  finds(body, title) {
    return this.query === "" || title.toLowerCase().includes(this.query) || this.found(body).length > 0;
  }

  /** The parts of a body that the user is looking for. */
  found(body) {
    return partsOf(body).filter(({ name, kind }) => `${kind} ${name}`.toLowerCase().includes(this.query));
  }

  /** The button that unfolds a body. */
  arrow(body, name) {
    const open = this.open.has(body);
    const title = `Links, joints and sites of ${name} (body ${body})`;
    const button = Object.assign(document.createElement("button"), { className: "arrow", textContent: open ? "▾" : "▸", title, ariaLabel: title });
    unfold(button, open);
    button.addEventListener("click", () => {
      if (!this.open.delete(body)) this.open.add(body);
      this.changed();
    });
    return button;
  }

  /** The lines of a body: all if it is unfolded, else those that are looked for. */
  rows(body) {
    const parts = this.open.has(body.body) && this.query === "" ? partsOf(body) : this.query === "" ? [] : this.found(body);
    return parts.slice(0, MAX_LINES).map((part) => this.line(body.body, part));
  }

  line(body, { kind, name, link, depth, about }) {
    const button = Object.assign(document.createElement("button"), { title: `${kind} ${name}` });
    button.append(Object.assign(document.createElement("small"), { textContent: kind }), ` ${name}`);
    if (about) button.append(Object.assign(document.createElement("small"), { textContent: ` ${about}` }));
    button.dataset.body = body;
    button.dataset.link = link;
    button.style.paddingLeft = `${18 + 9 * Math.min(depth, 8)}px`;
    button.addEventListener("click", () => this.choose(body, link));
    const row = Object.assign(document.createElement("div"), { className: "part" });
    row.append(button);
    return row;
  }
}

/** Links, joints and sites of a body, each below what it is on; a joint is chosen with the link that it moves. */
function partsOf({ links, sites = [] }) {
  const children = links.map(() => []);
  links.forEach(({ parent }, index) => parent !== undefined && children[parent].push(index));
  const parts = [];
  const pending = [[0, 0]];
  while (pending.length) {
    const [link, depth] = pending.pop();
    const { name, joint, kind } = links[link];
    if (joint !== undefined) parts.push({ kind: "joint", name: joint, link, depth, about: kind });
    parts.push({ kind: "link", name, link, depth });
    for (const site of sites) if (site.link === link) parts.push({ kind: "site", name: site.name, link, depth: depth + 1 });
    for (const child of [...children[link]].reverse()) pending.push([child, depth + 1]);
  }
  return parts;
}
