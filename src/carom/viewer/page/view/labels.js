// Short texts at points in the view, such as names of links: they are moved so that they do not cover each other.

import { fixed } from "../panel/numbers.js";
import { Placement } from "./placement.js";

/** Elements that texts do not run under. */
const COVERS = "#panel, #timeline, #dock, #previews figure";
/** Offset of a text from its point, to the right [pixels]. */
const ASIDE = 10;

export class Labels {
  constructor(overlay) {
    this.overlay = overlay;
    this.spans = [];
    this.begin();
  }

  begin() {
    this.used = 0;
    this.shown = [];
  }

  /** Adds a text beside a point. */
  add(camera, point, text, down = -8) {
    const pixel = camera.pixel(point);
    if (!pixel) return;
    const span = (this.spans[this.used++] ??= this.make());
    if (span.textContent !== text) span.textContent = text;
    this.addSpan(span, pixel, [ASIDE, down]);
  }

  /**
   * Adds the element of a text; it is hidden without a pixel.
   *
   * @param {?number[]} pixel
   * @param {Array} offset of the upper left corner from the pixel; null for down: the lower edge is at the pixel
   */
  addSpan(span, pixel, offset) {
    if (pixel) this.shown.push({ span, pixel, offset });
    span.hidden = !pixel;
  }

  /** Places the texts that were added for a view; those added first have the first choice. */
  end(camera) {
    for (const span of this.spans.slice(this.used)) span.hidden = true;
    if (this.shown.length === 0) return;
    const covers = [...document.querySelectorAll(COVERS)].map((element) => element.getBoundingClientRect()).filter(({ width }) => width > 0);
    const { left: x, top: y } = camera;
    const seen = covers.map(({ left, top, right, bottom }) => ({ left: left - x, top: top - y, right: right - x, bottom: bottom - y }));
    const placement = new Placement(camera.width, camera.height, seen);
    // All sizes are read before anything moves: the browser computes the layout once.
    for (const each of this.shown) each.size = [each.span.offsetWidth, each.span.offsetHeight];
    for (const { span, pixel, offset, size } of this.shown) {
      const corner = placement.place([pixel[0] - x, pixel[1] - y], [offset[0], offset[1] ?? -size[1]], size);
      span.hidden = corner === null;
      if (corner) span.style.transform = `translate(${x + corner[0]}px, ${y + corner[1]}px)`;
    }
    this.shown = [];
  }

  make() {
    const span = Object.assign(document.createElement("span"), { className: "reading" });
    this.overlay.append(span);
    return span;
  }
}

/** Maximum number of link names; more would cover each other. */
const MAX_NAMES = 300;

/** Shows the name of each link at its frame, below the position of its joint. */
export function labelLinks(labels, camera, scene) {
  let room = MAX_NAMES;
  for (const { body, name, links } of scene.bodies.values()) {
    if (scene.hidden.has(body)) continue;
    for (let link = 0; link < links.length && room > 0; link++, room--) {
      const pose = scene.linkPose(body, link);
      if (pose) labels.add(camera, pose.position, links[link].name || name, 10);
    }
  }
}

/** Shows the position of each joint at the joint. */
export function labelJoints(labels, camera, scene, readings) {
  for (const { body, joint, position } of readings.joints.values()) {
    const link = scene.bodies.get(body)?.links[joint + 1];
    const pose = link && scene.linkPose(body, joint + 1);
    if (!pose) continue;
    const angle = link.kind !== "prismatic";
    labels.add(camera, pose.position, angle ? `${fixed((position * 180) / Math.PI, 1)}°` : `${fixed(position, 4)} m`);
  }
}
