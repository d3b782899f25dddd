// The shader programs.

import { quickSurface } from "./software/quick_surface.js";
import { STAGE_LIGHT, STAGE_SKY } from "./stage/stage_light.js";

/** Light, sky and haze, shared by all programs. Colours are mixed in linear light. */
const COMMON = `
precision highp float;
uniform vec3 eye;
uniform vec3 upward;
uniform vec3 toLight;
uniform vec3 backdrop;
uniform float plainBackdrop;
uniform float haze;

// A gamma of 2, which is far cheaper than 2.2 if the CPU renders.
vec3 linear(vec3 c) { return c * c; }
vec3 display(vec3 c) { return sqrt(clamp(c, 0.0, 1.0)); }

const vec3 HORIZON = vec3(0.76, 0.84, 0.91), ZENITH = vec3(0.30, 0.48, 0.72), BELOW = vec3(0.52, 0.56, 0.61);

vec3 sky(vec3 direction) {
  if (plainBackdrop > 0.5) return linear(backdrop);
  float height = dot(direction, upward);
  return mix(HORIZON, height >= 0.0 ? ZENITH : BELOW, sqrt(min(height >= 0.0 ? height : -2.5 * height, 1.0)));
}

// Far objects fade into the colour of the horizon.
vec3 hazy(vec3 colour, vec3 point) {
  vec3 offset = point - eye;
  vec3 horizon = plainBackdrop > 0.5 ? linear(backdrop) : HORIZON;
  return mix(horizon, colour, exp(-dot(offset, offset) / (haze * haze)));
}
`;

const INSTANCE = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 axisX;
layout(location = 4) in vec3 axisY;
layout(location = 5) in vec3 axisZ;
layout(location = 6) in vec3 origin;
layout(location = 7) in vec4 rgba;
layout(location = 8) in vec3 specular;
uniform mat4 camera;
vec3 placed() { return axisX * position.x + axisY * position.y + axisZ * position.z + origin; }
`;

/**
 * The program of surfaces, compiled without the features that are not needed: if the CPU renders, a program
 * also spends time on branches that are not taken.
 *
 * @param {string[]} features any of
 *   TEXTURED: surfaces have a texture
 *   SHADOWED: surfaces receive shadows
 *   SOFT: edges of shadows are smoothed; otherwise each pixel reads the shadow map once
 *   QUICK: light is computed for each vertex, without SOFT, GLOSSY and MIRRORING
 *   GLOSSY: specular highlights and reflections of the sky
 *   ABOVE_GROUND: only surfaces above the ground, or the plane that mirrors, are drawn
 *   MIRRORING: the ground, or that plane, shows its reflection
 *   STAGED: the lights are those of files
 *   FLAT: surfaces have their plain colour, without light
 *   DEPTH: surfaces are the brighter the farther they are
 */
export function surface(features) {
  const head = ["#version 300 es", ...features.map((name) => `#define ${name}`)].join("\n");
  if (features.includes("QUICK")) return quickSurface(head, COMMON, INSTANCE, STAGE_LIGHT);
  return { vertex: `${head}\n${SURFACE_VERTEX}`, fragment: `${head}\n${SURFACE_FRAGMENT}` };
}

const SURFACE_VERTEX = `
${INSTANCE}
uniform mat4 lightCamera;
out vec3 point;
out vec3 facing;
out vec2 texel;
out vec4 colour;
out vec3 shine;
out vec3 shadowPoint;
void main() {
  point = placed();
  // Normals scale inversely to the shape.
  vec3 squared = vec3(dot(axisX, axisX), dot(axisY, axisY), dot(axisZ, axisZ));
  vec3 n = normal / max(squared, vec3(1e-20));
  facing = axisX * n.x + axisY * n.y + axisZ * n.z;
  texel = uv;
  colour = rgba;
  shine = specular;
  shadowPoint = (lightCamera * vec4(point, 1.0)).xyz * 0.5 + 0.5;
  gl_Position = camera * vec4(point, 1.0);
}`;

