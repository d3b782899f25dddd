// The switches of the display options of this page.

import { GROUPS } from "./options.js";

const SWITCHES = [
  [
    "Scene",
    ["shadows", "Shadows", "S"],
    ["wireframe", "Wireframe", "W"],
    ["visuals", "Visual shapes", "V"],
    ["collisions", "Collision shapes", ""],
    ["transparent", "Transparent", ""],
    ["grid", "Grid", ""],
    ["frames", "Link frames", "J"],
    ["bounds", "Bounds", "A"],
    ["names", "Name at mouse", ""],
    ["linkNames", "Link names", ""],
    ["linkColours", "Colour by link", ""],
    ["depth", "Depth", ""],
    ["cameras", "Cameras", ""],
    ["fileCameras", "Cameras of files", ""],
  ],
  [
    "Contacts",
    ["contacts", "Points", "C"],
    ["forces", "Forces", ""],
    ["cones", "Friction cones", ""],
    ["contactFrames", "Contact frames", ""],
    ["rays", "Rays", ""],
  ],
  [
    "Joints and links",
    ["axes", "Joint axes", ""],
    ["torques", "Torques", ""],
    ["jointFrames", "Joint frames", ""],
    ["positions", "Positions", ""],
    ["limits", "Limits", "L"],
    ["constraints", "Constraints", "K"],
    ["tendons", "Tendons", ""],
    ["masses", "Centres of mass", ""],
    ["inertias", "Inertia boxes", ""],
    ["inertiaFrames", "Inertia frames", ""],
    ["siteFrames", "Site frames", ""],
    ["skeleton", "Skeleton", ""],
    ["trail", "Trail of selected", ""],
  ],
];
/** Groups of files, whose switches are there if a file has them. */
const OF_FILES = [
  ["Groups of shapes", "shapes", (shape) => !shape.site && (shape.group ?? 0) > 0],
  ["Groups of sites", "sites", (shape) => shape.site],
  ["Groups of tendons", "tendons", null],
];

export class Toggles {
  /** @param {(name: string) => void} changed called with the option that the user has set */
  constructor(options, changed) {
    this.options = options;
    this.boxes = new Map();
    const root = document.getElementById("toggles");
    for (const [title, ...switches] of SWITCHES) {
      root.append(Object.assign(document.createElement("h2"), { textContent: title }));
      const group = Object.assign(document.createElement("div"), { className: "toggles" });
      for (const [name, text, key] of switches) group.append(this.makeSwitch(name, text, key, changed));
      root.append(group);
    }
    this.sections = OF_FILES.map(([title, kind, isOne]) => {
      const section = Object.assign(document.createElement("div"), { hidden: true });
      section.append(Object.assign(document.createElement("h2"), { textContent: title }));
      const group = Object.assign(document.createElement("div"), { className: "toggles groups" });
      for (let number = 0; number < GROUPS; number++) group.append(this.makeSwitch(`${kind}${number}`, String(number), "", changed));
      section.append(group);
      root.append(section);
      return { section, isOne };
    });
    this.show();
  }

  /** Offers the groups that shapes of bodies have, and those of tendons if there are any. */
  offer(bodies, tendons) {
    for (const { section, isOne } of this.sections) {
      section.hidden = isOne ? ![...bodies.values()].some((body) => body.shapes.some(isOne)) : !tendons;
    }
  }

  makeSwitch(name, text, key, changed) {
    const label = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", name });
    box.addEventListener("change", () => {
      this.options[name] = box.checked;
      changed(name);
    });
    label.append(box, text);
    if (key) label.append(Object.assign(document.createElement("kbd"), { textContent: key }));
    this.boxes.set(name, box);
    return label;
  }

  show() {
    for (const [name, box] of this.boxes) box.checked = this.options[name];
  }
}
