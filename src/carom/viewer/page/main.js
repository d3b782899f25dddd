// Starts the page: connected to a running simulation, or with a recording that is inside the page.

import { App } from "./app.js";
import { Connection } from "./connection.js";
import { playRecording } from "./replay.js";

const notice = document.getElementById("notice");

function say(text) {
  notice.textContent = text ?? "";
  notice.hidden = !text;
}

/**
 * Reloads the page after a lost WebGL context, because the restored context is empty. Browsers drop the
 * context when the machine sleeps, the driver is restarted, or a notebook has many views.
 */
function surviveLostGraphics() {
  const canvas = document.getElementById("view");
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    say("The browser has lost the graphics context. Waiting for it to be restored…");
  });
  canvas.addEventListener("webglcontextrestored", () => location.reload());
}

function watch() {
  const send = (message) => connection.send(message);
  const app = (window.app = new App(send, say));
  const connection = new Connection(
    (header, payload) => app.receive(header, payload),
    (connected) => {
      say(connected ? null : "The simulation has ended. Waiting for the next one…");
      if (connected) app.begin();
    },
  );
}

async function start() {
  surviveLostGraphics();
  const recording = document.getElementById("recording");
  if (recording) await playRecording(recording.textContent.trim(), (window.app = new App(() => {}, say)));
  else watch();
}

start().catch((error) => {
  say(error.message);
  throw error;
});
