// What was true when: of everything that has a name, its versions and how long each was shown.

export class Ledger {
  constructor() {
    /** Versions by name, the oldest first: from when on, until when (Infinity: now), and the message. */
    this.versions = new Map();
    this.bytes = 0;
  }

  /** A message takes the place of the one of the same name, from a moment on. */
  put(name, message, moment) {
    const list = this.versions.get(name) ?? [];
    this.close(list, moment);
    list.push({ from: moment, to: Infinity, message });
    this.bytes += sizeOf(message);
    this.versions.set(name, list);
  }

  /** What a name stands for is gone, from a moment on. */
  remove(name, moment) {
    this.close(this.versions.get(name) ?? [], moment);
  }

  close(list, moment) {
    const last = list.at(-1);
    if (last?.to !== Infinity) return;
    last.to = moment;
    // Nobody can have seen what lasted for no frame.
    if (last.from === moment) this.bytes -= sizeOf(list.pop().message);
  }

  /** The message that a name stands for now; null if it is gone. */
  newest(name) {
    const last = this.versions.get(name)?.at(-1);
    return last?.to === Infinity ? last.message : null;
  }

  /** What there was at a moment: versions by name. */
  at(moment) {
    const found = new Map();
    for (const [name, list] of this.versions) {
      const version = list.findLast(({ from, to }) => from <= moment && moment < to);
      if (version) found.set(name, version);
    }
    return found;
  }

  /** Drops what was gone before a moment. */
  forget(moment) {
    for (const [name, list] of this.versions) {
      while (list.length && list[0].to <= moment) this.bytes -= sizeOf(list.shift().message);
      if (!list.length) this.versions.delete(name);
    }
  }
}

function sizeOf({ payload }) {
  return (payload?.byteLength ?? 0) + 400;
}
