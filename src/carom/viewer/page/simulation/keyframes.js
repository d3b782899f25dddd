// The keyframes of a simulation: a button for each, and for saving, copying and dropping them.

import { FromPage } from "../protocol.js";
import { made, Section } from "./section.js";

/** @import { Notices } from "../panel/notices.js" */

export class Keyframes extends Section {
  /**
   * @param {(message: MessageFromPage) => void} send
   * @param {Notices} notices
   */
  constructor(send, notices) {
    super("keyframes");
    this.send = send;
    this.notices = notices;
    this.names = [];
    document.getElementById("keyframe-save").addEventListener("click", () => this.save());
  }

  take({ keyframes }) {
    this.root.hidden = false;
    this.names = keyframes.map(({ name }) => name);
    this.list.replaceChildren(...keyframes.map((keyframe) => this.row(keyframe)));
  }

  row({ name, time, text, own }) {
    const row = made("div", "", { className: "row keyframe" });
    const go = made("button", name, { title: `Go to ${name}, at ${Number(time.toPrecision(6))} s` });
    go.addEventListener("click", () => this.ask("reset", name));
    const copy = made("button", "Copy", { title: `Copy ${name} as text`, ariaLabel: `Copy ${name}` });
    copy.addEventListener("click", () => this.copy(name, text));
    row.append(go, copy);
    if (own) {
      const drop = made("button", "✕", { title: `Drop ${name}`, ariaLabel: `Drop ${name}` });
      drop.addEventListener("click", () => this.ask("forget", name));
      row.append(drop);
    }
    return row;
  }

  /** Keeps the present state under the name in the field, or one of its own. */
  save() {
    const field = document.getElementById("keyframe-name");
    const typed = field instanceof HTMLInputElement ? field.value.trim() : "";
    let number = 1;
    while (this.names.includes(`state ${number}`)) number += 1;
    this.ask("save", typed || `state ${number}`);
    if (field instanceof HTMLInputElement) field.value = "";
  }

  async copy(name, text) {
    try {
      await navigator.clipboard.writeText(text);
      this.notices.say(`Copied keyframe ${name}.`);
    } catch {
      this.notices.say(text);
    }
  }

  ask(action, name) {
    this.send({ type: FromPage.KEYFRAME, action, name });
  }
}
