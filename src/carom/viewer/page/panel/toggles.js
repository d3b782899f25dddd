// The switches of the display options of this page.

const GROUPS = [
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
  ],
  [
    "Contacts",
    ["contacts", "Points", "C"],
    ["forces", "Forces", ""],
    ["cones", "Friction cones", ""],
    ["rays", "Rays", ""],
  ],
  [
    "Joints and links",
    ["axes", "Joint axes", ""],
    ["torques", "Torques", ""],
    ["positions", "Positions", ""],
    ["limits", "Limits", "L"],
    ["constraints", "Constraints", "K"],
    ["tendons", "Tendons", ""],
    ["masses", "Centres of mass", ""],
    ["inertias", "Inertia boxes", ""],
    ["skeleton", "Skeleton", ""],
    ["trail", "Trail of selected", ""],
  ],
];

export class Toggles {
  /** @param {(name: string) => void} changed called with the option that the user has set */
  constructor(options, changed) {
    this.options = options;
    this.boxes = new Map();
    const root = document.getElementById("toggles");
    for (const [title, ...switches] of GROUPS) {
      root.append(Object.assign(document.createElement("h2"), { textContent: title }));
      const group = Object.assign(document.createElement("div"), { className: "toggles" });
      for (const [name, text, key] of switches) group.append(this.makeSwitch(name, text, key, changed));
      root.append(group);
    }
    this.show();
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
