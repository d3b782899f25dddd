// Notices over the view: how the connection stands, for as long as it does, and short messages beside it.

/** How long a short message is shown [ms]. */
const BRIEF_MS = 8000;

export class Notices {
  constructor() {
    this.root = document.getElementById("notice");
    this.state = document.createElement("span");
    this.message = document.createElement("span");
    this.buttons = Object.assign(document.createElement("span"), { className: "choices" });
    this.root.append(this.state, this.message, this.buttons);
    this.timer = null;
  }

  /**
   * Shows how the connection stands.
   *
   * @param {?string} text null if there is nothing to say
   * @param {Node[]} choices buttons below it
   */
  stand(text, choices = []) {
    // Told again and again while the page waits; it is announced once.
    if (this.state.textContent !== (text ?? "")) this.state.textContent = text ?? "";
    this.buttons.replaceChildren(...choices);
    this.show();
  }

  /** Shows a message, beside what is shown; null ends it. It goes away by itself unless it `lasts`. */
  say(text, lasts = false) {
    clearTimeout(this.timer);
    this.message.textContent = text ?? "";
    this.show();
    if (text && !lasts) this.timer = setTimeout(() => this.say(null), BRIEF_MS);
  }

  show() {
    this.message.hidden = this.message.textContent === "";
    this.root.hidden = this.message.hidden && this.state.textContent === "";
  }
}

/** A button for a notice. */
export function choice(text, act) {
  const button = Object.assign(document.createElement("button"), { textContent: text });
  button.addEventListener("click", act);
  return button;
}
