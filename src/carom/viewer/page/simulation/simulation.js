// The sections of the panel for a simulation without a script, and those that show all of a scene: controls, sensors,
// contacts.

import { Arguments } from "./arguments.js";
import { Console } from "./console.js";
import { Contacts } from "./contacts.js";
import { Controls } from "./controls.js";
import { Drop } from "./drop.js";
import { FromPage } from "../protocol.js";
import { isSpectator } from "../spectating.js";
import { Keyframes } from "./keyframes.js";
import { Sensors } from "./sensors.js";
import { Settings } from "./settings.js";

/** @import { App } from "../app.js" */

/** Time after the last frame when sections are updated once more [ms]; longer than between two updates. */
const SETTLED_MS = 150;

export class Simulation {
  /**
   * @param {App} app
   * @param {import("../panel/notices.js").Notices} notices
   */
  constructor(app, notices) {
    const { scene, readings, send, bodies, plots } = app;
    this.app = app;
    const choose = (body, link) => bodies.select(body, link);
    this.keyframes = new Keyframes(send, notices);
    this.arguments = new Arguments(send);
    this.controls = new Controls(scene, readings, send, app.memory);
    this.sensors = new Sensors(scene, readings, (key) => plots.choose(key));
    this.contacts = new Contacts(scene, readings, choose);
    this.settings = new Settings(send);
    this.console = new Console(notices);
    this.drop = new Drop(send, notices);
    /** Whether the page is that of a simulation without a script. */
    this.on = false;
    this.files = "";
    this.timer = undefined;
    document.getElementById("reload").addEventListener("click", () => send({ type: FromPage.RELOAD }));
    if (isSpectator()) for (const { list } of [this.keyframes, this.settings, this.arguments]) list.toggleAttribute("inert", true);
  }

  clear() {
    this.on = this.drop.on = false;
    this.files = "";
    for (const { root } of [this.keyframes, this.settings, this.arguments, this.console]) root.hidden = true;
    document.getElementById("reload").hidden = true;
    for (const part of [this.controls, this.sensors, this.contacts]) part.clear();
    this.console.last = null;
  }

  /** The page is that of a simulation without a script; other files than before are looked at anew. */
  take({ files, stated }) {
    this.on = true;
    this.drop.on = !isSpectator();
    document.getElementById("reload").hidden = isSpectator();
    this.app.panel.goes("Play");
    this.settings.takeStated(stated);
    const names = JSON.stringify(files);
    if (this.files !== "" && this.files !== names) this.app.lookAnew();
    this.files = names;
    this.app.panel.showTitle({ title: files.join(", "), watch: this.app.panel.watch });
    this.offer();
  }

  /** Bodies have come, gone or changed. */
  offer() {
    if (this.on) this.controls.offer();
    this.sensors.offer();
    this.soon();
  }

  show() {
    this.update();
    this.soon();
  }

  /** Updates what sections show once more, as no frames come while nothing moves. */
  soon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.update(), SETTLED_MS);
  }

  update() {
    if (this.on) this.controls.show();
    this.sensors.show();
    this.contacts.show();
  }

  /** The data besides poses that its sections need. */
  get wants() {
    return { joints: this.on && this.controls.isOpen, contacts: this.contacts.isOpen, sensors: this.sensors.wanted };
  }
}
