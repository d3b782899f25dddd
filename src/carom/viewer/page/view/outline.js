// The outline of the selected body: its silhouette is drawn into a mask, and the pixels around it are coloured. It is
// seen through what is in front of the body.

import { boundsOfBody } from "./bounds.js";
import { Picture, Program } from "./gpu.js";
import { Group } from "./group.js";

const COLOUR = [1, 0.55, 0.05];
/** Width of the outline [pixels of the page], and its least width [pixels of the canvas]. */
const WIDTH = 2.5;
const MIN_WIDTH = 1.5;
const SELECTED = { wireframe: false, linkColours: false, version: 0 };

const EDGE = {
  vertex: `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`,
  fragment: `#version 300 es
precision mediump float;
uniform sampler2D mask;
uniform vec2 texel;
uniform vec2 corner;
uniform vec3 colour;
out vec4 result;
float at(float x, float y) { return texture(mask, (gl_FragCoord.xy - corner + vec2(x, y)) * texel).a; }
void main() {
  float inside = at(0.0, 0.0);
  if (inside > 0.99) discard;
  float w = WIDTH, d = 0.7 * WIDTH;
  float straight = max(max(at(w, 0.0), at(-w, 0.0)), max(at(0.0, w), at(0.0, -w)));
  float slanted = max(max(at(d, d), at(-d, d)), max(at(d, -d), at(-d, -d)));
  result = vec4(colour, max(straight, slanted) * (1.0 - inside));
}`,
};

export class Outline {
  /** @param {Program} fill draws surfaces with an opacity of 1 */
  constructor(gl, fill) {
    this.gl = gl;
    this.fill = fill;
    this.mask = new Picture(gl);
    this.edges = new Map();
    this.nothing = gl.createVertexArray();
    this.groups = [];
    this.collected = [];
  }

  /**
   * Draws the outline of a body, if there is one.
   *
   * @param {{target: ?WebGLFramebuffer, x: number, y: number, width: number, height: number}} into where the view is drawn [drawn pixels]
   */
  draw(scene, camera, options, body, into) {
    const { gl } = this;
    this.collect(scene, options, scene.hidden.has(body?.body) ? undefined : body);
    if (this.groups.length === 0) return;
    const { target, x, y, width, height } = into;
    const ratio = width / camera.width;
    const thick = Math.max(MIN_WIDTH, WIDTH * ratio);
    const area = areaOf(boundsOfBody(scene, body, options.collisions), camera, ratio, thick);
    if (area) {
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(area.left, height - area.bottom, area.width, area.height);
    }
    this.mask.begin(width, height);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.fill.use({ camera: camera.matrix });
    for (const group of this.groups) {
      group.fill(scene, SELECTED, camera.eye, height / 2);
      group.draw();
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(x, y, width, height);
    // The mask is clean only in its part: what is drawn keeps so far from its edge as the outline looks around.
    const inset = Math.ceil(thick);
    if (area) gl.scissor(x + area.left + inset, y + height - area.bottom + inset, Math.max(0, area.width - 2 * inset), Math.max(0, area.height - 2 * inset));
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.mask.texture);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindVertexArray(this.nothing);
    this.edge(thick).use({ texel: [1 / width, 1 / height], corner: [x, y], colour: COLOUR });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.BLEND);
    gl.disable(gl.SCISSOR_TEST);
  }

  /** The program for a width of the outline, in tenths of a pixel. */
  edge(thick) {
    const width = thick.toFixed(1);
    if (!this.edges.has(width)) {
      const program = new Program(this.gl, { ...EDGE, fragment: EDGE.fragment.replaceAll("WIDTH", width) });
      program.sampler("mask", 0);
      this.edges.set(width, program);
    }
    return this.edges.get(width);
  }

  /** Collects the shapes of the body, when it or the scene's shapes have changed. */
  collect(scene, options, body) {
    const collected = [scene.groups, body, options.shownGroups];
    if (collected.every((each, i) => each === this.collected[i])) return;
    this.collected = collected;
    for (const group of this.groups) group.dispose();
    const shown = (body?.shapes ?? []).filter((shape) => options.shows(shape) && shape.rgba[3] > 0);
    this.groups = shown.flatMap((shape) => {
      const levels = scene.levelsOf(shape);
      if (!levels) return [];
      const group = new Group(this.gl, levels, shape, false, false);
      group.add(body, shape);
      return [group];
    });
  }
}

/** The part of the view in which a box and its outline are; null if it is not known. */
function areaOf(bounds, camera, ratio, thick) {
  if (!bounds) return null;
  const corners = [...Array(8).keys()].map((bits) => camera.pixel([0, 1, 2].map((i) => bounds[(bits >> i) & 1][i])));
  if (corners.includes(null)) return null;
  const [xs, ys] = [camera.left, camera.top].map((start, i) => corners.map((pixel) => (pixel[i] - start) * ratio));
  const margin = Math.ceil(2 * thick) + 1;
  const [left, top] = [xs, ys].map((values) => Math.floor(Math.min(...values)) - margin);
  const [right, bottom] = [xs, ys].map((values) => Math.ceil(Math.max(...values)) + margin);
  return { left, bottom, width: right - left, height: bottom - top };
}
