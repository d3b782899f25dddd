// What stands for the renderer in a browser without WebGL: the page shows everything but the picture.

import { Pace } from "./software/pace.js";
import { element } from "../elements.js";

/** Stands for the context of WebGL: all its functions do nothing. */
const NO_CONTEXT = new Proxy(/** @type {WebGL2RenderingContext} */ ({}), { get: () => () => null });

export class NoGraphics {
  constructor() {
    this.gl = NO_CONTEXT;
    this.byProcessor = false;
    this.lost = false;
    this.pace = new Pace(false);
    // Pictures and films would be empty.
    for (const id of ["picture", "film", "render"]) element(id, HTMLButtonElement).disabled = true;
    element("size", HTMLSelectElement).disabled = true;
    document.getElementById("no-picture").hidden = false;
  }

  resize() {
    return false;
  }

  begin() {}

  draw() {}
}
