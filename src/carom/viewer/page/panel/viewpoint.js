// The camera's controls: presets, following, and the arguments of resetDebugVisualizerCamera.

import { boundsOfBody, boundsOfScene, downToFloor } from "../view/bounds.js";
import { PRESETS } from "../view/camera.js";
import { fixed } from "./numbers.js";
import { element } from "../elements.js";

/** @import { Memory } from "../memory.js" */
/** @import { Options } from "./options.js" */
/** @import { Camera } from "../view/camera.js" */
/** @import { Scene } from "../view/scene.js" */

/** More robots than this are not kept in view. */
const MAX_ROBOTS = 20;

export class Viewpoint {
  /**
   * @param {Camera} camera
   * @param {Scene} scene
   * @param {Options} options
   * @param {Memory} memory keeps the user's camera for the next run of the script
   * @param {() => void} moved called when the user has moved the camera
   */
  constructor(camera, scene, options, memory, moved) {
    /** The camera of the first view, which is the script's, and that of the view that the panel acts on. */
    this.camera = camera;
    this.chosen = camera;
    this.scene = scene;
    this.options = options;
    this.memory = memory;
    this.moved = moved;
    this.numbers = document.getElementById("camera-numbers");
    this.following = element("follow", HTMLInputElement);
    this.selection = null;
    /** The cameras of all views. */
    this.cameras = () => [camera];
    /** Whether the page fits the scene into view, because neither script nor user has set the camera. */
    this.undecided = true;
    /** Whether bodies that are added from now on do not change the view. */
    this.settled = false;
    /** Whether the page shows other files than before, whose bodies may still be to come. */
    this.anew = false;
    /** The box that was fitted into the first view. */
    this.box = null;
    /** The first camera that the script has set in this run, as a text; null if it has not. */
    this.scripted = null;
    const presets = document.getElementById("presets");
    for (const name of Object.keys(PRESETS)) {
      const button = Object.assign(document.createElement("button"), { textContent: name });
      button.addEventListener("click", () => this.change(() => this.chosen.preset(name)));
      presets.append(button);
    }
    document.getElementById("fit").addEventListener("click", () => this.change(() => this.fit()));
    this.following.addEventListener("change", () => {
      for (const each of this.cameras()) each.followed = null;
      // From here on, whether or not there is a picture before the body moves.
      this.follow();
    });
    document.getElementById("copy-camera").addEventListener("click", () => this.copy());
  }

  /** The camera is neither the user's nor the script's at the start of a run. */
  begin() {
    this.undecided = true;
    this.settled = false;
    this.fitted = null;
    this.anew = false;
    this.box = null;
    this.scripted = null;
  }

  /**
   * Takes the camera of a message; true if the page shows another one. A script that is run again sets the camera
   * that the user has moved since: it stays where the user has moved it.
   */
  take(header) {
    const { distance, yaw, pitch, target, chosen, script } = header;
    const first = script && this.scripted === null;
    if (first) this.scripted = JSON.stringify([distance, yaw, pitch, target]);
    if (chosen) this.undecided = false;
    if (first && this.recall(this.scripted)) return true;
    this.camera.set(header);
    return false;
  }

  /** Keeps the camera that the user has moved. */
  remember() {
    const over = this.scripted ?? this.memory.get("camera")?.over ?? null;
    this.memory.put("camera", { over, view: this.camera.state() });
  }

  /** Shows the camera that the user has moved from the script's camera, or without one; false if there is none. */
  recall(scripted) {
    const kept = this.memory.get("camera");
    if (!kept || kept.over !== scripted) return false;
    this.camera.set(kept.view);
    return true;
  }

  /** How much of the window the panel and the time bar cover [pixels]. */
  get covers() {
    const { clientWidth, clientHeight } = document.getElementById("view");
    const covered = (id, measure) => {
      const part = document.getElementById(id);
      return part.hidden ? 0 : measure(part.getBoundingClientRect());
    };
    const folded = document.getElementById("panel").classList.contains("folded");
    const side = folded ? 0 : covered("panel", ({ left }) => clientWidth - left);
    return { side, below: covered("timeline", ({ top }) => clientHeight - top) };
  }

  /** How much of a view they cover: nothing, if there are several. */
  get insets() {
    return this.cameras().length > 1 ? { side: 0, below: 0 } : this.covers;
  }

