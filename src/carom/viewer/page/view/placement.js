// Where texts go: near their points, clear of each other and of what covers the view.

/** A text is moved up or down by at most so many times its height. */
const MAX_STEPS = 5;
const GAP = 1;

export class Placement {
  /**
   * @param {number} width width of the view [pixels]
   * @param {number} height
   * @param {{left: number, top: number, right: number, bottom: number}[]} covers rectangles that texts keep clear of
   */
  constructor(width, height, covers) {
    this.width = width;
    this.height = height;
    this.covers = covers;
    this.taken = [];
  }

  /**
   * Finds a place for a text, and takes it.
   *
   * @param {number[]} pixel the point of the text
   * @param {number[]} offset wanted offset of its upper left corner from there
   * @param {number[]} size its width and height
   * @returns {?number[]} its upper left corner; null if the point is out of view or covered, or if all is taken nearby
   */
  place([x, y], [right, down], [width, height]) {
    if (x < 0 || y < 0 || x > this.width || y > this.height) return null;
    if (this.covers.some((cover) => x > cover.left && x < cover.right && y > cover.top && y < cover.bottom)) return null;
    const wanted = this.clear([x + right, y + down], width, height);
    for (const left of [wanted, x - right - width]) {
      for (let step = 0; step <= 2 * MAX_STEPS; step++) {
        // Below, above, further below, and so on.
        const shift = Math.ceil(step / 2) * (step % 2 ? 1 : -1) * (height + GAP);
        const corner = [left, y + down + shift];
        const box = { left, top: corner[1], right: left + width, bottom: corner[1] + height };
        if (this.covers.some((cover) => meets(cover, box)) || this.taken.some((other) => meets(other, box))) continue;
        this.taken.push(box);
        return corner;
      }
    }
    return null;
  }

  /** The left edge of a text, moved to the left if it would run under something or out of the view. */
  clear([left, top], width, height) {
    const box = { left, top, right: left + width, bottom: top + height };
    const ends = this.covers.filter((cover) => cover.left > left - width && meets(cover, box)).map((cover) => cover.left);
    return Math.max(0, Math.min(left, Math.min(this.width, ...ends) - width - GAP));
  }
}

function meets(a, b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}
