// The legend of arrows, over the view: how many newtons an arrow of the drawn length is.

import { niceScale } from "../view/arrows/arrow_scale.js";

/** Length of the legend's arrow, at least [pixels]. */
const MIN_PIXELS = 36;

export class Legend {
  constructor() {
    this.root = document.getElementById("legend");
    this.rows = ["force", "torque"].map((kind) => {
      const row = Object.assign(document.createElement("div"), { className: kind, hidden: true });
      const bar = document.createElement("i");
      const text = document.createElement("span");
      row.append(bar, text);
      this.root.append(row);
      return { row, bar, text };
    });
  }

  /**
   * @param {{force: number, torque: number}} scales force and torque per metre; 0 for those that are not shown
   * @param {number} metre length of a metre at the camera's target [pixels]
   */
  show(scales, metre) {
    const amounts = [scales.force, scales.torque];
    const units = ["N", "N·m (slides: N)"];
    this.rows.forEach(({ row, bar, text }, index) => {
      row.hidden = !(amounts[index] > 0);
      if (row.hidden) return;
      const amount = niceScale((amounts[index] * MIN_PIXELS) / metre);
      bar.style.width = `${(amount / amounts[index]) * metre}px`;
      const shown = `${amount} ${units[index]}`;
      if (text.textContent !== shown) text.textContent = shown;
    });
  }
}
