// The program of surfaces that the CPU draws while something moves: light is computed for each vertex.

/**
 * @param {string} head the version and the features, see `surface` in shaders.js: TEXTURED, SHADOWED, ABOVE_GROUND
 * @param {string} common functions of light and haze
 * @param {string} instance attributes of vertices and instances
 * @param {string} stage function of the lights of files, with the feature STAGED
 */
export function quickSurface(head, common, instance, stage) {
  const staged = head.includes("STAGED") ? stage : "";
  return { vertex: `${head}\n${instance}\n${staged}\n${VERTEX}`, fragment: `${head}\n${common}\n${FRAGMENT}` };
}

const VERTEX = `
uniform mat4 lightCamera;
uniform vec3 eye;
uniform vec3 upward;
uniform vec3 toLight;
uniform float shadowBias;
out vec3 point;
out vec2 texel;
out vec3 shade;
out vec4 direct;
out vec3 shadowPoint;
void main() {
  point = placed();
  // Normals scale inversely to the shape. The side that is seen is lit.
  vec3 squared = vec3(dot(axisX, axisX), dot(axisY, axisY), dot(axisZ, axisZ));
  vec3 n = normal / max(squared, vec3(1e-20));
  n = axisX * n.x + axisY * n.y + axisZ * n.z;
  vec3 toEye = eye - point;
  if (dot(n, n) < 1e-12) n = toEye;
  n = normalize(n);
  if (dot(n, toEye) < 0.0) n = -n;
  float towards = max(dot(n, toLight), 0.0);
  float height = dot(n, upward) * 0.5 + 0.5;
#ifdef STAGED
  vec3 steady, first;
  stageLight(point, n, normalize(toEye), rgba.rgb, vec3(0.0), steady, first);
  shade = steady;
  direct = vec4(first, rgba.a);
#else
  vec3 base = rgba.rgb * rgba.rgb;
  shade = base * mix(vec3(0.28, 0.27, 0.26), vec3(0.44, 0.47, 0.52), height);
  direct = vec4(base * vec3(0.60, 0.58, 0.54) * towards, rgba.a);
#endif
  texel = uv;
  shadowPoint = (lightCamera * vec4(point, 1.0)).xyz * 0.5 + 0.5;
  shadowPoint.z -= shadowBias * (3.0 - 2.0 * towards);
  gl_Position = camera * vec4(point, 1.0);
}`;

const FRAGMENT = `
precision highp sampler2DShadow;
in vec3 point;
in vec2 texel;
in vec3 shade;
in vec4 direct;
in vec3 shadowPoint;
uniform sampler2D image;
uniform sampler2DShadow shadows;
uniform float shadowStrength;
uniform vec3 stageHaze;
uniform float mirrorLevel;
out vec4 result;
void main() {
#ifdef ABOVE_GROUND
  if (dot(point, upward) < mirrorLevel + 0.002) discard;
#endif
  float sun = 1.0;
#ifdef SHADOWED
  vec3 off = abs(shadowPoint - 0.5);
  if (max(max(off.x, off.y), off.z) < 0.5)
    sun -= shadowStrength * (1.0 - textureLod(shadows, shadowPoint, 0.0));
#endif
  vec3 seen = shade + direct.rgb * sun;
#ifdef STAGED
#ifdef TEXTURED
  seen *= texture(image, texel).rgb;
#endif
  vec3 offset = point - eye;
  result = vec4(mix(stageHaze, clamp(seen, 0.0, 1.0), exp(-dot(offset, offset) / (haze * haze))), direct.a);
  return;
#endif
#ifdef TEXTURED
  seen *= linear(texture(image, texel).rgb);
#endif
  result = vec4(display(hazy(seen, point)), direct.a);
}`;
