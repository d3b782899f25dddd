// Sharp or fluent: the choice that a browser without a graphics card leaves, and why the picture is coarse.

import { element } from "../elements.js";

/** @import { Pace } from "../view/software/pace.js" */
/** @import { Memory } from "../memory.js" */

export class Quality {
  /**
   * @param {{byProcessor: boolean, pace: Pace}} renderer
   * @param {Memory} memory keeps the choice for the next run of the script
   * @param {() => void} changed called when the view has to be drawn again
   */
  constructor({ byProcessor, pace }, memory, changed) {
    this.pace = pace;
    this.memory = memory;
    this.select = element("sharpness", HTMLSelectElement);
    this.reason = document.getElementById("coarse");
    document.getElementById("quality").hidden = !byProcessor;
    this.select.addEventListener("change", () => {
      this.pace.sharp = this.select.value === "sharp";
      memory.put("sharp", this.pace.sharp);
      this.show();
      changed();
    });
  }

  /** Goes on with the pace of another renderer. */
  take(pace) {
    this.pace = pace;
    this.recall();
  }

  /** Takes the choice that the browser has kept. */
  recall() {
    this.pace.sharp = this.memory.get("sharp") === true;
    this.select.value = this.pace.sharp ? "sharp" : "fluent";
    this.show();
  }

  /** Says how coarse the picture is while something moves. */
  show() {
    const { byProcessor, sharpness } = this.pace;
    const coarse = byProcessor && sharpness < 1;
    const text = coarse ? `No graphics card: ${Math.round(sharpness * 100)} % of the pixels along each edge while something moves.` : "";
    if (this.reason.textContent !== text) this.reason.textContent = text;
  }
}
