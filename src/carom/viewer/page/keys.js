// Keys go to the script, and some change the view as they do in PyBullet's window.

const SHORTCUTS = { w: "wireframe", j: "frames", a: "bounds", s: "shadows", g: "panel" };
/** Keys that would make the browser do something else than the script wants. */
const KEPT_FROM_THE_BROWSER = /^(Arrow.*|Page.*|Home|End|Tab|Backspace| |F([1-46-9]|1[03-5]))$/;

export class Keys {
  constructor(send, options, optionsChanged) {
    const types = (target) => target instanceof HTMLElement && target.matches("input:not([type=range]):not([type=checkbox]), textarea, select");
    window.addEventListener("keydown", (event) => {
      if (types(event.target) || event.isComposing) return;
      const command = event.ctrlKey || event.metaKey;
      const onControl = event.target instanceof HTMLElement && event.target.matches("input, button");
      if (KEPT_FROM_THE_BROWSER.test(event.key) && !command && !onControl) event.preventDefault();
      if (event.repeat) return;
      send({ type: "key", key: event.key, code: event.code, down: true });
      const name = SHORTCUTS[event.key];
      if (name && options.shortcuts && !command && !event.altKey) {
        options[name] = !options[name];
        optionsChanged();
      }
    });
    window.addEventListener("keyup", (event) => {
      send({ type: "key", key: event.key, code: event.code, down: false });
    });
    // Whoever takes the keyboard away will not tell when keys go up.
    window.addEventListener("blur", () => send({ type: "blur" }));
  }
}
