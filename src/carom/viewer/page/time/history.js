// The last frames of a simulation, and the other messages shown with them.

import { MessageVersions, sameBytes } from "./message_versions.js";
import { KEPT_BY, REMOVAL, ToPage } from "../protocol.js";

/** Maximum memory for frames and other messages [bytes]. */
export const BUDGET_BYTES = 128 * 2 ** 20;
/** Memory of a frame besides its numbers [bytes]. */
const FRAME_BYTES = 200;
/** Step of the history's clock between frames if simulated time stands still or goes back [s]. */
const MIN_INTERVAL = 1 / 60;
/** Number of frames between two checks of the memory. */
const TIDY_EVERY = 64;

/**
 * A frame, and its time on the history's clock [s].
 *
 * @typedef {{header: FrameToPage, payload: ArrayBuffer, clock: number}} Frame
 */

export class History {
  constructor(budget = BUDGET_BYTES) {
    this.budget = budget;
    /** Called with the frames that have been put before the others. */
    this.prepended = (_frames) => {};
    this.clear();
  }

  clear() {
    this.messages = new MessageVersions();
    /** @type {Frame[]} */
    this.frames = [];
    /**
     * Number of the first frame that is kept, counted from the first frame that has arrived: it grows as frames are
     * dropped, and is below 0 when earlier ones have been put before them.
     */
    this.first = 0;
    this.bytes = 0;
    this.version = (this.version ?? 0) + 1;
  }

  get count() {
    return this.frames.length;
  }

  /** Whether there is memory for more frames. */
  get hasRoom() {
    return this.bytes + this.messages.bytes < this.budget;
  }

  /** Clock of the first and of the last kept frame: time since the first frame that has arrived [s]. */
  get start() {
    return this.frames[0]?.clock ?? 0;
  }

  get end() {
    return this.frames.at(-1)?.clock ?? 0;
  }

  /** Adds a message. */
  take(header, payload) {
    if (header.type === ToPage.FRAME) return this.takeFrame(header, payload);
    const name = nameOf(header);
    if (name === null) return;
    const moment = this.first + this.frames.length;
    if (isRemoval(header)) this.messages.remove(name, moment);
    else this.messages.put(name, { header, payload }, moment);
  }

  takeFrame(header, payload) {
    const last = this.frames.at(-1);
    if (last && last.header.time === header.time && sameBytes(last.payload, payload)) return;
    const passed = last ? header.time - last.header.time : 0;
    const clock = last ? last.clock + (passed > 0 ? passed : MIN_INTERVAL) : 0;
    this.frames.push({ header, payload, clock });
    this.bytes += payload.byteLength + FRAME_BYTES;
    if (this.frames.length % TIDY_EVERY === 0) this.tidy();
  }

  /**
   * Puts earlier frames before those that are kept.
   *
   * @param {{header: FrameToPage, payload: ArrayBuffer}[]} frames in order
   * @param {{name: string, from: number, to: number, message: object}[]} versions the messages shown with them, in
   *   order; the frames are counted as in `first`, and `to` is Infinity for what is still shown
   */
  prepend(frames, versions) {
    let next = this.frames[0];
    /** @type {Frame[]} */
    const earlier = new Array(frames.length);
    for (let i = frames.length - 1; i >= 0; i--) {
      const passed = next.header.time - frames[i].header.time;
      earlier[i] = next = { ...frames[i], clock: next.clock - (passed > 0 ? passed : MIN_INTERVAL) };
      this.bytes += next.payload.byteLength + FRAME_BYTES;
    }
    this.frames = earlier.concat(this.frames);
    this.first -= earlier.length;
    this.messages.prepend(versions);
    this.prepended(earlier);
  }

  /** Drops the oldest frames until the budget is met. */
  tidy() {
    let drop = 0;
    while (this.bytes + this.messages.bytes > this.budget && drop < this.frames.length - 1) {
      this.bytes -= this.frames[drop].payload.byteLength + FRAME_BYTES;
      drop += 1;
    }
    if (drop === 0) return;
    this.frames.splice(0, drop);
    this.first += drop;
    this.messages.forget(this.first);
  }

  /** Index of the last frame that is not later than a time on the clock [s]. */
  indexAt(clock) {
    let [low, high] = [0, this.frames.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle].clock <= clock + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** The messages shown with a frame: versions by name. */
  sceneAt(index) {
    return this.messages.at(this.first + index);
  }
}

/** The name under which a message is kept; null if the message is not kept. */
export function nameOf(header) {
  const field = KEPT_BY[header.type];
  if (field === undefined) return null;
  return field === "" ? header.type.replace(REMOVAL, "") : `${field} ${header[field]}`;
}

/** Whether a message removes what another one has shown. */
export function isRemoval(header) {
  return header.type.startsWith(REMOVAL);
}

/** The message that removes the object of a name. */
export function removalOf(name) {
  const [kind, number] = name.split(" ");
  return number === undefined ? { type: REMOVAL + kind } : { type: REMOVAL + kind, [kind]: Number(number) };
}
