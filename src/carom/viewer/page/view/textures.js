// Textures of the scene, from texels or from the bytes of an image file.

/**
 * Decodes an image file as the simulation does: without turning it, and with the colours of transparent pixels.
 *
 * @returns {Promise<ImageBitmap>} the image, the bottom row first
 */
export function decodedImage({ file }, payload) {
  /** @type {ImageBitmapOptions} */
  const options = { imageOrientation: "flipY", premultiplyAlpha: "none", colorSpaceConversion: "none" };
  return createImageBitmap(new Blob([payload], { type: file }), options);
}

/** A repeating texture of an image; a `plain` one has no anisotropic filtering. */
export function bitmapTexture(gl, bitmap, plain) {
  const texture = begun(gl);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, gl.RGB, gl.UNSIGNED_BYTE, bitmap);
  return filtered(gl, texture, plain);
}

/** A repeating texture of RGB bytes, the bottom row first; a `plain` one has no anisotropic filtering. */
export function imageTexture(gl, { width, height }, payload, plain) {
  let texels = new Uint8Array(payload);
  // Small patterns are enlarged, because linear filtering would blur their sharp borders.
  const times = Math.max(width, height) <= 16 ? 32 : 1;
  if (times > 1) {
    texels = enlarged(texels, width, height, times);
    [width, height] = [width * times, height * times];
  }
  const texture = begun(gl);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, width, height, 0, gl.RGB, gl.UNSIGNED_BYTE, texels);
  return filtered(gl, texture, plain);
}

function begun(gl) {
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  return texture;
}

function filtered(gl, texture, plain) {
  gl.generateMipmap(gl.TEXTURE_2D);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  const sharper = plain ? null : gl.getExtension("EXT_texture_filter_anisotropic");
  if (sharper) {
    const most = gl.getParameter(sharper.MAX_TEXTURE_MAX_ANISOTROPY_EXT);
    gl.texParameterf(gl.TEXTURE_2D, sharper.TEXTURE_MAX_ANISOTROPY_EXT, Math.min(8, most));
  }
  return texture;
}

function enlarged(texels, width, height, times) {
  const result = new Uint8Array(width * height * 3 * times * times);
  let at = 0;
  for (let row = 0; row < height * times; row++) {
    for (let column = 0; column < width * times; column++) {
      const from = (Math.floor(row / times) * width + Math.floor(column / times)) * 3;
      for (let channel = 0; channel < 3; channel++) result[at++] = texels[from + channel];
    }
  }
  return result;
}
