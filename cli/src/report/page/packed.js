// Arrays of the document: lists of numbers, or 16 bits a value between two ends, as base64.

const MISSING = 65535;

/** Values of an array, as numbers of double precision; missing ones are not a number. */
function unpack(array) {
  if (Array.isArray(array)) return Float64Array.from(array, (value) => (value === null ? NaN : value));
  const text = atob(array.data);
  const values = new Float64Array(text.length / 2);
  const step = (array.high - array.low) / (MISSING - 1);
  for (let i = 0; i < values.length; i++) {
    const code = text.charCodeAt(2 * i) | (text.charCodeAt(2 * i + 1) << 8);
    values[i] = code === MISSING ? NaN : array.low + step * code;
  }
  return values;
}
