// The past before the page was there: fetched from the process that simulates, part by part, the newest first.

import { decoded } from "./recording.js";
import { FromPage } from "../protocol.js";

/** @import { History } from "./history.js" */

export class Past {
  /**
   * @param {History} history
   * @param {(message: MessageFromPage) => void} send sends a message to the simulation
   */
  constructor(history, send) {
    this.history = history;
    this.send = send;
    /** Called after each part. */
    this.changed = () => {};
    this.clear();
  }

  clear() {
    /** The simulation's number of the first frame that the page has received; null until it has come. */
    this.joined = null;
  }

  /** Asks for the past when the first frame has arrived. */
  meet({ number }) {
    if (this.joined !== null || number === undefined || this.history.count === 0) return;
    this.joined = number;
    if (number > 0) this.ask(number, false);
  }

  /** Asks for the frames before one, and what is shown with them, unless it is shown with that one and `known`. */
  ask(before, known) {
    this.send({ type: FromPage.PAST, before, known });
  }

  /** Takes a part of the past, and asks for the next one while there is room. */
  async take({ first, oldest, versions }, payload) {
    const { history, joined } = this;
    const { version } = history;
    const { messages } = await decoded(payload);
    // Meanwhile the page may show another run, or have dropped the frames that come next.
    if (version !== history.version || joined === null) return;
    const frames = messages.slice(versions.length).map(([header, bytes]) => ({ header, payload: bytes }));
    if (first + frames.length !== joined + history.first) return;
    const shown = versions.map(([name, from, to], i) => {
      const [header, bytes] = messages[i];
      return { name, from: from - joined, to: to === null ? Infinity : to - joined, message: { header, payload: bytes } };
    });
    history.prepend(frames, shown);
    this.changed();
    if (first > oldest && frames.length > 0 && history.hasRoom) this.ask(first, true);
  }
}
