// Lines that the page draws over the scene: frames, bounding boxes, masses, constraints, tendons, rays.

import { add, composed, dot, length, scale, subtract, turned } from "./maths.js";
import { boundsOfLink } from "./bounds.js";
import { ArrowScale } from "./arrows/arrow_scale.js";
import { addContacts, addJoints } from "./forces.js";
import { Lines, across } from "./lines.js";
import { Stage } from "./stage/stage.js";
import { Solids } from "./arrows/solids.js";

const AXES = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const AXIS_COLOURS = [
  [0.86, 0.16, 0.14],
  [0.13, 0.62, 0.22],
  [0.16, 0.36, 0.86],
];
/** Radius of arrows, as a share of the camera's distance. */
const THICKNESS = 0.007;
const FRAME_LENGTH = 0.1;
const SMALL_FRAME = 0.05;
const PULL = [0.95, 0.62, 0.1];
const BOUNDS = [0.9, 0.45, 0.1];
const MASS = [0.75, 0.1, 0.6];
const INERTIA = [0.55, 0.2, 0.75];
const CONSTRAINT = [0.1, 0.65, 0.6];
const HIT = [0.95, 0.25, 0.15];
const MISS = [0.2, 0.75, 0.3];
const BEYOND = [0.6, 0.65, 0.7];
const CAMERA = [0.35, 0.3, 0.75];
const BONE = [0.95, 0.75, 0.15];
const BONE_SIZE = 0.012;
const TRAIL = [0.9, 0.3, 0.55];
const TENDON = [0.75, 0.3, 0.2];
const TENDON_WIDTH = 4;
/** Length of the dashes of slack tendons, in widths, and how many of them a straight piece has at most. */
const DASH = 4;
const MAX_DASHES = 200;
const TENDON_AT_LIMIT = [0.95, 0.55, 0.1];

export class Overlays {
  constructor(scene, options, readings, handles, camera) {
    this.scene = scene;
    this.options = options;
    this.readings = readings;
    this.handles = handles;
    /** Frames the chosen one of many worlds. @type {import("../layout/worlds.js").Worlds | null} */
    this.worlds = null;
    /** The camera of the view that is drawn, and the one that sizes of arrows are of in all views. */
    this.camera = camera;
    this.first = camera;
    this.lines = new Lines();
    this.solids = new Solids();
    this.fitted = { force: new ArrowScale(), torque: new ArrowScale() };
    this.stage = new Stage(scene);
    this.constraints = [];
    this.rays = new Float32Array(0);
    /** Four near and four far corners of the view frustum of the script's camera; empty without a camera. */
    this.pyramid = [];
    /** Returns the recent positions of the selected link, the newest last. */
    this.trail = () => [];
    /** The selected body and link; link null for the whole body. */
    this.selection = null;
    /** Scales of arrows: force [N] and torque [N m] per metre of length. */
    this.scales = { force: 0, torque: 0 };
    /** Simulated time of what is drawn [s]. */
    this.time = 0;
  }

  /** Radius of arrows, and the distance that their lengths are measured by [m]. */
  get thickness() {
    return THICKNESS * this.reach;
  }

  get reach() {
    return this.first.distance;
  }

  /** Fits the scale of forces or torques to the largest one. */
  fit(kind, largest) {
    this.fitted[kind].fit(largest, this.reach, this.time);
    this.scales[kind] = this.fitted[kind].perMetre;
  }

  clear() {
    for (const each of Object.values(this.fitted)) each.clear();
    this.stage.take(null);
    this.constraints = [];
    this.rays = new Float32Array(0);
    this.pyramid = [];
    this.selection = null;
    this.scales = { force: 0, torque: 0 };
  }

  takeRays(payload) {
    this.rays = new Float32Array(payload);
  }

