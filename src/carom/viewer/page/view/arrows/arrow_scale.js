// The scale of arrows: force or torque for each metre, so that the largest one now is long enough to be seen.

/** Longest arrow, as a share of the camera's distance. */
const LONGEST = 0.3;
/** How long a smaller scale has to do before it is taken [s of simulated time]: impacts are short. */
const CALM = 0.5;

export class ArrowScale {
  constructor() {
    this.clear();
  }

  clear() {
    /** Force or torque for each metre; 0 until there is one. */
    this.perMetre = 0;
    this.since = null;
  }

  /**
   * Fits the scale to the largest amount of a picture.
   *
   * @param {number} largest force or torque [N or N m]
   * @param {number} distance of the camera from its target [m]
   * @param {number} time simulated time [s]
   */
  fit(largest, distance, time) {
    const wanted = niceScale(largest / (LONGEST * distance));
    if (wanted === 0) return;
    if (wanted >= this.perMetre) [this.perMetre, this.since] = [wanted, null];
    else if (this.since === null) this.since = time;
    // Time also goes back, when the past is looked at.
    else if (Math.abs(time - this.since) > CALM) [this.perMetre, this.since] = [wanted, null];
  }
}

/** The smallest of 1, 2, 5, 10, 20... that is not less than an amount; 0 for none. */
export function niceScale(amount) {
  if (!(amount > 0) || !Number.isFinite(amount)) return 0;
  const power = 10 ** Math.floor(Math.log10(amount));
  return Number((power * ([1, 2, 5].find((step) => step * power >= amount * (1 - 1e-9)) ?? 10)).toPrecision(6));
}
