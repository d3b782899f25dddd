// Charts of joints, bodies, contacts, sensors and values of scripts over time.

import { Chart } from "./chart.js";
import { download } from "../time/download.js";
import { sourcesOf } from "./sources.js";
import { POSE_FLOATS } from "../view/scene.js";
import { Readings } from "../view/readings.js";

/** Maximum number of samples of a plot; beyond it the oldest tenth is dropped. */
const MOST_SAMPLES = 20000;

export class Plots {
  /** @param {() => void} wantsChanged called when the plots need other data from the simulation */
  constructor(scene, history, player, memory, wantsChanged) {
    Object.assign(this, { scene, history, player, memory, wantsChanged });
    this.select = document.getElementById("joint");
    this.root = document.getElementById("charts");
    this.plotted = new Map();
    this.sources = new Map();
    this.valueNames = new Set();
    this.known = "";
    this.select.addEventListener("change", () => {
      if (this.select.value) this.add(this.sources.get(this.select.value));
      this.select.value = "";
      this.remember();
    });
  }

  /** Updates the list of quantities that can be plotted. */
  offer() {
    const groups = sourcesOf(this.scene, this.valueNames);
    const known = JSON.stringify(Object.values(groups).map((group) => group.map(({ key, title }) => [key, title])));
    if (known === this.known) return;
    this.known = known;
    this.sources = new Map(Object.values(groups).flatMap((group) => group.map((source) => [source.key, source])));
    const options = Object.entries(groups).filter(([, group]) => group.length > 0).map(([title, group]) => {
      const element = Object.assign(document.createElement("optgroup"), { label: title });
      element.append(...group.slice(0, 500).map(({ key, title }) => new Option(title, key)));
      return element;
    });
    this.select.replaceChildren(new Option("Plot…", ""), ...options);
    document.getElementById("plots").hidden = this.sources.size === 0;
    for (const key of [...this.plotted.keys()]) if (!this.sources.has(key)) this.remove(key);
    for (const key of this.memory.get("plots") ?? []) this.add(this.sources.get(key));
  }

  /** Keeps which plots there are, for the next run of the script. */
  remember() {
    this.memory.put("plots", [...this.plotted.keys()]);
  }

  takeAway(key) {
    this.remove(key);
    this.remember();
  }

  /** The data that the plots need from the simulation. */
  get wants() {
    const wants = { joints: [], links: [], contacts: false };
    for (const { source } of this.plotted.values()) {
      wants.joints.push(...(source.wants.joints ?? []));
      wants.links.push(...(source.wants.links ?? []));
      wants.contacts ||= !!source.wants.contacts;
    }
    return wants;
  }

  add(source) {
    if (!source || this.plotted.has(source.key)) return;
    const root = Object.assign(document.createElement("div"), { className: "chart" });
    const header = document.createElement("header");
    const buttons = document.createElement("span");
    for (const [text, title, act] of [
      ["CSV", "Save these numbers", () => this.save(source.key)],
      ["✕", "Remove", () => this.takeAway(source.key)],
    ]) {
      const button = Object.assign(document.createElement("button"), { textContent: text, title });
      button.addEventListener("click", act);
      buttons.append(button);
    }
    header.append(source.title, buttons);
    root.append(header);
    const charts = source.charts.map(({ name, traces }) => new Chart(name, traces));
    for (const chart of charts) {
      chart.changed = () => this.draw();
      root.append(chart.canvas);
    }
    this.root.append(root);
    const plot = { source, root, charts, samples: [] };
    this.plotted.set(source.key, plot);
    this.refill(plot);
    this.wantsChanged();
  }

  /** Fills a new plot with samples of the history. */
  refill(plot) {
    const readings = new Readings();
    for (const { header, payload } of this.history.frames.slice(-MOST_SAMPLES)) {
      readings.take(header, payload);
      this.sample(plot, header, payload, readings);
    }
    this.draw();
  }

  remove(key) {
    this.plotted.get(key)?.root.remove();
    this.plotted.delete(key);
    this.wantsChanged();
  }

  clear() {
    for (const plot of this.plotted.values()) plot.samples.length = 0;
    this.valueNames.clear();
  }

  /** Adds a sample of a frame to each plot. */
  take(header, payload, readings) {
    for (const name of Object.keys(header.values ?? {})) this.takeName(name);
    for (const plot of this.plotted.values()) this.sample(plot, header, payload, readings);
  }

  /** Adds a plot for a value that a script has begun to plot. */
  takeName(name) {
    if (this.valueNames.has(name)) return;
    this.valueNames.add(name);
    this.offer();
    this.add(this.sources.get(`value ${name}`));
  }

  sample({ source, root, charts, samples }, header, payload, readings) {
    const values = source.read({ readings, pose: this.poseIn(header, payload) });
    if (!values) return;
    const { time } = header;
    if (samples.length && time < samples.at(-1).time) samples.length = 0;
    if (samples.length && time === samples.at(-1).time) return;
    samples.push({ time, values });
    if (samples.length > MOST_SAMPLES) samples.splice(0, MOST_SAMPLES / 10);
    charts.forEach(({ name }, index) => (root.dataset[name.replace(/\W.*/, "")] = values[index][0]));
  }

  poseIn({ layout }, payload) {
    return (body, link) => {
      const at = layout === this.scene.layout.layout ? this.scene.poseAt(body, link) : -1;
      if (at < 0 || 4 * (at + POSE_FLOATS) > payload.byteLength) return null;
      const [x, y, z, ...orientation] = new Float32Array(payload, 4 * at, POSE_FLOATS);
      return { position: [x, y, z], orientation };
    };
  }

  draw() {
    const { player, history } = this;
    const cursor = player.live || history.count === 0 ? null : history.frames[player.index].header.time;
    for (const { charts, samples } of this.plotted.values()) {
      charts.forEach((chart, index) => chart.draw(samples, index, cursor));
    }
  }

  /** Saves a plot as a CSV table: a column for the time and one for each line. */
  save(key) {
    const { source, samples } = this.plotted.get(key);
    const columns = source.charts.flatMap(({ name, traces }) => traces.map((trace) => `${name} ${trace.name}`.trim()));
    const lines = samples.map(({ time, values }) => [time, ...values.flat()].map((value) => value ?? "").join(","));
    const quoted = ["time [s]", ...columns].map((name) => `"${name}"`).join(",");
    download(new Blob([`${[quoted, ...lines].join("\n")}\n`], { type: "text/csv" }), `${source.title}.csv`);
  }
}
