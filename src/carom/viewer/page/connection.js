// The connection to the simulation: a WebSocket or, behind a proxy that does not support WebSockets, polling.
// It reconnects by itself when the next simulation starts.

import { bounded } from "./bounded.js";

const RETRY_MS = 700;
/** How long an answer to a page that polls may take; a server that ends may give none [ms]. */
const SILENCE_MS = 20000;
/** How long a socket may take to open before polling is tried [ms]. */
const PATIENCE_MS = 4000;
/** Maximum number of characters of the messages in one request; servers limit request lines to 8,192. */
const MAX_QUERY = 6000;

export class Connection {
  /**
   * @param {(header: MessageToPage, payload: ArrayBuffer) => void} receive called with each message
   * @param {(connected: boolean) => void} changed called when the connection is made or lost
   */
  constructor(receive, changed) {
    this.receive = receive;
    this.changed = changed;
    this.folder = location.pathname.replace(/[^/]*$/, "");
    this.socket = null;
    this.unsent = null;
    this.hadSocket = false;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    // The address may have a token, which allows access through a proxy or from another machine.
    const socket = new WebSocket(`${scheme}://${location.host}${this.folder}socket${location.search}`);
    const tooLong = setTimeout(() => socket.close(), PATIENCE_MS);
    let opened = false;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      clearTimeout(tooLong);
      opened = this.hadSocket = true;
      this.changed(true);
    };
    socket.onmessage = (event) => this.receive(...decoded(event.data));
    socket.onclose = async () => {
      clearTimeout(tooLong);
      if (!opened) await this.poll();
      this.changed(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
    this.socket = socket;
  }

  /** Polls the server until a request fails. */
  async poll() {
    if (this.hadSocket || !new URLSearchParams(location.search).has("token")) return;
    const name = Math.random().toString(36).slice(2);
    let number = null;
    this.unsent = [];
    /** The name under which the page polls now; null to stop. */
    this.asked = name;
    try {
      for (;;) {
        const asked = `${this.folder}poll${location.search}&page=${name}${this.takeUnsent()}`;
        const answer = await fetch(asked, { cache: "no-store", signal: AbortSignal.timeout(SILENCE_MS) });
        if (!answer.ok) break;
        const buffer = await answer.arrayBuffer();
        const view = new DataView(buffer);
        const known = view.getUint32(0, true);
        if (known !== number) this.changed(true);
        number = known;
        if (this.asked === null) break;
        for (let at = 4; at < buffer.byteLength; ) {
          const length = view.getUint32(at, true);
          this.receive(...decoded(buffer.slice(at + 4, at + 4 + length)));
          at += 4 + length;
        }
      }
    } catch (problem) {
      // A request fails when the simulation has ended or was never there.
      if (!(problem instanceof TypeError) && problem.name !== "TimeoutError") throw problem;
    } finally {
      this.unsent = null;
    }
  }

  /** Takes as many waiting messages as fit into one request, as part of its query. */
  takeUnsent() {
    let text = "";
    while (this.unsent.length > 0) {
      const next = `&told=${encodeURIComponent(this.unsent[0])}`;
      if (text && text.length + next.length > MAX_QUERY) break;
      text += next;
      this.unsent.shift();
    }
    return text;
  }

  /** Closes the connection; it is opened again, and the simulation sends everything anew. */
  reopen() {
    this.asked = null;
    this.socket.close();
  }

  /**
   * Sends a message, its numbers within their bounds.
   *
   * @param {MessageFromPage} message
   */
  send(message) {
    const sound = bounded(message);
    if (sound === null) return;
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(sound));
    else this.unsent?.push(JSON.stringify(sound));
  }
}

/**
 * Header and payload of a message; src/carom/viewer/messages.py documents the format.
 *
 * @param {ArrayBuffer} buffer
 * @returns {[MessageToPage, ArrayBuffer]}
 */
function decoded(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  return [header, buffer.slice(4 + length)];
}
