// The resolution of pictures: higher while nothing moves, lower while drawing takes too long.

/** Resolution scales: drawn pixels per screen pixel, along an edge. */
const STEPS = [0.25, 0.3, 0.4, 0.5, 0.65, 0.8, 1];
/** Initial scale if the CPU renders, as an index of `STEPS`. */
const MODEST = STEPS.indexOf(0.5);
/** Slower pictures lower the resolution, faster ones raise it; the aim is 30 pictures per second [ms]. */
const SLOW_MS = 34;
/** At half the resolution and below 20 pictures per second are enough [ms]. */
const MODEST_SLOW_MS = 50;
const VERY_SLOW_MS = 70;
const FAST_MS = 20;
/** Below half the resolution these are fast enough to go back towards it [ms]. */
const MODEST_FAST_MS = 36;
/** Number of pictures whose times are averaged, without the slowest: another process may have delayed it. */
const PICTURES = 8;
/** Time without a change before drawing with all details, and before drawing at the best resolution [ms]. */
const STILL_MS = 500;
const RESTING_MS = 1500;

export class Pace {
  /** @param {boolean} byProcessor whether the CPU renders: then each pixel takes time from the simulation */
  constructor(byProcessor) {
    this.byProcessor = byProcessor;
    this.step = byProcessor ? MODEST : STEPS.length - 1;
    this.durations = [];
    this.unchanged = 0;
    this.held = null;
    /** Whether a picture is drawn that is saved, with all details. */
    this.careful = false;
    /** Whether the user wants all pixels while something moves, however long that takes. */
    this.sharp = false;
  }

  /** Keeps one resolution while `holding`, because a video cannot change its size: without a GPU the present one. */
  hold(holding) {
    this.held = holding ? (this.byProcessor && !this.sharp ? STEPS[this.step] : 1) : null;
  }

  /** Whether nothing has moved for a while, so that there is time for all details. */
  get still() {
    return this.careful || this.unchanged > STILL_MS;
  }

  /** Resolution scale of the next picture: drawn pixels per screen pixel, along an edge. */
  get sharpness() {
    if (this.held !== null) return this.held;
    if (!this.still) return this.sharp ? 1 : STEPS[this.step];
    // Without a GPU pictures have no antialiasing: a higher resolution replaces it.
    return this.byProcessor && this.unchanged > RESTING_MS ? 2 : 1;
  }

  /** Whether pictures have fewer pixels than the screen, but for those of a video, which is what it shows. */
  get coarse() {
    return this.held === null && this.sharpness < 1;
  }

  /**
   * Records the time since the last visible change [ms], before each picture.
   * A picture that is redrawn only for a higher resolution is not a change.
   */
  wait(unchanged) {
    if (this.still && unchanged <= STILL_MS) this.durations = [];
    this.unchanged = unchanged;
  }

  /** Records the time that a picture took [ms]; adapts the resolution while something moves. */
  note(duration) {
    if (this.still || this.sharp || this.held !== null) return;
    this.durations.push(duration);
    if (this.durations.length < PICTURES) return;
    const total = this.durations.reduce((sum, each) => sum + each, -Math.max(...this.durations));
    const mean = total / (PICTURES - 1);
    this.durations = [];
    const slow = this.step <= MODEST ? MODEST_SLOW_MS : SLOW_MS;
    const fast = this.step < MODEST ? MODEST_FAST_MS : FAST_MS;
    const change = mean > VERY_SLOW_MS && this.step > MODEST ? -2 : mean > slow ? -1 : mean < fast ? 1 : 0;
    this.step = Math.min(Math.max(this.step + change, 0), STEPS.length - 1);
  }
}