  /** Moves the camera of the chosen view. */
  change(act) {
    act();
    this.moved();
  }

  /** Fits the selected body, or the whole scene, into view. */
  fit() {
    const body = this.selection && this.scene.bodies.get(this.selection.body);
    const collisions = this.options.collisions;
    const bounds = (body && boundsOfBody(this.scene, body, collisions)) ?? boundsOfScene(this.scene, collisions);
    if (bounds) this.chosen.fit(bounds, this.insets);
    return bounds !== null;
  }

  /** Fits the whole scene into the view of a camera. */
  fitAll(camera) {
    const bounds = this.scene.poses.length > 0 ? boundsOfScene(this.scene, this.options.collisions) : null;
    if (bounds) camera.fit(bounds, this.insets);
  }

  /** Fits the scene into view as its bodies arrive, unless the script or the user has set the camera. */
  lookAtFirst() {
    if (!this.undecided || this.settled || this.scene.bodies.size === 0 || this.scene.poses.length === 0) return false;
    const bounds = boundsOfScene(this.scene, false);
    if (!bounds) return false;
    // The view is fitted again whenever bodies have been added or removed; of other files, whenever a layout comes.
    const key = JSON.stringify([this.anew && this.scene.layout.layout, ...this.scene.bodies.keys()]);
    if (key === this.fitted) return false;
    this.fitted = key;
    if (this.recall(null)) this.undecided = false;
    else {
      this.box = downToFloor(this.scene, bounds, false, this.options.yUp ? 1 : 2);
      this.camera.fit(this.box, this.insets);
    }
    return true;
  }

  /**
   * Moves the camera of the first view away if a robot that stands fixed moves out of it, as an arm that is lifted;
   * what falls or runs away may do so. True if it has moved.
   */
  widen() {
    const { scene, camera } = this;
    if (!this.undecided || !this.box || camera.lens) return false;
    let wider = this.box;
    for (const body of [...scene.bodies.values()].filter(standsFixed).slice(0, MAX_ROBOTS)) {
      const bounds = !scene.hidden.has(body.body) && boundsOfBody(scene, body, false);
      if (bounds && !inView(camera, bounds)) wider = boxAround(wider, bounds);
    }
    if (wider === this.box) return false;
    this.box = wider;
    camera.fit(wider, this.insets);
    return true;
  }

  /** Moves the cameras along with the selected body or link, if following is on. */
  follow() {
    if (!this.following.checked) return;
    const { body, link } = this.selection ?? {};
    const pose = body === undefined ? null : this.scene.inertialPose(body, link ?? 0);
    for (const camera of this.cameras()) if (!camera.lens) camera.follow(pose && pose.position);
  }

  /** The numbers of the camera: the arguments of the call that brings it back. */
  get text() {
    const { distance, yaw, pitch, target } = this.chosen;
    return `${fixed(distance, 2)}, ${fixed(yaw, 1)}, ${fixed(pitch, 1)}, [${target.map((x) => fixed(x, 2)).join(", ")}]`;
  }

  show() {
    const { text } = this;
    if (this.numbers.textContent !== text) this.numbers.textContent = text;
  }

  /** The call that brings the camera back. */
  get call() {
    return `p.resetDebugVisualizerCamera(${this.text})`;
  }

  copy() {
    navigator.clipboard?.writeText(this.call).catch(() => {});
  }
}

/** Whether a body has links that move, and a base that does not. */
function standsFixed({ links }) {
  return !links[0].moves && links.some((link) => link.moves);
}

/**
 * @param {Camera} camera
 * @param {number[][]} box
 */
function inView(camera, box) {
  return [...Array(8).keys()].every((corner) => {
    const pixel = camera.pixel([0, 1, 2].map((i) => box[(corner >> i) & 1][i]));
    return pixel && pixel[0] >= 0 && pixel[0] <= camera.width && pixel[1] >= 0 && pixel[1] <= camera.height;
  });
}

/**
 * @param {number[][]} a
 * @param {number[][]} b
 */
function boxAround(a, b) {
  return [a[0].map((x, i) => Math.min(x, b[0][i])), a[1].map((x, i) => Math.max(x, b[1][i]))];
}
