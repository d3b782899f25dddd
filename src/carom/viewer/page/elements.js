// Finding elements of the page.

/**
 * The element with an id, which has to be of a kind.
 *
 * @template {HTMLElement} E
 * @param {string} id
 * @param {new () => E} kind such as `HTMLInputElement`
 * @returns {E}
 */
export function element(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new TypeError(`The page has no ${kind.name} ${id}.`);
  return found;
}
