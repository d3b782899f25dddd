// Which run the page shows: a run that has ended stays until the user lets the next one take its place.

import { choice } from "./panel/notices.js";
import { FromPage, ToPage } from "./protocol.js";

/** @import { App } from "./app.js" */
/** @import { Notices } from "./panel/notices.js" */

/** The choice to let each next run take the place of the last one at once, kept by the browser. */
const AT_ONCE = "carom.nextRunAtOnce";

export class Runs {
  /**
   * @param {App} app
   * @param {Notices} notices
   * @param {() => void} reconnect closes the connection, which then opens again
   */
  constructor(app, notices, reconnect) {
    this.app = app;
    this.notices = notices;
    this.reconnect = reconnect;
    /** The run that is shown, null before the first one. */
    this.shown = null;
    /** The run of the present connection: null until it has told its title. */
    this.present = null;
    this.allowed = false;
    /** The last line of the exception that has ended the present run; null if there was none. */
    this.error = null;
  }

  /** Takes a message of the connection, which shows it unless the run that has ended is still shown. */
  receive(header, payload) {
    if (header.type === ToPage.TITLE && this.present === null) this.meet(header);
    if (header.type === ToPage.ENDING) this.error = header.error;
    if (this.present !== null && this.present === this.shown) this.app.receive(header, payload);
  }

  /** Decides whether a run that has told its name takes its place. */
  meet({ run }) {
    this.present = run;
    if (this.shown === null || this.shown === run || this.allowed || this.atOnce || this.app.history.count < 2) this.accept();
    else this.offer();
  }

  accept() {
    this.shown = this.present;
    this.allowed = false;
    this.error = null;
    this.notices.stand(null);
    this.app.begin();
  }

  offer() {
    this.app.send({ type: FromPage.VISIBLE, visible: false });
    const always = Object.assign(document.createElement("input"), { type: "checkbox" });
    const label = document.createElement("label");
    label.append(always, "Always at once");
    always.addEventListener("change", () => localStorage.setItem(AT_ONCE, always.checked ? "yes" : ""));
    const show = choice("Show it", () => {
      this.allowed = true;
      this.reconnect();
    });
    this.notices.stand("The next run is there. This one stays until you let it go.", [show, label]);
  }

  get atOnce() {
    return localStorage.getItem(AT_ONCE) === "yes";
  }

  /** The connection has been lost or could not be made. */
  leave() {
    const wasThere = this.present !== null;
    this.present = null;
    // The page itself has closed the connection, to let the next run in.
    if (this.allowed && wasThere) return;
    const end = this.error === null ? "The simulation has ended." : `The script has ended by an error: ${this.error}`;
    this.notices.stand(`${end} Waiting for the next one…`);
  }
}
