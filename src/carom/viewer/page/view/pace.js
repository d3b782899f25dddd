// How fine pictures are: finer while nothing moves, coarser while they take too long.

/** Picture elements for each of the page, along an edge. */
const STEPS = [0.25, 0.3, 0.4, 0.5, 0.65, 0.8, 1];
/** Where the processor draws, the first picture has half of them. */
const MODEST = STEPS.indexOf(0.5);
/** Pictures that take longer than this become coarser; those that take less, finer: 30 a second are wanted [ms]. */
const SLOW_MS = 34;
const VERY_SLOW_MS = 70;
const FAST_MS = 20;
/** So many pictures in a row are looked at. The slowest of them does not count: something else may have run. */
const PICTURES = 8;
/** After so long without a change nothing is going on, and after so long there is time for the best picture [ms]. */
const STILL_MS = 500;
const RESTING_MS = 1500;

export class Pace {
  /** @param {boolean} byProcessor there is no graphics card: each picture element costs time that the simulation needs */
  constructor(byProcessor) {
    this.byProcessor = byProcessor;
    this.step = byProcessor ? MODEST : STEPS.length - 1;
    this.durations = [];
    this.unchanged = 0;
    this.held = null;
  }

  /** Keeps all pictures as fine as those that move are now: films cannot change their size. Or ends that. */
  hold(holding) {
    this.held = holding ? STEPS[this.step] : null;
  }

  /** Nothing has moved for a while: there is time for all details. */
  get still() {
    return this.unchanged > STILL_MS;
  }

  /** Picture elements for each of the page, along an edge, in the next picture. */
  get sharpness() {
    if (this.held !== null) return this.held;
    if (!this.still) return STEPS[this.step];
    // Pictures that the processor draws have no smoothed edges: more elements take their place.
    return this.byProcessor && this.unchanged > RESTING_MS ? 2 : 1;
  }

  /**
   * Takes note of the time since the last change of what is seen [ms], before each picture.
   * A picture that is drawn only because it can be finer now is no change.
   */
  wait(unchanged) {
    if (this.still && unchanged <= STILL_MS) this.durations = [];
    this.unchanged = unchanged;
  }

  /** Takes note of how long a picture took while something moved [ms]. */
  note(duration) {
    if (this.still || this.held !== null) return;
    this.durations.push(duration);
    if (this.durations.length < PICTURES) return;
    const total = this.durations.reduce((sum, each) => sum + each, -Math.max(...this.durations));
    const mean = total / (PICTURES - 1);
    this.durations = [];
    const change = mean > VERY_SLOW_MS ? -2 : mean > SLOW_MS ? -1 : mean < FAST_MS ? 1 : 0;
    this.step = Math.min(Math.max(this.step + change, 0), STEPS.length - 1);
  }
}
