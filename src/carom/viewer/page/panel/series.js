// Numbers of a quantity in all frames of the history.

import { POSE_FLOATS } from "../view/scene.js";
import { Readings } from "../view/readings.js";

/** @import { Vector } from "../view/maths.js" */
/** @import { Source } from "./sources.js" */
/** @import { History } from "../time/history.js" */

/** Number of frames that are read at once; the page draws in between. */
const AT_ONCE = 3000;

export class Series {
  /**
   * @param {Source} source
   * @param {History} history
   * @param {() => void} changed called when earlier samples have been read
   */
  constructor(source, history, changed) {
    this.source = source;
    this.history = history;
    this.changed = changed;
    this.clear();
    this.fill();
  }

  /** Forgets all samples; those of the frames to come are taken, and those of the others filled. */
  clear() {
    /** Where the poses of each body are, by layout. */
    this.starts = new Map();
    this.samples = [];
    /** Number of the first frame that has been read. */
    this.from = this.history.first + this.history.count;
    this.filling = false;
  }

  /** Reads the frames of the history that come before those that have been read, the newest first. */
  fill() {
    const { history } = this;
    this.filling = false;
    const begin = Math.max(history.first, this.from - AT_ONCE);
    if (begin >= this.from) return;
    const frames = history.frames.slice(begin - history.first, this.from - history.first);
    const readings = new Readings();
    const earlier = frames.map((frame) => {
      readings.take(frame.header, frame.payload);
      return this.read(frame, readings);
    });
    this.samples = earlier.filter((sample) => sample !== null).concat(this.samples);
    this.from = begin;
    this.changed();
    this.fillSoon();
  }

  fillSoon() {
    if (this.filling || this.from <= this.history.first) return;
    this.filling = true;
    setTimeout(() => this.filling && this.fill());
  }

  /** Adds the sample of the newest frame. */
  take(frame, readings) {
    const { history, samples } = this;
    const sample = this.read(frame, readings);
    if (sample !== null) samples.push(sample);
    // A tenth is dropped at once.
    const kept = samples.length > 100 ? samples[Math.floor(samples.length / 10)].clock : Infinity;
    if (kept < history.start) samples.splice(0, Math.floor(samples.length / 10));
  }

  /** Numbers in a frame, null if it has none. */
  read({ header, payload, clock }, readings) {
    const values = this.source.read({ readings, pose: (body, link) => this.pose(header, payload, body, link) });
    return values === null ? null : { clock, time: header.time, values };
  }

  /** @returns {?{position: Vector, orientation: number[]}} */
  pose({ layout }, payload, body, link) {
    const start = this.startsOf(layout).get(body);
    if (start === undefined || 4 * (start + POSE_FLOATS * (link + 1)) > payload.byteLength) return null;
    const [x, y, z, ...orientation] = new Float32Array(payload, 4 * (start + POSE_FLOATS * link), POSE_FLOATS);
    return { position: [x, y, z], orientation };
  }

  /** Where the poses of each body are in the frames of a layout. */
  startsOf(layout) {
    if (!this.starts.has(layout)) {
      const known = this.history.messages.versions.get("layout")?.find(({ message }) => message.header.layout === layout);
      if (!known) return new Map();
      let at = 0;
      const starts = new Map();
      for (const [body, count] of known.message.header.bodies) {
        starts.set(body, at);
        at += count * POSE_FLOATS;
      }
      this.starts.set(layout, starts);
    }
    return this.starts.get(layout);
  }
}

/** Index of the first sample after a moment on the history's clock [s]. */
export function firstAfter(samples, clock) {
  let [low, high] = [0, samples.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (samples[middle].clock > clock) high = middle;
    else low = middle + 1;
  }
  return low;
}

/** Samples from one moment to another, and one beyond on either side, so that lines reach the edges. */
export function between(samples, from, to) {
  return samples.slice(Math.max(0, firstAfter(samples, from) - 1), firstAfter(samples, to) + 1);
}

/** The sample that is shown at a moment: the last one that is not later; null if there is none. */
export function sampleAt(samples, clock) {
  return samples[firstAfter(samples, clock + 1e-9) - 1] ?? null;
}

/** Points for a line, as pairs of moment and value: at most the lowest and the highest of each of some intervals. */
export function thinned(points, intervals) {
  if (points.length <= 4 * intervals) return points;
  const result = [];
  const each = points.length / intervals;
  for (let i = 0; i < intervals; i++) {
    const part = points.slice(Math.floor(i * each), Math.floor((i + 1) * each));
    const known = part.filter(([, value]) => value !== null);
    if (known.length < part.length) result.push(part.find(([, value]) => value === null));
    if (known.length === 0) continue;
    const low = known.reduce((a, b) => (b[1] < a[1] ? b : a));
    const high = known.reduce((a, b) => (b[1] > a[1] ? b : a));
    result.push(...(low[0] <= high[0] ? [low, high] : [high, low]));
  }
  return result;
}
