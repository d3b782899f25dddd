// The list of bodies, and the data of the selected body, with sliders that drive its joints and actuators.

import { fixed, shown } from "./numbers.js";
import { makeSlider } from "./slider.js";
import { press } from "./states.js";
import { titlesOf } from "../view/names.js";
import { FromPage } from "../protocol.js";
import { isSpectator } from "../spectating.js";

/** @import { Readings } from "../view/readings.js" */
/** @import { Scene } from "../view/scene.js" */

const MOVABLE = /revolute|continuous|prismatic/;
/** Range of the slider of a joint without limits, to either side: revolute [rad] and prismatic [m]. */
const FULL_TURN = Math.PI;
const SLIDE = 1;
/** Ranges of the sliders for speed [rad/s, m/s] and torque [N m, N] of a joint whose file does not say how much. */
const SPEED = { prismatic: 1, other: 2 * Math.PI };
const EFFORT = 100;
/** What a slider can set, and the field of a reading that has it now. */
const MODES = ["position", "velocity", "torque"];

export class Bodies {
  /**
   * @param {Scene} scene
   * @param {Readings} readings
   * @param {(message: MessageFromPage) => void} send
   */
  constructor(scene, readings, send) {
    this.scene = scene;
    this.readings = readings;
    this.send = send;
    this.list = document.getElementById("bodies-list");
    this.card = document.getElementById("body-card");
    this.selected = null;
    this.link = null;
    this.sliders = new Map();
    /** Sliders of actuators. */
    this.controls = new Map();
    this.known = "";
    /** Called with body and link (or null) when the selection changes. */
    this.selectionChanged = (_body, _link) => {};
    /** Returns the call that brings the camera back. */
    this.cameraCall = () => "";
    /** Called when a body has been hidden or shown. */
    this.changed = () => {};
  }

  /** Updates the list of bodies. */
  offer() {
    const bodies = [...this.scene.bodies.values()];
    const known = JSON.stringify(bodies.map(({ body, name, links, path }) => [body, name, links.length, path]));
    if (known === this.known) return;
    this.known = known;
    const titles = titlesOf(this.scene);
    document.getElementById("bodies-count").textContent = String(bodies.length);
    this.list.replaceChildren(
      ...bodies.slice(0, MAX_LISTED).map(({ body, name }) => {
        const text = `${body}  ${titles.get(body)}`;
        const button = Object.assign(document.createElement("button"), { textContent: text, title: text });
        button.dataset.body = body;
        button.addEventListener("click", () => this.select(body === this.selected ? null : body));
        const row = document.createElement("div");
        row.append(button, this.eye(body, name));
        return row;
      }),
    );
    if (this.selected !== null && !this.scene.bodies.has(this.selected)) this.select(null);
    else this.mark();
  }

  /** The checkbox that shows or hides a body. */
  eye(body, name) {
    const shows = `Show ${name} (body ${body})`;
    const eye = Object.assign(document.createElement("input"), { type: "checkbox", title: shows, ariaLabel: shows });
    eye.checked = !this.scene.hidden.has(body);
    eye.addEventListener("change", () => {
      this.scene.setHidden(body, !eye.checked);
      this.changed();
    });
    return eye;
  }

  mark() {
    for (const button of this.list.querySelectorAll("button")) press(button, Number(button.dataset.body) === this.selected);
  }

  select(body, link = null) {
    this.selected = body;
    this.link = link;
    this.mark();
    this.build();
    this.selectionChanged(body, link);
  }

  build() {
    this.sliders.clear();
    this.controls.clear();
    this.card.replaceChildren();
    const body = this.scene.bodies.get(this.selected);
    this.card.hidden = !body;
    if (!body) return;
    const title = Object.assign(document.createElement("h2"), { textContent: `${body.name} (body ${body.body})` });
    this.facts = document.createElement("dl");
    const copy = Object.assign(document.createElement("button"), { textContent: "Copy as Python", className: "copy" });
    copy.title = "Copy the pose, the joint positions, what was set by hand and the camera as calls that bring them back";
    copy.addEventListener("click", () => this.copy());
    this.card.append(title, this.facts, copy);
    body.links.forEach((link, index) => {
      if (MOVABLE.test(link.kind ?? "")) this.card.append(this.jointSlider(body.body, index - 1, link));
    });
    (body.actuators ?? []).forEach((actuator, index) => this.card.append(this.actuatorSlider(body.body, index, actuator)));
    // They show what the joints do.
    if (isSpectator()) for (const slider of this.card.querySelectorAll(".slider")) slider.toggleAttribute("inert", true);
    this.show();
  }

