// Files that are dropped on the page: sent in pieces, then shown.

import { FromPage } from "../protocol.js";

/** Bytes of a piece: in base 64 they fit into a message. */
const PIECE = 30000;

export class Drop {
  /**
   * @param {(message: MessageFromPage) => void} send
   * @param {import("../panel/notices.js").Notices} notices
   */
  constructor(send, notices) {
    this.send = send;
    this.notices = notices;
    /** Whether files can be dropped. */
    this.on = false;
    this.mark = document.getElementById("dropping");
    window.addEventListener("dragover", (event) => this.over(event));
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && this.show(false));
    window.addEventListener("drop", (event) => this.take(event));
  }

  show(over) {
    this.mark.hidden = !over;
  }

  over(event) {
    if (!this.on || !event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    this.show(true);
  }

  async take(event) {
    if (!this.on || !event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    this.show(false);
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
    const loose = entries.length ? [] : [...event.dataTransfer.files].map((file) => ({ name: file.name, file }));
    try {
      const found = (await Promise.all(entries.map((entry) => filesIn(entry, "")))).flat();
      await this.sendAll([...found, ...loose]);
    } catch (problem) {
      this.notices.say(`What was dropped cannot be read: ${problem.message}`);
    }
  }

  /**
   * Sends files, then asks to show them.
   *
   * @param {{name: string, file: Blob}[]} files
   */
  async sendAll(files) {
    if (files.length === 0) return;
    for (const { name, file } of files) {
      this.notices.say(`Sending ${name}…`, true);
      for (let at = 0; at === 0 || at < file.size; at += PIECE) {
        const bytes = new Uint8Array(await file.slice(at, at + PIECE).arrayBuffer());
        this.send({ type: FromPage.UPLOAD, name, start: at === 0, data: btoa(String.fromCharCode(...bytes)) });
      }
    }
    this.notices.say(null);
    this.send({ type: FromPage.OPEN });
  }
}

/** All files in what was dropped, with their paths. */
async function filesIn(entry, folder) {
  const name = `${folder}${entry.name}`;
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    return [{ name, file }];
  }
  const reader = entry.createReader();
  const inside = [];
  for (;;) {
    // A part of them at a time.
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) break;
    inside.push(...some);
  }
  return (await Promise.all(inside.map((each) => filesIn(each, `${name}/`)))).flat();
}
