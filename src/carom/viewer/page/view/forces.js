// Drawings of contacts and joints: contact points, forces, friction cones, joint axes, torques and limits.

import { add, cross, dot, scale, subtract, turned, unit } from "./maths.js";
import { across } from "./lines.js";

const POINT = [0.95, 0.8, 0.1];
const APART = [0.6, 0.65, 0.7];
const FORCE = [0.85, 0.2, 0.1];
const CONE = [0.2, 0.55, 0.85];
const AXIS = [0.1, 0.5, 0.9];
const TORQUE = [0.9, 0.45, 0.05];
const LIMIT = [0.5, 0.55, 0.15];
const POINT_SIZE = 0.012;
const NORMAL_LENGTH = 0.06;
const AXIS_LENGTH = 0.12;
const ARC_RADIUS = 0.08;
/** Maximum length of an arrow [m]. */
const LONGEST = 0.4;
const CONE_LINES = 16;

/** Adds contact points, their forces and their friction cones. */
export function addContacts(overlays) {
  const { lines, options, readings, scales } = overlays;
  if (!options.contacts && !options.forces && !options.cones) return;
  for (const contact of readings.contacts) {
    const { point, normal, pressure, friction, distance } = contact;
    if (options.contacts) {
      lines.star(point, POINT_SIZE, distance > 0 ? APART : POINT, 2.5);
      lines.line(point, add(point, scale(normal, NORMAL_LENGTH)), distance > 0 ? APART : POINT, 1.5);
    }
    const force = add(scale(normal, pressure), friction);
    scales.force = Math.max(scales.force, niceScale(Math.hypot(...force)));
    if (options.forces && scales.force > 0) lines.arrow(point, scale(force, 1 / scales.force), FORCE);
    if (options.cones && pressure > 0) addCone(lines, contact, pressure / scales.force);
  }
}

/** Adds a friction cone: a contact sticks while its force is inside, and slides at the edge of the cone. */
function addCone(lines, { point, normal, coefficient }, height) {
  const [side, other] = across(normal);
  const centre = add(point, scale(normal, height));
  const radius = height * coefficient;
  const rim = (i) => {
    const angle = (2 * Math.PI * i) / CONE_LINES;
    return add(centre, add(scale(side, radius * Math.cos(angle)), scale(other, radius * Math.sin(angle))));
  };
  for (let i = 0; i < CONE_LINES; i++) {
    lines.line(rim(i), rim(i + 1), CONE, 1);
    if (i % 4 === 0) lines.line(point, rim(i), CONE, 1);
  }
}

/** Adds the axes, torques and limits of joints. */
export function addJoints(overlays) {
  const { options } = overlays;
  if (!options.axes && !options.torques && !options.limits) return;
  overlays.eachLink((body, index, link) => {
    if (!link.axis || !/revolute|continuous|prismatic/.test(link.kind)) return;
    const pose = overlays.scene.linkPose(body.body, index);
    if (!pose) return;
    const axis = unit(turned(pose.orientation, link.axis));
    const reading = overlays.readings.joints.get(`${body.body},${index - 1}`);
    if (options.axes) addAxis(overlays.lines, pose.position, axis);
    if (options.torques && reading) addTorque(overlays, pose.position, axis, reading.torque, link.kind);
    if (options.limits && reading && link.limits) addLimits(overlays.lines, pose, axis, link, reading.position);
  });
}

function addAxis(lines, origin, axis) {
  lines.line(subtract(origin, scale(axis, 0.5 * AXIS_LENGTH)), origin, AXIS, 2);
  lines.arrow(origin, scale(axis, AXIS_LENGTH), AXIS, 2);
}

/** Adds the force of a prismatic joint as an arrow along its axis, a torque as an arc about the axis. */
function addTorque({ lines, scales }, origin, axis, torque, kind) {
  scales.torque = Math.max(scales.torque, niceScale(Math.abs(torque)));
  if (!(scales.torque > 0)) return;
  if (kind === "prismatic") {
    lines.arrow(origin, scale(axis, torque / scales.torque), TORQUE, 3);
    return;
  }
  const angle = ((torque / scales.torque) * 1.5 * Math.PI) / LONGEST;
  const [zero] = across(axis);
  lines.arc(origin, axis, zero, ARC_RADIUS, 0, angle, TORQUE, 3);
  const other = cross(axis, zero);
  const tip = add(origin, add(scale(zero, ARC_RADIUS * Math.cos(angle)), scale(other, ARC_RADIUS * Math.sin(angle))));
  const onward = add(scale(zero, -Math.sin(angle)), scale(other, Math.cos(angle)));
  lines.arrow(tip, scale(onward, Math.sign(angle) * 0.04), TORQUE, 3);
}

/** Adds the range of motion of a joint, relative to its present position. */
function addLimits(lines, pose, axis, { kind, limits: [lower, upper] }, position) {
  const origin = pose.position;
  if (kind === "prismatic") {
    const [from, to] = [lower, upper].map((at) => add(origin, scale(axis, at - position)));
    lines.line(from, to, LIMIT, 3);
    for (const end of [from, to]) lines.star(end, 0.015, LIMIT);
    return;
  }
  const [zero] = across(axis);
  // A direction fixed to the moving link is drawn at the joint's present position.
  const other = cross(axis, zero);
  const hand = unit(turned(pose.orientation, [1, 0.3, 0.2]));
  const now = Math.atan2(dot(hand, other), dot(hand, zero));
  const [from, to] = [lower, upper].map((at) => now + at - position);
  lines.arc(origin, axis, zero, ARC_RADIUS, from, to, LIMIT, 3);
  for (const [angle, colour] of [[from, LIMIT], [to, LIMIT], [now, AXIS]]) {
    const tip = add(scale(zero, ARC_RADIUS * Math.cos(angle)), scale(other, ARC_RADIUS * Math.sin(angle)));
    lines.line(origin, add(origin, tip), colour, 2);
  }
}

/** The smallest scale of 1, 2, 5, 10, 20... [N or N m per metre] for which an arrow is not too long. */
function niceScale(amount) {
  if (!(amount > 0) || !Number.isFinite(amount)) return 0;
  const wanted = amount / LONGEST;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [1, 2, 5, 10].find((step) => step * power >= wanted * (1 - 1e-9));
}
