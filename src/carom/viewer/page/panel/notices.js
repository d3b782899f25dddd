// Notices over the view: how the connection stands, for as long as it does, and short messages beside it.

/** How long a short message is shown [ms]. */
const BRIEF_MS = 8000;

export class Notices {
  constructor() {
    this.root = document.getElementById("notice");
    this.state = new Row(this.root);
    this.message = new Row(this.root);
    this.timer = null;
  }

  /**
   * Shows how the connection stands.
   *
   * @param {?string} text null if there is nothing to say
   * @param {Node[]} choices buttons below it
   */
  stand(text, choices = []) {
    this.state.show(text, choices);
    this.update();
  }

  /** Shows a message, beside what is shown; null ends it. It goes away by itself unless it `lasts`. */
  say(text, lasts = false, choices = []) {
    clearTimeout(this.timer);
    this.message.show(text, choices);
    this.update();
    if (text && !lasts) this.timer = setTimeout(() => this.say(null), BRIEF_MS);
  }

  /**
   * Asks for a while whether to do something; without an answer it is not done.
   *
   * @param {string} text the question
   * @param {string} yes what the button says that does it
   * @param {string} no what the button says that does not
   * @param {() => void} act called with the answer yes
   */
  ask(text, yes, no, act) {
    const asker = document.activeElement;
    const end = () => {
      this.say(null);
      if (asker instanceof HTMLElement) asker.focus({ preventScroll: true });
    };
    const doing = choice(yes, () => {
      end();
      act();
    });
    this.say(text, false, [doing, choice(no, end)]);
    doing.focus({ preventScroll: true });
  }

  update() {
    this.root.hidden = this.state.empty && this.message.empty;
  }
}

/** A text with buttons below it. */
class Row {
  constructor(root) {
    this.text = document.createElement("span");
    this.buttons = Object.assign(document.createElement("span"), { className: "choices" });
    root.append(this.text, this.buttons);
  }

  show(text, choices) {
    // Told again and again while the page waits; it is announced once.
    if (this.text.textContent !== (text ?? "")) this.text.textContent = text ?? "";
    this.buttons.replaceChildren(...choices);
    this.text.hidden = this.empty;
  }

  get empty() {
    return this.text.textContent === "";
  }
}

/** A button for a notice. */
export function choice(text, act) {
  const button = Object.assign(document.createElement("button"), { textContent: text });
  button.addEventListener("click", act);
  return button;
}
