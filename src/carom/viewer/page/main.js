// Where the page begins: live beside a simulation, or alone with a recording inside it.

import { App } from "./app.js";
import { Connection } from "./connection.js";
import { playRecording } from "./replay.js";

const notice = document.getElementById("notice");

function say(text) {
  notice.textContent = text ?? "";
  notice.hidden = !text;
}

/**
 * Browsers drop the WebGL context of a page when the machine sleeps, the driver is restarted, or a notebook has many
 * views. What comes back is empty, so the page begins again.
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
