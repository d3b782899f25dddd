// Fields for the arguments of xacro files, which are loaded again with what is typed there.

import { FromPage } from "../protocol.js";
import { made, Section } from "./section.js";

export class Arguments extends Section {
  /** @param {(message: MessageFromPage) => void} send */
  constructor(send) {
    super("arguments");
    this.send = send;
  }

  take({ arguments: all }) {
    this.root.hidden = all.length === 0;
    this.list.replaceChildren(...all.map(({ name, value }) => this.row(name, value)));
  }

  row(name, value) {
    const row = made("label", name, { className: "argument" });
    const field = made("input", "", { type: "text", value, spellcheck: false });
    field.addEventListener("keydown", (event) => event.key === "Enter" && field.blur());
    field.addEventListener("change", () => this.send({ type: FromPage.ARGUMENTS, values: { [name]: field.value } }));
    row.append(field);
    return row;
  }
}
