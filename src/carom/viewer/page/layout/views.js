// One, two or four views of the scene, each with a camera of its own. The first one is that of the script.

import { Camera, PRESETS } from "../view/camera.js";
import { made } from "../simulation/section.js";
import { press } from "../panel/states.js";

/** @import { Memory } from "../memory.js" */
/** @import { Lenses } from "../panel/lenses.js" */

const COUNTS = [1, 2, 4];
/** Directions that the views after the first one have at first. */
const DIRECTIONS = ["corner", "front", "top", "right"];
/** Space between views [pixels]. */
const GAP = 2;
/** What the panel leaves free of the window is used if it is this share at least; else views go on below it. */
const MIN_FREE = 0.5;
const OWN = "own";

/** A view: its camera, and the elements over it. */
export class View {
  /** @param {Camera} camera */
  constructor(camera, number) {
    this.camera = camera;
    this.number = number;
    /** Covers what the image of a script's camera does not contain. */
    this.cover = made("div", "", { className: "letterbox", hidden: true });
    if (number === 0) this.cover.id = "letterbox";
    this.select = made("select", "", { title: "What this view shows", ariaLabel: `What view ${number + 1} shows` });
    this.pane = made("div", "", { className: "pane" });
    this.pane.append(this.cover, this.select);
    /** Whether nobody has moved its camera: then it shows the whole scene. */
    this.fresh = number > 0;
    /** Name of the camera that it is to look through when that is there; null for none. */
    this.wanted = null;
  }
}

export class Views {
  /**
   * @param {Memory} memory
   * @param {Camera} camera that of the first view
   * @param {{changed: () => void, chosen: (camera: Camera) => void, moved: () => void, fit: (camera: Camera) => void}} tell
   *   called when something has changed, when another view is chosen, when the user has moved the camera of the chosen
   *   one, and to show the whole scene
   */
  constructor(memory, camera, tell) {
    this.memory = memory;
    this.tell = tell;
    this.root = document.getElementById("panes");
    this.all = [new View(camera, 0)];
    this.chosen = this.all[0];
    this.key = "";
    this.size = [1, 1];
    /** Views that do not show the whole scene yet. @type {View[]} */
    this.newcomers = [];
    /** @type {Lenses | null} */
    this.lenses = null;
    this.buttons = COUNTS.map((count) => {
      const button = made("button", String(count), { title: count > 1 ? `${count} views at once` : "One view" });
      button.addEventListener("click", () => {
        this.split(count);
        this.remember();
      });
      return button;
    });
    document.getElementById("views").append(...this.buttons);
    this.split(1);
  }

  get count() {
    return this.all.length;
  }

  get cameras() {
    return this.all.map(({ camera }) => camera);
  }

  /** Shows so many views; those that come show the whole scene from the next direction. @param {number} count */
  split(count) {
    this.all.length = Math.min(this.count, count);
    while (this.count < count) {
      const view = new View(new Camera(), this.count);
      const { camera } = view;
      camera.yUp = this.all[0].camera.yUp;
      camera.set(this.all[0].camera.state());
      camera.preset(DIRECTIONS[view.number]);
      this.all.push(view);
    }
    this.root.replaceChildren(...this.all.map(({ pane }) => pane));
    this.root.classList.toggle("several", count > 1);
    for (const view of this.all) view.select.onchange = () => this.show(view, view.select.value);
    this.buttons.forEach((button, i) => press(button, COUNTS[i] === count));
    this.key = "";
    this.choose(this.all.includes(this.chosen) ? this.chosen : this.all[0]);
    this.offer();
    this.newcomers = this.all.filter(({ fresh }) => fresh);
    this.tell.changed();
  }

  /**
   * Lays the views out; true if that has changed something.
   *
   * @param {number} width of the window [pixels]
   * @param {number} height
   * @param {() => {side: number, below: number}} covers what covers the window at its right and at its bottom [pixels]
   */
  arrange(width, height, covers) {
    const { side, below } = this.count > 1 ? covers() : { side: 0, below: 0 };
    const key = [this.count, width, height, side, below].join();
    if (key === this.key) return false;
    this.key = key;
    this.size = [width, height];
    const free = (whole, covered) => (whole - covered < MIN_FREE * whole ? whole : whole - covered);
    const [right, bottom] = [free(width, side && side + GAP), free(height, below && below + GAP)];
    const columns = this.count === 4 || (this.count === 2 && right >= bottom) ? 2 : 1;
    const rows = this.count / columns;
    const [wide, high] = [(right - GAP * (columns - 1)) / columns, (bottom - GAP * (rows - 1)) / rows];
    this.all.forEach(({ camera, pane }, i) => {
      const [left, top] = [(i % columns) * (wide + GAP), Math.floor(i / columns) * (high + GAP)];
      camera.resize(wide, high, left, top);
      Object.assign(pane.style, { left: `${left}px`, top: `${top}px`, width: `${wide}px`, height: `${high}px` });
    });
    for (const { camera } of this.newcomers) this.tell.fit(camera);
    this.newcomers = [];
    return true;
  }

