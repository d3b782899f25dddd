// The pane below the view: all plotted quantities in one chart, over the whole past or a part of it.

import { download } from "../time/download.js";
import { tableOf } from "./table.js";
import { OverlayChart } from "./overlay_chart.js";
import { sampleAt } from "./series.js";
import { unfold } from "./states.js";
import { Traces } from "./traces.js";
import { element } from "../elements.js";

/** @import { Plotted } from "./traces.js" */
/** @import { Memory } from "../memory.js" */
/** @import { Player } from "../time/player.js" */
/** @import { TimeWindow } from "../time/window.js" */

const MIN_HEIGHT = 110;
/** Height of the view that is left at least [pixels]. */
const MIN_VIEW = 120;
/** A pointer that moves less than this is a click [pixels]. */
const STILL = 4;
/** Zoom by one notch of the wheel. */
const NOTCH = 1.25;

export class Dock {
  /**
   * @param {Map<string, Plotted>} plotted the plots by key
   * @param {Player} player
   * @param {TimeWindow} part the part of the history that is shown
   * @param {Memory} memory
   * @param {() => void} changed called when the page has to be drawn again
   */
  constructor(plotted, player, part, memory, changed) {
    this.player = player;
    this.part = part;
    this.memory = memory;
    this.changed = changed;
    this.traces = new Traces(plotted);
    this.root = document.getElementById("dock");
    this.legend = document.getElementById("dock-legend");
    this.canvas = element("dock-chart", HTMLCanvasElement);
    this.button = document.getElementById("dock-open");
    this.chart = new OverlayChart(this.canvas);
    this.hovered = null;
    this.height = 240;
    this.bind();
  }

  bind() {
    const click = (id, act) => document.getElementById(id).addEventListener("click", act);
    click("dock-open", () => this.open(!this.isOpen));
    click("dock-close", () => this.open(false));
    click("dock-all", () => this.part.clear());
    click("dock-save", () => this.save());
    const edge = document.getElementById("dock-edge");
    edge.addEventListener("pointerdown", (event) => edge.setPointerCapture(event.pointerId));
    edge.addEventListener("pointermove", (event) => {
      if (edge.hasPointerCapture(event.pointerId)) this.resize(this.root.getBoundingClientRect().bottom - event.clientY);
    });
    edge.addEventListener("pointerup", () => this.remember());
    // Enlarges the pane, and puts it back.
    edge.addEventListener("dblclick", () => this.resize(this.height < this.most ? this.most : 240));
    this.bindChart();
    window.addEventListener("resize", () => this.isOpen && this.resize(this.height));
  }

  bindChart() {
    const { canvas, chart, part } = this;
    let pressed = null;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      part.zoom(chart.clockAt(event.offsetX), event.deltaY < 0 ? 1 / NOTCH : NOTCH);
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pressed = { x: event.offsetX, moved: 0 };
    });
    canvas.addEventListener("pointermove", (event) => {
      this.hovered = event.offsetX;
      if (pressed && event.buttons) {
        pressed.moved += Math.abs(event.movementX);
        if (pressed.moved >= STILL) part.pan(chart.clockAt(0) - chart.clockAt(event.movementX));
      }
      this.changed();
    });
    canvas.addEventListener("pointerup", (event) => {
      if (pressed && pressed.moved < STILL) {
        this.player.running = false;
        this.player.seek(chart.clockAt(event.offsetX));
      }
      pressed = null;
    });
    canvas.addEventListener("pointerleave", () => {
      this.hovered = null;
      this.changed();
    });
    canvas.addEventListener("dblclick", () => part.clear());
  }

  get isOpen() {
    return !this.root.hidden;
  }

  /** The greatest height of the pane [pixels]. */
  get most() {
    return Math.max(MIN_HEIGHT, window.innerHeight - MIN_VIEW - 60);
  }

  open(open) {
    this.root.hidden = !open;
    document.body.classList.toggle("docked", open);
    unfold(this.button, open);
    if (!open) this.part.clear();
    this.resize(this.height);
    this.remember();
  }

  resize(height) {
    this.height = Math.min(Math.max(height, MIN_HEIGHT), this.most);
    document.documentElement.style.setProperty("--dock", this.isOpen ? `${this.height}px` : "0px");
    this.changed();
  }

  remember() {
    this.memory.put("dock", { open: this.isOpen, height: this.height });
  }

  /** Shows the pane as the browser has kept it for the script. */
  recall() {
    const kept = this.memory.get("dock");
    if (!kept) return;
    this.height = kept.height;
    this.open(kept.open);
  }

  /** Updates the chart and its legend. */
  draw() {
    if (!this.isOpen) return;
    const { player, part, chart } = this;
    const { history } = player;
    if (history.count === 0) return;
    const traces = this.traces.all;
    const hovered = this.hovered === null ? null : chart.clockAt(this.hovered);
    const shown = player.live ? null : player.clock;
    const timeAt = (clock) => {
      const { header, clock: at } = history.frames[history.indexAt(clock)];
      return header.time + clock - at;
    };
    chart.draw(traces.filter((trace) => trace.shown), part.range, { shown, hovered }, timeAt);
    const at = hovered ?? shown ?? history.end;
    document.getElementById("dock-time").textContent = `${timeAt(at).toFixed(3)} s`;
    element("dock-all", HTMLButtonElement).disabled = part.zoomed === null;
    this.fillLegend(traces, at);
  }

  fillLegend(traces, at) {
    const names = traces.map(({ key }) => key).join("\n");
    if (names !== this.legend.dataset.names) {
      this.legend.dataset.names = names;
      this.legend.replaceChildren(...traces.map((trace) => this.entry(trace)));
    }
    traces.forEach((trace, i) => {
      const value = trace.shown ? sampleAt(trace.series.samples, at) : null;
      const number = value === null ? null : trace.value(value.values);
      this.legend.children[i].querySelector("output").textContent = number === null ? "" : `${number.toPrecision(4)} ${trace.unit}`;
    });
  }

  entry({ key, title, unit, colour, shown }) {
    const label = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: shown });
    box.addEventListener("change", () => {
      this.traces.show(key, box.checked);
      this.changed();
    });
    const line = document.createElement("i");
    line.style.background = colour;
    const text = Object.assign(document.createElement("span"), { textContent: title, title: unit ? `${title} [${unit}]` : title });
    label.append(box, line, text, document.createElement("output"));
    return label;
  }

  /** Saves what the chart shows as a CSV table. */
  save() {
    const shown = this.traces.all.filter((trace) => trace.shown);
    download(new Blob([tableOf(shown, this.part.range)], { type: "text/csv" }), `${document.title} plots.csv`);
  }
}
