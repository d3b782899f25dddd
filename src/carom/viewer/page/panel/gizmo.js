// The directions of the world's axes, in a corner of the view. A click on the end of an axis looks along it.

import { dot } from "../view/maths.js";

/** @import { Viewpoint } from "./viewpoint.js" */

const SIZE = 76;
const REACH = 27;
const RADIUS = 8;
const AXES = [
  { axis: [1, 0, 0], name: "x", views: ["front", "back"] },
  { axis: [0, 1, 0], name: "y", views: ["left", "right"] },
  { axis: [0, 0, 1], name: "z", views: ["top", "below"] },
];
/** Views from the ends of the axes if y is upwards. */
const VIEWS_Y_UP = [["back", "front"], ["top", "below"], ["left", "right"]];

export class Gizmo {
  /** @param {Viewpoint} viewpoint */
  constructor(viewpoint) {
    this.root = document.getElementById("gizmo");
    this.root.setAttribute("viewBox", `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`);
    this.ends = AXES.flatMap(({ axis, name, views }, index) =>
      [1, -1].map((sign, back) => {
        const group = element("g", { class: `${name} ${sign > 0 ? "plus" : "minus"}` });
        group.append(element("title", {}, `View from ${sign > 0 ? "" : "−"}${name}`));
        const line = element("line", { x1: 0, y1: 0 });
        const head = element("circle", { r: sign > 0 ? RADIUS : RADIUS - 2 });
        const text = element("text", {}, sign > 0 ? name : "");
        group.append(...(sign > 0 ? [line] : []), head, text);
        group.addEventListener("click", () => {
          const camera = viewpoint.chosen;
          viewpoint.change(() => camera.preset(camera.yUp ? VIEWS_Y_UP[index][back] : views[back]));
        });
        return { group, line, head, text, axis: axis.map((x) => sign * x) };
      }),
    );
    this.root.append(...this.ends.map(({ group }) => group));
    this.seen = "";
  }

  /** Shows the axes as the camera sees them, in the corner of its view. */
  show({ right, up, forward, left, top }, shown) {
    this.root.toggleAttribute("hidden", !shown);
    const seen = [right, up, forward, left, top].join();
    if (seen === this.seen) return;
    this.seen = seen;
    this.root.style.transform = left + top > 0 ? `translate(${left}px, ${top}px)` : "";
    for (const { axis, line, head, text } of this.ends) {
      const [x, y] = [REACH * dot(axis, right), -REACH * dot(axis, up)];
      for (const [part, names] of [[line, ["x2", "y2"]], [head, ["cx", "cy"]], [text, ["x", "y"]]]) {
        part.setAttribute(names[0], x.toFixed(2));
        part.setAttribute(names[1], y.toFixed(2));
      }
    }
    // The nearest end is drawn last, over the others.
    const ordered = [...this.ends].sort((a, b) => dot(b.axis, forward) - dot(a.axis, forward));
    this.root.append(...ordered.map(({ group }) => group));
  }
}

function element(name, attributes, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}
