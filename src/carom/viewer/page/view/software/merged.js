// Small shapes merged into one large mesh. If the CPU renders, each instance costs as much as a draw call of
// its own, far more than its few triangles.

import { INSTANCE_FLOATS, Level } from "../level.js";

/** Meshes with more vertices are drawn as instances: copying them would cost more than it saves. */
const MAX_VERTICES = 100;

export class Merged extends Level {
  static suits(mesh) {
    return mesh.vertexCount <= MAX_VERTICES;
  }

  constructor(gl, mesh, reach) {
    super(gl, mesh, reach);
    /** Number of copies of the mesh in the buffers. */
    this.copies = 0;
    this.buffers = [];
    this.wide = new Float32Array(0);
  }

  /** Copies the numbers of each instance to all its vertices, and uploads them. */
  end() {
    if (this.count === 0) return;
    if (this.count > this.copies) this.copyMesh(Math.max(this.count, 2 * this.copies));
    const { data, wide, count } = this;
    const vertices = this.mesh.vertexCount;
    let to = 0;
    for (let from = 0; from < count * INSTANCE_FLOATS; from += INSTANCE_FLOATS) {
      for (let vertex = 0; vertex < vertices; vertex++) {
        for (let i = 0; i < INSTANCE_FLOATS; i++) wide[to++] = data[from + i];
      }
    }
    this.upload(wide.subarray(0, to));
  }

  copyMesh(copies) {
    this.forgetCopies();
    const { mesh } = this;
    this.copies = copies;
    this.wide = new Float32Array(copies * mesh.vertexCount * INSTANCE_FLOATS);
    const vertices = new Float32Array(copies * mesh.floats.length);
    let to = 0;
    for (const part of mesh.parts) {
      for (let copy = 0; copy < copies; copy++, to += part.length) vertices.set(part, to);
    }
    this.vertices = this.bufferOf(this.gl.ARRAY_BUFFER, vertices);
    this.solid = this.vertexArray(this.vertices, this.elements(mesh.indices), copies, 0);
  }

  /** Index buffer of all copies. */
  elements(indices) {
    const all = new Uint32Array(this.copies * indices.length);
    for (let i = 0; i < all.length; i++) {
      all[i] = indices[i % indices.length] + Math.floor(i / indices.length) * this.mesh.vertexCount;
    }
    return this.bufferOf(this.gl.ELEMENT_ARRAY_BUFFER, all);
  }

  bufferOf(kind, numbers) {
    const gl = this.gl;
    const buffer = gl.createBuffer();
    gl.bindVertexArray(null);
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, numbers, gl.STATIC_DRAW);
    this.buffers.push(buffer);
    return buffer;
  }

  draw() {
    const gl = this.gl;
    gl.bindVertexArray(this.solid);
    gl.drawElements(gl.TRIANGLES, this.mesh.indices.length * this.count, gl.UNSIGNED_INT, 0);
  }

  drawEdges() {
    const { gl, mesh } = this;
    this.wire ??= this.vertexArray(this.vertices, this.elements(mesh.edges), this.copies, 0);
    gl.bindVertexArray(this.wire);
    gl.drawElements(gl.LINES, mesh.edges.length * this.count, gl.UNSIGNED_INT, 0);
  }

  forgetCopies() {
    const gl = this.gl;
    for (const buffer of this.buffers) gl.deleteBuffer(buffer);
    for (const array of [this.solid, this.wire]) gl.deleteVertexArray(array);
    [this.buffers, this.solid, this.wire] = [[], null, null];
  }

  dispose() {
    this.forgetCopies();
    super.dispose();
  }
}
