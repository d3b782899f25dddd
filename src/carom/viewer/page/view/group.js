// Shapes that look alike, drawn at once as instances of a mesh.

/** Numbers per instance on the graphics card: three axes, origin, colour, colour of highlights. */
const INSTANCE_FLOATS = 19;
const INSTANCE_ATTRIBUTES = [3, 3, 3, 3, 4, 3];
const FIRST_INSTANCE_ATTRIBUTE = 3;

export class Group {
  /**
   * @param {{mesh: Mesh, reach: number}[]} levels meshes, the finest first, and up to what radius in pixels
   *   each looks right
   * @param {object} shape one of the shapes
   * @param {boolean} clear whether they can be seen through
   */
  constructor(gl, levels, shape, clear) {
    this.gl = gl;
    this.levels = levels.map(({ mesh, reach }) => new Level(gl, mesh, reach));
    this.texture = shape.texture;
    this.twoSided = shape.twoSided;
    this.collision = !!shape.collision;
    this.clear = clear;
    this.members = [];
    this.filledFor = "";
    /** Somewhere among the instances, to sort by. */
    this.middle = [0, 0, 0];
  }

  /** The mesh that is looked at from near by. */
  get mesh() {
    return this.levels[0].mesh;
  }

  get instances() {
    return this.levels.reduce((sum, level) => sum + level.count, 0);
  }

  add(body, shape) {
    this.members.push({ body, shape, radius: this.mesh.radius * Math.max(...shape.scale.map(Math.abs)) });
  }

  /** Puts the instances where their links are; see `Scene.fill`. */
  fill(scene, options, eye, focal) {
    const [levels, several] = [this.levels, this.levels.length > 1];
    // Where there is one mesh it does not matter who looks.
    const filledFor = [scene.version, options.wireframe, options.version, ...(several ? [...eye, focal] : [])].join();
    if (this.filledFor === filledFor) return;
    this.filledFor = filledFor;
    for (const level of levels) level.begin(this.members.length);
    for (const { body, shape, radius } of this.members) {
      const at = scene.poseAt(body.body, shape.link);
      if (at < 0) continue;
      let level = 0;
      if (several) {
        const distance = Math.hypot(scene.poses[at] - eye[0], scene.poses[at + 1] - eye[1], scene.poses[at + 2] - eye[2]);
        const pixels = (focal * radius) / Math.max(distance - radius, 1e-6);
        while (level + 1 < levels.length && pixels <= levels[level + 1].reach) level++;
      }
      const colour = (options.wireframe && options.wireColour(body.body, shape.link)) || shape.rgba;
      levels[level].push(scene.poses, at, shape, colour);
    }
    for (const level of levels) level.end();
    this.middle = (levels.find((level) => level.count) ?? levels[0]).origin();
  }

  /** Draws the triangles of all instances. */
  draw() {
    const gl = this.gl;
    for (const { mesh, count, solid } of this.levels) {
      if (count === 0) continue;
      gl.bindVertexArray(solid);
      gl.drawElementsInstanced(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0, count);
    }
  }

  /** Draws the edges of all instances. */
  drawEdges() {
    const gl = this.gl;
    for (const level of this.levels) {
      if (level.count === 0) continue;
      gl.bindVertexArray(level.outline());
      gl.drawElementsInstanced(gl.LINES, level.mesh.edgeCount, gl.UNSIGNED_INT, 0, level.count);
    }
  }

  dispose() {
    for (const level of this.levels) level.dispose();
  }
}

/** The instances that are drawn with the same mesh. */
class Level {
  constructor(gl, mesh, reach) {
    this.gl = gl;
    this.mesh = mesh;
    this.reach = reach;
    this.data = new Float32Array(0);
    this.count = 0;
    this.buffer = gl.createBuffer();
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
    INSTANCE_ATTRIBUTES.forEach((size, index) => {
      const place = FIRST_INSTANCE_ATTRIBUTE + index;
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

  begin(room) {
    if (this.data.length < room * INSTANCE_FLOATS) this.data = new Float32Array(room * INSTANCE_FLOATS);
    this.count = 0;
  }

  /**
   * Adds an instance. Runs for each shape in each picture, so it makes no arrays.
   *
   * @param {Float32Array} poses poses of inertial frames
   * @param {number} at where that of the link is
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
    // The shape is turned by its own orientation, then by that of the link.
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

  /** Brings the instances to the graphics card. */
  end() {
    const gl = this.gl;
    if (this.count === 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.data.subarray(0, this.count * INSTANCE_FLOATS), gl.DYNAMIC_DRAW);
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
