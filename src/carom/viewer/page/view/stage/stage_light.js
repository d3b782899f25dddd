// How the lights of files shine, for the shaders of surfaces. As in MuJoCo, colours are mixed as they are displayed.

import { LIGHTS, LIGHT_VECTORS } from "./stage.js";

export const STAGE_LIGHT = `
uniform vec4 stageLights[${LIGHTS * LIGHT_VECTORS}];
uniform float stageCount;
uniform vec3 stageAmbient;

// The light that a surface sends to the eye: that of the first light, which may be held up, and all other.
void stageLight(vec3 point, vec3 n, vec3 toEye, vec3 base, vec3 shine, out vec3 steady, out vec3 first) {
  steady = base * stageAmbient;
  first = vec3(0.0);
  for (int i = 0; i < ${LIGHTS}; i++) {
    if (float(i) >= stageCount) break;
    vec4 place = stageLights[i * ${LIGHT_VECTORS}], aim = stageLights[i * ${LIGHT_VECTORS} + 1];
    vec4 fall = stageLights[i * ${LIGHT_VECTORS} + 2];
    vec3 towardsIt = place.xyz - point * place.w;
    float far = max(length(towardsIt), 1e-9);
    towardsIt /= far;
    float strength = 1.0;
    if (place.w > 0.5) {
      float along = dot(-towardsIt, aim.xyz);
      strength = along < aim.w ? 0.0 : fall.w > 0.0 ? pow(max(along, 0.0), fall.w) : 1.0;
      strength /= max(fall.x + far * (fall.y + far * fall.z), 1e-6);
    }
    float facing = max(dot(n, towardsIt), 0.0);
    float gleam = facing > 0.0 ? pow(max(dot(n, normalize(towardsIt + toEye)), 0.0), 64.0) : 0.0;
    vec3 seen = base * stageLights[i * ${LIGHT_VECTORS} + 3].rgb * facing + shine * stageLights[i * ${LIGHT_VECTORS} + 4].rgb * gleam;
    if (i == 0) first = seen * strength;
    else steady += seen * strength;
  }
}
`;

/** The sky of a file: six images side by side on a cube, whose y axis is up. */
export const STAGE_SKY = `
uniform sampler2D skyImage;
uniform vec3 stageHaze;
uniform float hazeShown;
vec3 stageSky(vec3 direction) {
  vec3 d = vec3(direction.x, direction.z, -direction.y);
  vec3 size = abs(d);
  float side;
  vec2 place;
  if (size.x >= size.y && size.x >= size.z) { side = d.x > 0.0 ? 0.0 : 1.0; place = vec2(d.x > 0.0 ? -d.z : d.z, -d.y) / size.x; }
  else if (size.y >= size.z) { side = d.y > 0.0 ? 2.0 : 3.0; place = vec2(d.x, d.y > 0.0 ? d.z : -d.z) / size.y; }
  else { side = d.z > 0.0 ? 4.0 : 5.0; place = vec2(d.z > 0.0 ? d.x : -d.x, -d.y) / size.z; }
  place = clamp(0.5 + 0.5 * place, 0.004, 0.996);
  vec3 colour = textureLod(skyImage, vec2((side + place.x) / 6.0, 1.0 - place.y), 0.0).rgb;
  return mix(stageHaze, colour, max(1.0 - hazeShown, smoothstep(0.0, 0.3, abs(direction.z))));
}
`;
