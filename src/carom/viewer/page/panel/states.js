// States of buttons, for the eye and for screen readers.

/** Shows whether a button is pressed. */
export function press(button, on) {
  button.classList.toggle("on", on);
  tell(button, "aria-pressed", on);
}

/** Tells whether what a button unfolds is open. */
export function unfold(button, open) {
  tell(button, "aria-expanded", open);
}

function tell(button, name, state) {
  if (button.getAttribute(name) !== String(state)) button.setAttribute(name, String(state));
}
