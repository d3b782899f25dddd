// Gravity, time step, law of contact and other parameters of a simulation.

import { FromPage } from "../protocol.js";
import { made, Section } from "./section.js";

const AXES = ["x", "y", "z"];
const EARTH = [0, 0, -9.81];

export class Settings extends Section {
  /** @param {(message: MessageFromPage) => void} send */
  constructor(send) {
    super("physics");
    this.send = send;
  }

  take({ settings }) {
    this.root.hidden = false;
    this.list.replaceChildren(...settings.map((setting) => this.row(setting)));
  }

  /** Shows what the files state besides bodies. */
  takeStated(stated) {
    const root = document.getElementById("stated");
    root.hidden = stated.length === 0;
    document.getElementById("stated-list").replaceChildren(...stated.flatMap(([name, value]) => [made("dt", name), made("dd", value)]));
  }

  row(setting) {
    const { name, title, value, unit, choices } = setting;
    const row = made("div", "", { className: "setting" });
    row.dataset.setting = name;
    if (typeof value === "boolean") {
      const label = made("label", "", { className: "check" });
      const box = made("input", "", { type: "checkbox", checked: value });
      box.addEventListener("change", () => this.set(name, box.checked));
      label.append(box, title);
      row.append(label);
      return row;
    }
    row.append(made("span", unit ? `${title} [${unit}]` : title));
    if (choices) row.append(this.choice(name, title, value, choices));
    else row.append(...this.fields(name, title, value));
    if (name === "gravity") row.append(this.gravity(value));
    return row;
  }

  choice(name, title, value, choices) {
    const select = made("select", "", { ariaLabel: title });
    select.append(...choices.map((text) => new Option(text, text, false, text === value)));
    select.addEventListener("change", () => this.set(name, select.value));
    return select;
  }

  fields(name, title, values) {
    const fields = values.map((value, place) => {
      const label = values.length > 1 ? `${title} ${AXES[place]}` : title;
      const field = made("input", "", { type: "number", step: "any", value: String(Number(value.toPrecision(9))), ariaLabel: label, title: label });
      field.addEventListener("keydown", (event) => event.key === "Enter" && field.blur());
      field.addEventListener("change", () => this.set(name, fields.map((each, i) => (each.value === "" ? values[i] : Number(each.value)))));
      return field;
    });
    return fields;
  }

  /** Switches gravity on as on earth, or off. */
  gravity(value) {
    const off = value.every((part) => part === 0);
    const button = made("button", off ? "Earth" : "None", { title: off ? "Gravity as on earth" : "No gravity" });
    button.addEventListener("click", () => this.set("gravity", off ? EARTH : [0, 0, 0]));
    return button;
  }

  set(name, value) {
    this.send({ type: FromPage.SETTING, name, value });
  }
}
