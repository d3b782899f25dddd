// Plays a recording that is inside the page.

import { decoded } from "./time/recording.js";

/** @import { App } from "./app.js" */

/**
 * @param {string} text the recording in base 64
 * @param {App} app
 */
export async function playRecording(text, app) {
  document.body.classList.add("replay");
  const bytes = await (await fetch(`data:application/octet-stream;base64,${text}`)).arrayBuffer();
  const { facts, messages } = await decoded(bytes);
  app.panel.showTitle({ title: facts.title });
  for (const [header, payload] of messages) app.history.take(header, payload);
  if (facts.camera) {
    app.camera.set(facts.camera);
    app.viewpoint.undecided = false;
  }
  if (facts.options) {
    app.options.take(facts.options);
    app.optionsChanged();
  }
  app.plots.offer();
  for (const { header } of app.history.frames) app.plots.takeNames(header);
  app.player.seek(firstSight(app.history));
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) app.player.play();
}

/** The first moment with something to see: scripts load robots after floors, some time after they begin. */
export function firstSight({ frames, start }) {
  const most = frames.reduce((found, { header }) => Math.max(found, header.poses), 0);
  return frames.find(({ header }) => 2 * header.poses >= most)?.clock ?? start;
}
