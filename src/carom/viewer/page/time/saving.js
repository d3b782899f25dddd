// Saving the view as a picture or a video, and the history as a page that replays it.

import { download } from "./download.js";
import { removalOf } from "./history.js";
import { encoded } from "./recording.js";

const FILM_FPS = 30;
const FILM_BITS = 8_000_000;
const FILM_KINDS = ["video/mp4;codecs=avc1", "video/webm;codecs=vp9", "video/webm"];
/** Placeholder of the recording in the page that plays it. */
const PLACE = "RECORDING";

export class Saving {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {History} history
   * @param {() => string} title returns the name of the files
   * @param {() => object} facts returns the further data of a replay: camera and options
   * @param {(text: ?string) => void} say shows a notice
   */
  constructor(canvas, history, title, facts, say) {
    Object.assign(this, { canvas, history, title, facts, say });
    this.pictureWanted = false;
    /** The page that replays a history, without one; null until it has come. */
    this.player = null;
    this.film = null;
    this.filmButton = document.getElementById("film");
    document.getElementById("picture").addEventListener("click", () => this.askForPicture());
    this.filmButton.addEventListener("click", () => this.toggleFilm());
    document.getElementById("save").addEventListener("click", () => this.saveReplay());
    this.changed = () => {};
    /** Called with true when a video is started, and with false when it ends. */
    this.filming = () => {};
  }

  askForPicture() {
    this.pictureWanted = true;
    this.changed();
  }

  /** Saves a picture if asked for. Called right after drawing, while the canvas still has its pixels. */
  drawn() {
    if (!this.pictureWanted) return;
    this.pictureWanted = false;
    const picture = document.createElement("canvas");
    [picture.width, picture.height] = [this.canvas.width, this.canvas.height];
    const context = picture.getContext("2d");
    context.drawImage(this.canvas, 0, 0);
    this.write(context, this.canvas.width / this.canvas.clientWidth);
    picture.toBlob((blob) => download(blob, `${this.title()}.png`));
  }

  /** Draws the texts that are over the view into a picture. */
  write(context, ratio) {
    for (const span of document.querySelectorAll("#labels span:not([hidden])")) {
      const { left, bottom } = span.getBoundingClientRect();
      const style = getComputedStyle(span);
      context.font = `${style.fontWeight} ${parseFloat(style.fontSize) * ratio}px ${style.fontFamily}`;
      context.fillStyle = style.color;
      context.fillText(span.textContent, left * ratio, (bottom - 4) * ratio);
    }
  }

  toggleFilm() {
    if (this.film) this.film.stop();
    else this.startFilm();
  }

  startFilm() {
    const kind = FILM_KINDS.find((kind) => MediaRecorder.isTypeSupported(kind));
    const film = new MediaRecorder(this.canvas.captureStream(FILM_FPS), { mimeType: kind, videoBitsPerSecond: FILM_BITS });
    const parts = [];
    this.filming(true);
    film.ondataavailable = ({ data }) => parts.push(data);
    film.onstop = () => {
      this.film = null;
      this.filming(false);
      this.filmButton.classList.remove("on");
      download(new Blob(parts, { type: kind }), `${this.title()}.${kind.startsWith("video/mp4") ? "mp4" : "webm"}`);
    };
    film.start();
    this.film = film;
    this.filmButton.classList.add("on");
    this.changed();
  }

  /** Fetches the page that replays a history, while there is a server: scripts end before their users save. */
  async prepare() {
    if (this.player !== null) return;
    try {
      const response = await fetch(`replay.html${location.search}`);
      if (response.ok) this.player ??= await response.text();
    } catch {
      // `saveReplay` asks once more, and says what is wrong.
    }
  }

  /** Saves a page that replays the history, without a network. */
  async saveReplay() {
    if (this.history.count === 0) return;
    this.say("Saving…", true);
    try {
      await this.prepare();
      if (this.player === null) throw new Error("there is no server that has the player");
      const page = this.player;
      const bytes = await encoded(this.history, { title: this.title(), ...this.facts() }, removalOf);
      download(new Blob([page.replace(PLACE, () => base64(bytes))], { type: "text/html" }), `${this.title()}.html`);
      this.say(null);
    } catch (error) {
      this.say(`The replay could not be saved: ${error.message}`);
    }
  }
}

function base64(buffer) {
  const bytes = new Uint8Array(buffer);
  let text = "";
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text);
}
