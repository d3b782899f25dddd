// Key events: they are sent to the script, and some change the view, as in PyBullet's window.

import { FromPage } from "../protocol.js";

/** @import { App } from "../app.js" */

/** Keys that switch an option. */
const SHORTCUTS = {
  a: "bounds",
  c: "contacts",
  g: "panel",
  j: "frames",
  k: "constraints",
  l: "limits",
  s: "shadows",
  v: "visuals",
  w: "wireframe",
};
/** Keys whose default action in the browser is suppressed, because scripts use them. */
const KEPT_FROM_THE_BROWSER = /^(Arrow.*|Page.*|Home|End|Backspace| |F([1-46-9]|1[03-5]))$/;
/** Controls that are done with once they are clicked. */
const CLICKED = "button, input[type=range], input[type=checkbox], summary";
/** Controls to which Tab leads. */
const WALKED = "input, button, summary, select, textarea";
const TYPING = "input:not([type=range]):not([type=checkbox]), textarea, select";

export class Keys {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.acts = {
      d: () => (app.scene.many ? app.say("Key d has no effect here: it is for a single world") : app.send({ type: FromPage.SLEEP })),
      i: () => app.panel.togglePause(),
      o: () => app.send({ type: FromPage.STEP }),
      p: () => app.send({ type: FromPage.PROFILE, running: true }),
      F1: () => app.saving.toggleFilm(),
      "?": () => app.help.toggle(),
    };
    window.addEventListener("keydown", (event) => this.down(event));
    window.addEventListener("keyup", (event) => this.up(event));
    window.addEventListener("pointerup", () => this.giveBack());
    // A click by the keyboard leaves the focus to who walks through the panel with it.
    window.addEventListener("click", (event) => event.detail > 0 && this.giveBack());
    // A page without the focus gets no key releases.
    window.addEventListener("blur", () => this.leave());
  }

  down(event) {
    const { target, key } = event;
    const element = target instanceof HTMLElement ? target : null;
    if (event.isComposing) return;
    // Who walks through the panel with the keyboard goes back to the view; from there Esc ends the script.
    if (key === "Escape" && element?.matches(WALKED) && !this.app.help.open) return this.app.canvas.focus();
    if (element?.matches(TYPING)) return;
    const command = event.ctrlKey || event.metaKey;
    const onControl = element?.matches("input, button, summary");
    if (KEPT_FROM_THE_BROWSER.test(key) && !command && !onControl) event.preventDefault();
    if (event.repeat) return;
    // While the help is open, ESC closes the help and not the simulation.
    if (key === "Escape" && this.app.help.open) return this.app.help.toggle();
    // While the view is that of a script's camera, ESC goes back to the user's own.
    if (key === "Escape" && this.app.lenses.looking) return this.app.lenses.leave();
    this.app.send({ type: FromPage.KEY, key, code: event.code, down: true });
    if (!this.app.options.shortcuts || command || event.altKey) return;
    const name = SHORTCUTS[key];
    if (name) {
      this.app.options[name] = !this.app.options[name];
      // As in PyBullet's window, the grid is hidden and shown with the panel.
      if (name === "panel") this.app.options.grid = this.app.options.panel;
      this.app.optionSet(name);
    } else this.acts[key]?.();
  }

  up(event) {
    this.app.send({ type: FromPage.KEY, key: event.key, code: event.code, down: false });
    if (event.key === "p") this.app.send({ type: FromPage.PROFILE, running: false });
  }

  /** What was clicked does not keep the keyboard: the script alone gets the keys, as in PyBullet's window. */
  giveBack() {
    if (document.activeElement?.matches(CLICKED)) this.app.canvas.focus({ preventScroll: true });
  }

  leave() {
    this.app.send({ type: FromPage.BLUR });
    this.app.send({ type: FromPage.PROFILE, running: false });
  }
}
