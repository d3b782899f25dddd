// Data in a frame besides poses: contacts, joints, velocities of links and so on, in columns of numbers.

/** Numbers of columns; src/carom/viewer/readings.py documents them. */
const CONTACT = 16;
const JOINT = 8;
const LINK = 14;
const ACTUATOR = 5;
const SENSOR = 4;
const TENDON = 9;
const TENDON_LOOK = 7;
const WIDTHS = { contacts: CONTACT, joints: JOINT, links: LINK, actuators: ACTUATOR, sensors: SENSOR, tendons: TENDON, tendonLooks: TENDON_LOOK };

export class Readings {
  constructor() {
    this.clear();
  }

  clear() {
    this.contacts = [];
    this.joints = new Map();
    this.links = new Map();
    this.clearDriven();
    this.values = {};
  }

  /** Reads the blocks of numbers that follow the poses in a frame. */
  take({ poses, blocks = [], values = {} }, payload) {
    this.values = values;
    let at = poses * 28;
    this.contacts = [];
    this.joints = new Map();
    this.links = new Map();
    this.clearDriven();
    for (const [kind, count] of blocks) {
      const width = WIDTHS[kind];
      const numbers = new Float32Array(payload, at, count * width);
      at += numbers.byteLength;
      for (let row = 0; row < count; row++) this[`add_${kind}`](numbers.subarray(row * width, (row + 1) * width));
    }
  }

  clearDriven() {
    this.actuators = new Map();
    /** The numbers of each sensor. */
    this.sensors = new Map();
    /** The straight pieces of tendons. */
    this.tendons = [];
    this.looks = 0;
  }

  add_actuators([body, actuator, control, force, activation]) {
    this.actuators.set(`${body},${actuator}`, { control, force, activation: Number.isNaN(activation) ? null : activation });
  }

  add_sensors([body, sensor, place, value]) {
    const key = `${body},${sensor}`;
    if (!this.sensors.has(key)) this.sensors.set(key, []);
    this.sensors.get(key)[place] = value;
  }

  add_tendons(row) {
    this.tendons.push({
      body: row[0],
      start: [...row.subarray(1, 4)],
      end: [...row.subarray(4, 7)],
      force: row[7],
      atLimit: row[8] > 0,
      slack: false,
      radius: NaN,
      rgba: [],
      group: 0,
    });
  }

  /** Takes how a piece of a tendon is drawn, in the order of the pieces; radius and colour that no file states are NaN. */
  add_tendonLooks([slack, radius, red, green, blue, alpha, group]) {
    const tendon = this.tendons[this.looks++];
    if (tendon) Object.assign(tendon, { slack: slack > 0, radius, rgba: [red, green, blue, alpha], group });
  }

  add_contacts(row) {
    this.contacts.push({
      a: [row[0], row[1]],
      b: [row[2], row[3]],
      point: [...row.subarray(4, 7)],
      normal: [...row.subarray(7, 10)],
      pressure: row[10],
      friction: [...row.subarray(11, 14)],
      coefficient: row[14],
      distance: row[15],
    });
  }

  add_joints(row) {
    const [body, joint, position, velocity, torque, target, targetVelocity, applied] = row;
    this.joints.set(`${body},${joint}`, { body, joint, position, velocity, torque, target, targetVelocity, applied });
  }

  add_links(row) {
    const [body, link] = row;
    const parts = ["velocity", "rate", "force", "moment"];
    const facts = Object.fromEntries(parts.map((name, i) => [name, [...row.subarray(2 + 3 * i, 5 + 3 * i)]]));
    this.links.set(`${body},${link}`, { body, link, ...facts });
  }
}
