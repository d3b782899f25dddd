// Shapes with the same meshes and texture, drawn in one call.

import { Level } from "./level.js";
import { Merged } from "./software/merged.js";

/** @import { Mesh } from "./gpu.js" */

export class Group {
  /**
   * @param {{mesh: Mesh, reach: number}[]} levels levels of detail, the finest first: meshes, and the maximum
   *   radius on the screen at which each is used [pixels]
   * @param {{texture: number, twoSided: boolean, collision?: boolean, site?: boolean, group?: number}} shape one of the shapes
   * @param {boolean} clear whether the shapes are transparent
   * @param {boolean} byProcessor whether the CPU renders, because there is no GPU
   */
  constructor(gl, levels, shape, clear, byProcessor) {
    this.levels = levels.map(({ mesh, reach }) => new (byProcessor && Merged.suits(mesh) ? Merged : Level)(gl, mesh, reach));
    this.texture = shape.texture;
    this.twoSided = shape.twoSided;
    this.collision = !!shape.collision;
    this.site = !!shape.site;
    this.group = shape.group ?? 0;
    this.clear = clear;
    this.members = [];
    this.filledFor = "";
    /** A point among the instances, to sort groups by depth. */
    this.middle = [0, 0, 0];
  }

  /** The finest mesh. */
  get mesh() {
    return this.levels[0].mesh;
  }

  get instances() {
    return this.levels.reduce((sum, level) => sum + level.count, 0);
  }

  add(body, shape) {
    this.members.push({ body, shape, radius: this.mesh.radius * Math.max(...shape.scale.map(Math.abs)) });
  }

  /** Updates the poses and colours of the instances; see `Scene.fill`. */
  fill(scene, options, eye, focal, stillOnly) {
    const [levels, several] = [this.levels, this.levels.length > 1];
    // With a single level of detail the camera does not matter.
    const looks = [options.wireframe, options.linkColours, options.version];
    const filledFor = [scene.version, stillOnly, ...looks, ...(several ? [...eye, focal] : [])].join();
    if (this.filledFor === filledFor) return;
    this.filledFor = filledFor;
    for (const level of levels) level.begin(this.members.length);
    for (const { body, shape, radius } of this.members) {
      const at = scene.poseAt(body.body, shape.link);
      if (at < 0 || scene.hidden.has(body.body) || (stillOnly && body.links[shape.link].moves)) continue;
      let level = 0;
      if (several) {
        const distance = Math.hypot(scene.poses[at] - eye[0], scene.poses[at + 1] - eye[1], scene.poses[at + 2] - eye[2]);
        const pixels = (focal * radius) / Math.max(distance - radius, 1e-6);
        while (level + 1 < levels.length && pixels <= levels[level + 1].reach) level++;
      }
      const wire = options.wireframe && options.wireColour(body.body, shape.link);
      const colour = wire || (options.linkColours ? linkColour(body.body, shape.link) : shape.rgba);
      levels[level].push(scene.poses, at, shape, colour);
    }
    for (const level of levels) level.end();
    this.middle = (levels.find((level) => level.count) ?? levels[0]).origin();
  }

  /** Draws the triangles of all instances. */
  draw() {
    for (const level of this.levels) if (level.count > 0) level.draw();
  }

  /** Draws the edges of all instances. */
  drawEdges() {
    for (const level of this.levels) if (level.count > 0) level.drawEdges();
  }

  dispose() {
    for (const level of this.levels) level.dispose();
  }
}

/** Hue step between successive numbers [turns]: the golden ratio gives neighbours different colours. */
const HUE_STEP = 0.61803398875;

/** A different colour for each link. */
export function linkColour(body, link) {
  const hue = ((body * 17 + link + 1) * HUE_STEP) % 1;
  const part = (turn) => 0.35 + 0.6 * Math.min(Math.max(Math.abs(((hue + turn) % 1) * 6 - 3) - 1, 0), 1);
  return [part(0), part(1 / 3), part(2 / 3), 1];
}
