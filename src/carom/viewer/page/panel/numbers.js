// Numbers as text.

/** A number with some decimals; what rounds to nothing is 0, without a sign. */
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text;
}

/** Decimals with which a range is divided into a thousand steps or more. */
export function digitsFor(range) {
  return Math.max(0, Math.min(MAX_DIGITS, 3 - Math.floor(Math.log10(range || 1))));
}

/** A number as it is shown for a range: with decimals or, if these were too many, with a power of ten. */
export function shown(value, range) {
  const digits = digitsFor(range);
  if (digits <= MAX_SHOWN) return fixed(value, digits);
  const smallest = 10 ** -digits;
  return Math.abs(value) < smallest / 2 ? "0" : value.toExponential(Math.max(0, Math.min(3, Math.floor(Math.log10(Math.abs(value) / smallest)))));
}

/** A step for a range: a hundredth of its power of ten. */
export function stepFor(range) {
  return Number(`1e${Math.floor(Math.log10(range || 1)) - 2}`);
}

const MAX_DIGITS = 18;
const MAX_SHOWN = 6;
