// Whether the page is that of a spectator, who sees everything and can change nothing. The server knows it by the
// token, says so in the page, and does not listen to what else such a page sends.

import { SPECTATING } from "./protocol.js";

/** Whether this page only watches. */
export function isSpectator() {
  return document.body.classList.contains("spectator");
}

/**
 * What sends the messages of a page: of a spectator only those by which it asks to be shown something.
 *
 * @param {(message: MessageFromPage) => void} send
 * @returns {(message: MessageFromPage) => void}
 */
export function sendingAs(send, spectator = isSpectator()) {
  return (message) => {
    if (!spectator || SPECTATING.has(message.type)) send(message);
  };
}

/** The address of this page for spectators, by their token. */
export function watchingAddress(token, { origin, pathname } = location) {
  return `${origin}${pathname}?token=${encodeURIComponent(token)}`;
}
