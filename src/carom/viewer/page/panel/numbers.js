// Numbers as text.

/** A number with some decimals; what rounds to nothing is 0, without a sign. */
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text;
}

/** Decimals with which a range is divided into a thousand steps or more. */
export function digitsFor(range) {
  return Math.max(0, Math.min(MOST_DIGITS, 3 - Math.floor(Math.log10(range || 1))));
}

const MOST_DIGITS = 15;
