// What there is: bodies, their shapes, and where their links are.

import { composed } from "./maths.js";
import { Mesh, imageTexture } from "./gpu.js";
import { Group } from "./group.js";

const IDENTITY = { position: [0, 0, 0], orientation: [0, 0, 0, 1] };
/** Numbers of a pose in a frame: position and quaternion. */
export const POSE_FLOATS = 7;
/** How much of a body is seen where bodies are made transparent. */
const GLASS = 0.35;

export class Scene {
  /** @param {boolean} byProcessor whether there is no graphics card */
  constructor(gl, byProcessor) {
    this.gl = gl;
    this.byProcessor = byProcessor;
    this.clear();
  }

  /** Forgets everything, before another simulation tells its own. */
  clear() {
    for (const mesh of this.meshes?.values() ?? []) mesh.dispose();
    for (const texture of this.textures?.values() ?? []) this.gl.deleteTexture(texture);
    for (const group of this.groups ?? []) group.dispose();
    this.meshes = new Map();
    this.textures = new Map();
    this.bodies = new Map();
    this.dynamics = new Map();
    /** Bodies that the user does not want to see. */
    this.hidden = new Set();
    this.layout = { layout: 0, bodies: [] };
    this.groups = [];
    this.stale = true;
    this.transparent = false;
    /** Grows with every change of what is where. */
    this.version = 0;
    /** Poses of the newest frame, all in one array, and where those of each body begin. */
    this.poses = new Float32Array(0);
    this.starts = new Map();
    this.startsOf = this.layout;
  }

  addMesh(header, payload) {
    this.meshes.set(header.mesh, new Mesh(this.gl, header, payload));
    this.stale = true;
  }

  removeMesh({ mesh }) {
    this.meshes.get(mesh)?.dispose();
    this.meshes.delete(mesh);
    this.stale = true;
  }

  addTexture(header, payload) {
    this.textures.set(header.texture, imageTexture(this.gl, header, payload, this.byProcessor));
  }

  removeTexture({ texture }) {
    this.gl.deleteTexture(this.textures.get(texture) ?? null);
    this.textures.delete(texture);
  }

  /** Takes over masses and inertias of a body's links. */
  addDynamics(header) {
    this.dynamics.set(header.body, header);
  }

  removeDynamics({ body }) {
    this.dynamics.delete(body);
  }

  addBody(header) {
    // Another body under the number of one that is gone: its poses come with the next frame.
    if (this.bodies.get(header.body)?.links.length !== header.links.length) this.starts.delete(header.body);
    this.bodies.set(header.body, header);
    this.stale = true;
  }

  removeBody({ body }) {
    this.bodies.delete(body);
    this.hidden.delete(body);
    this.starts.delete(body);
    this.stale = true;
  }

  /** Shows a body, or hides it. */
  setHidden(body, hidden) {
    if (hidden) this.hidden.add(body);
    else this.hidden.delete(body);
    this.version += 1;
  }

  /** Takes over where all links are; a frame that was made for other bodies is left alone. */
  place({ layout, poses }, payload) {
    if (layout !== this.layout.layout) return;
    this.poses = new Float32Array(payload, 0, poses * POSE_FLOATS);
    if (this.startsOf !== this.layout) {
      this.startsOf = this.layout;
      let start = 0;
      this.starts = new Map();
      for (const [body, links] of this.layout.bodies) {
        this.starts.set(body, start);
        start += links * POSE_FLOATS;
      }
    }
    this.version += 1;
  }

  /** Where the pose of a link is in `poses`; -1 if it is not known yet. */
  poseAt(body, link) {
    const start = this.starts.get(body);
    return start === undefined ? -1 : start + link * POSE_FLOATS;
  }

  /** Pose of the inertial frame of a link; 0 is the base. The world's for body -1. */
  inertialPose(body, link) {
    if (body < 0) return IDENTITY;
    const at = this.poseAt(body, link);
    if (at < 0 || link >= (this.bodies.get(body)?.links.length ?? 0)) return null;
    const [x, y, z, ...orientation] = this.poses.subarray(at, at + POSE_FLOATS);
    return { position: [x, y, z], orientation };
  }

  /** Pose of a link frame. */
  linkPose(body, link) {
    const pose = this.inertialPose(body, link);
    if (body < 0 || pose === null) return pose;
    return composed(pose, this.bodies.get(body).links[link]);
  }

  /** Shapes that look alike, to be drawn at once. */
  regroup(options) {
    if (!this.stale && options.transparent === this.transparent) return;
    this.stale = false;
    this.transparent = options.transparent;
    for (const group of this.groups) group.dispose();
    const groups = new Map();
    for (const body of this.bodies.values()) {
      const glassy = options.transparent && body.links.some((link) => link.moves);
      for (const shape of body.shapes) {
        if (shape.rgba[3] <= 0) continue;
        const clear = glassy || shape.rgba[3] < 1;
        const numbers = shape.meshes.map(([mesh]) => mesh);
        // Shapes that are seen through are drawn one by one, from the back to the front.
        const key = [...numbers, shape.texture, shape.twoSided, !!shape.collision, clear && groups.size].join();
        if (!groups.has(key)) {
          const levels = shape.meshes.map(([mesh, reach]) => ({ mesh: this.meshes.get(mesh), reach: reach ?? Infinity }));
          if (!levels.every(({ mesh }) => mesh?.indices.length)) continue;
          groups.set(key, new Group(this.gl, levels, shape, clear, this.byProcessor));
        }
        groups.get(key).add(body, glassy ? { ...shape, rgba: [...shape.rgba.slice(0, 3), shape.rgba[3] * GLASS] } : shape);
      }
    }
    this.groups = [...groups.values()];
    this.version += 1;
  }

  /**
   * Brings the instances of all groups up to date.
   *
   * @param {number[]} eye where they are looked at from
   * @param {number} focal pixels that something of the size of its distance takes up
   */
  fill(options, eye, focal) {
    for (const group of this.groups) group.fill(this, options, eye, focal);
  }
}
