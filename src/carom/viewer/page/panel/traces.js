// The lines of the chart below the view: those of all plotted quantities, of which the user chooses.

const COLOURS = ["#1f77b4", "#d9482b", "#2f9e44", "#8250c4", "#c28a00", "#1aa0a8", "#d6418d", "#7f6a55", "#5b7fff", "#98a11c"];

/** @import { Chart } from "./chart.js" */
/** @import { Series } from "./series.js" */
/** @import { Source } from "./sources.js" */

/**
 * A quantity that is plotted, with its charts, and the element that has them.
 *
 * @typedef {object} Plotted
 * @property {Source} source
 * @property {HTMLElement} root
 * @property {Chart[]} charts
 * @property {Series} series
 * @property {{clock: number, time: number, values: number[][]}[]} samples
 */

/**
 * A line of the chart; `value` reads its value from a sample's values.
 *
 * @typedef {object} Trace
 * @property {string} key
 * @property {string} title
 * @property {string} unit
 * @property {string} colour
 * @property {boolean} target whether it is the target of another one, and dashed
 * @property {Series} series
 * @property {(values: number[][]) => ?number} value
 * @property {boolean} shown
 */

export class Traces {
  /** @param {Map<string, Plotted>} plotted the plots by key */
  constructor(plotted) {
    this.plotted = plotted;
    /** Which lines are shown, by key; of new plots those of the first chart. */
    this.shown = new Map();
    this.colours = new Map();
  }

  /**
   * All lines.
   *
   * @returns {Trace[]}
   */
  get all() {
    return [...this.plotted.values()].flatMap(({ source, series }) =>
      source.charts.flatMap((chart, i) =>
        chart.traces.map((trace, j) => {
          const key = `${source.key} ${i} ${j}`;
          const { unit, text } = partsOf(chart);
          // A value of a script has its name only once.
          const title = [...new Set([source.title, text, trace.name])].filter(Boolean).join(" · ");
          return { key, title, unit, colour: this.colour(key), target: !!trace.target, series, value: (values) => known(values[i][j]), shown: this.shown.get(key) ?? i === 0 };
        }),
      ),
    );
  }

  colour(key) {
    if (!this.colours.has(key)) this.colours.set(key, COLOURS[this.colours.size % COLOURS.length]);
    return this.colours.get(key);
  }

  show(key, on) {
    this.shown.set(key, on);
  }
}

/**
 * The name of a chart without its unit, and the unit: `force [N]` has `N`.
 *
 * @param {{name: string, unit?: string}} chart
 */
function partsOf({ name, unit }) {
  const [, text, stated] = /^(.*?)(?: \[(.*)\])?$/.exec(name);
  return { text, unit: unit ?? stated ?? "" };
}

/** A value, null if it is not a finite number. */
function known(value) {
  return Number.isFinite(value) ? value : null;
}
