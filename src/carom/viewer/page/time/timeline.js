// The time bar below the view: scrubbing, playback, loops, marks, and the return to the live simulation.

import { fixed } from "../panel/numbers.js";
import { press, unfold } from "../panel/states.js";
import { FromPage } from "../protocol.js";
import { isSpectator } from "../spectating.js";
import { element } from "../elements.js";

/** @import { Player } from "./player.js" */
/** @import { TimeWindow } from "./window.js" */

const NEAR = 8;

export class Timeline {
  /**
   * @param {Player} player
   * @param {TimeWindow} part the part of the history that the bar spans
   * @param {(message: MessageFromPage) => void} send sends a message to the simulation; does nothing in a replay
   */
  constructor(player, part, send) {
    this.player = player;
    this.part = part;
    this.send = send;
    this.root = document.getElementById("timeline");
    this.scrubber = element("scrub", HTMLInputElement);
    this.label = document.getElementById("moment");
    this.playing = document.getElementById("play");
    this.live = document.getElementById("live");
    this.loop = document.getElementById("loop");
    this.ticks = document.getElementById("ticks");
    /** Marks by number: their times on the history's clock [s], and their buttons. */
    this.marks = new Map();
    this.bind();
    player.changed = () => this.show();
  }

  bind() {
    const { player } = this;
    this.scrubber.addEventListener("input", () => {
      player.running = false;
      player.seek(Number(this.scrubber.value));
    });
    this.playing.addEventListener("click", () => (player.running ? player.pause() : player.play()));
    this.live.addEventListener("click", () => player.goLive());
    this.loop.addEventListener("click", () => {
      player.looping = !player.looping;
      this.show();
    });
    const extras = document.getElementById("extras");
    document.getElementById("more").addEventListener("click", (event) => {
      unfold(event.currentTarget, extras.classList.toggle("open"));
    });
    document.getElementById("back").addEventListener("click", () => player.step(-1));
    document.getElementById("forth").addEventListener("click", () => player.step(1));
    document.getElementById("mark").addEventListener("click", () => this.send({ type: FromPage.MARK }));
    const speed = element("playback", HTMLSelectElement);
    speed.addEventListener("change", () => (player.speed = Number(speed.value)));
  }

  clear() {
    for (const mark of [...this.marks.keys()]) this.removeMark({ mark });
  }

  addMark({ mark, time }) {
    const frames = this.player.history.frames;
    const frame = frames.findLast(({ header }) => header.time <= time + 1e-9) ?? frames.at(-1);
    const button = Object.assign(document.createElement("button"), { className: "tick" });
    button.title = `Mark at ${time.toFixed(3)} s: click to view this state`;
    const clock = frame?.clock ?? 0;
    button.addEventListener("click", () => this.player.seek(clock));
    if (!isSpectator()) {
      button.title += ", double-click to continue the simulation from it";
      button.addEventListener("dblclick", () => {
        this.send({ type: FromPage.RESTORE, mark });
        this.player.goLive();
      });
    }
    this.ticks.append(button);
    this.marks.set(mark, { clock, button });
    this.show();
  }

  removeMark({ mark }) {
    this.marks.get(mark)?.button.remove();
    this.marks.delete(mark);
  }

  /** Updates the bar. */
  show() {
    const { player } = this;
    const { history } = player;
    const clock = player.live ? history.end : player.clock;
    if (history.count === 0) return;
    const [start, end] = this.part.range;
    [this.scrubber.min, this.scrubber.max] = [String(start), String(Math.max(end, start + 1e-3))];
    this.scrubber.valueAsNumber = clock;
    const { time } = history.frames[Math.max(player.index, 0)].header;
    this.label.textContent = player.live ? `${fixed(time, 2)} s` : `${fixed(time, 3)} s, ${fixed(clock - history.end, 2)}`;
    this.playing.textContent = player.running ? "❚❚" : "▶";
    this.playing.title = player.running ? "Pause the playback" : "Play the recording";
    press(this.live, player.live);
    press(this.loop, player.looping);
    this.root.classList.toggle("past", !player.live);
    const span = Math.max(end - start, 1e-6);
    for (const { clock: at, button } of this.marks.values()) {
      button.hidden = at < start || at > end + 1e-6;
      // The thumb of a slider does not reach the ends of its track.
      button.style.left = `calc(${NEAR}px + ${(at - start) / span} * (100% - ${2 * NEAR}px))`;
    }
  }
}
