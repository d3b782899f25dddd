// The camera's controls: presets, following, and the arguments of resetDebugVisualizerCamera.

import { boundsOfBody, boundsOfScene } from "../view/bounds.js";
import { PRESETS } from "../view/camera.js";

export class Viewpoint {
  /**
   * @param {Camera} camera
   * @param {Scene} scene
   * @param {Options} options
   * @param {() => void} moved called when the user has moved the camera
   */
  constructor(camera, scene, options, moved) {
    Object.assign(this, { camera, scene, options, moved });
    this.numbers = document.getElementById("camera-numbers");
    this.following = document.getElementById("follow");
    this.selection = null;
    /** Whether the page fits the scene into view, because neither script nor user has set the camera. */
    this.undecided = true;
    const presets = document.getElementById("presets");
    for (const name of Object.keys(PRESETS)) {
      const button = Object.assign(document.createElement("button"), { textContent: name });
      button.addEventListener("click", () => this.change(() => camera.preset(name)));
      presets.append(button);
    }
    document.getElementById("fit").addEventListener("click", () => this.change(() => this.fit()));
    this.following.addEventListener("change", () => (camera.followed = null));
    document.getElementById("copy-camera").addEventListener("click", () => this.copy());
  }

  change(act) {
    act();
    this.undecided = false;
    this.moved();
  }

  /** Fits the selected body, or the whole scene, into view. */
  fit() {
    const body = this.selection && this.scene.bodies.get(this.selection.body);
    const collisions = this.options.collisions;
    const bounds = (body && boundsOfBody(this.scene, body, collisions)) ?? boundsOfScene(this.scene, collisions);
    if (bounds) this.camera.fit(bounds);
    return bounds !== null;
  }

  /** Fits the scene into view as its bodies arrive, unless the script or the user has set the camera. */
  lookAtFirst() {
    if (!this.undecided || this.scene.bodies.size === 0 || this.scene.poses.length === 0) return false;
    const bounds = boundsOfScene(this.scene, false);
    if (!bounds) return false;
    const key = JSON.stringify([...this.scene.bodies.keys()]);
    // The view is fitted again whenever bodies have been added or removed.
    if (key === this.fitted) return false;
    this.fitted = key;
    this.camera.fit(bounds);
    return true;
  }

  /** Moves the camera along with the selected body or link, if following is on. */
  follow() {
    if (!this.following.checked) return;
    const { body, link } = this.selection ?? {};
    const pose = body === undefined ? null : this.scene.inertialPose(body, link ?? 0);
    this.camera.follow(pose && pose.position);
  }

  show() {
    const { distance, yaw, pitch, target } = this.camera;
    const text = `${distance.toFixed(2)}, ${yaw.toFixed(1)}, ${pitch.toFixed(1)}, [${target.map((x) => x.toFixed(2)).join(", ")}]`;
    if (this.numbers.textContent !== text) this.numbers.textContent = text;
  }

  copy() {
    navigator.clipboard?.writeText(`p.resetDebugVisualizerCamera(${this.numbers.textContent})`).catch(() => {});
  }
}
