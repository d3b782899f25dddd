// Solid arrows, rods and cones on the GPU: one mesh, drawn as instances, over everything else.

import { Program } from "../gpu.js";
import { SOLID_FLOATS } from "./solids.js";

const SIDES = 14;
/** Sizes and places of the attributes: start, vector, colour, and the three sizes. */
const ATTRIBUTES = [3, 3, 4, 3];

/**
 * A vertex has its number around (0 to 1), and its ring: centre and rim of the shaft's start, its end, the
 * head's centre and rim, and the tip. The normal of a flat ring is along the arrow.
 */
const SOLID = {
  vertex: `#version 300 es
layout(location = 0) in vec3 start;
layout(location = 1) in vec3 vector;
layout(location = 2) in vec4 tint;
layout(location = 3) in vec3 sizes;
layout(location = 4) in vec3 place;
uniform mat4 camera;
uniform vec3 eye;
out vec4 colour;
out vec3 normal;
out vec3 toEye;
void main() {
  float size = length(vector);
  vec3 along = vector / max(size, 1e-12);
  vec3 side = normalize(cross(along, abs(along.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
  float angle = 6.2831853 * place.x;
  vec3 outward = cos(angle) * side + sin(angle) * cross(along, side);
  float neck = size - sizes.z;
  // Rings: 0 centre, 1 rim and 2 end of the shaft, 3 rim of the head, 4 tip.
  float radius = place.y < 0.5 || place.y > 3.5 ? 0.0 : place.y < 2.5 ? sizes.x : sizes.y;
  float height = place.y < 1.5 ? 0.0 : place.y > 3.5 ? size : neck;
  vec3 slanted = normalize(outward * max(sizes.z, 1e-9) + along * sizes.y);
  normal = place.z < 0.5 ? -along : place.z < 1.5 ? outward : slanted;
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
  constructor(gl) {
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
    const mesh = triangles();
    this.corners = mesh.length / 3;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, mesh, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(ATTRIBUTES.length);
    gl.vertexAttribPointer(ATTRIBUTES.length, 3, gl.FLOAT, false, 0, 0);
    gl.bindVertexArray(null);
  }

  /** Draws solids over the picture: they hide each other, and nothing hides them. */
  draw(solids, camera) {
    if (solids.count === 0) return;
    const gl = this.gl;
    this.program.use({ camera: camera.matrix, eye: camera.eye });
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, solids.used, gl.DYNAMIC_DRAW);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, this.corners, solids.opaque);
    const clouded = solids.count - solids.opaque;
    if (clouded === 0) return;
    // What is left of the buffer: instances cannot begin at another one in WebGL.
    gl.bufferData(gl.ARRAY_BUFFER, solids.used.subarray(solids.opaque * SOLID_FLOATS), gl.DYNAMIC_DRAW);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, this.corners, clouded);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}

/** The triangles of the mesh: share of the turn, ring, and kind of normal (0 flat, 1 outward, 2 slanted). */
function triangles() {
  const numbers = [];
  for (let i = 0; i < SIDES; i++) {
    const [a, b] = [i / SIDES, (i + 1) / SIDES];
    const strips = [[0, 1, 0], [1, 2, 1], [2, 3, 0], [3, 4, 2]];
    for (const [from, to, kind] of strips) {
      numbers.push(a, from, kind, b, from, kind, b, to, kind, a, from, kind, b, to, kind, a, to, kind);
    }
  }
  return new Float32Array(numbers);
}
