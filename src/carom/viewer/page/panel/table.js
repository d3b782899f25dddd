// Tables of numbers as CSV.

import { firstAfter } from "./series.js";

/** @import { Trace } from "./traces.js" */

/**
 * A table of lines over time: a row for each frame in a part of the history that has a value of any.
 *
 * @param {Trace[]} traces
 * @param {[number, number]} range begin and end on the history's clock [s]
 */
export function tableOf(traces, [from, to]) {
  const rows = new Map();
  traces.forEach(({ series: { samples }, value }, column) => {
    for (const { clock, time, values } of samples.slice(firstAfter(samples, from - 1e-9), firstAfter(samples, to + 1e-9))) {
      if (!rows.has(clock)) rows.set(clock, [time, ...traces.map(() => "")]);
      rows.get(clock)[column + 1] = value(values) ?? "";
    }
  });
  const names = traces.map(({ title, unit }) => (unit ? `${title} [${unit}]` : title));
  const lines = [...rows].sort(([a], [b]) => a - b).map(([, row]) => row.join(","));
  return `${[headerOf(["time [s]", ...names]), ...lines].join("\n")}\n`;
}

/** The first line of a table. */
export function headerOf(names) {
  return names.map((name) => `"${name.replaceAll('"', '""')}"`).join(",");
}
