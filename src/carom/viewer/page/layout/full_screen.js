// The page on the whole screen, without the browser around it.

import { press } from "../panel/states.js";

/** Binds the button; it is hidden where the browser does not let the page do so. @param {() => void} changed */
export function fullScreen(changed) {
  const button = document.getElementById("full");
  button.hidden = !document.fullscreenEnabled;
  button.addEventListener("click", () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => {});
  });
  document.addEventListener("fullscreenchange", () => {
    press(button, document.fullscreenElement !== null);
    changed();
  });
}
