// Saving the view as a picture or a video, and the history as a page that replays it.

import { download } from "./download.js";
import { filmOf } from "./film.js";
import { press } from "../panel/states.js";
import { removalOf } from "./history.js";
import { encoded } from "./recording.js";

/** @import { History } from "./history.js" */
/** @import { Player } from "./player.js" */
/** @import { Shots } from "./shots.js" */

const FILM_FPS = 30;
const FILM_BITS = 8_000_000;
const FILM_KINDS = ["video/mp4;codecs=avc1", "video/webm;codecs=vp9", "video/webm"];
/** Placeholder of the recording in the page that plays it. */
const PLACE = "RECORDING";

export class Saving {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {History} history
   * @param {Player} moments plays the recording that is filmed
   * @param {Shots} shots draws pictures
   * @param {() => string} title returns the name of the files
   * @param {() => object} facts returns the further data of a replay: camera and options
   * @param {(text: ?string, lasts?: boolean) => void} say shows a notice
   */
  constructor(canvas, history, moments, shots, title, facts, say) {
    this.canvas = canvas;
    this.history = history;
    this.moments = moments;
    this.shots = shots;
    this.title = title;
    this.facts = facts;
    this.say = say;
    /** The page that replays a history, without one; null until it has come. */
    this.player = null;
    this.film = null;
    this.filmButton = document.getElementById("film");
    this.renderButton = document.getElementById("render");
    /** Whether the recording is being filmed, and whether it shall go on being so. */
    this.rendering = false;
    document.getElementById("picture").addEventListener("click", () => this.savePicture());
    this.renderButton.addEventListener("click", () => this.toggleRendering());
    this.filmButton.addEventListener("click", () => this.toggleFilm());
    document.getElementById("save").addEventListener("click", () => this.saveReplay());
    this.changed = () => {};
    /** Called with true when a video is started, and with false when it ends. */
    this.filming = (_on) => {};
  }

  savePicture() {
    try {
      this.shots.draw().toBlob((blob) => download(blob, `${this.title()}.png`));
    } catch (error) {
      this.say(`The picture could not be saved: ${error.message}`);
    }
  }

  /** Films the recording from the shown moment on, or all of it; a second call ends that. */
  async toggleRendering() {
    const { history, moments, renderButton: button } = this;
    if (this.rendering || history.count === 0) return (this.rendering = false);
    const { live, clock, speed } = moments;
    const from = live || clock >= history.end ? history.start : clock;
    const label = button.textContent;
    this.rendering = true;
    press(button, true);
    const draw = (moment) => {
      moments.running = false;
      moments.seek(moment);
      return this.shots.draw();
    };
    const progress = (share) => {
      button.textContent = `${Math.round(100 * share)} %`;
      return this.rendering;
    };
    try {
      const film = await filmOf(draw, { from, to: history.end, speed }, progress);
      if (film) download(film, `${this.title()}.webm`);
    } catch (error) {
      this.say(`The video could not be made: ${error.message}`);
    } finally {
      this.rendering = false;
      press(button, false);
      button.textContent = label;
      if (live) moments.goLive();
      else moments.seek(clock);
    }
  }

  toggleFilm() {
    if (this.film) this.film.stop();
    else this.startFilm();
  }

  startFilm() {
    const kind = FILM_KINDS.find((each) => MediaRecorder.isTypeSupported(each));
    const film = new MediaRecorder(this.canvas.captureStream(FILM_FPS), { mimeType: kind, videoBitsPerSecond: FILM_BITS });
    const parts = [];
    this.filming(true);
    film.ondataavailable = ({ data }) => parts.push(data);
    film.onstop = () => {
      this.film = null;
      this.filming(false);
      press(this.filmButton, false);
      download(new Blob(parts, { type: kind }), `${this.title()}.${kind.startsWith("video/mp4") ? "mp4" : "webm"}`);
    };
    film.start();
    this.film = film;
    press(this.filmButton, true);
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
