// A chart of several values over time, which can be zoomed.

import { between, sampleAt } from "./series.js";

const COLOURS = ["#1f6fb2", "#c2452d", "#3a8f4d", "#7a4fb0", "#a07a10", "#287f86"];
const TARGET = "#e08a1e";
const INK = "#5b6b7a";
const CURSOR = "#d0342c";
/** Initial and minimum time span of a chart [s]. */
const SECONDS = 10;
const MIN_SECONDS = 0.05;

export class Chart {
  /**
   * @param {string} name
   * @param {{name: string, target?: boolean}[]} traces in the order of their values in a sample
   */
  constructor(name, traces) {
    this.name = name;
    this.traces = traces;
    this.span = SECONDS;
    /** The latest moment that is shown [s]; null for that of the newest sample. */
    this.end = null;
    this.canvas = Object.assign(document.createElement("canvas"), { title: name });
    this.canvas.addEventListener("wheel", (event) => this.zoom(event), { passive: false });
    /** Where the mouse is [pixels]; null if it is elsewhere. */
    this.hovered = null;
    this.canvas.addEventListener("pointermove", (event) => {
      this.hovered = event.offsetX;
      if (event.buttons) this.pan(event.movementX);
      else this.changed();
    });
    this.canvas.addEventListener("pointerleave", () => {
      this.hovered = null;
      this.changed();
    });
    this.canvas.addEventListener("dblclick", () => this.zoomOut());
    this.latest = 0;
    this.drawnFor = "";
    this.changed = () => {};
  }

  zoom(event) {
    event.preventDefault();
    const width = this.canvas.clientWidth;
    const end = this.end ?? this.latest;
    const under = end - this.span * (1 - event.offsetX / width);
    const factor = Math.exp(Math.sign(event.deltaY) * 0.25);
    this.span = Math.max(MIN_SECONDS, this.span * factor);
    this.end = under + this.span * (1 - event.offsetX / width);
    if (this.end >= this.latest) this.end = null;
    this.changed();
  }

  pan(pixels) {
    const end = (this.end ?? this.latest) - (pixels / this.canvas.clientWidth) * this.span;
    this.end = end >= this.latest ? null : end;
    this.changed();
  }

  zoomOut() {
    [this.span, this.end] = [SECONDS, null];
    this.changed();
  }

  /**
   * @param {{clock: number, values: (number|null)[][]}[]} samples in order; see `series.js`
   * @param {number} number index of this chart's values in a sample
   * @param {?number} cursor a moment to mark by a vertical line, unless the mouse is at another [s]
   */
  draw(samples, number, cursor) {
    const { canvas } = this;
    const ratio = window.devicePixelRatio;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.font = "10px system-ui, sans-serif";
    context.fillStyle = INK;
    context.fillText(this.name, 4, 11);
    if (samples.length === 0) return;
    this.latest = samples.at(-1).clock;
    const end = this.end ?? this.latest;
    const shown = between(samples, end - this.span, end).map(({ clock, values }) => ({ clock, values: values[number] }));
    if (shown.length === 0) return;
    if (this.hovered !== null) cursor = end - this.span * (1 - this.hovered / width);
    const scale = this.scale(shown, end, width, height);
    this.traces.forEach(({ target }, index) => this.trace(context, shown, index, target, scale));
    if (cursor !== null) this.line(context, scale.x(cursor), height);
    const at = cursor === null ? shown.at(-1) : (sampleAt(shown, cursor) ?? shown[0]);
    this.read(context, at.values, width);
  }

  scale(shown, end, width, height) {
    let [low, high] = [Infinity, -Infinity];
    for (const { values } of shown) {
      for (const value of values) {
        if (value === null || !Number.isFinite(value)) continue;
        [low, high] = [Math.min(low, value), Math.max(high, value)];
      }
    }
    if (low > high) [low, high] = [0, 0];
    const margin = Math.max((high - low) * 0.1, 1e-3);
    [low, high] = [low - margin, high + margin];
    return {
      x: (clock) => width - 4 - ((end - clock) / this.span) * (width - 8),
      y: (value) => height - 4 - ((value - low) / (high - low)) * (height - 20),
    };
  }

  trace(context, shown, index, target, { x, y }) {
    context.strokeStyle = target ? TARGET : COLOURS[index % COLOURS.length];
    context.lineWidth = 1.4;
    context.setLineDash(target ? [4, 3] : []);
    context.beginPath();
    let drawing = false;
    for (const { clock, values } of shown) {
      const value = values[index];
      if (value === null || !Number.isFinite(value)) drawing = false;
      else {
        context[drawing ? "lineTo" : "moveTo"](x(clock), y(value));
        drawing = true;
      }
    }
    context.stroke();
    context.setLineDash([]);
  }

  line(context, x, height) {
    context.strokeStyle = CURSOR;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x, 14);
    context.lineTo(x, height);
    context.stroke();
  }

  read(context, values, width) {
    let right = width - 4;
    for (let index = this.traces.length - 1; index >= 0; index--) {
      const value = values[index];
      if (value === null || !Number.isFinite(value)) continue;
      const { name, target } = this.traces[index];
      const text = `${this.traces.length > 1 ? `${name} ` : ""}${value.toPrecision(4)}`;
      context.fillStyle = target ? TARGET : COLOURS[index % COLOURS.length];
      right -= context.measureText(text).width;
      if (right < 50) return;
      context.fillText(text, right, 11);
      right -= 8;
    }
  }
}
