// The socket to the simulation. It comes back by itself when the simulation does.

const RETRY_MS = 700;

export class Connection {
  /**
   * @param {(header: object, payload: ArrayBuffer) => void} receive called with each message
   * @param {(connected: boolean) => void} changed called when the connection is made or lost
   */
  constructor(receive, changed) {
    this.receive = receive;
    this.changed = changed;
    this.socket = null;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const folder = location.pathname.replace(/[^/]*$/, "");
    // The address may hold a token, by which the page may come through a proxy or from another machine.
    const socket = new WebSocket(`${scheme}://${location.host}${folder}socket${location.search}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.changed(true);
    socket.onmessage = (event) => this.receive(...decoded(event.data));
    socket.onclose = () => {
      this.changed(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
    this.socket = socket;
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

/** Header and payload of a message; src/carom/viewer/messages.py has the layout. */
function decoded(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  return [header, buffer.slice(4 + length)];
}
