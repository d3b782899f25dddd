// Data in a frame besides poses: contacts, joints, and velocities of links, in columns of numbers.

/** Numbers of columns; src/carom/viewer/readings.py documents them. */
const CONTACT = 16;
const JOINT = 8;
const LINK = 14;

export class Readings {
  constructor() {
    this.clear();
  }

  clear() {
    this.contacts = [];
    this.joints = new Map();
    this.links = new Map();
    this.values = {};
  }

  /** Reads the blocks of numbers that follow the poses in a frame. */
  take({ poses, blocks = [], values = {} }, payload) {
    this.values = values;
    let at = poses * 28;
    this.contacts = [];
    this.joints = new Map();
    this.links = new Map();
    for (const [kind, count] of blocks) {
      const width = { contacts: CONTACT, joints: JOINT, links: LINK }[kind];
      const numbers = new Float32Array(payload, at, count * width);
      at += numbers.byteLength;
      for (let row = 0; row < count; row++) this[`add_${kind}`](numbers.subarray(row * width, (row + 1) * width));
    }
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
