// Vectors are arrays of 3, quaternions are (x, y, z, w), matrices are 4 x 4 and column-major, as in WebGL.

/** @typedef {[number, number, number]} Vector */
/** @typedef {[number, number, number, number]} Quaternion */

/** @type {(a: ArrayLike<number>, b: ArrayLike<number>) => Vector} */
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/** @type {(a: ArrayLike<number>, b: ArrayLike<number>) => Vector} */
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @type {(a: ArrayLike<number>, factor: number) => Vector} */
export const scale = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
/** @type {(a: ArrayLike<number>, b: ArrayLike<number>) => number} */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @type {(a: ArrayLike<number>) => number} */
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** @type {(a: ArrayLike<number>, b: ArrayLike<number>) => Vector} */
export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** @type {(a: ArrayLike<number>) => Vector} */
export function unit(a) {
  const size = length(a);
  return size > 0 ? scale(a, 1 / size) : [0, 0, 0];
}

/**
 * Rotates a vector by a quaternion.
 *
 * @param {Iterable<number>} quaternion
 * @param {ArrayLike<number>} v
 */
export function turned(quaternion, v) {
  const [x, y, z, w] = quaternion;
  const [tx, ty, tz] = scale(cross([x, y, z], v), 2);
  return add(add(v, [w * tx, w * ty, w * tz]), cross([x, y, z], [tx, ty, tz]));
}

/**
 * Product a b: the rotation by b, then by a.
 *
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @returns {Quaternion}
 */
export function quaternionProduct(a, b) {
  return [
    a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
    a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
    a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
    a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
  ];
}

/** Transforms pose b, given in the frame of pose a, into the frame that a is given in. */
export function composed(a, b) {
  return {
    position: add(a.position, turned(a.orientation, b.position)),
    orientation: quaternionProduct(a.orientation, b.orientation),
  };
}

export function multiply(a, b) {
  const result = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let i = 0; i < 4; i++) sum += a[i * 4 + row] * b[column * 4 + i];
      result[column * 4 + row] = sum;
    }
  }
  return result;
}

/** Transformation from world to camera axes; x to the right, y up, z towards the viewer. */
export function viewMatrix(eye, right, up, forward) {
  return new Float32Array([
    ...[right[0], up[0], -forward[0], 0],
    ...[right[1], up[1], -forward[1], 0],
    ...[right[2], up[2], -forward[2], 0],
    ...[-dot(right, eye), -dot(up, eye), dot(forward, eye), 1],
  ]);
}

/** Perspective projection with a vertical field of view of 90 degrees, as in PyBullet's window. */
export function perspective(aspect, near, far) {
  const depth = far - near;
  return new Float32Array([
    ...[1 / aspect, 0, 0, 0],
    ...[0, 1, 0, 0],
    ...[0, 0, -(far + near) / depth, -1],
    ...[0, 0, (-2 * far * near) / depth, 0],
  ]);
}

export function orthographic(halfSize, near, far) {
  return new Float32Array([
    ...[1 / halfSize, 0, 0, 0],
    ...[0, 1 / halfSize, 0, 0],
    ...[0, 0, -2 / (far - near), 0],
    ...[0, 0, -(far + near) / (far - near), 1],
  ]);
}
