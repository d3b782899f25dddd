// The messages over time: the versions of each named message, and in which frames each version was shown.

export class MessageVersions {
  constructor() {
    /** Versions by name, the oldest first: shown from a frame on until another (Infinity: now), message. */
    this.versions = new Map();
    this.bytes = 0;
  }

  /** Adds a message, which replaces that of the same name from a moment (a frame number) on. */
  put(name, message, moment) {
    const list = this.versions.get(name) ?? [];
    this.close(list, moment);
    list.push({ from: moment, to: Infinity, message });
    this.bytes += sizeOf(message);
    this.versions.set(name, list);
  }

  /** Removes the message of a name, from a moment on. */
  remove(name, moment) {
    this.close(this.versions.get(name) ?? [], moment);
  }

  close(list, moment) {
    const last = list.at(-1);
    if (last?.to !== Infinity) return;
    last.to = moment;
    // A version that was shown in no frame is dropped.
    if (last.from === moment) this.bytes -= sizeOf(list.pop().message);
  }

  /** Adds earlier versions: of each name in order, none of them later than those that are there. */
  prepend(versions) {
    const lists = new Map();
    for (const { name, ...version } of versions) {
      if (!lists.has(name)) lists.set(name, []);
      lists.get(name).push(version);
    }
    for (const [name, earlier] of lists) {
      const list = this.versions.get(name) ?? [];
      const [last, next] = [earlier.at(-1), list[0]];
      if (next && last.to > next.from) {
        // What was there when the page joined is the same, or it has taken the place of the last one.
        if (sameMessage(last.message, next.message)) {
          next.from = last.from;
          earlier.pop();
        } else last.to = next.from;
      } else if (!next && last.to > 0) last.to = 0;
      for (const { message } of earlier) this.bytes += sizeOf(message);
      this.versions.set(name, [...earlier, ...list]);
    }
  }

  /** The present message of a name; null if it has been removed. */
  newest(name) {
    const last = this.versions.get(name)?.at(-1);
    return last?.to === Infinity ? last.message : null;
  }

  /** The versions at a moment, by name. */
  at(moment) {
    const found = new Map();
    for (const [name, list] of this.versions) {
      const version = list.findLast(({ from, to }) => from <= moment && moment < to);
      if (version) found.set(name, version);
    }
    return found;
  }

  /** Drops the versions that ended before a moment. */
  forget(moment) {
    for (const [name, list] of this.versions) {
      while (list.length && list[0].to <= moment) this.bytes -= sizeOf(list.shift().message);
      if (!list.length) this.versions.delete(name);
    }
  }
}

function sameMessage(a, b) {
  return JSON.stringify(a.header) === JSON.stringify(b.header) && sameBytes(a.payload, b.payload);
}

/** Whether two payloads have the same bytes. */
export function sameBytes(a, b) {
  if (a.byteLength !== b.byteLength) return false;
  const words = a.byteLength >> 2;
  const [x, y] = [new Uint32Array(a, 0, words), new Uint32Array(b, 0, words)];
  if (!x.every((value, i) => value === y[i])) return false;
  const [rest, other] = [new Uint8Array(a, 4 * words), new Uint8Array(b, 4 * words)];
  return rest.every((value, i) => value === other[i]);
}

function sizeOf({ payload }) {
  return (payload?.byteLength ?? 0) + 400;
}
