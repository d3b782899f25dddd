// Signs: texts with a fixed orientation in the world.

import { add, composed, scale, turned } from "./maths.js";

/** Height of a line of text of size 1 [m]. */
const LINE_HEIGHT = 0.1;
const PIXELS = 64;
const FONT = `600 ${Math.round(PIXELS * 0.75)}px system-ui, sans-serif`;

export class Sign {
  /** @param {TextToPage} item a text; it starts at its position and runs along its x axis, its y axis is up */
  constructor(gl, item) {
    this.gl = gl;
    this.item = item;
    const canvas = written(item);
    this.height = item.size * LINE_HEIGHT;
    this.width = (this.height * canvas.width) / canvas.height;
    this.texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, canvas);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    for (const edge of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, edge, gl.CLAMP_TO_EDGE);
  }

  /** Lower left corner of the sign and the edges from there; null while the pose of its link is unknown. */
  edges(scene) {
    const pose = scene.linkPose(this.item.body, this.item.link);
    if (!pose) return null;
    const { position, orientation } = composed(pose, this.item);
    const [across, upright] = [turned(orientation, [this.width, 0, 0]), turned(orientation, [0, this.height, 0])];
    // The position is on the baseline of the text.
    return { corner: add(position, scale(upright, -0.25)), across, upright };
  }

  dispose() {
    this.gl.deleteTexture(this.texture);
  }
}

function written({ text, colour }) {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  context.font = FONT;
  canvas.width = Math.max(1, Math.min(4096, Math.ceil(context.measureText(text).width)));
  canvas.height = PIXELS;
  context.font = FONT;
  context.fillStyle = `rgb(${colour.map((part) => Math.round(255 * part)).join()})`;
  context.fillText(text, 0, PIXELS * 0.75);
  return canvas;
}