  /** The part of the canvas that a view has, from the lower left corner on [drawn pixels]. */
  part(number, canvas) {
    const [across, upright] = [canvas.width / this.size[0], canvas.height / this.size[1]];
    const { left, top, width, height } = this.all[number].camera;
    const [x, right] = [left, left + width].map((at) => Math.round(at * across));
    const [low, high] = [top + height, top].map((at) => canvas.height - Math.round(at * upright));
    return { number, x, y: low, width: Math.max(1, right - x), height: Math.max(1, high - low) };
  }

  /** The view at a pixel of the window; the chosen one between views. */
  at(x, y) {
    const has = ({ camera: { left, top, width, height } }) => x >= left && y >= top && x < left + width && y < top + height;
    return this.all.find(has) ?? this.chosen;
  }

  /** Chooses the view that the panel and the pointer act on. @param {View} view */
  choose(view) {
    this.chosen = view;
    for (const each of this.all) each.pane.classList.toggle("chosen", each === view);
    this.tell.chosen(view.camera);
    this.tell.changed();
  }

  /** Shows the scene from a direction, through a camera, or from where the user has been. */
  show(view, look) {
    this.choose(view);
    if (look in PRESETS) view.camera.preset(look);
    else if (look === OWN) view.camera.look(null);
    else this.lenses.lookThrough(view.camera, look.slice(look.indexOf(" ") + 1));
    this.tell.moved();
  }

  /** The user has moved the camera of the chosen view. */
  moved() {
    this.chosen.fresh = false;
    this.chosen.wanted = null;
    this.remember();
  }

  /** Shows the whole scene in the views that nobody has moved. */
  fitFresh() {
    for (const { camera, fresh } of this.all) if (fresh && !camera.lens) this.tell.fit(camera);
  }

  /** Lists what a view can show: directions, and the cameras there are. */
  offer() {
    for (const view of this.all) {
      const group = (label, options) => {
        const found = made("optgroup", "", { label });
        found.append(...options);
        return found;
      };
      const cameras = this.lenses ? [...this.lenses.lenses.values()].map(({ lens, name }) => new Option(name, `camera ${lens}`)) : [];
      const directions = Object.keys(PRESETS).map((name) => new Option(name, name));
      view.select.replaceChildren(new Option("free view", OWN), group("Directions", directions), ...(cameras.length > 0 ? [group("Cameras", cameras)] : []));
      const wanted = this.lenses && [...this.lenses.lenses.values()].find(({ name }) => name === view.wanted);
      if (!wanted) continue;
      view.wanted = null;
      this.lenses.lookThrough(view.camera, wanted.lens);
    }
  }

  /** What a view shows, as an entry of its list. */
  lookOf({ camera }) {
    if (camera.lens) return `camera ${camera.lens.key}`;
    const same = ([yaw, pitch]) => Math.abs(yaw - camera.yaw) < 1e-6 && Math.abs(pitch - camera.pitch) < 1e-6;
    return Object.keys(PRESETS).find((name) => same(PRESETS[name])) ?? OWN;
  }

  /** Shows in the lists what the views show. */
  tellLooks() {
    if (this.count === 1) return;
    for (const view of this.all) {
      const look = this.lookOf(view);
      if (view.select.value !== look && document.activeElement !== view.select) view.select.value = look;
    }
  }

  remember() {
    const views = this.all.map(({ camera, fresh, wanted }) => {
      const name = camera.lens ? this.lenses.lenses.get(camera.lens.key)?.name : wanted;
      return { camera: camera.state(), fresh, ...(name && { through: name }) };
    });
    this.memory.put("views", this.count > 1 ? views : []);
  }

  /** Shows the views that the browser has kept for the script. */
  recall() {
    const kept = this.memory.get("views");
    if (!Array.isArray(kept) || !COUNTS.includes(kept.length)) return;
    this.split(kept.length);
    this.all.forEach((view, i) => {
      view.wanted = kept[i].through ?? null;
      view.fresh = i > 0 && kept[i].fresh;
      // The first one is kept with the script's camera that it replaces.
      if (i > 0) view.camera.set(kept[i].camera);
    });
    this.newcomers = this.all.filter(({ fresh }) => fresh);
    this.offer();
  }
}
