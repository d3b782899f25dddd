// Sliders of all actuators and joints of a simulation.

import { Drives, MOVABLE } from "../panel/drives.js";
import { isSpectator } from "../spectating.js";
import { titlesOf } from "../view/names.js";
import { made, Section } from "./section.js";

/** Sliders that are shown at most. */
const MAX_SLIDERS = 200;

export class Controls {
  constructor(scene, readings, send, memory) {
    this.scene = scene;
    this.memory = memory;
    this.actuators = new Section("actuators");
    this.joints = new Section("joints");
    this.driven = new Drives(readings, send, "all-");
    this.placed = new Drives(readings, send, "all-");
    this.known = "";
  }

  clear() {
    this.known = "";
    this.actuators.root.hidden = this.joints.root.hidden = true;
  }

  /** Whether the page needs the states of all joints and actuators. */
  get isOpen() {
    return this.actuators.isOpen || this.joints.isOpen;
  }

  /** Makes a slider for each actuator and joint that there is. */
  offer() {
    const bodies = this.scene.own;
    const known = JSON.stringify(bodies.map(({ body, name, links, actuators }) => [body, name, links.map(({ joint, kind, limits }) => [joint, kind, limits]), actuators]));
    if (known === this.known) return;
    this.known = known;
    this.driven.clear();
    this.placed.clear();
    const titles = titlesOf(this.scene);
    const actuators = bodies.flatMap((body) => (body.actuators ?? []).map((it, index) => [body, () => this.driven.actuatorSlider(body.body, index, it)]));
    const joints = bodies.flatMap((body) =>
      body.links.flatMap((link, index) => (MOVABLE.test(link.kind ?? "") ? [[body, () => this.placed.jointSlider(body.body, index - 1, link)]] : [])),
    );
    fill(this.actuators, actuators, titles);
    fill(this.joints, joints, titles);
    // Without actuators joints are what is moved.
    if (actuators.length === 0 && this.memory.get("sections")?.joints === undefined) this.joints.root.open = true;
  }

  show() {
    if (this.actuators.isDue()) this.driven.show();
    if (this.joints.isDue()) this.placed.show();
  }
}

/** Fills a section with sliders, below the title of each body if there are several. */
function fill(section, makers, titles) {
  section.root.hidden = makers.length === 0;
  const owners = new Set(makers.map(([body]) => body));
  let last = null;
  const parts = [];
  for (const [body, make] of makers.slice(0, MAX_SLIDERS)) {
    if (owners.size > 1 && body !== last) parts.push(made("h2", titles.get(body.body)));
    last = body;
    parts.push(make());
  }
  if (makers.length > MAX_SLIDERS) parts.push(made("small", `${makers.length - MAX_SLIDERS} more; choose a body to see its own`));
  section.list.replaceChildren(...parts);
  section.list.toggleAttribute("inert", isSpectator());
}
