// What there is: bodies, their shapes, and where their links are.

import { composed, turned } from "./maths.js";
import { Mesh, imageTexture } from "./gpu.js";

const IDENTITY = { position: [0, 0, 0], orientation: [0, 0, 0, 1] };
/** Numbers per instance on the graphics card: three axes, origin, colour, colour of highlights. */
export const INSTANCE_FLOATS = 19;

export class Scene {
  constructor(gl) {
    this.gl = gl;
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
    this.layout = { layout: 0, bodies: [] };
    this.groups = [];
    this.stale = true;
    this.version = 0;
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
    this.textures.set(header.texture, imageTexture(this.gl, header, payload));
  }

  removeTexture({ texture }) {
    this.gl.deleteTexture(this.textures.get(texture) ?? null);
    this.textures.delete(texture);
  }

  addBody(header) {
    const poses = this.bodies.get(header.body)?.poses ?? [];
    this.bodies.set(header.body, { ...header, poses });
    this.stale = true;
  }

  removeBody({ body }) {
    this.bodies.delete(body);
    this.stale = true;
  }

  /** Takes over where all links are; a frame that was made for other bodies is left alone. */
  place({ layout }, payload) {
    if (layout !== this.layout.layout) return false;
    const numbers = new Float32Array(payload);
    let at = 0;
    for (const [number, links] of this.layout.bodies) {
      const body = this.bodies.get(number);
      for (let link = 0; link < links; link++, at += 7) {
        if (!body) continue;
        const [x, y, z, a, b, c, d] = numbers.subarray(at, at + 7);
        body.poses[link] = { position: [x, y, z], orientation: [a, b, c, d] };
      }
    }
    this.version += 1;
    return true;
  }

  /** Pose of the inertial frame of a link; 0 is the base. The world's for body -1. */
  inertialPose(body, link) {
    if (body < 0) return IDENTITY;
    return this.bodies.get(body)?.poses[link] ?? null;
  }

  /** Pose of a link frame. */
  linkPose(body, link) {
    const pose = this.inertialPose(body, link);
    if (body < 0 || pose === null) return pose;
    return composed(pose, this.bodies.get(body).links[link]);
  }

  /** Shapes that look alike, to be drawn at once. */
  regroup() {
    if (!this.stale) return;
    this.stale = false;
    for (const group of this.groups) group.dispose();
    const groups = new Map();
    for (const body of this.bodies.values()) {
      for (const shape of body.shapes) {
        const mesh = this.meshes.get(shape.mesh);
        if (!mesh || mesh.count === 0 || shape.rgba[3] <= 0) continue;
        const clear = shape.rgba[3] < 1;
        // Shapes that are seen through are drawn one by one, from the back to the front.
        const key = [shape.mesh, shape.texture, shape.twoSided, !!shape.collision, clear && groups.size].join();
        if (!groups.has(key)) groups.set(key, new Group(this.gl, mesh, shape, clear));
        groups.get(key).members.push({ body, shape });
      }
    }
    this.groups = [...groups.values()];
    this.version += 1;
  }

  /** Brings the instances of all groups up to date. */
  fill(options) {
    for (const group of this.groups) group.fill(this.version, options);
  }
}

class Group {
  constructor(gl, mesh, shape, clear) {
    this.gl = gl;
    this.mesh = mesh;
    this.texture = shape.texture;
    this.twoSided = shape.twoSided;
    this.collision = !!shape.collision;
    this.clear = clear;
    this.members = [];
    this.buffer = gl.createBuffer();
    this.version = -1;
    this.solid = this.vertexArray(mesh.indexBuffer);
    this.wire = null;
  }

  vertexArray(elements) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.mesh.vertexBuffer);
    const vertex = [
      [3, 0],
      [3, this.mesh.normalsAt],
      [2, this.mesh.uvsAt],
    ];
    vertex.forEach(([size, at], place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, at);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    let at = 0;
    [3, 3, 3, 3, 4, 3].forEach((size, index) => {
      const place = 3 + index;
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, INSTANCE_FLOATS * 4, at);
      gl.vertexAttribDivisor(place, 1);
      at += size * 4;
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
    gl.bindVertexArray(null);
    return array;
  }

  /** The edges, to be drawn as lines. */
  outline() {
    this.wire ??= this.vertexArray(this.mesh.edges());
    return this.wire;
  }

  fill(version, options) {
    if (this.version === version && this.wires === options.wireframe && this.colours === options.colours) return;
    [this.version, this.wires, this.colours] = [version, options.wireframe, options.colours];
    const data = new Float32Array(this.members.length * INSTANCE_FLOATS);
    let count = 0;
    this.middle = [0, 0, 0];
    for (const { body, shape } of this.members) {
      const pose = body.poses[shape.link];
      if (!pose) continue;
      const { position, orientation } = composed(pose, shape);
      this.middle = position;
      const [sx, sy, sz] = shape.scale;
      data.set(turned(orientation, [sx, 0, 0]), count);
      data.set(turned(orientation, [0, sy, 0]), count + 3);
      data.set(turned(orientation, [0, 0, sz]), count + 6);
      data.set(position, count + 9);
      data.set(shape.rgba, count + 12);
      const wireColour = options.wireframe && options.wireColour(body.body, shape.link);
      if (wireColour) data.set(wireColour, count + 12);
      data.set(shape.specular, count + 16);
      count += INSTANCE_FLOATS;
    }
    this.instances = count / INSTANCE_FLOATS;
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  }

  dispose() {
    this.gl.deleteBuffer(this.buffer);
    this.gl.deleteVertexArray(this.solid);
    this.gl.deleteVertexArray(this.wire);
  }
}
