// Many worlds: which of them are shown and where, and which one is looked at.

import { FromPage } from "../protocol.js";
import { element } from "../elements.js";
import { isSpectator } from "../spectating.js";

/** More worlds than this have no numbers in the view: they would cover each other. */
const MAX_NAMED = 64;
/** Height of the frame of the chosen world above the ground [m]. */
const LIFT = 0.002;
const CHOSEN = [0.25, 0.55, 1];

export class Worlds {
  /**
   * @param {import("../view/scene.js").Scene} scene
   * @param {(message: MessageFromPage) => void} send
   */
  constructor(scene, send) {
    this.scene = scene;
    this.send = send;
    this.root = element("worlds", HTMLDetailsElement);
    this.number = element("world", HTMLInputElement);
    this.shown = element("worlds-shown", HTMLSelectElement);
    this.arrangement = element("worlds-arrangement", HTMLSelectElement);
    this.number.addEventListener("change", () => this.choose(Number(this.number.value)));
    document.getElementById("world-before").addEventListener("click", () => this.choose(this.facts.chosen - 1));
    document.getElementById("world-after").addEventListener("click", () => this.choose(this.facts.chosen + 1));
    this.shown.addEventListener("change", () => send({ type: FromPage.WORLDS, shown: Number(this.shown.value) }));
    this.arrangement.addEventListener("change", () => this.arrange(this.arrangement.value));
    document.getElementById("worlds-choice").toggleAttribute("inert", isSpectator());
    this.clear();
  }

  clear() {
    this.facts = null;
    this.scene.many = false;
    this.root.hidden = true;
  }

  /** Takes which worlds are shown; true if another one is looked at. */
  take(facts) {
    const isOther = this.facts !== null && this.facts.chosen !== facts.chosen;
    this.facts = facts;
    this.scene.many = true;
    this.root.hidden = false;
    const { count, shown, chosen, arrangement } = facts;
    document.getElementById("worlds-count").textContent = `${shown.length} of ${count}`;
    Object.assign(this.number, { max: String(count - 1), value: String(chosen) });
    if (![...this.shown.options].some(({ value }) => Number(value) === shown.length)) this.shown.append(new Option(String(shown.length)));
    this.shown.value = String(shown.length);
    this.arrangement.value = arrangement;
    return isOther;
  }

  /** Looks at a world; those after the last one are the first ones again. */
  choose(number) {
    const { count } = this.facts;
    if (Number.isInteger(number)) this.send({ type: FromPage.WORLDS, chosen: ((number % count) + count) % count });
  }

  /** @param {string} arrangement */
  arrange(arrangement) {
    if (arrangement === "grid" || arrangement === "overlay") this.send({ type: FromPage.WORLDS, arrangement });
  }

  /** A frame around the chosen world in the grid. */
  addLines(lines) {
    if (!this.facts || this.facts.size === 0 || this.facts.shown.length === 1) return;
    const { size, cells, shown, chosen } = this.facts;
    const [x, y, z] = cells[shown.indexOf(chosen)];
    const half = 0.48 * size;
    const corners = [[-half, -half], [half, -half], [half, half], [-half, half]].map(([a, b]) => [x + a, y + b, z + LIFT]);
    corners.forEach((corner, i) => lines.line(corner, corners[(i + 1) % 4], CHOSEN, 2));
  }

  /** The number of each world in the grid, at the edge of its place. */
  addLabels(labels, camera) {
    if (!this.facts || this.facts.size === 0 || this.facts.shown.length > MAX_NAMED) return;
    const { size, cells, shown } = this.facts;
    cells.forEach(([x, y, z], i) => labels.add(camera, [x, y - 0.45 * size, z], `world ${shown[i]}`, 10));
  }
}
