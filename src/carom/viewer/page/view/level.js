// One level of detail of a group: the shapes drawn as instances of the same mesh.

/** Numbers per instance on the GPU: three scaled axes, origin, colour, specular colour. */
export const INSTANCE_FLOATS = 19;
const INSTANCE_ATTRIBUTES = [3, 3, 3, 3, 4, 3];
const FIRST_INSTANCE_ATTRIBUTE = 3;

export class Level {
  constructor(gl, mesh, reach) {
    this.gl = gl;
    this.mesh = mesh;
    this.reach = reach;
    this.data = new Float32Array(0);
    this.count = 0;
    this.buffer = gl.createBuffer();
    this.solid = this.vertexArray(mesh.vertexBuffer, mesh.indexBuffer, 1, 1);
    this.wire = null;
  }

  /**
   * Makes a vertex array of the vertices, elements and instances.
   *
   * @param {number} copies number of copies of the mesh in its buffer: all positions, then all normals, then
   *   all texture coordinates
   * @param {number} divisor 1: instance attributes advance per instance; 0: per vertex
   */
  vertexArray(vertices, elements, copies, divisor) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, vertices);
    const vertex = [
      [3, 0],
      [3, this.mesh.normalsAt],
      [2, this.mesh.uvsAt],
    ];
    vertex.forEach(([size, at], place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, at * copies);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    let at = 0;
    INSTANCE_ATTRIBUTES.forEach((size, index) => {
      const place = FIRST_INSTANCE_ATTRIBUTE + index;
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, INSTANCE_FLOATS * 4, at);
      gl.vertexAttribDivisor(place, divisor);
      at += size * 4;
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
    gl.bindVertexArray(null);
    return array;
  }

  draw() {
    const gl = this.gl;
    gl.bindVertexArray(this.solid);
    gl.drawElementsInstanced(gl.TRIANGLES, this.mesh.indices.length, gl.UNSIGNED_INT, 0, this.count);
  }

  drawEdges() {
    const { gl, mesh } = this;
    this.wire ??= this.vertexArray(mesh.vertexBuffer, mesh.edgeBuffer, 1, 1);
    gl.bindVertexArray(this.wire);
    gl.drawElementsInstanced(gl.LINES, mesh.edges.length, gl.UNSIGNED_INT, 0, this.count);
  }

  begin(room) {
    if (this.data.length < room * INSTANCE_FLOATS) this.data = new Float32Array(room * INSTANCE_FLOATS);
    this.count = 0;
  }

  /**
   * Adds an instance. Called for each shape in each picture, so it allocates no arrays.
   *
   * @param {Float32Array} poses poses of inertial frames
   * @param {number} at index of the link's pose in `poses`
   */
  push(poses, at, { position, orientation, scale, specular }, colour) {
    const data = this.data;
    const to = this.count * INSTANCE_FLOATS;
    const ax = poses[at + 3];
    const ay = poses[at + 4];
    const az = poses[at + 5];
    const aw = poses[at + 6];
    const bx = orientation[0];
    const by = orientation[1];
    const bz = orientation[2];
    const bw = orientation[3];
    // Orientation of the link times that of the shape in the link.
    const x = aw * bx + ax * bw + ay * bz - az * by;
    const y = aw * by - ax * bz + ay * bw + az * bx;
    const z = aw * bz + ax * by - ay * bx + az * bw;
    const w = aw * bw - ax * bx - ay * by - az * bz;
    const sx = 2 * scale[0];
    const sy = 2 * scale[1];
    const sz = 2 * scale[2];
    data[to] = sx * (0.5 - y * y - z * z);
    data[to + 1] = sx * (x * y + w * z);
    data[to + 2] = sx * (x * z - w * y);
    data[to + 3] = sy * (x * y - w * z);
    data[to + 4] = sy * (0.5 - x * x - z * z);
    data[to + 5] = sy * (y * z + w * x);
    data[to + 6] = sz * (x * z + w * y);
    data[to + 7] = sz * (y * z - w * x);
    data[to + 8] = sz * (0.5 - x * x - y * y);
    const px = position[0];
    const py = position[1];
    const pz = position[2];
    const tx = 2 * (ay * pz - az * py);
    const ty = 2 * (az * px - ax * pz);
    const tz = 2 * (ax * py - ay * px);
    data[to + 9] = poses[at] + px + aw * tx + ay * tz - az * ty;
    data[to + 10] = poses[at + 1] + py + aw * ty + az * tx - ax * tz;
    data[to + 11] = poses[at + 2] + pz + aw * tz + ax * ty - ay * tx;
    for (let i = 0; i < 4; i++) data[to + 12 + i] = colour[i] ?? 1;
    for (let i = 0; i < 3; i++) data[to + 16 + i] = specular[i];
    this.count += 1;
  }

  /** Uploads the instances to the GPU. */
  end() {
    if (this.count > 0) this.upload(this.data.subarray(0, this.count * INSTANCE_FLOATS));
  }

  upload(numbers) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
  }

  /** Origin of the first instance. */
  origin() {
    return [...this.data.subarray(9, 12)];
  }

  dispose() {
    this.gl.deleteBuffer(this.buffer);
    this.gl.deleteVertexArray(this.solid);
    this.gl.deleteVertexArray(this.wire);
  }
}
