// Charts of joints, bodies, contacts, sensors and values of scripts over time.

import { Chart } from "./chart.js";
import { download } from "../time/download.js";
import { Dock } from "./dock.js";
import { headerOf } from "./table.js";
import { Readings } from "../view/readings.js";
import { Series } from "./series.js";
import { sourcesOf } from "./sources.js";
import { element } from "../elements.js";

/** @import { Source } from "./sources.js" */
/** @import { Plotted } from "./traces.js" */
/** @import { TimeWindow } from "../time/window.js" */

export class Plots {
  /**
   * @param {TimeWindow} part the part of the history that the chart below the view shows
   * @param {() => void} wantsChanged called when the plots need other data from the simulation
   * @param {() => void} changed called when the page has to be drawn again
   */
  constructor(scene, history, player, part, memory, wantsChanged, changed) {
    this.scene = scene;
    this.history = history;
    this.player = player;
    this.memory = memory;
    this.wantsChanged = wantsChanged;
    this.changed = changed;
    this.select = element("joint", HTMLSelectElement);
    this.root = document.getElementById("charts");
    /** @type {Map<string, Plotted>} */
    this.plotted = new Map();
    this.dock = new Dock(this.plotted, player, part, memory, changed);
    /** @type {Map<string, Source>} */
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
    /** @type {[string, Source][]} */
    const present = Object.values(groups).flatMap((group) => group.map((source) => [source.key, source]));
    // Of bodies that were not there at a past moment, the plots stay.
    this.sources = new Map(this.player.live ? present : [...this.sources, ...present]);
    const options = Object.entries(groups).filter(([, group]) => group.length > 0).map(([title, group]) => {
      const list = Object.assign(document.createElement("optgroup"), { label: title });
      list.append(...group.slice(0, 500).map((source) => new Option(source.title, source.key)));
      return list;
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

  /** Adds what the user has chosen elsewhere. */
  choose(key) {
    this.add(this.sources.get(key));
    this.remember();
  }

  takeAway(key) {
    this.remove(key);
    this.remember();
  }

  /** The data that the plots need from the simulation. */
  get wants() {
    const wants = { joints: [], links: [], contacts: false, sensors: [] };
    for (const { source } of this.plotted.values()) {
      wants.joints.push(...(source.wants.joints ?? []));
      wants.links.push(...(source.wants.links ?? []));
      wants.sensors.push(...(source.wants.sensors ?? []));
      wants.contacts ||= !!source.wants.contacts;
    }
    return wants;
  }

  add(source) {
    if (!source || this.plotted.has(source.key)) return;
    const root = Object.assign(document.createElement("div"), { className: "chart" });
    const header = document.createElement("header");
    const buttons = document.createElement("span");
    for (const { text, title, act } of [
      { text: "CSV", title: "Save these numbers", act: () => this.save(source.key) },
      { text: "✕", title: "Remove", act: () => this.takeAway(source.key) },
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
    const series = new Series(source, this.history, () => this.changed());
    const plot = { source, root, charts, series, get samples() { return series.samples; } };
    this.plotted.set(source.key, plot);
    tellNewest(plot);
    this.draw();
    this.wantsChanged();
  }

  remove(key) {
    this.plotted.get(key)?.root.remove();
    this.plotted.delete(key);
    this.wantsChanged();
  }

  clear() {
    for (const { series } of this.plotted.values()) series.clear();
    this.valueNames.clear();
  }

  /** Adds a sample of the newest frame to each plot. */
  take(frame) {
    if (this.plotted.size === 0) return;
    const readings = new Readings();
    readings.take(frame.header, frame.payload);
    for (const plot of this.plotted.values()) {
      plot.series.take(frame, readings);
      tellNewest(plot);
    }
  }

  /** Earlier frames have come: reads the plotted quantities there, and what values the script has plotted. */
  takeEarlier(frames) {
    for (const { header } of frames) this.takeNames(header);
    for (const { series } of this.plotted.values()) series.fillSoon();
  }

  /**
   * Adds plots for values that a script has begun to plot.
   *
   * @param {FrameToPage} header
   */
  takeNames({ values }) {
    for (const name of Object.keys(values ?? {})) this.takeName(name);
  }

  /** Adds a plot for a value that a script has begun to plot. */
  takeName(name) {
    if (this.valueNames.has(name)) return;
    this.valueNames.add(name);
    this.offer();
    this.add(this.sources.get(`value ${name}`));
  }

  draw() {
    const { player, history } = this;
    const cursor = player.live || history.count === 0 ? null : history.frames[player.index].clock;
    for (const { charts, samples } of this.plotted.values()) {
      charts.forEach((chart, index) => chart.draw(samples, index, cursor));
    }
    this.dock.draw();
  }

  /** Saves a plot as a CSV table: a column for the time and one for each line. */
  save(key) {
    const { source, samples } = this.plotted.get(key);
    const columns = source.charts.flatMap(({ name, traces }) => traces.map((trace) => `${name} ${trace.name}`.trim()));
    const lines = samples.map(({ time, values }) => [time, ...values.flat()].map((value) => value ?? "").join(","));
    download(new Blob([`${[headerOf(["time [s]", ...columns]), ...lines].join("\n")}\n`], { type: "text/csv" }), `${source.title}.csv`);
  }
}

/** Leaves the newest numbers of a plot in the page, for who reads it by programs. */
function tellNewest({ source, root, samples }) {
  const newest = samples.at(-1);
  if (newest) source.charts.forEach(({ name }, index) => (root.dataset[name.replace(/\W.*/, "")] = newest.values[index][0]));
}
