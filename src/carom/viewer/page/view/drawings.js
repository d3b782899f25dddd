// Lines, points and texts that scripts draw, fixed to links or in the world.

import { add, turned } from "./maths.js";
import { titlesOf } from "./names.js";
import { Sign } from "./sign.js";
import { ToPage } from "../protocol.js";

const WORLD_AXES = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const TEXT_PIXELS = 15;

export class Drawings {
  constructor(gl, overlay) {
    this.gl = gl;
    this.overlay = overlay;
    this.items = new Map();
    this.clouds = [];
    this.signs = [];
    this.name = Object.assign(document.createElement("span"), { className: "hover", hidden: true });
    overlay.append(this.name);
  }

  add(header, payload) {
    this.remove(header);
    const item = { ...header };
    if (header.type === ToPage.POINTS) Object.assign(item, this.cloud(header, payload));
    if (header.type === ToPage.TEXT && header.orientation) item.sign = new Sign(this.gl, header);
    else if (header.type === ToPage.TEXT) item.labels = [this.label(header)];
    this.items.set(header.item, item);
    this.list();
  }

  /** Forgets all items, whose parts on the GPU are lost. */
  forgetGraphics() {
    for (const { labels } of this.items.values()) for (const label of labels ?? []) label.remove();
    this.items.clear();
    this.list();
  }

  remove({ item }) {
    const known = this.items.get(item);
    if (!known) return;
    for (const label of known.labels ?? []) label.remove();
    known.sign?.dispose();
    if (known.buffer) {
      this.gl.deleteBuffer(known.buffer);
      this.gl.deleteVertexArray(known.array);
    }
    this.items.delete(item);
    this.list();
  }

  /** Lists point clouds and signs separately, because the renderer needs them for every picture. */
  list() {
    const items = [...this.items.values()];
    this.clouds = items.filter((item) => item.type === ToPage.POINTS);
    this.signs = items.flatMap((item) => item.sign ?? []);
  }

  clear() {
    for (const item of [...this.items.values()]) this.remove(item);
  }

  cloud({ body, link, count, size }, payload) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    const buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, payload, gl.STATIC_DRAW);
    for (const place of [0, 1]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, place * count * 12);
    }
    gl.bindVertexArray(null);
    const axes = (scene) => {
      const pose = scene.linkPose(body, link);
      return pose && [...WORLD_AXES.map((axis) => turned(pose.orientation, axis)), pose.position];
    };
    return { array, buffer, count, size, axes };
  }

  /** Leaves out the texts of views that are no longer there. @param {number} views */
  keepLabels(views) {
    for (const { labels } of this.items.values()) for (const label of labels?.splice(views) ?? []) label?.remove();
  }

  label({ text, colour, size }) {
    const label = document.createElement("span");
    label.textContent = text;
    label.style.color = `rgb(${colour.map((part) => Math.round(255 * part)).join()})`;
    label.style.fontSize = `${TEXT_PIXELS * size}px`;
    this.overlay.append(label);
    return label;
  }

  /** Adds the lines drawn by scripts. */
  addLines(lines, scene) {
    for (const item of this.items.values()) {
      if (item.type !== ToPage.LINE) continue;
      const pose = scene.linkPose(item.body, item.link);
      if (pose) lines.line(inFrame(pose, item.start), inFrame(pose, item.end), item.colour, item.width);
    }
  }

  /** Shows the names of body, link and joint under the mouse. */
  showName(scene, named, pixel) {
    this.name.hidden = !named;
    if (!named) return;
    const body = scene.bodies.get(named.body);
    const link = body.links[named.link];
    this.name.textContent = [titlesOf(scene).get(body.body), link.name, link.joint && `joint ${named.link - 1} ${link.joint}`].filter(Boolean).join(" · ");
    this.name.style.transform = `translate(${pixel[0] + 14}px, ${pixel[1] + 14}px)`;
  }

  /**
   * Adds the texts to the labels, each with its lower left corner at its position.
   *
   * @param {number} view number of the view: each has labels of its own
   */
  addLabels(labels, scene, camera, view = 0) {
    for (const item of this.items.values()) {
      if (!item.labels) continue;
      const label = (item.labels[view] ??= this.label(item));
      const pose = scene.linkPose(item.body, item.link);
      labels.addSpan(label, pose && camera.pixel(inFrame(pose, item.position)), [0, null]);
    }
  }
}

function inFrame(pose, point) {
  return add(pose.position, turned(pose.orientation, point));
}