const SURFACE_FRAGMENT = `
${COMMON}
precision highp sampler2DShadow;
in vec3 point;
in vec3 facing;
in vec2 texel;
in vec4 colour;
in vec3 shine;
in vec3 shadowPoint;
uniform sampler2D image;
uniform sampler2DShadow shadows;
uniform float shadowStrength;
uniform vec3 stageHaze;
// Height of the plane that mirrors, and its share; below 0 the more, the more transparent it is.
uniform float mirrorLevel;
uniform float mirrorShare;
uniform float shadowTexel;
uniform float shadowBias;
// The picture of the reflection in the ground, and its size in pixels.
uniform sampler2D reflection;
uniform vec2 reflectionSize;
uniform vec2 reflectionCorner;
// Distance from the camera to its target.
uniform float focus;
out vec4 result;

float lit(float slope) {
  vec3 p = shadowPoint;
  vec2 edge = min(p.xy, 1.0 - p.xy);
  float inside = p.z < 1.0 ? smoothstep(0.0, 0.05, min(edge.x, edge.y)) : 0.0;
  float bias = shadowBias * (1.0 + 2.0 * slope);
#ifdef SOFT
  float sum = 0.0;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++)
      sum += texture(shadows, vec3(p.xy + vec2(i, j) * shadowTexel, p.z - bias));
  float seen = sum / 9.0;
#else
  float seen = texture(shadows, vec3(p.xy, p.z - bias));
#endif
  return 1.0 - shadowStrength * inside * (1.0 - seen);
}

#ifdef STAGED
${STAGE_LIGHT}
#endif

void main() {
  float level = dot(point, upward);
#ifdef DEPTH
  // The target of the camera is grey; the horizon is white.
  result = vec4(vec3(1.0 - exp(-0.7 * length(point - eye) / focus)), 1.0);
  return;
#endif
#ifdef FLAT
  result = vec4(colour.rgb, 1.0);
  return;
#endif
#ifdef ABOVE_GROUND
  if (level < mirrorLevel + 0.002) discard;
#endif
  vec3 base = linear(colour.rgb);
#ifdef TEXTURED
  base *= linear(texture(image, texel).rgb);
#endif
  vec3 n = facing;
  if (dot(n, n) < 1e-12) n = cross(dFdx(point), dFdy(point));
  n = normalize(n);
  if (!gl_FrontFacing) n = -n;
  float towards = max(dot(n, toLight), 0.0);
#ifdef SHADOWED
  float sun = lit(1.0 - towards);
#else
  float sun = 1.0;
#endif
#ifdef STAGED
  vec3 plain = colour.rgb;
#ifdef TEXTURED
  plain *= texture(image, texel).rgb;
#endif
  vec3 steady, first;
  stageLight(point, n, normalize(eye - point), plain, shine, steady, first);
  vec3 offset = point - eye;
  vec3 staged = clamp(steady + first * sun, 0.0, 1.0);
  result = vec4(mix(stageHaze, staged, exp(-dot(offset, offset) / (haze * haze))), colour.a);
#else
  float height = dot(n, upward) * 0.5 + 0.5;
  vec3 ambient = mix(vec3(0.28, 0.27, 0.26), vec3(0.44, 0.47, 0.52), height);
  vec3 seen = base * (ambient + vec3(0.60, 0.58, 0.54) * towards * sun);
#ifdef GLOSSY
  vec3 toEye = normalize(eye - point);
  float gleam = towards > 0.0 ? max(dot(n, normalize(toLight + toEye)), 0.0) : 0.0;
  gleam *= gleam; gleam *= gleam; gleam *= gleam; gleam *= gleam;
  gleam *= gleam * gleam * 0.22 * sun;
  float rim = 1.0 - max(dot(n, toEye), 0.0);
  rim *= rim * rim * rim * 0.06;
  seen += shine * (gleam + rim * sky(reflect(-toEye, n)));
#endif
  result = vec4(display(hazy(seen, point)), colour.a);
#endif
#ifdef MIRRORING
  if (abs(level - mirrorLevel) < 0.002 && dot(n, upward) > 0.99) {
    // Of floors of files the light is added, as in MuJoCo. Else, the more transparent a floor is, the stronger is
    // its reflection; an opaque floor reflects 20 %.
    vec3 mirrored = texture(reflection, (gl_FragCoord.xy - reflectionCorner) / reflectionSize).rgb;
    result = vec4(mirrorShare >= 0.0 ? min(result.rgb + mirrorShare * mirrored, 1.0) : mix(result.rgb, mirrored, max(1.0 - colour.a, 0.2)), 1.0);
  }
#endif
}`;

export const SHADOW = {
  vertex: `#version 300 es
${INSTANCE}
void main() { gl_Position = camera * vec4(placed(), 1.0); }`,
  fragment: `#version 300 es
precision mediump float;
void main() {}`,
};

export const WIRE = {
  vertex: `#version 300 es
${INSTANCE}
out vec4 colour;
void main() {
  colour = rgba;
  gl_Position = camera * vec4(placed(), 1.0);
}`,
  fragment: `#version 300 es
precision mediump float;
in vec4 colour;
out vec4 result;
void main() { result = vec4(colour.rgb * 0.72, 1.0); }`,
};

