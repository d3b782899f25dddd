// Solid arrows, rods and cones on the GPU: one mesh, drawn as instances, over everything else.

import { Program } from "../gpu.js";
import { SOLID_FLOATS } from "./solids.js";

/** Corners of a ring; fewer if the CPU draws, for which each vertex of a hundred arrows takes time. */
const SIDES = 14;
const FEW_SIDES = 8;
/** Size of the place of a vertex on the mesh: cosine and sine of its angle, ring, and kind of normal. */
const PLACE = 4;
/** Sizes and places of the attributes: start, vector, colour, and the three sizes. */
const ATTRIBUTES = [3, 3, 4, 3];

/**
 * The rings of the mesh: centre and rim of the shaft's start, its end, the rim of the head, and the tip. The
 * normal of a flat ring is along the arrow.
 */
const SOLID = {
  vertex: `#version 300 es
layout(location = 0) in vec3 start;
layout(location = 1) in vec3 vector;
layout(location = 2) in vec4 tint;
layout(location = 3) in vec3 sizes;
layout(location = 4) in vec4 place;
uniform mat4 camera;
uniform vec3 eye;
out vec4 colour;
out vec3 normal;
out vec3 toEye;
void main() {
  float size = length(vector);
  vec3 along = vector / max(size, 1e-12);
  vec3 side = normalize(cross(along, abs(along.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
  vec3 outward = place.x * side + place.y * cross(along, side);
  float neck = size - sizes.z;
  // Rings: 0 centre, 1 rim and 2 end of the shaft, 3 rim of the head, 4 tip.
  float radius = place.z < 0.5 || place.z > 3.5 ? 0.0 : place.z < 2.5 ? sizes.x : sizes.y;
  float height = place.z < 1.5 ? 0.0 : place.z > 3.5 ? size : neck;
  vec3 slanted = normalize(outward * max(sizes.z, 1e-9) + along * sizes.y);
  normal = place.w < 0.5 ? -along : place.w < 1.5 ? outward : slanted;
  vec3 point = start + along * height + outward * radius;
  colour = tint;
  toEye = eye - point;
  gl_Position = camera * vec4(point, 1.0);
}`,
  fragment: `#version 300 es
precision mediump float;
in vec4 colour;
in vec3 normal;
in vec3 toEye;
out vec4 result;
void main() {
  float facing = abs(dot(normalize(normal), normalize(toEye)));
  result = vec4(colour.rgb * (0.55 + 0.5 * facing), colour.a);
}`,
};

export class SolidBatch {
  /** @param {boolean} byProcessor whether the CPU draws */
  constructor(gl, byProcessor) {
    this.gl = gl;
    this.program = new Program(gl, SOLID);
    this.buffer = gl.createBuffer();
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    let at = 0;
    ATTRIBUTES.forEach((size, place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, SOLID_FLOATS * 4, at);
      gl.vertexAttribDivisor(place, 1);
      at += size * 4;
    });
    const { places, indices } = ringMesh(byProcessor ? FEW_SIDES : SIDES);
    this.corners = indices.length;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, places, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(ATTRIBUTES.length);
    gl.vertexAttribPointer(ATTRIBUTES.length, PLACE, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
  }

  /**
   * Draws solids over the picture: they hide each other, and nothing hides them.
   *
   * @param {?number[]} window the part of the view that they are in, whose depths are lost; null for all of it
   */
  draw(solids, camera, window) {
    if (solids.count === 0) return;
    const gl = this.gl;
    this.program.use({ camera: camera.matrix, eye: camera.eye });
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, solids.used, gl.DYNAMIC_DRAW);
    if (window) gl.enable(gl.SCISSOR_TEST);
    if (window) gl.scissor(...window);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.SCISSOR_TEST);
    gl.drawElementsInstanced(gl.TRIANGLES, this.corners, gl.UNSIGNED_SHORT, 0, solids.opaque);
    const clouded = solids.count - solids.opaque;
    if (clouded === 0) return;
    // What is left of the buffer: instances cannot begin at another one in WebGL.
    gl.bufferData(gl.ARRAY_BUFFER, solids.used.subarray(solids.opaque * SOLID_FLOATS), gl.DYNAMIC_DRAW);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.drawElementsInstanced(gl.TRIANGLES, this.corners, gl.UNSIGNED_SHORT, 0, clouded);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}

/**
 * Vertices and triangles of the mesh: each strip from ring to ring has vertices of its own, for its normal (0
 * flat, 1 outward, 2 slanted).
 */
export function ringMesh(sides) {
  const [places, indices] = [[], []];
  for (const [from, to, kind] of [[0, 1, 0], [1, 2, 1], [2, 3, 0], [3, 4, 2]]) {
    const first = places.length / PLACE;
    for (let i = 0; i < sides; i++) {
      const angle = (2 * Math.PI * i) / sides;
      for (const ring of [from, to]) places.push(Math.cos(angle), Math.sin(angle), ring, kind);
      const [near, next] = [first + 2 * i, first + 2 * ((i + 1) % sides)];
      // At the centre, and at the tip, all vertices are one point.
      if (from !== 0) indices.push(near, next, near + 1);
      if (from === 0 || to !== 4) indices.push(next, next + 1, near + 1);
    }
  }
  return { places: new Float32Array(places), indices: new Uint16Array(indices) };
}
