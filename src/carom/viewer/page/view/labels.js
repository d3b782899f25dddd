// Short texts at points in the view, such as the positions of joints.

import { fixed } from "../panel/numbers.js";

export class Labels {
  constructor(overlay) {
    this.overlay = overlay;
    this.spans = [];
    this.used = 0;
  }

  begin() {
    this.used = 0;
  }

  add(camera, point, text, down = -8) {
    const pixel = camera.pixel(point);
    if (!pixel) return;
    const span = (this.spans[this.used++] ??= this.make());
    span.hidden = false;
    if (span.textContent !== text) span.textContent = text;
    span.style.transform = `translate(${pixel[0] + 10}px, ${pixel[1] + down}px)`;
  }

  end() {
    for (const span of this.spans.slice(this.used)) span.hidden = true;
  }

  make() {
    const span = Object.assign(document.createElement("span"), { className: "reading" });
    this.overlay.append(span);
    return span;
  }
}

/** Maximum number of link names; more would cover each other. */
const MOST_NAMES = 300;

/** Shows the name of each link at its frame, below the position of its joint. */
export function labelLinks(labels, camera, scene) {
  let room = MOST_NAMES;
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
