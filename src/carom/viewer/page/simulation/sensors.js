// The sensors of all bodies: a bar for each number; a click on the name plots it.

import { fixed } from "../panel/numbers.js";
import { titlesOf } from "../view/names.js";
import { made, Section } from "./section.js";

/** Bars of one sensor that are shown at most, and sensors. */
const MAX_BARS = 16;
const MAX_SENSORS = 200;

export class Sensors extends Section {
  /** @param {(key: string) => void} plot called with the key of the sensor that is to be plotted */
  constructor(scene, readings, plot) {
    super("sensors");
    this.scene = scene;
    this.readings = readings;
    this.plot = plot;
    /** Bars of each sensor, by the numbers of body and sensor, and the greatest number so far. */
    this.rows = new Map();
    this.known = "";
  }

  clear() {
    this.known = "";
    this.rows.clear();
    this.root.hidden = true;
  }

  /** The bodies whose sensors the page needs. */
  get wanted() {
    return this.isOpen ? this.scene.own.filter(({ sensors }) => sensors).map(({ body }) => body) : [];
  }

  offer() {
    const bodies = this.scene.own.filter(({ sensors }) => sensors);
    const known = JSON.stringify(bodies.map(({ body, name, sensors }) => [body, name, sensors]));
    if (known === this.known) return;
    this.known = known;
    this.rows.clear();
    const titles = titlesOf(this.scene);
    const all = bodies.flatMap((body) => body.sensors.map((sensor, index) => ({ body: body.body, index, sensor })));
    this.root.hidden = all.length === 0;
    this.list.replaceChildren(...all.slice(0, MAX_SENSORS).map((each) => this.row(each, bodies.length > 1 ? titles.get(each.body) : "")));
  }

  row({ body, index, sensor: { name, kind, size } }, owner) {
    const row = made("div", "", { className: "sensor" });
    const button = made("button", name, { title: `Plot ${name}: ${kind}${owner ? ` of ${owner}` : ""}` });
    button.addEventListener("click", () => this.plot(`reading ${body},${index}`));
    const bars = Array.from({ length: Math.min(size, MAX_BARS) }, () => {
      const bar = made("div", "", { className: "bar" });
      const fill = made("i", "");
      const number = made("output", "");
      bar.append(fill, number);
      return { bar, fill, number };
    });
    const all = made("div", "", { className: "bars" });
    all.append(...bars.map(({ bar }) => bar));
    row.append(button, all);
    this.rows.set(`${body},${index}`, { bars, most: 0 });
    return row;
  }

  show() {
    if (!this.isDue()) return;
    for (const [key, row] of this.rows) {
      const values = this.readings.sensors.get(key);
      if (!values) continue;
      row.most = Math.max(row.most, ...values.filter(Number.isFinite).map(Math.abs));
      row.bars.forEach(({ fill, number }, place) => {
        const value = values[place] ?? 0;
        const share = row.most > 0 ? value / row.most : 0;
        fill.style.left = `${50 + 50 * Math.min(0, share)}%`;
        fill.style.width = `${50 * Math.abs(share)}%`;
        number.textContent = fixed(value, 4);
      });
    }
  }
}
