// A slider with a number field for its value, and a button that resets it to its first value.

import { shown, stepFor } from "./numbers.js";

/**
 * @param {string} id of the slider's element
 * @param {string} name
 * @param {(value: number) => void} moved called with the value that the user has set
 * @returns {{element: HTMLElement, show: (facts: {lower: number, upper: number, value: number}) => void, begin: () => void}}
 */
export function makeSlider(id, name, moved) {
  const element = Object.assign(document.createElement("div"), { className: "slider" });
  const label = Object.assign(document.createElement("label"), { textContent: name, htmlFor: id });
  const typed = Object.assign(document.createElement("input"), { type: "number", step: "any", title: `Value of ${name}`, ariaLabel: `Value of ${name}` });
  const reset = Object.assign(document.createElement("button"), { textContent: "↺", className: "reset", title: `Reset ${name}` });
  const range = Object.assign(document.createElement("input"), { type: "range", step: "any", id });
  const header = Object.assign(document.createElement("div"), { className: "line" });
  header.append(label, typed, reset);
  element.append(header, range);
  let start = null;
  let span = 1;
  let held = false;
  const read = () => {
    if (document.activeElement !== typed) typed.value = shown(Number(range.value), span);
    reset.disabled = start === null || Number(range.value) === start;
  };
  const set = (value) => {
    range.value = value;
    read();
    moved(Number(range.value));
  };
  range.addEventListener("pointerdown", () => (held = true));
  for (const kind of ["pointerup", "pointercancel"]) window.addEventListener(kind, () => (held = false));
  range.addEventListener("input", () => set(range.value));
  typed.addEventListener("change", () => typed.value !== "" && set(Number(typed.value)));
  typed.addEventListener("keydown", (event) => event.key === "Enter" && typed.blur());
  typed.addEventListener("blur", read);
  reset.addEventListener("click", () => set(start));
  const show = ({ lower, upper, value }) => {
    // While the user moves the slider, the value that the simulation sends back is out of date.
    if (held) return;
    span = upper - lower;
    typed.step = String(stepFor(span));
    [range.min, range.max, range.value] = [lower, upper, value];
    start ??= Number(range.value);
    read();
  };
  /** The next value that is shown is the first one. */
  const begin = () => (start = null);
  return { element, show, begin };
}
