// Lines on the GPU: all lines of a picture in one buffer, each as a rectangle with four corners.

import { LINE_FLOATS } from "./lines.js";

const CORNERS = 4;
/** Corners of the two triangles of a line's rectangle. */
const TRIANGLES = [0, 1, 2, 2, 1, 3];
const ATTRIBUTES = [3, 3, 3, 1];

export class LineBatch {
  constructor(gl) {
    this.gl = gl;
    this.buffer = gl.createBuffer();
    this.elements = gl.createBuffer();
    this.wide = new Float32Array(0);
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.elements);
    let at = 0;
    ATTRIBUTES.forEach((size, place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, LINE_FLOATS * 4, at);
      at += size * 4;
    });
    gl.bindVertexArray(null);
  }

  /** Draws the first `count` lines with the current program; lines inside bodies are drawn without a depth test. */
  draw({ used: numbers, outside }, count) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    if (this.wide.length < count * LINE_FLOATS * CORNERS) this.makeRoom(2 * count);
    let to = 0;
    for (let from = 0; from < count * LINE_FLOATS; from += LINE_FLOATS) {
      for (let corner = 0; corner < CORNERS; corner++) {
        for (let i = 0; i < LINE_FLOATS; i++) this.wide[to++] = numbers[from + i];
      }
    }
    gl.bufferData(gl.ARRAY_BUFFER, this.wide.subarray(0, to), gl.DYNAMIC_DRAW);
    if (outside > 0) this.drawPart(0, outside);
    if (outside === count) return;
    gl.disable(gl.DEPTH_TEST);
    this.drawPart(outside, count);
    gl.enable(gl.DEPTH_TEST);
  }

  drawPart(from, to) {
    const [first, length] = [from * TRIANGLES.length, (to - from) * TRIANGLES.length];
    this.gl.drawElements(this.gl.TRIANGLES, length, this.gl.UNSIGNED_INT, first * Uint32Array.BYTES_PER_ELEMENT);
  }

  makeRoom(lines) {
    const gl = this.gl;
    this.wide = new Float32Array(lines * CORNERS * LINE_FLOATS);
    const elements = new Uint32Array(lines * TRIANGLES.length);
    for (let i = 0; i < elements.length; i++) {
      elements[i] = Math.floor(i / TRIANGLES.length) * CORNERS + TRIANGLES[i % TRIANGLES.length];
    }
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, elements, gl.STATIC_DRAW);
  }
}