  /** A slider for the control of an actuator; the script may set it again. */
  actuatorSlider(body, actuator, { name, range: [lower, upper] }) {
    const control = makeSlider(`actuator-${body}-${actuator}`, name, (value) => {
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
    const control = makeSlider(`joint-${body}-${joint}`, link.joint, (value) => {
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

  /** Updates the numbers of the selected body. */
  show() {
    const body = this.scene.bodies.get(this.selected);
    if (!body) return;
    const index = this.link ?? 0;
    const pose = this.scene.linkPose(body.body, index);
    const dynamics = this.scene.dynamics.get(body.body)?.links;
    const facts = [["link", body.links[index].name]];
    if (dynamics) {
      const total = dynamics.reduce((sum, { mass }) => sum + mass, 0);
      facts.push(["mass", `${dynamics[index].mass.toPrecision(4)} kg of ${total.toPrecision(4)} kg`]);
    }
    if (pose) {
      facts.push(["position", numbers(pose.position, 4)]);
      facts.push(["orientation", numbers(pose.orientation, 4)]);
      facts.push(["roll pitch yaw", `${numbers(eulerDegrees(pose.orientation), 1)} °`]);
    }
    const reading = this.readings.links.get(`${body.body},${index - 1}`);
    if (reading) {
      facts.push(["velocity", `${numbers(reading.velocity, 3)} m/s`]);
      facts.push(["turning", `${numbers(reading.rate, 3)} rad/s`]);
    }
    const text = facts.flat().join("\n");
    if (text !== this.shown) {
      this.shown = text;
      this.facts.replaceChildren(
        ...facts.flatMap(([name, value]) => [
          Object.assign(document.createElement("dt"), { textContent: name }),
          Object.assign(document.createElement("dd"), { textContent: value }),
        ]),
      );
    }
    for (const [key, slider] of this.sliders) this.showJoint(slider, this.readings.joints.get(key));
    for (const [key, control] of this.controls) this.showActuator(control, this.readings.actuators.get(key));
  }

  /** Copies the state of the selected body, the drives that were set by hand and the camera as calls that restore them. */
  copy() {
    const body = this.selected;
    const pose = this.scene.inertialPose(body, 0);
    if (!pose) return;
    const list = (values) => `[${values.map((value) => Number(value.toFixed(6))).join(", ")}]`;
    const calls = [`p.resetBasePositionAndOrientation(${body}, ${list(pose.position)}, ${list(pose.orientation)})`];
    for (const [key, { position, velocity }] of this.readings.joints) {
      const [owner, joint] = key.split(",").map(Number);
      if (owner !== body || !this.sliders.has(key)) continue;
      calls.push(`p.resetJointState(${body}, ${joint}, ${Number(position.toFixed(6))}, ${Number(velocity.toFixed(6))})`);
    }
    for (const [key, { mode, byHand }] of this.sliders) {
      if (byHand === null) continue;
      const joint = Number(key.split(",")[1]);
      calls.push(driveCall(body, joint, mode, byHand, this.scene.bodies.get(body).links[joint + 1].effort || DRIVE_FORCE));
    }
    calls.push(this.cameraCall());
    navigator.clipboard?.writeText(calls.join("\n")).catch(() => {});
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

/** Maximum force of a drive that was set by hand, if the file has no effort limit; and its other numbers, as in `drives.py`. */
const DRIVE_FORCE = 500;
const [GAIN, VELOCITY_GAIN, FASTEST, OUT_OF_REACH] = [0.1, 1, 2, 1e6];

/** The call that drives a joint as its slider does. */
function driveCall(body, joint, mode, value, force) {
  const call = (kind, aims) => `p.setJointMotorControl2(${[body, joint, `p.${kind}`, ...aims].join(", ")})`;
  if (mode === "position") {
    const gains = `positionGain=${GAIN}, velocityGain=${VELOCITY_GAIN}, maxVelocity=${FASTEST}`;
    return call("POSITION_CONTROL", [`targetPosition=${value}`, `force=${force}`, gains]);
  }
  const gain = `velocityGain=${VELOCITY_GAIN}`;
  if (mode === "velocity") return call("VELOCITY_CONTROL", [`targetVelocity=${value}`, `force=${force}`, gain]);
  return call("VELOCITY_CONTROL", [`targetVelocity=${Math.sign(value) * OUT_OF_REACH}`, `force=${Math.abs(value)}`, gain]);
}

/** Maximum number of bodies in the list. */
const MAX_LISTED = 500;

function numbers(values, digits) {
  return values.map((value) => fixed(value, digits)).join("  ");
}

/** @param {number[]} quaternion */
function eulerDegrees([x, y, z, w]) {
  const roll = Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
  const pitch = Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x))));
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  return [roll, pitch, yaw].map((angle) => (angle * 180) / Math.PI);
}
