// Starts the page: connected to a running simulation, or with a recording that is inside the page.

import { App } from "./app.js";
import { Connection } from "./connection.js";
import { Notices } from "./panel/notices.js";
import { playRecording } from "./replay.js";
import { Runs } from "./runs.js";
import { sendingAs } from "./spectating.js";

const notices = new Notices();
const say = (text, lasts = false) => notices.say(text, lasts);

/**
 * Fills the WebGL context again after it was lost: a restored one is empty. Browsers drop the context when the
 * machine sleeps, the driver is restarted, or a notebook has many views.
 */
function surviveLostGraphics() {
  const canvas = document.getElementById("view");
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    say("The browser has lost the graphics context. Waiting for it to be restored…", true);
  });
  canvas.addEventListener("webglcontextrestored", () => {
    window.app.refillGraphics();
    say(null);
  });
}

function watch() {
  const send = sendingAs((message) => connection.send(message));
  const app = (window.app = new App(send, notices));
  const runs = new Runs(app, notices, () => connection.reopen());
  const connection = new Connection(
    (header, payload) => runs.receive(header, payload),
    (connected) => (connected ? app.saving.prepare() : runs.leave()),
  );
}

async function start() {
  document.getElementById("arriving").remove();
  surviveLostGraphics();
  const recording = document.getElementById("recording");
  if (recording) await playRecording(recording.textContent.trim(), (window.app = new App(() => {}, notices)));
  else watch();
}

start().catch((error) => {
  say(error.message, true);
  throw error;
});
