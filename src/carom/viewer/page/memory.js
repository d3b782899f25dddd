// What the browser keeps for each script: camera, switches, folded sections, plots.

const PREFIX = "carom.script.";
/** Changes are written together after this time [ms]. */
const SOON_MS = 200;

export class Memory {
  constructor() {
    this.key = null;
    this.kept = {};
    this.timer = null;
  }

  /** Begins with the script of a title; true if it is another one than before. Replays never begin. */
  begin(title) {
    const key = PREFIX + title;
    if (key === this.key) return false;
    if (this.timer !== null) this.write();
    this.key = key;
    this.kept = {};
    try {
      const kept = JSON.parse(localStorage.getItem(key) ?? "{}");
      if (kept !== null && typeof kept === "object") this.kept = kept;
    } catch {
      // Frames of other sites may have no storage, and what another version wrote may not be readable.
    }
    return true;
  }

  get(name) {
    return this.kept[name];
  }

  put(name, value) {
    if (this.key === null) return;
    this.kept[name] = value;
    this.timer ??= setTimeout(() => this.write(), SOON_MS);
  }

  write() {
    clearTimeout(this.timer);
    this.timer = null;
    try {
      localStorage.setItem(this.key, JSON.stringify(this.kept));
    } catch {
      // Without storage the page forgets.
    }
  }
}
