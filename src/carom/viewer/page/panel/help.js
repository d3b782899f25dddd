// The list of keys and mouse actions, shown over the view.

import { unfold } from "./states.js";

const SECTIONS = {
  Mouse: {
    click: "select a body",
    drag: "pull a body, or turn the view",
    "Ctrl + drag": "turn the view",
    "Ctrl + Shift + drag": "turn a body",
    "Shift + drag": "move the view",
    wheel: "zoom",
    "two fingers": "zoom and move the view",
  },
  Show: {
    a: "bounds",
    c: "contact points",
    j: "link frames",
    k: "constraints",
    l: "joint limits",
    s: "shadows",
    v: "visual shapes",
    w: "wireframe",
    g: "panel, time bar, grid",
  },
  Simulation: {
    i: "pause, continue",
    o: "one step, while paused",
    d: "keep bodies awake, or let them sleep",
    p: "while held: record a timing profile",
    F1: "record a video; again to save it",
    "?": "this list",
    Tab: "go to the panel, and through it",
    Esc: "back to the view, or close the window and end the connection",
  },
};

export class Help {
  constructor() {
    this.root = document.getElementById("help");
    this.root.append(...Object.entries(SECTIONS).map(([title, keys]) => section(title, keys)));
    this.root.addEventListener("click", () => this.toggle());
    document.getElementById("keys").addEventListener("click", () => this.toggle());
    this.showState();
  }

  showState() {
    unfold(document.getElementById("keys"), this.open);
  }

  get open() {
    return !this.root.hidden;
  }

  toggle() {
    this.root.hidden = this.open;
    this.showState();
  }
}

function section(title, keys) {
  const list = document.createElement("dl");
  for (const [key, text] of Object.entries(keys)) {
    const term = document.createElement("dt");
    term.append(Object.assign(document.createElement("kbd"), { textContent: key }));
    list.append(term, Object.assign(document.createElement("dd"), { textContent: text }));
  }
  const element = document.createElement("section");
  element.append(Object.assign(document.createElement("h2"), { textContent: title }), list);
  return element;
}
