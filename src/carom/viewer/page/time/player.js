// The player: shows the newest moment of the history, or a past one, paused or playing.

import { removalOf } from "./history.js";

/** @import { History } from "./history.js" */

const NOTHING = new ArrayBuffer(0);

export class Player {
  /**
   * @param {History} history
   * @param {(header: object, payload: ArrayBuffer) => void} show shows a message
   */
  constructor(history, show) {
    this.history = history;
    /** The part of the history that is played. */
    this.part = { range: [0, 0] };
    this.show = show;
    /** Whether the newest moment is shown, and new messages as they arrive. */
    this.live = true;
    this.running = false;
    this.speed = 1;
    this.looping = false;
    /** The shown moment, as a time on the history's clock [s]. */
    this.clock = 0;
    /** The messages that are shown, by name. */
    this.staged = new Map();
    this.changed = () => {};
  }

  clear() {
    this.live = true;
    this.running = false;
    this.staged = new Map();
    this.changed();
  }

  /** Index of the shown frame in the history. */
  get index() {
    return this.live ? this.history.count - 1 : this.history.indexAt(this.clock);
  }

  /** Shows a past moment, at a time on the history's clock [s]. */
  seek(clock) {
    if (this.history.count === 0) return;
    this.live = false;
    this.clock = Math.min(Math.max(clock, this.history.start), this.history.end);
    this.stage();
    this.changed();
  }

  /** Goes some frames forwards or back, and pauses there. */
  step(frames) {
    const { history } = this;
    if (history.count === 0) return;
    this.running = false;
    const index = Math.min(Math.max(this.index + frames, 0), history.count - 1);
    this.seek(history.frames[index].clock);
  }

  /** Plays from the shown moment on; from the beginning if the shown moment is the last one. */
  play() {
    if (this.history.count === 0) return;
    const [start, end] = this.part.range;
    const from = this.live || this.clock >= end || this.clock < start ? start : this.clock;
    this.running = true;
    this.seek(from);
  }

  pause() {
    this.running = false;
    this.changed();
  }

  /** Returns to the live simulation. */
  goLive() {
    this.running = false;
    this.live = true;
    if (this.history.count) {
      this.clock = this.history.end;
      this.stage();
    }
    this.changed();
  }

  /** Advances the playback by a time [s]; returns whether another moment is shown. */
  tick(seconds) {
    if (this.live || !this.running) return false;
    const [start, end] = this.part.range;
    let clock = this.clock + seconds * this.speed;
    if (clock > end) {
      if (!this.looping) this.running = false;
      clock = this.looping ? start : end;
    }
    this.seek(clock);
    return true;
  }

  /** Shows the messages and the frame of the shown moment. */
  stage() {
    const { history } = this;
    const index = this.index;
    // The live view includes messages that have arrived since the last frame.
    this.setScene(history.sceneAt(this.live ? history.count : index));
    const { header, payload, clock } = history.frames[index];
    const next = this.live ? undefined : history.frames[index + 1];
    const share = next ? (this.clock - clock) / (next.clock - clock) : 0;
    if (share > 1e-6 && next.header.layout === header.layout && next.header.time > header.time) {
      const time = header.time + share * (next.header.time - header.time);
      this.show({ ...header, time, past: true }, blended(payload, next.payload, share, header.poses));
    } else this.show({ ...header, past: !this.live }, payload);
  }

  setScene(versions) {
    const gone = [...this.staged.keys()].filter((name) => !versions.has(name));
    for (const name of gone.reverse()) this.show(removalOf(name), NOTHING);
    const fresh = [...versions].filter(([name, version]) => this.staged.get(name) !== version.message);
    fresh.sort(([, a], [, b]) => a.from - b.from);
    for (const [, { message }] of fresh) this.show(message.header, message.payload);
    this.staged = new Map([...versions].map(([name, { message }]) => [name, message]));
  }

  /** Records a message that is shown as it arrives; null removes it. */
  stageNow(name, message) {
    if (message === null) this.staged.delete(name);
    else this.staged.set(name, message);
  }
}

/** Payload with poses interpolated between two frames; the numbers after the poses are those of frame `a`. */
function blended(a, b, share, poses) {
  const result = new Float32Array(a.slice(0));
  const other = new Float32Array(b);
  for (let at = 0; at < poses * 7; at += 7) {
    for (let i = 0; i < 3; i++) result[at + i] += share * (other[at + i] - result[at + i]);
    let [dot, size] = [0, 0];
    for (let i = 3; i < 7; i++) dot += result[at + i] * other[at + i];
    const sign = dot < 0 ? -share : share;
    for (let i = 3; i < 7; i++) {
      result[at + i] = (1 - share) * result[at + i] + sign * other[at + i];
      size += result[at + i] ** 2;
    }
    size = Math.sqrt(size) || 1;
    for (let i = 3; i < 7; i++) result[at + i] /= size;
  }
  return result.buffer;
}
