// A large chart of many lines over time, with an axis for each of two units.

import { between, thinned } from "./series.js";

const TOP = 8;
const BOTTOM = 20;
/** Width of an axis with its numbers [pixels]. */
const AXIS = 56;
const SHOWN = "#d0342c";

/** @import { Trace } from "./traces.js" */

export class OverlayChart {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.range = [0, 1];
  }

  /** Left and right edge of the lines [pixels]. */
  get edges() {
    return [AXIS, this.canvas.clientWidth - AXIS];
  }

  /** The moment at a distance from the left edge of the canvas [pixels]. */
  clockAt(x) {
    const [left, right] = this.edges;
    const [from, to] = this.range;
    return from + ((x - left) / Math.max(right - left, 1)) * (to - from);
  }

  /**
   * @param {Trace[]} traces the lines that are shown; see `traces.js`
   * @param {[number, number]} range the moments at the left and the right edge [s]
   * @param {{shown: ?number, hovered: ?number}} moments moments that are marked by a vertical line
   * @param {(clock: number) => number} timeAt the simulated time at a moment
   */
  draw(traces, range, { shown, hovered }, timeAt) {
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0 || height === 0) return;
    this.range = range;
    const ratio = window.devicePixelRatio;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.font = "11px system-ui, sans-serif";
    const style = getComputedStyle(canvas);
    const [ink, grid] = [style.color, style.borderColor];
    const [left, right] = this.edges;
    const x = (clock) => left + ((clock - range[0]) / Math.max(range[1] - range[0], 1e-9)) * (right - left);
    this.times(context, x, height, ink, grid, timeAt);
    const lines = traces.map((trace) => ({ trace, points: pointsOf(trace, range, right - left) }));
    const units = [...new Set(traces.map(({ unit }) => unit))];
    units.forEach((unit, index) => {
      const own = lines.filter(({ trace }) => trace.unit === unit);
      const [low, high] = extent(own.map(({ points }) => points));
      const y = (value) => height - BOTTOM - ((value - low) / (high - low)) * (height - TOP - BOTTOM);
      if (index < 2) this.axis(context, { unit, low, high, y, atRight: index === 1, grid: index === 0 ? grid : null, ink });
      context.save();
      context.beginPath();
      context.rect(left, 0, right - left, height);
      context.clip();
      for (const { trace, points } of own) line(context, trace, points, x, y);
      context.restore();
    });
    for (const [clock, colour] of [[shown, SHOWN], [hovered, ink]]) {
      if (clock === null || x(clock) < left - 0.5 || x(clock) > right + 0.5) continue;
      stroke(context, colour, [[x(clock), TOP], [x(clock), height - BOTTOM]]);
    }
  }

  times(context, x, height, ink, grid, timeAt) {
    const [from, to] = this.range;
    // Round times, which are not round on the history's clock.
    const ahead = timeAt(to) - to;
    context.textAlign = "center";
    for (const time of ticks(from + ahead, to + ahead, 8)) {
      const clock = time - ahead;
      stroke(context, grid, [[x(clock), TOP], [x(clock), height - BOTTOM]]);
      context.fillStyle = ink;
      context.fillText(`${Number(timeAt(clock).toFixed(4))} s`, x(clock), height - 6);
    }
  }

  axis(context, { unit, low, high, y, atRight, grid, ink }) {
    const [left, right] = this.edges;
    context.fillStyle = ink;
    context.textAlign = atRight ? "left" : "right";
    const at = atRight ? right + 6 : left - 6;
    for (const value of ticks(low, high, 4)) {
      if (grid) stroke(context, grid, [[left, y(value)], [right, y(value)]]);
      context.fillText(short(value), at, y(value) + 4);
    }
    context.textAlign = atRight ? "right" : "left";
    context.fillText(unit, atRight ? right - 4 : left + 4, TOP + 8);
  }
}

function pointsOf({ series, value }, [from, to], width) {
  const points = between(series.samples, from, to).map(({ clock, values }) => [clock, value(values)]);
  return thinned(points, Math.max(50, Math.round(width)));
}

/** Lowest and highest value of some lines, with a margin. */
function extent(lines) {
  let [low, high] = [Infinity, -Infinity];
  for (const points of lines) {
    for (const [, value] of points) {
      if (value === null) continue;
      [low, high] = [Math.min(low, value), Math.max(high, value)];
    }
  }
  if (low > high) return [0, 1];
  const margin = Math.max(0.06 * (high - low), 1e-3 * Math.max(Math.abs(high), 1e-3));
  return [low - margin, high + margin];
}

function line(context, { colour, target }, points, x, y) {
  context.strokeStyle = colour;
  context.lineWidth = 1.6;
  context.setLineDash(target ? [5, 4] : []);
  context.beginPath();
  let drawing = false;
  for (const [clock, value] of points) {
    if (value !== null) context[drawing ? "lineTo" : "moveTo"](x(clock), y(value));
    drawing = value !== null;
  }
  context.stroke();
  context.setLineDash([]);
}

function stroke(context, colour, [[x, y], [toX, toY]]) {
  context.strokeStyle = colour;
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(toX, toY);
  context.stroke();
}

/** Round numbers in a range, so many or fewer. */
function ticks(from, to, most) {
  const rough = Math.max((to - from) / most, 1e-9);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((times) => times * power).find((each) => each >= rough);
  const result = [];
  for (let i = Math.ceil(from / step); i * step <= to; i++) result.push(i * step);
  return result;
}

function short(value) {
  return String(Number(value.toFixed(6)) && Number(value.toPrecision(4)));
}
