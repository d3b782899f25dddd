// Lights, sky and cameras of the files.

import { add, composed, scale, subtract, turned, unit } from "../maths.js";
import { Vectors } from "../gpu.js";
import { frameOf } from "./file_cameras.js";

/** @import { Camera } from "../camera.js" */
/** @import { Lines } from "../lines.js" */
/** @import { Scene } from "../scene.js" */

/** Number of lights that are drawn: those that shine most. */
export const LIGHTS = 8;
/** Numbers of a light for the shaders, in vectors of four. */
export const LIGHT_VECTORS = 5;
const CAMERA = [0.2, 0.55, 0.6];
/** Length of the frustum of a camera, as a share of the distance of the viewer. */
const FRUSTUM = 0.06;
/** A plane mirrors if it is level so far [cosine]. */
const LEVEL = 0.999;
/** Planes without end are drawn so wide [m]. */
const ENDLESS = 255;
/** Colour of the horizon of the window's own sky. */
const HORIZON = [0.87, 0.92, 0.95];

export class Stage {
  /** @param {Scene} scene */
  constructor(scene) {
    this.scene = scene;
    this.facts = null;
    /** The shapes that were looked at for a plane without end, and whether there is one. */
    this.surveyed = null;
    this.endless = false;
  }

  /** Takes what the files say, or null for nothing. */
  take(facts) {
    this.facts = facts;
    this.scene.version += 1;
    this.scene.looks += 1;
  }

  /** Whether there are lights of files, which are then those of the picture. */
  get lit() {
    return this.facts !== null && (this.facts.lights.length > 0 || this.facts.headlight !== null);
  }

  /** The texture of the sky; undefined for the sky of the window. */
  get sky() {
    return this.facts === null ? undefined : this.scene.textures.get(this.facts.sky);
  }

  /** Colour of the horizon. */
  get haze() {
    return this.sky === undefined ? HORIZON : this.facts.haze;
  }

  /**
   * Whether there is a haze at the horizon: always under the sky of the window, and under that of a file if a plane
   * goes on without end, as in MuJoCo.
   */
  get hazy() {
    if (this.sky === undefined) return true;
    const { groups } = this.scene;
    if (groups !== this.surveyed) {
      this.surveyed = groups;
      this.endless = groups.some(({ mesh, members }) => isFlat(mesh) && members.some(({ shape }) => isEndless(mesh, shape)));
    }
    return this.endless;
  }

  /** Whether a light moves with a body. */
  get moves() {
    const isMoving = (body, link) => !!this.scene.bodies.get(body)?.links[link]?.moves;
    return this.lit && this.facts.lights.some(({ body, link, target }) => isMoving(body, link) || (target && isMoving(...target)));
  }

  /**
   * Pose in the world of something on a link, turned to its target if it has one.
   *
   * @param {{body: number, link: number, position: number[], orientation?: number[], target?: [number, number]}} thing
   * @param {number[]} ahead direction in its own frame that is turned to the target
   */
  place({ body, link, position, orientation = [0, 0, 0, 1], target }, ahead) {
    const on = body < 0 ? { position: [0, 0, 0], orientation: [0, 0, 0, 1] } : this.scene.linkPose(body, link);
    if (!on || (body >= 0 && this.scene.hidden.has(body))) return null;
    const pose = composed(on, { position, orientation });
    const aimed = target && this.scene.inertialPose(...target);
    const direction = aimed ? unit(subtract(aimed.position, pose.position)) : turned(pose.orientation, ahead);
    return { ...pose, direction, aimed: !!aimed };
  }

  /** The lights in the world, the one whose shadows are drawn first. */
  get lights() {
    const found = [];
    for (const light of this.facts.lights) {
      const at = this.place(light, light.direction);
      if (at) found.push({ ...light, at: at.position, along: at.direction, power: light.diffuse[0] + light.diffuse[1] + light.diffuse[2] });
    }
    return found.sort((a, b) => Number(b.shadow) - Number(a.shadow) || b.power - a.power).slice(0, LIGHTS - 1);
  }

