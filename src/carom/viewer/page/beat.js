// How often the page looks for something to draw: with each picture of the screen, seldom while nothing changes.

/** Interval while the page rests [ms]: then it still notices a window of another size, or a gamepad. */
const RESTING_MS = 100;

export class Beat {
  /**
   * @param {(now: number, rested: boolean) => boolean} look draws what has changed; told whether the page rested until
   *   now, returns whether it may rest
   */
  constructor(look) {
    this.look = look;
    /** Whether the page rests, and the timer of its next look. */
    this.resting = false;
    this.timer = null;
    /** Called when something has changed while the page rested. */
    this.awoken = () => {};
  }

  /** Looks with the next picture of the screen. */
  next() {
    requestAnimationFrame((now) => this.beat(now));
  }

  beat(now) {
    const rested = this.resting;
    this.resting = false;
    this.resting = this.look(now, rested);
    // The browser makes no picture of the screen for a timer, which saves most of what a page at rest would take.
    if (this.resting) this.timer = setTimeout(() => this.beat(performance.now()), RESTING_MS);
    else this.next();
  }

  /** Looks with the next picture of the screen, because something has changed. */
  wake() {
    if (!this.resting) return;
    this.resting = false;
    clearTimeout(this.timer);
    this.awoken();
    this.next();
  }
}
