// The panel: time and speed, and the sliders and buttons of the script.

import { fixed } from "./numbers.js";
import { makeSlider } from "./slider.js";
import { unfold } from "./states.js";
import { FromPage } from "../protocol.js";
import { element } from "../elements.js";
import { choice } from "./notices.js";
import { isSpectator, watchingAddress } from "../spectating.js";

/** @import { Notices } from "./notices.js" */
/** @import { Options } from "./options.js" */

export class Panel {
  /**
   * @param {(message: MessageFromPage) => void} send
   * @param {Options} options
   * @param {Notices} notices
   * @param {import("../layout/own.js").OwnPanels} own puts controls into panels of the script
   */
  constructor(send, options, notices, own) {
    this.send = send;
    this.own = own;
    this.notices = notices;
    this.options = options;
    this.root = document.getElementById("panel");
    this.sliders = document.getElementById("sliders");
    this.controls = new Map();
    document.getElementById("close").addEventListener("click", () => this.askToClose());
    document.getElementById("share").addEventListener("click", () => this.share());
    /** Token of spectators. */
    this.watch = null;
    // They show what the script is told by others.
    this.sliders.toggleAttribute("inert", isSpectator());
    document.getElementById("fold").addEventListener("click", () => this.fold(!this.folded));
    this.pause = document.getElementById("pause");
    this.step = element("step", HTMLButtonElement);
    this.speed = element("speed", HTMLSelectElement);
    this.paused = false;
    /** What the button says that ends a pause. */
    this.word = "Continue";
    this.pause.addEventListener("click", () => this.togglePause());
    this.step.addEventListener("click", () => send({ type: FromPage.STEP }));
    document.getElementById("reset").addEventListener("click", () => send({ type: FromPage.RESET }));
    this.speed.addEventListener("change", () => {
      send({ type: FromPage.SPEED, speed: this.speed.value === "" ? null : Number(this.speed.value) });
    });
    this.fold(window.innerWidth < 420);
    this.showOptions();
  }

  /** Collapses the panel to its title, or expands it. */
  fold(folded) {
    this.folded = folded;
    this.root.classList.toggle("folded", folded);
    const button = document.getElementById("fold");
    button.textContent = folded ? "▾" : "▴";
    button.title = folded ? "Expand the panel" : "Collapse the panel";
    unfold(button, !folded);
  }

  /** Asks before the script is ended: the cross is close to the fold arrow. */
  askToClose() {
    this.notices.ask("End the script?", "End it", "Let it run", () => this.send({ type: FromPage.CLOSE }));
  }

  /** Pauses or continues. It is shown at once, so that a second press before the answer undoes the first. */
  togglePause() {
    const paused = !this.paused;
    this.send({ type: FromPage.PAUSE, paused });
    this.showPause({ paused });
  }

  showOptions() {
    this.root.hidden = !this.options.panel;
    document.getElementById("timeline").hidden = !this.options.panel;
  }

  /** Sets what the button says that ends a pause. */
  goes(word) {
    this.word = word;
    this.showPause({ paused: this.paused });
  }

  showPause({ paused }) {
    this.paused = paused;
    this.pause.textContent = paused ? this.word : "Pause";
    this.step.disabled = !paused;
  }

  showSpeed({ speed }) {
    this.speed.value = speed === null ? "" : String(speed);
  }

  showTime({ time, rate }) {
    document.getElementById("clock").textContent = fixed(time, 3);
    if (rate !== undefined) document.getElementById("rate").textContent = fixed(rate, 2);
  }

  showFps(fps) {
    document.getElementById("fps").textContent = fps.toFixed(0);
  }

  /** Tells the link for spectators, and copies it where the browser lets the page do so. */
  async share() {
    const link = watchingAddress(this.watch);
    try {
      await navigator.clipboard.writeText(link);
      this.notices.say(`Copied the link for spectators, who see everything and change nothing: ${link}`);
    } catch {
      this.notices.say(`The link for spectators, who see everything and change nothing: ${link}`, true, [choice("Done", () => this.notices.say(null))]);
    }
  }

  /** Shows the name of the run; a replay has no spectators. */
  showTitle({ title, watch = null }) {
    this.watch = watch;
    document.title = title;
    document.getElementById("title").textContent = title;
  }

  addSlider(message) {
    const known = this.controls.get(message.slider);
    if (known) return known.show(message);
    const control = this.makeControl(message);
    this.own.insert(message.slider, message.panel, control.element);
    this.controls.set(message.slider, control);
  }

  removeSlider({ slider }) {
    this.controls.get(slider)?.element.remove();
    this.controls.delete(slider);
  }

  clear() {
    for (const slider of [...this.controls.keys()]) this.removeSlider({ slider });
  }

  makeControl(message) {
    if (message.button) return this.makeButton(message);
    if (message.options) return message.options.length ? this.makeChoice(message) : this.makeBox(message);
    return this.makeSlider(message);
  }

  makeChoice(message) {
    const select = document.createElement("select");
    select.append(...message.options.map((text, number) => new Option(text, number)));
    select.addEventListener("change", () => this.send({ type: FromPage.SLIDER, slider: message.slider, value: Number(select.value) }));
    return this.labelled("row pair", select, message, ({ value }) => (select.value = value));
  }

  makeBox(message) {
    const box = Object.assign(document.createElement("input"), { type: "checkbox" });
    box.addEventListener("change", () => this.send({ type: FromPage.SLIDER, slider: message.slider, value: Number(box.checked) }));
    return this.labelled("check", box, message, ({ value }) => (box.checked = value !== 0));
  }

  /** A control with its name. */
  labelled(className, control, message, show) {
    const label = Object.assign(document.createElement("label"), { className });
    label.append(...(className === "check" ? [control, message.name] : [message.name, control]));
    const root = Object.assign(document.createElement("div"), { className: "slider" });
    root.append(label);
    show(message);
    return { element: root, show };
  }

  makeButton({ slider, name }) {
    const root = Object.assign(document.createElement("div"), { className: "slider" });
    const button = Object.assign(document.createElement("button"), { textContent: name });
    button.addEventListener("click", () => this.send({ type: FromPage.PRESS, slider }));
    root.append(button);
    return { element: root, show() {} };
  }

  makeSlider(message) {
    const control = makeSlider(`slider-${message.slider}`, message.name, (value) => {
      this.send({ type: FromPage.SLIDER, slider: message.slider, value });
    });
    control.show(message);
    return control;
  }
}
