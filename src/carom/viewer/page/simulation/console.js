// The console: warnings, errors, and what of the files is not simulated.

import { made, Section } from "./section.js";

/** @import { Notices } from "../panel/notices.js" */

export class Console extends Section {
  /** @param {Notices} notices */
  constructor(notices) {
    super("console");
    this.notices = notices;
    this.count = document.getElementById("console-count");
    this.last = null;
  }

  take({ lines }) {
    this.root.hidden = false;
    const grave = lines.filter(({ level }) => level !== "info").length;
    this.count.textContent = grave ? String(grave) : "";
    this.list.replaceChildren(
      ...lines.map(({ level, text, count }) => {
        const line = made("p", count > 1 ? `${text} (${count} times)` : text, { className: level });
        line.dataset.level = level;
        return line;
      }),
    );
    this.list.scrollTop = this.list.scrollHeight;
    const newest = lines.at(-1);
    const said = newest && JSON.stringify(newest);
    // What is there when the page opens is read in the console.
    if (this.last !== null && said !== this.last && newest?.level === "error") this.notices.say(newest.text);
    this.last = said ?? "";
  }
}
