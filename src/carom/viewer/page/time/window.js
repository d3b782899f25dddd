// The part of the history that charts and the time bar show: all of it, or what the user has zoomed into.

/** @import { History } from "./history.js" */

/** Least length of the part [s]. */
const MIN_SECONDS = 0.02;

export class TimeWindow {
  /** @param {History} history */
  constructor(history) {
    this.history = history;
    /** Length of the part, and its end on the history's clock [s]; the end is null while it moves on with the newest frame. */
    this.zoomed = null;
    this.changed = () => {};
  }

  /**
   * Begin and end of the part on the history's clock [s].
   *
   * @returns {[number, number]}
   */
  get range() {
    const { start, end } = this.history;
    if (this.zoomed === null) return [start, end];
    const to = this.zoomed.end ?? end;
    return [Math.max(start, to - this.zoomed.span), Math.min(end, to)];
  }

  /** Makes the part longer by a factor, around a moment that stays where it is. */
  zoom(clock, factor) {
    const [from, to] = this.range;
    const span = Math.max(MIN_SECONDS, (to - from) * factor);
    const share = to > from ? (to - clock) / (to - from) : 0;
    this.show(clock + share * span - span, clock + share * span);
  }

  /** Moves the part by a time [s]. */
  pan(seconds) {
    if (this.zoomed === null) return;
    const { start, end } = this.history;
    const [from, to] = this.range;
    const by = Math.min(Math.max(seconds, start - from), end - to);
    this.show(from + by, to + by);
  }

  /** Shows what is between two moments. */
  show(from, to) {
    const { start, end } = this.history;
    if (from <= start && to >= end) this.zoomed = null;
    else this.zoomed = { span: Math.min(to, end) - Math.max(from, start), end: to >= end ? null : to };
    this.changed();
  }

  /** Shows everything again. */
  clear() {
    this.zoomed = null;
    this.changed();
  }
}
