// The list of bodies, and the data of the selected body, with sliders that drive its joints and actuators.

import { Drives, MOVABLE } from "./drives.js";
import { fixed } from "./numbers.js";
import { press } from "./states.js";
import { Tree } from "../simulation/tree.js";
import { titlesOf } from "../view/names.js";
import { isSpectator } from "../spectating.js";

/** @import { Readings } from "../view/readings.js" */
/** @import { Scene } from "../view/scene.js" */

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
    this.drives = new Drives(readings, send, "");
    this.tree = new Tree(scene, (chosen, link) => this.select(chosen, link));
    this.tree.changed = () => this.offer();
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
    const bodies = this.scene.own;
    const known = JSON.stringify([bodies.map(({ body, name, links, path, sites }) => [body, name, links.map((link) => link.name), path, sites]), this.tree.state]);
    if (known === this.known) return;
    this.known = known;
    const titles = titlesOf(this.scene);
    document.getElementById("bodies-count").textContent = String(bodies.length);
    const found = bodies.filter((body) => this.tree.finds(body, titles.get(body.body)));
    this.list.replaceChildren(...found.slice(0, MAX_LISTED).flatMap((body) => [this.row(body, titles), ...this.tree.rows(body)]));
    if (this.selected !== null && !this.scene.bodies.has(this.selected)) this.select(null);
    else this.mark();
  }

  /** The line of a body: what unfolds it, its name and its checkbox. */
  row({ body, name }, titles) {
    const text = `${body}  ${titles.get(body)}`;
    const button = Object.assign(document.createElement("button"), { textContent: text, title: text });
    button.dataset.body = body;
    button.addEventListener("click", () => this.select(body === this.selected && this.link === null ? null : body));
    const row = document.createElement("div");
    row.append(this.tree.arrow(body, name), button, this.eye(body, name));
    return row;
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
    for (const button of /** @type {NodeListOf<HTMLElement>} */ (this.list.querySelectorAll("button[data-body]"))) {
      const { body, link } = button.dataset;
      press(button, Number(body) === this.selected && (link === undefined || Number(link) === this.link));
    }
  }

  select(body, link = null) {
    this.selected = body;
    this.link = link;
    this.mark();
    this.build();
    this.selectionChanged(body, link);
  }

  build() {
    this.drives.clear();
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
      if (MOVABLE.test(link.kind ?? "")) this.card.append(this.drives.jointSlider(body.body, index - 1, link));
    });
    (body.actuators ?? []).forEach((actuator, index) => this.card.append(this.drives.actuatorSlider(body.body, index, actuator)));
    // They show what the joints do.
    if (isSpectator()) for (const slider of this.card.querySelectorAll(".slider")) slider.toggleAttribute("inert", true);
    this.show();
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
    this.drives.show();
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
      if (owner !== body || !this.drives.sliders.has(key)) continue;
      calls.push(`p.resetJointState(${body}, ${joint}, ${Number(position.toFixed(6))}, ${Number(velocity.toFixed(6))})`);
    }
    for (const [key, { mode, byHand }] of this.drives.sliders) {
      if (byHand === null) continue;
      const joint = Number(key.split(",")[1]);
      calls.push(driveCall(body, joint, mode, byHand, this.scene.bodies.get(body).links[joint + 1].effort || DRIVE_FORCE));
    }
    calls.push(this.cameraCall());
    navigator.clipboard?.writeText(calls.join("\n")).catch(() => {});
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
