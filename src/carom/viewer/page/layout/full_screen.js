// The page on the whole screen, without the browser around it.

import { press } from "../panel/states.js";

/** @import { Memory } from "../memory.js" */

export class FullScreen {
  /**
   * Binds the button; it is hidden where the browser does not let the page fill the screen.
   *
   * @param {Memory} memory
   * @param {() => void} changed
   */
  constructor(memory, changed) {
    this.memory = memory;
    this.button = document.getElementById("full");
    this.button.hidden = !document.fullscreenEnabled;
    this.title = this.button.title;
    /** Ends the wait for something that the user does. @type {AbortController | null} */
    this.waiting = null;
    /** Whether the page is being left or loaded again, by which the browser ends the full screen. */
    this.leaving = false;
    window.addEventListener("beforeunload", () => (this.leaving = true));
    this.button.addEventListener("click", () => {
      if (document.fullscreenElement) document.exitFullscreen();
      else this.enter();
    });
    document.addEventListener("fullscreenchange", () => {
      const on = document.fullscreenElement !== null;
      press(this.button, on);
      if (!this.leaving) memory.put("fullScreen", on);
      changed();
    });
  }

  enter() {
    this.waiting?.abort();
    document.documentElement.requestFullscreen().catch(() => {});
  }

  /**
   * Fills the screen again as when the page was open last. Browsers let a page do so only when the user does
   * something: the first click or key does it, and the button says so.
   */
  recall() {
    this.waiting?.abort();
    if (this.memory.get("fullScreen") !== true || document.fullscreenElement || !document.fullscreenEnabled) return;
    this.waiting = new AbortController();
    const { signal } = this.waiting;
    this.button.title = "The next click or key fills the screen again, as before; Esc does not";
    signal.addEventListener("abort", () => (this.button.title = this.title));
    window.addEventListener("keydown", (event) => (event.key === "Escape" ? this.forget() : this.enter()), { signal, capture: true });
    // The button does so itself.
    window.addEventListener("pointerup", ({ target }) => this.button.contains(/** @type {Node} */ (target)) || this.enter(), { signal, capture: true });
  }

  forget() {
    this.waiting.abort();
    this.memory.put("fullScreen", false);
  }
}
