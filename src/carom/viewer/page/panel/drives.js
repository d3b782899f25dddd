// Sliders that drive joints and actuators of bodies, and show what these do.

import { fixed, shown } from "./numbers.js";
import { makeSlider } from "./slider.js";
import { FromPage } from "../protocol.js";

/** @import { Readings } from "../view/readings.js" */

export const MOVABLE = /revolute|continuous|prismatic/;
/** Range of the slider of a joint without limits, to either side: revolute [rad] and prismatic [m]. */
const FULL_TURN = Math.PI;
const SLIDE = 1;
/** Ranges of the sliders for speed [rad/s, m/s] and torque [N m, N] of a joint whose file does not say how much. */
const SPEED = { prismatic: 1, other: 2 * Math.PI };
const EFFORT = 100;
/** What a slider can set, and the field of a reading that has it now. */
const MODES = ["position", "velocity", "torque"];

export class Drives {
  /**
   * @param {Readings} readings
   * @param {(message: MessageFromPage) => void} send
   * @param {string} prefix what the ids of its sliders begin with
   */
  constructor(readings, send, prefix) {
    this.readings = readings;
    this.send = send;
    this.prefix = prefix;
    /** Sliders of joints, by the numbers of body and joint. */
    this.sliders = new Map();
    /** Sliders of actuators. */
    this.controls = new Map();
  }

  clear() {
    this.sliders.clear();
    this.controls.clear();
  }

  /** Shows what joints and actuators do. */
  show() {
    for (const [key, slider] of this.sliders) this.showJoint(slider, this.readings.joints.get(key));
    for (const [key, control] of this.controls) this.showActuator(control, this.readings.actuators.get(key));
  }

  /** A slider for the control of an actuator; the script may set it again. */
  actuatorSlider(body, actuator, { name, range: [lower, upper] }) {
    const control = makeSlider(`${this.prefix}actuator-${body}-${actuator}`, name, (value) => {
      this.send({ type: FromPage.CONTROL, body, actuator, control: value });
    });
    const now = Object.assign(document.createElement("small"), { className: "now" });
    control.element.append(now);
    this.controls.set(`${body},${actuator}`, { ...control, now, lower, upper });
    return control.element;
  }

  showActuator({ now, lower, upper, show }, reading) {
    if (!reading) return;
    now.textContent = `force ${fixed(reading.force, 2)}`;
    show({ lower, upper, value: Math.min(Math.max(reading.control, lower), upper) });
  }

  jointSlider(body, joint, link) {
    const key = `${body},${joint}`;
    const control = makeSlider(`${this.prefix}joint-${body}-${joint}`, link.joint, (value) => {
      const slider = this.sliders.get(key);
      slider.byHand = value;
      back.disabled = false;
      this.send({ type: FromPage.DRIVE, body, joint, mode: slider.mode, target: value });
    });
    const sets = `What the slider of ${link.joint} sets`;
    const mode = Object.assign(document.createElement("select"), { title: sets, ariaLabel: sets });
    mode.append(...MODES.map((name) => new Option(name)));
    const back = Object.assign(document.createElement("button"), { textContent: "Give back", disabled: true });
    back.title = `Give ${link.joint} back to the script: its motor is as before it was moved here`;
    const release = () => {
      Object.assign(this.sliders.get(key), { byHand: null });
      back.disabled = true;
    };
    back.addEventListener("click", () => {
      release();
      this.send({ type: FromPage.GIVE_BACK, body, joint });
    });
    mode.addEventListener("change", () => {
      Object.assign(this.sliders.get(key), { mode: mode.value, byHand: null });
      control.begin();
      this.show();
    });
    const hand = Object.assign(document.createElement("div"), { className: "hand" });
    hand.append(mode, back);
    const now = Object.assign(document.createElement("small"), { className: "now" });
    control.element.append(hand, now);
    const reach = link.kind === "prismatic" ? SLIDE : FULL_TURN;
    const [lower, upper] = link.limits ?? [-reach, reach];
    const unit = link.kind === "prismatic" ? ["m", "m/s", "N"] : ["rad", "rad/s", "N·m"];
    const fastest = link.speed || (link.kind === "prismatic" ? SPEED.prismatic : SPEED.other);
    const strongest = link.effort || EFFORT;
    const ranges = { position: [lower, upper], velocity: [-fastest, fastest], torque: [-strongest, strongest] };
    this.sliders.set(key, { ...control, now, ranges, unit, mode: "position", byHand: null });
    return control.element;
  }

  showJoint(slider, reading) {
    if (!reading) return;
    const [length, speed, force] = slider.unit;
    const [least, most] = slider.ranges.position;
    slider.now.textContent = `${shown(reading.position, most - least)} ${length}, ${fixed(reading.velocity, 2)} ${speed}, ${fixed(reading.torque, 2)} ${force}`;
    const [lower, upper] = slider.ranges[slider.mode];
    const aim = { position: [reading.target, reading.position], velocity: [reading.targetVelocity, 0], torque: [0, 0] }[slider.mode];
    const value = slider.mode === "position" ? aim : [slider.byHand, ...aim];
    const present = value.find((each) => each !== null && !Number.isNaN(each));
    slider.show({ lower, upper, value: Math.min(Math.max(present, lower), upper) });
  }
}