export const SKY = {
  vertex: `#version 300 es
uniform vec3 forward;
uniform vec3 rightward;
uniform vec3 overhead;
out vec3 direction;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  direction = forward + rightward * corner.x + overhead * corner.y;
  gl_Position = vec4(corner, 1.0, 1.0);
}`,
  fragment: `#version 300 es
${COMMON}
in vec3 direction;
uniform float skyShown;
${STAGE_SKY}
out vec4 result;
void main() {
  vec3 seen = normalize(direction);
  result = vec4(skyShown > 0.5 ? stageSky(seen) : display(sky(seen)), 1.0);
}`,
};

/** The grid on the ground plane through the origin: lines every 10 m, 1 m and, near the camera, 10 cm. */
export const GRID = {
  vertex: `#version 300 es
uniform mat4 camera;
uniform vec3 centre;
uniform vec3 across;
uniform vec3 along;
uniform float extent;
out vec3 point;
out vec2 place;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  point = centre + (across * corner.x + along * corner.y) * extent;
  place = vec2(dot(point, across), dot(point, along));
  gl_Position = camera * vec4(point, 1.0);
}`,
  fragment: `#version 300 es
${COMMON}
uniform float extent;
uniform vec3 centre;
in vec3 point;
in vec2 place;
out vec4 result;
float lines(float spacing) {
  vec2 at = place / spacing, width = fwidth(at);
  vec2 off = abs(fract(at - 0.5) - 0.5) / max(width, vec2(1e-6));
  // Lines closer together than pixels would flicker.
  return (1.0 - min(min(off.x, off.y), 1.0)) * (1.0 - smoothstep(0.1, 0.5, max(width.x, width.y)));
}
void main() {
  float strength = max(lines(1.0) * 0.55, max(lines(10.0) * 0.8, lines(0.1) * 0.16));
  vec3 colour = vec3(0.18, 0.23, 0.28);
  vec2 width = fwidth(place);
  vec2 axis = 1.0 - min(abs(place) / max(width * 1.5, vec2(1e-6)), 1.0);
  if (axis.y > 0.05) { colour = vec3(0.70, 0.10, 0.08); strength = max(strength, axis.y); }
  if (axis.x > 0.05) { colour = vec3(0.08, 0.42, 0.12); strength = max(strength, axis.x); }
  float fade = 1.0 - smoothstep(0.3, 1.0, length(point - centre) / extent);
  result = vec4(display(colour), strength * fade);
}`,
};

/** Lines with a width in pixels, as rectangles that face the viewer. */
export const LINES = {
  vertex: `#version 300 es
layout(location = 0) in vec3 start;
layout(location = 1) in vec3 end;
layout(location = 2) in vec3 tint;
layout(location = 3) in float width;
uniform mat4 camera;
uniform vec2 pixels;
uniform float thinnest;
out vec3 colour;
void main() {
  colour = tint;
  vec4 a = camera * vec4(start, 1.0), b = camera * vec4(end, 1.0);
  float nearest = 0.01;
  if (a.w < nearest && b.w < nearest) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (a.w < nearest) a = mix(a, b, (nearest - a.w) / (b.w - a.w));
  if (b.w < nearest) b = mix(b, a, (nearest - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * pixels;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  // Four corners for each line.
  bool far = (gl_VertexID & 2) == 2;
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  vec4 corner = far ? b : a;
  vec2 shift = vec2(-along.y, along.x) * side * max(width, thinnest) / pixels;
  gl_Position = vec4(corner.xy + shift * corner.w, corner.z - 1e-5 * corner.w, corner.w);
}`,
  fragment: `#version 300 es
precision mediump float;
in vec3 colour;
out vec4 result;
void main() { result = vec4(colour, 1.0); }`,
};

export const POINTS = {
  vertex: `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 tint;
uniform mat4 camera;
uniform vec3 axisX;
uniform vec3 axisY;
uniform vec3 axisZ;
uniform vec3 origin;
uniform float size;
out vec3 colour;
void main() {
  colour = tint;
  gl_Position = camera * vec4(axisX * position.x + axisY * position.y + axisZ * position.z + origin, 1.0);
  gl_PointSize = size;
}`,
  fragment: `#version 300 es
precision mediump float;
in vec3 colour;
out vec4 result;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  result = vec4(colour, 1.0);
}`,
};

/** A text, as a textured rectangle in the world. */
export const SIGN = {
  vertex: `#version 300 es
uniform mat4 camera;
uniform vec3 corner;
uniform vec3 across;
uniform vec3 upright;
out vec2 texel;
void main() {
  texel = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = camera * vec4(corner + across * texel.x + upright * texel.y, 1.0);
}`,
  fragment: `#version 300 es
precision mediump float;
uniform sampler2D image;
in vec2 texel;
out vec4 result;
void main() {
  result = texture(image, texel);
  if (result.a < 0.02) discard;
}`,
};