  /**
   * Collects all lines of a view.
   *
   * @param {import("./camera.js").Camera} camera that of the view
   * @param {?number[][]} pull start and end of the line from a pulled body to the mouse
   * @param {?{body: number, link: number}} named the link whose frame is shown
   */
  draw(camera, drawings, pull, named) {
    this.camera = camera;
    const { lines, scene, options } = this;
    lines.clear();
    this.solids.clear();
    if (pull) lines.line(...pull, PULL, 2.5);
    drawings.addLines(lines, scene);
    if (options.bounds) this.eachLink((body, link) => this.addBounds(boundsOfLink(scene, body, link, options.collisions), BOUNDS));
    if (options.constraints) this.addConstraints();
    if (options.tendons) this.addTendons();
    if (options.rays) this.addRays();
    if (options.cameras && !this.camera.lens) this.addCamera();
    if (options.fileCameras && !this.camera.lens) this.stage.addCameras(lines, this.reach);
    if (options.trail) this.addTrail();
    lines.goInside();
    addContacts(this);
    if (named) this.addFrame(named.body, named.link);
    if (options.frames) this.eachLink((body, link) => this.addFrame(body.body, link));
    this.addOtherFrames();
    this.addSelection();
    this.addMasses();
    this.eachLink((body, link, { parent }) => {
      if (options.skeleton || body.shapes.length === 0) this.addBone(body, link, parent);
    });
    addJoints(this);
    this.handles.addLines(lines, camera.eye, camera.forward);
    this.worlds?.addLines(lines);
    this.solids.end();
    return lines;
  }

  eachLink(visit) {
    for (const body of this.scene.bodies.values()) if (!this.scene.hidden.has(body.body)) body.links.forEach((link, index) => visit(body, index, link));
  }

  addFrame(body, link) {
    this.addAxes(this.scene.linkPose(body, link));
  }

  /** The frames of joints, sites and inertia, and those of contacts, whose x axis is the normal. */
  addOtherFrames() {
    const { jointFrames, siteFrames, inertiaFrames, contactFrames } = this.options;
    if (jointFrames) this.eachLink((body, link, { kind }) => kind && kind !== "fixed" && this.addFrame(body.body, link));
    if (inertiaFrames) this.eachLink((body, link) => this.addAxes(this.scene.inertialPose(body.body, link)));
    if (siteFrames) this.eachSite((pose) => this.addAxes(pose, SMALL_FRAME));
    if (!contactFrames) return;
    for (const { point, normal } of this.readings.contacts) {
      [normal, ...across(normal)].forEach((axis, i) => this.lines.line(point, add(point, scale(axis, SMALL_FRAME)), AXIS_COLOURS[i], 2));
    }
  }

  eachSite(visit) {
    for (const body of this.scene.bodies.values()) {
      for (const site of this.scene.hidden.has(body.body) ? [] : (body.sites ?? [])) {
        const link = this.scene.inertialPose(body.body, site.link);
        if (link) visit(composed(link, site));
      }
    }
  }

  addAxes(pose, size = FRAME_LENGTH) {
    if (!pose) return;
    AXES.forEach((axis, i) => {
      const tip = add(pose.position, turned(pose.orientation, scale(axis, size)));
      this.lines.line(pose.position, tip, AXIS_COLOURS[i], 2);
    });
  }

  addBounds(bounds, colour) {
    if (bounds) this.lines.box(...bounds, (corner) => corner, colour);
  }

  /** The selected body; undefined if there is none. */
  get selected() {
    return this.selection ? this.scene.bodies.get(this.selection.body) : undefined;
  }

  addSelection() {
    if (this.selected && this.selection.link !== null) this.addFrame(this.selection.body, this.selection.link);
  }

  addMasses() {
    const { masses, inertias } = this.options;
    if (!masses && !inertias) return;
    this.eachLink((body, link) => {
      const pose = this.scene.inertialPose(body.body, link);
      const dynamics = this.scene.dynamics.get(body.body)?.links[link];
      if (!pose || !dynamics || dynamics.mass <= 0) return;
      const half = halfExtents(dynamics);
      if (masses) this.lines.star(pose.position, Math.max(0.01, 0.5 * Math.max(...half)), MASS, 2.5);
      const place = (corner) => add(pose.position, turned(pose.orientation, corner));
      if (inertias) this.lines.box(scale(half, -1), half, place, INERTIA, 1.5);
    });
  }

