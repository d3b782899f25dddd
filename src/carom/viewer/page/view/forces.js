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
/** Length of the arms of a cross [m], and at least this share of the camera's distance. */
const POINT_SIZE = 0.012;
const POINT_SHARE = 0.008;
const NORMAL_LENGTH = 0.06;
const AXIS_LENGTH = 0.12;
const ARC_RADIUS = 0.08;
/** Radius of a torque's arc, as a share of the camera's distance. */
const ARC_SHARE = 0.06;
const CONE_LINES = 16;
const CONE_ALPHA = 0.3;

/** Adds contact points, their forces and their friction cones, on the bodies that move. */
export function addContacts(overlays) {
  const { lines, solids, options, readings, scales, thickness } = overlays;
  if (!options.contacts && !options.forces && !options.cones) return;
  const forces = readings.contacts.map(({ normal, pressure, friction }) => add(scale(normal, pressure), friction));
  if (options.forces || options.cones) overlays.fit("force", Math.max(0, ...forces.map((force) => Math.hypot(...force))));
  const size = Math.max(POINT_SIZE, POINT_SHARE * overlays.reach);
  readings.contacts.forEach((contact, index) => {
    const { point, normal, pressure, distance } = contact;
    if (options.contacts) {
      lines.star(point, size, distance > 0 ? APART : POINT, 2.5);
      lines.line(point, add(point, scale(normal, NORMAL_LENGTH)), distance > 0 ? APART : POINT, 1.5);
    }
    if (!(scales.force > 0)) return;
    for (const way of waysOf(overlays.scene, contact)) {
      if (options.forces) solids.arrow(point, scale(forces[index], way / scales.force), FORCE, thickness);
      if (options.cones && pressure > 0) addCone(overlays, contact, (way * pressure) / scales.force);
    }
  });
}

/** The signs of a contact's force for the bodies that move: 1 for the first body of the pair, -1 for the other. */
function waysOf(scene, { a, b }) {
  const moves = ([body, link]) => scene.bodies.get(body)?.links[link]?.moves;
  return [moves(a) && 1, moves(b) && -1].filter(Boolean);
}

/** Adds a friction cone: a contact sticks while its force is inside, and slides at the edge of the cone. */
function addCone({ lines, solids }, { point, normal, coefficient }, height) {
  const [side, other] = across(normal);
  const centre = add(point, scale(normal, height));
  const radius = Math.abs(height) * coefficient;
  const rim = (i) => {
    const angle = (2 * Math.PI * i) / CONE_LINES;
    return add(centre, add(scale(side, radius * Math.cos(angle)), scale(other, radius * Math.sin(angle))));
  };
  solids.cone(point, scale(normal, height), radius, CONE, CONE_ALPHA);
  for (let i = 0; i < CONE_LINES; i++) lines.line(rim(i), rim(i + 1), CONE, 1.5);
}

/** Adds the axes, torques and limits of joints. */
export function addJoints(overlays) {
  const { options } = overlays;
  if (!options.axes && !options.torques && !options.limits) return;
  if (options.torques) {
    const torques = [...overlays.readings.joints.values()].map(({ torque }) => Math.abs(torque));
    overlays.fit("torque", Math.max(0, ...torques.filter(Number.isFinite)));
  }
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
function addTorque({ solids, scales, thickness, reach }, origin, axis, torque, kind) {
  if (!(scales.torque > 0) || torque === 0) return;
  const length = torque / scales.torque;
  if (kind === "prismatic") {
    solids.arrow(origin, scale(axis, length), TORQUE, thickness);
    return;
  }
  const [zero] = across(axis);
  const radius = ARC_SHARE * reach;
  // The arc is as long as an arrow would be.
  solids.arc(origin, axis, zero, radius, length / radius, TORQUE, thickness);
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
  for (const { angle, colour } of [{ angle: from, colour: LIMIT }, { angle: to, colour: LIMIT }, { angle: now, colour: AXIS }]) {
    const tip = add(scale(zero, ARC_RADIUS * Math.cos(angle)), scale(other, ARC_RADIUS * Math.sin(angle)));
    lines.line(origin, add(origin, tip), colour, 2);
  }
}
