// Keeps the numbers of messages to the simulation within their bounds: it refuses what is beyond.

import { BOUNDS } from "./protocol.js";

/**
 * A message with all its numbers within their bounds; null if one is not a number at all, as of a ray that meets
 * nothing.
 *
 * @param {MessageFromPage} message
 */
export function bounded(message) {
  if (isBroken(message)) return null;
  const bounds = BOUNDS[message.type] ?? {};
  return Object.fromEntries(Object.entries(message).map(([field, value]) => [field, field in bounds ? within(value, bounds[field]) : value]));
}

function isBroken(value) {
  if (typeof value === "number") return Number.isNaN(value);
  return typeof value === "object" && value !== null && Object.values(value).some(isBroken);
}

/** A value with the numbers in it, at any depth, not below and not above two others. */
function within(value, [lower, upper]) {
  if (typeof value === "number") return Math.min(Math.max(value, lower), upper);
  if (Array.isArray(value)) return value.map((each) => within(each, [lower, upper]));
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, within(each, [lower, upper])]));
}