  /**
   * Uniforms of the lights, and where the light whose shadows are drawn comes from.
   *
   * @param {Camera} camera
   */
  shading(camera) {
    const lights = this.lights;
    const { headlight } = this.facts;
    const ambient = [headlight, ...lights].reduce((sum, light) => (light ? add(sum, light.ambient) : sum), [0, 0, 0]);
    const rows = lights.map((light) => lightRow(light));
    // The first light may be in shadow: without one that casts any there is a dark one.
    const first = lights[0];
    const shadow = !!first?.shadow;
    if (!shadow) rows.unshift(lightRow({ directional: true, along: [0, 0, -1], diffuse: [0, 0, 0], specular: [0, 0, 0] }));
    if (headlight) rows.push(lightRow({ ...headlight, directional: true, along: camera.forward }));
    const numbers = new Float32Array(LIGHTS * LIGHT_VECTORS * 4);
    rows.slice(0, LIGHTS).forEach((row, i) => numbers.set(row, i * LIGHT_VECTORS * 4));
    const towards = !shadow ? [0, 0, 1] : first.directional ? scale(first.along, -1) : unit(subtract(first.at, camera.centre));
    return {
      shadow,
      towards,
      uniforms: { "stageLights[0]": new Vectors(numbers), stageCount: Math.min(rows.length, LIGHTS), stageAmbient: ambient, stageHaze: this.haze },
    };
  }

  /** Height and share of the light of a level plane that mirrors what is above it; null if there is none. */
  get mirror() {
    if (this.facts === null) return null;
    let found = null;
    for (const body of this.scene.bodies.values()) {
      for (const shape of body.shapes) {
        if (!shape.reflectance || body.links[shape.link].moves || this.scene.hidden.has(body.body)) continue;
        const link = this.scene.inertialPose(body.body, shape.link);
        if (!link) continue;
        const { position, orientation } = composed(link, shape);
        if (turned(orientation, [0, 0, 1])[2] > LEVEL && !(found?.share >= shape.reflectance)) found = { height: position[2], share: shape.reflectance };
      }
    }
    return found;
  }

  /**
   * Adds the cameras as small frusta.
   *
   * @param {Lines} lines
   */
  addCameras(lines, reach) {
    for (const camera of this.facts?.cameras ?? []) {
      const at = this.place(camera, [0, 0, -1]);
      if (!at) continue;
      const far = FRUSTUM * reach;
      const { right, up } = frameOf(at);
      const high = far * Math.tan((camera.angle * Math.PI) / 360);
      const middle = add(at.position, scale(at.direction, far));
      const corner = (x, y) => add(middle, add(scale(right, x * high * camera.aspect), scale(up, y * high)));
      const corners = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
      corners.forEach((each, i) => {
        lines.line(at.position, each, CAMERA, 2);
        lines.line(each, corners[(i + 1) % 4], CAMERA, 2);
      });
      const tip = add(middle, scale(up, 1.5 * high));
      for (const each of [corners[2], corners[3]]) lines.line(each, tip, CAMERA, 2);
    }
  }
}

const isFlat = ({ bounds: { lower, upper } }) => upper[2] - lower[2] < 1e-6;
const isEndless = ({ bounds: { lower, upper } }, { scale: [x, y] }) => Math.min((upper[0] - lower[0]) * x, (upper[1] - lower[1]) * y) >= ENDLESS;

/** The numbers of a light for the shaders. */
function lightRow({ directional, at = [0, 0, 0], along, cutoff = 180, exponent = 0, attenuation = [1, 0, 0], diffuse, specular }) {
  const edge = cutoff >= 90 ? -2 : Math.cos((cutoff * Math.PI) / 180);
  const place = directional ? [...scale(along, -1), 0] : [...at, 1];
  return [...place, ...along, edge, ...attenuation, cutoff >= 90 ? 0 : exponent, ...diffuse, 0, ...specular, 0];
}
