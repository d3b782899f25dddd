// Short texts beside things in the view, such as the angle of a joint beside it.

export class Labels {
  constructor(overlay) {
    this.overlay = overlay;
    this.spans = [];
    this.used = 0;
  }

  begin() {
    this.used = 0;
  }

  add(camera, point, text) {
    const pixel = camera.pixel(point);
    if (!pixel) return;
    const span = (this.spans[this.used++] ??= this.make());
    span.hidden = false;
    if (span.textContent !== text) span.textContent = text;
    span.style.transform = `translate(${pixel[0] + 10}px, ${pixel[1] - 8}px)`;
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

/** Puts the position of each joint beside it. */
export function labelJoints(labels, camera, scene, readings) {
  for (const { body, joint, position } of readings.joints.values()) {
    const link = scene.bodies.get(body)?.links[joint + 1];
    const pose = link && scene.linkPose(body, joint + 1);
    if (!pose) continue;
    const angle = link.kind !== "prismatic";
    labels.add(camera, pose.position, angle ? `${((position * 180) / Math.PI).toFixed(1)}°` : `${position.toFixed(4)} m`);
  }
}