  addConstraints() {
    for (const constraint of this.constraints) {
      const [a, b] = [constraint.parent, constraint.child].map(({ body, link, position }) => {
        const pose = this.scene.inertialPose(body, link);
        return pose && add(pose.position, turned(pose.orientation, position));
      });
      if (!a || !b) continue;
      this.lines.line(a, b, CONSTRAINT, 2.5);
      for (const end of [a, b]) this.lines.star(end, 0.02, CONSTRAINT);
    }
  }

  addTendons() {
    for (const { body, start, end, atLimit, slack, radius, rgba, group } of this.readings.tendons) {
      if (this.scene.hidden.has(body) || !this.options.showsGroup("tendons", group) || rgba[3] === 0) continue;
      const isStated = !Number.isNaN(radius);
      const colour = isStated ? rgba.slice(0, 3) : atLimit ? TENDON_AT_LIMIT : TENDON;
      const width = isStated ? this.pixels(2 * radius, start, end) : TENDON_WIDTH;
      if (slack) this.addDashes(start, end, colour, width);
      else this.lines.line(start, end, colour, width);
    }
  }

  /** Width on the screen [pixels] of something of a width [m] midway between two points. */
  pixels(width, start, end) {
    const away = subtract(scale(add(start, end), 0.5), this.camera.eye);
    const depth = Math.max(dot(away, this.camera.forward), 1e-3);
    return Math.max(1, (width * this.camera.height) / (2 * depth));
  }

  /** Adds a line of dashes, as long as four times its width, with gaps half as long. */
  addDashes(start, end, colour, width) {
    const way = subtract(end, start);
    const depth = Math.max(dot(subtract(start, this.camera.eye), this.camera.forward), 1e-3);
    const dash = Math.max((2 * depth * DASH * width) / this.camera.height, length(way) / MAX_DASHES);
    const period = 1.5 * dash;
    for (let at = 0; at * length(way) < length(way); at += period / length(way)) {
      const to = Math.min(1, at + dash / length(way));
      this.lines.line(add(start, scale(way, at)), add(start, scale(way, to)), colour, width);
    }
  }

  /** Adds the frustum of the script's camera, with a triangle at the upper edge of the image. */
  addCamera() {
    const [near, far] = [this.pyramid.slice(0, 4), this.pyramid.slice(4)];
    if (far.length === 0) return;
    for (let i = 0; i < 4; i++) {
      this.lines.line(near[i], far[i], CAMERA, 2);
      for (const corners of [near, far]) this.lines.line(corners[i], corners[(i + 1) % 4], CAMERA, 2);
    }
    const [right, left] = [far[2], far[3]];
    const up = scale(add(far[3], scale(far[0], -1)), 0.3);
    const tip = add(scale(add(left, right), 0.5), up);
    for (const corner of [left, right]) this.lines.line(corner, tip, CAMERA, 2);
  }

  /** Adds a line from a link to its parent, and a cross: those of bodies without shapes are all that is seen of them. */
  addBone(body, link, parent) {
    const [child, other] = [this.scene.linkPose(body.body, link), parent !== undefined && this.scene.linkPose(body.body, parent)];
    if (!child) return;
    this.lines.star(child.position, BONE_SIZE, BONE, 3);
    if (other) this.lines.line(other.position, child.position, BONE, 3);
  }

  addTrail() {
    const places = this.trail();
    for (let i = 1; i < places.length; i++) this.lines.line(places[i - 1], places[i], TRAIL, 2);
  }

  addRays() {
    for (let at = 0; at + 10 <= this.rays.length; at += 10) {
      const [start, end, normal] = [0, 3, 6].map((i) => [...this.rays.subarray(at + i, at + i + 3)]);
      const fraction = this.rays[at + 9];
      const point = start.map((x, i) => x + fraction * (end[i] - x));
      this.lines.line(start, point, fraction < 1 ? HIT : MISS, 1.5);
      if (fraction >= 1) continue;
      this.lines.line(point, end, BEYOND, 1);
      this.lines.line(point, add(point, scale(normal, 0.05)), AXIS_COLOURS[2], 2);
    }
  }
}

/** Half extents of the box of uniform density that has this mass and these principal moments of inertia. */
function halfExtents({ mass, inertia: [x, y, z] }) {
  return [y + z - x, z + x - y, x + y - z].map((sum) => Math.sqrt((1.5 * Math.max(sum, 0)) / mass));
}
