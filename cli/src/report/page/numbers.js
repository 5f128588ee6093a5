// Numbers with units, as readers expect them: SI prefixes, a bounded number of digits, round ticks.

const PREFIXES = [["f", -15], ["p", -12], ["n", -9], ["µ", -6], ["m", -3], ["", 0], ["k", 3], ["M", 6], ["G", 9], ["T", 12]];
const PREFIXED = /^(m|s|J|W|N|Pa|Hz)(?![a-zA-Z])/;

/** A unit as it is printed: `W/(m2.K)` is W/(m² K). */
function unitText(unit) {
  if (!unit || unit === "1") return "";
  return unit.replace(/(?<=[a-zA-Z])2/g, "²").replace(/(?<=[a-zA-Z])3/g, "³").replace(/\./g, " ");
}

/** Whether a unit takes a prefix: not kilograms, kelvins, speeds, nor areas. */
const takesPrefix = (unit) => PREFIXED.test(unit || "") && !/^(m|s)[/.2-9]/.test(unit);

/** Factor and label of a unit in which values up to this size are short. */
function scaleOf(size, unit) {
  const plain = { factor: 1, label: unitText(unit) };
  if (!takesPrefix(unit) || !(size > 0) || !isFinite(size)) return plain;
  const exponent = Math.floor(Math.log10(size * (1 + 1e-12)));
  const found = PREFIXES.find(([, power]) => exponent - power >= 0 && exponent - power < 3);
  return found ? { factor: 10 ** -found[1], label: found[0] + unitText(unit) } : plain;
}

/** A number with so many digits, with an exponent where it would be long without. */
function digits(value, count = 5) {
  if (!isFinite(value)) return String(value);
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(count - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(count)));
}

/** A value with its unit; temperatures also in degrees Celsius. */
function quantity(value, unit, count = 5) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const { factor, label } = scaleOf(Math.abs(value), unit);
  const text = `${digits(value * factor, count)}${label ? ` ${label}` : ""}`;
  return unit === "K" && value > 100 ? `${text} (${(value - 273.15).toFixed(2)} °C)` : text;
}

/** A share as a percentage of two digits. */
const percent = (share) => `${digits(100 * share, 2)} %`;

/** Round values between two, about so many. */
function ticks(low, high, count) {
  const span = high - low;
  if (!(span > 0) || !isFinite(span)) return [low];
  const rough = span / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; k++) found.push(k * step);
  return found;
}

/** Smallest and largest finite number. */
function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high && value < Infinity) high = value;
  }
  return low <= high ? [low, high] : [0, 0];
}

/** A range that can be drawn: never empty. */
function widened([low, high]) {
  if (high > low) return [low, high];
  const margin = Math.abs(low) * 1e-3 || 1;
  return [low - margin, high + margin];
}
