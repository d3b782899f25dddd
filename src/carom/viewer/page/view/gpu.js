// Shader programs, meshes and render targets on the GPU.

/** Vectors of four numbers, for a uniform that is an array of them. */
export class Vectors {
  /** @param {Float32Array} numbers */
  constructor(numbers) {
    this.numbers = numbers;
  }
}

export class Program {
  constructor(gl, { vertex, fragment }) {
    this.gl = gl;
    this.program = gl.createProgram();
    for (const [kind, source] of [
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
    this.places = new Map();
  }

  /** Makes the program the current one and sets its uniforms: numbers, arrays of 2, 3 or 16 numbers, or `Vectors`. */
  use(uniforms) {
    this.gl.useProgram(this.program);
    for (const [name, value] of Object.entries(uniforms)) this.set(name, value);
  }

  set(name, value) {
    const gl = this.gl;
    if (!this.places.has(name)) this.places.set(name, gl.getUniformLocation(this.program, name));
    const place = this.places.get(name);
    if (place === null) return;
    if (typeof value === "number") gl.uniform1f(place, value);
    else if (value instanceof Vectors) gl.uniform4fv(place, value.numbers);
    else if (value.length === 2) gl.uniform2fv(place, value);
    else if (value.length === 3) gl.uniform3fv(place, value);
    else gl.uniformMatrix4fv(place, false, value);
  }

  sampler(name, unit) {
    this.use({});
    this.gl.uniform1i(this.gl.getUniformLocation(this.program, name), unit);
  }
}

/** A triangle mesh; its edges are computed when they are first drawn. */
export class Mesh {
  constructor(gl, { vertices, triangles }, payload) {
    this.gl = gl;
    this.vertexCount = vertices;
    this.floats = new Float32Array(payload, 0, vertices * 8);
    this.positions = this.floats.subarray(0, vertices * 3);
    this.indices = new Uint32Array(payload, vertices * 32, triangles * 3);
    this.vertexBuffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertexBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.floats, gl.STATIC_DRAW);
    this.normalsAt = vertices * 12;
    this.uvsAt = vertices * 24;
    this.indexBuffer = this.elements(this.indices);
    this.ownEdges = null;
    this.ownEdgeBuffer = null;
    this.bounds = boundsOf(this.positions);
    /** Radius of the bounding sphere about the origin. */
    this.radius = radiusOf(this.positions);
  }

  elements(indices) {
    const gl = this.gl;
    const buffer = gl.createBuffer();
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    return buffer;
  }

  /** Positions, normals and texture coordinates of all vertices. */
  get parts() {
    const { floats, vertexCount: count } = this;
    return [this.positions, floats.subarray(count * 3, count * 6), floats.subarray(count * 6)];
  }

  /** Indices of the two vertices of each edge. */
  get edges() {
    return (this.ownEdges ??= distinctEdges(this.positions, this.indices));
  }

  get edgeBuffer() {
    return (this.ownEdgeBuffer ??= this.elements(this.edges));
  }

  dispose() {
    for (const buffer of [this.vertexBuffer, this.indexBuffer, this.ownEdgeBuffer]) this.gl.deleteBuffer(buffer);
  }
}

function boundsOf(positions) {
  const lower = [Infinity, Infinity, Infinity];
  const upper = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    lower[i % 3] = Math.min(lower[i % 3], positions[i]);
    upper[i % 3] = Math.max(upper[i % 3], positions[i]);
  }
  return { lower, upper };
}

function radiusOf(positions) {
  let radius = 0;
  for (let i = 0; i < positions.length; i += 3) {
    radius = Math.max(radius, Math.hypot(positions[i], positions[i + 1], positions[i + 2]));
  }
  return radius;
}

/** Edges of triangles, without those inside a flat face. */
function distinctEdges(positions, indices) {
  const names = new Map();
  const same = new Uint32Array(positions.length / 3);
  for (let i = 0; i < same.length; i++) {
    const name = `${positions[3 * i]},${positions[3 * i + 1]},${positions[3 * i + 2]}`;
    if (!names.has(name)) names.set(name, i);
    same[i] = names.get(name);
  }
  const edges = new Map();
  for (let t = 0; t < indices.length; t += 3) {
    const corners = [same[indices[t]], same[indices[t + 1]], same[indices[t + 2]]];
    const normal = faceNormal(positions, corners);
    for (let i = 0; i < 3; i++) {
      const [a, b] = [corners[i], corners[(i + 1) % 3]].sort((p, q) => p - q);
      const known = edges.get(a * same.length + b);
      if (known === undefined) edges.set(a * same.length + b, { a, b, normal, flat: false });
      else known.flat = normal.every((value, axis) => Math.abs(value - known.normal[axis]) < 1e-3);
    }
  }
  return new Uint32Array([...edges.values()].filter((edge) => !edge.flat).flatMap((edge) => [edge.a, edge.b]));
}

function faceNormal(positions, corners) {
  const [a, b, c] = corners;
  const side = (from, to, axis) => positions[3 * to + axis] - positions[3 * from + axis];
  const [ux, uy, uz] = [0, 1, 2].map((axis) => side(a, b, axis));
  const [vx, vy, vz] = [0, 1, 2].map((axis) => side(a, c, axis));
  const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const size = Math.hypot(...n) || 1;
  return n.map((value) => value / size);
}

/** A square depth texture, seen from the light, for shadows. */
export class ShadowMap {
  constructor(gl, size) {
    this.gl = gl;
    this.wanted = size;
    this.size = Math.min(size, gl.getParameter(gl.MAX_TEXTURE_SIZE), 8192);
    this.texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, this.size, this.size);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    }
    for (const edge of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
      gl.texParameteri(gl.TEXTURE_2D, edge, gl.CLAMP_TO_EDGE);
    }
    this.target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  dispose() {
    this.gl.deleteTexture(this.texture);
    this.gl.deleteFramebuffer(this.target);
  }
}

/** A picture that is rendered into a texture. */
export class Picture {
  constructor(gl) {
    this.gl = gl;
    this.width = 0;
    this.height = 0;
    this.texture = gl.createTexture();
    this.depth = gl.createRenderbuffer();
    this.target = gl.createFramebuffer();
  }

  /** Makes the picture the render target; depths are cleared if it is `fresh`. */
  begin(width, height, fresh = true) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    if (this.width !== width || this.height !== height) this.resize(width, height);
    gl.viewport(0, 0, width, height);
    if (fresh) gl.clear(gl.DEPTH_BUFFER_BIT);
  }

  resize(width, height) {
    const gl = this.gl;
    [this.width, this.height] = [width, height];
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    for (const edge of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, edge, gl.CLAMP_TO_EDGE);
    gl.bindTexture(gl.TEXTURE_2D, null);
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.texture, 0);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depth);
  }
}
