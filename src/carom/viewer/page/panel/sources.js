// The quantities that can be plotted, and how their numbers are read from a frame.

import { composed } from "../view/maths.js";
import { titlesOf } from "../view/names.js";

const MOVABLE = /revolute|continuous|prismatic/;
const AT_REST = { velocity: [0, 0, 0], rate: [0, 0, 0] };
const UNKNOWN = { velocity: [null, null, null], rate: [null, null, null] };
const XYZ = [{ name: "x" }, { name: "y" }, { name: "z" }];

/** @import { Readings } from "../view/readings.js" */
/** @import { Vector } from "../view/maths.js" */

/**
 * A quantity that can be plotted: a row of charts, and what reads the values of their lines from a frame.
 *
 * @typedef {object} Source
 * @property {string} key
 * @property {string} title
 * @property {{name: string, unit?: string, traces: {name: string, target?: boolean}[]}[]} charts
 * @property {(frame: Facts) => ?(?number)[][]} read null if the frame does not have the quantity
 * @property {{joints?: number[], links?: [number, number][], contacts?: boolean, sensors?: number[]}} wants what is to be asked for
 */

/**
 * What sources read of a frame; the pose is null where the frame has none.
 *
 * @typedef {{readings: Readings, pose: (body: number, link: number) => ?{position: Vector, orientation: number[]}}} Facts
 */

/**
 * All quantities that can be plotted now: groups of sources by title.
 *
 * @returns {Record<string, Source[]>}
 */
export function sourcesOf(scene, valueNames) {
  /** @type {Record<string, Source[]>} */
  const groups = { Joints: [], Actuators: [], Sensors: [], Bodies: [], "Contact forces": [], "Force-torque sensors": [], Values: [] };
  const titles = titlesOf(scene);
  for (const body of scene.own) {
    const title = titles.get(body.body);
    body.links.forEach((link, index) => {
      if (MOVABLE.test(link.kind ?? "")) groups.Joints.push(jointSource(body, title, index - 1, link));
      if (index > 0) groups["Force-torque sensors"].push(sensorSource(body, title, index - 1, link));
    });
    (body.actuators ?? []).forEach(({ name }, index) => groups.Actuators.push(actuatorSource(body, title, index, name)));
    (body.sensors ?? []).forEach((sensor, index) => groups.Sensors.push(readingSource(body, title, index, sensor)));
    groups.Bodies.push(bodySource(body));
    groups["Contact forces"].push(contactSource(body));
  }
  for (const name of valueNames) groups.Values.push(valueSource(name));
  return groups;
}

/** @returns {Source} */
function jointSource({ body }, name, joint, link) {
  const read = ({ readings }) => {
    const row = readings.joints.get(`${body},${joint}`);
    if (!row) return null;
    const known = (value) => (Number.isNaN(value) ? null : value);
    return [
      [row.position, known(row.target)],
      [row.velocity, known(row.targetVelocity)],
      [row.torque, known(row.applied)],
    ];
  };
  const units = link.kind === "prismatic" ? ["m", "m/s", "N"] : ["rad", "rad/s", "N·m"];
  const charts = ["position", "velocity", "torque"].map((quantity, i) => ({ name: quantity, unit: units[i], traces: [{ name: "" }, { name: "target", target: true }] }));
  return { key: `${body},${joint}`, title: `${name} · ${link.joint}`, charts, read, wants: { joints: [body] } };
}

/** @returns {Source} */
function actuatorSource({ body }, owner, index, name) {
  const read = ({ readings }) => {
    const row = readings.actuators.get(`${body},${index}`);
    return row ? [[row.control, row.activation], [row.force]] : null;
  };
  const charts = [
    { name: "control", traces: [{ name: "" }, { name: "activation", target: true }] },
    { name: "force", traces: [{ name: "" }] },
  ];
  return { key: `actuator ${body},${index}`, title: `${owner} · ${name}`, charts, read, wants: { joints: [body] } };
}

/** @returns {Source} of a sensor; up to four numbers are the lines of one chart */
function readingSource({ body }, owner, index, { name, kind, size }) {
  const read = ({ readings }) => {
    const values = readings.sensors.get(`${body},${index}`);
    return values ? [values.slice(0, size)] : null;
  };
  const names = size === 1 ? [""] : size <= 4 ? ["x", "y", "z", "w"] : Array.from({ length: size }, (_, i) => String(i));
  const charts = [{ name: kind, traces: names.slice(0, size).map((each) => ({ name: each })) }];
  return { key: `reading ${body},${index}`, title: `${owner} · ${name}`, charts, read, wants: { sensors: [body] } };
}

/** @returns {Source} */
function bodySource({ body, name, links }) {
  const read = ({ readings, pose }) => {
    const where = pose(body, 0);
    if (!where) return null;
    const { position } = composed(where, links[0]);
    const motion = readings.links.get(`${body},-1`) ?? (links[0].moves ? UNKNOWN : AT_REST);
    return [position, motion.velocity, motion.rate];
  };
  const charts = ["position [m]", "velocity [m/s]", "turning [rad/s]"].map((quantity) => ({ name: quantity, traces: XYZ }));
  return { key: `body ${body}`, title: `${name} (body ${body})`, charts, read, wants: { links: [[body, -1]] } };
}

/** @returns {Source} */
function contactSource({ body, name }) {
  const read = ({ readings }) => {
    const forces = readings.contacts.filter(({ a, b }) => a[0] === body || b[0] === body);
    const pressure = forces.reduce((sum, contact) => sum + contact.pressure, 0);
    const friction = forces.reduce((sum, contact) => sum + Math.hypot(...contact.friction), 0);
    return [[pressure, friction]];
  };
  const charts = [{ name: "force [N]", traces: [{ name: "normal" }, { name: "friction" }] }];
  return { key: `contact ${body}`, title: `${name} (body ${body})`, charts, read, wants: { contacts: true } };
}

/** @returns {Source} */
function sensorSource({ body }, name, joint, link) {
  const read = ({ readings }) => {
    const row = readings.links.get(`${body},${joint}`);
    return row ? [row.force, row.moment] : null;
  };
  const charts = ["force [N]", "moment [N·m]"].map((quantity) => ({ name: quantity, traces: XYZ }));
  return { key: `sensor ${body},${joint}`, title: `${name} · ${link.joint}`, charts, read, wants: { links: [[body, joint]] } };
}

/** @returns {Source} */
function valueSource(name) {
  const read = ({ readings }) => (name in readings.values ? [[readings.values[name]]] : null);
  return { key: `value ${name}`, title: name, charts: [{ name, traces: [{ name: "" }] }], read, wants: {} };
}
