// The scene: bodies, their shapes, and the poses of their links.

import { composed } from "./maths.js";
import { Mesh } from "./gpu.js";
import { Group } from "./group.js";
import { bitmapTexture, decodedImage, imageTexture } from "./textures.js";

const IDENTITY = { position: [0, 0, 0], orientation: [0, 0, 0, 1] };
/** Number of floats of a pose in a frame: position and quaternion. */
export const POSE_FLOATS = 7;
/** Opacity of bodies that are shown transparent. */
const GLASS = 0.35;

export class Scene {
  /** @param {boolean} byProcessor whether the CPU renders, because there is no GPU */
  constructor(gl, byProcessor) {
    this.gl = gl;
    this.byProcessor = byProcessor;
    /** Called when an image has been decoded, some time after its message. */
    this.textureArrived = () => {};
    this.clear();
  }

  /** Empties the scene, before a simulation sends its own. */
  clear() {
    for (const mesh of this.meshes?.values() ?? []) mesh.dispose();
    for (const texture of this.textures?.values() ?? []) this.gl.deleteTexture(texture);
    for (const group of this.groups ?? []) group.dispose();
    this.meshes = new Map();
    this.textures = new Map();
    /** Messages of the images that are being decoded. */
    this.decoding = new Map();
    this.bodies = new Map();
    this.dynamics = new Map();
    /** Whether it is some of many worlds, where nothing is driven by hand. */
    this.many = false;
    /** Numbers of the bodies that the user has hidden. */
    this.hidden = new Set();
    this.layout = { layout: 0, bodies: [] };
    this.groups = [];
    this.stale = true;
    this.transparent = false;
    /** Increases with every change of shapes or poses. */
    this.version = 0;
    /** Increases with every change of shapes, textures or hidden bodies. */
    this.looks = 0;
    /** Poses of the newest frame in one array, and the index at which the poses of each body begin. */
    this.poses = new Float32Array(0);
    this.starts = new Map();
    this.startsOf = this.layout;
  }

  /** Forgets what was on the GPU, which has lost it. */
  forgetGraphics() {
    this.meshes = new Map();
    this.textures = new Map();
    this.groups = [];
    this.stale = true;
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
    this.removeTexture(header);
    this.looks += 1;
    if (header.file) this.decodeTexture(header, payload);
    else this.textures.set(header.texture, imageTexture(this.gl, header, payload, this.byProcessor));
  }

  /** Decodes an image; until then shapes have their plain colour. */
  async decodeTexture(header, payload) {
    const { decoding } = this;
    decoding.set(header.texture, header);
    const bitmap = await decodedImage(header, payload);
    // It may have been removed or replaced in the meantime, or all of the scene.
    if (decoding === this.decoding && decoding.get(header.texture) === header) {
      decoding.delete(header.texture);
      this.textures.set(header.texture, bitmapTexture(this.gl, bitmap, this.byProcessor));
      this.looks += 1;
      this.textureArrived();
    }
    bitmap.close();
  }

  removeTexture({ texture }) {
    this.gl.deleteTexture(this.textures.get(texture) ?? null);
    this.textures.delete(texture);
    this.decoding.delete(texture);
  }

  /** Sets the masses and inertias of a body's links. */
  addDynamics(header) {
    this.dynamics.set(header.body, header);
  }

  removeDynamics({ dynamics }) {
    this.dynamics.delete(dynamics);
  }

  addBody(header) {
    // A new body has the number of a removed one: its poses come with the next frame.
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

  /** The bodies of the only world, or of the chosen one of many. */
  get own() {
    return [...this.bodies.values()].filter(({ world }) => world === undefined);
  }

  /** Shows a body, or hides it. */
  setHidden(body, hidden) {
    if (hidden) this.hidden.add(body);
    else this.hidden.delete(body);
    this.version += 1;
    this.looks += 1;
  }

  /** Sets the poses of all links; a frame that was made for other bodies is ignored. */
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

  /** Index of the pose of a link in `poses`; -1 if the pose is not known yet. */
  poseAt(body, link) {
    const start = this.starts.get(body);
    return start === undefined ? -1 : start + link * POSE_FLOATS;
  }

  /** Pose of the inertial frame of a link in the world; link 0 is the base, body -1 is the world. */
  inertialPose(body, link) {
    if (body < 0) return IDENTITY;
    const at = this.poseAt(body, link);
    if (at < 0 || link >= (this.bodies.get(body)?.links.length ?? 0)) return null;
    const [x, y, z, ...orientation] = this.poses.subarray(at, at + POSE_FLOATS);
    return { position: [x, y, z], orientation };
  }

  /** Pose of a link frame in the world. */
  linkPose(body, link) {
    const pose = this.inertialPose(body, link);
    if (body < 0 || pose === null) return pose;
    return composed(pose, this.bodies.get(body).links[link]);
  }

  /** Groups the shapes with the same meshes and texture, to draw each group in one call. */
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
        // Transparent shapes are drawn one by one, from back to front.
        const key = [...numbers, shape.texture, shape.twoSided, !!shape.collision, !!shape.site, shape.group ?? 0, clear && groups.size].join();
        if (!groups.has(key)) {
          const levels = this.levelsOf(shape);
          if (!levels) continue;
          groups.set(key, new Group(this.gl, levels, shape, clear, this.byProcessor));
        }
        groups.get(key).add(body, glassy ? { ...shape, rgba: [...shape.rgba.slice(0, 3), shape.rgba[3] * GLASS] } : shape);
      }
    }
    this.groups = [...groups.values()];
    this.version += 1;
    this.looks += 1;
  }

  /** The levels of detail of a shape (see `Group`); null while a mesh is missing, or if one is empty. */
  levelsOf(shape) {
    const levels = shape.meshes.map(([mesh, reach]) => ({ mesh: this.meshes.get(mesh), reach: reach ?? Infinity }));
    return levels.every(({ mesh }) => mesh?.indices.length) ? levels : null;
  }

  /**
   * Updates the instances of all groups.
   *
   * @param {number[]} eye position of the camera
   * @param {number} focal focal length of the camera [pixels]
   * @param {boolean} stillOnly whether only those that do not move are wanted
   */
  fill(options, eye, focal, stillOnly = false) {
    for (const group of this.groups) group.fill(this, options, eye, focal, stillOnly);
  }
}
