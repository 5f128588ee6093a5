// Scales of colour: lightness grows evenly along each, so that they read without hue, too.

const RAMPS = {
  heat: ["#0d0f2b", "#2b1a5e", "#5b1f7d", "#8d2a7b", "#bb3a68", "#e0584c", "#f58234", "#fcb04a", "#fde08a", "#fffbe0"],
  stress: ["#12233f", "#143a5e", "#14547a", "#186f8b", "#238a8f", "#3fa68a", "#6dbf80", "#a2d477", "#d6e67f", "#fbf7c4"],
};

const KINDS = { K: "heat", "W/m2": "heat" };

const parsed = Object.fromEntries(Object.entries(RAMPS).map(([name, stops]) => [
  name,
  stops.map((text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16))),
]));

/** The scale of a quantity: warm for heat, cool for all else. */
const rampOf = (unit) => KINDS[unit] || "stress";

/** 256 colours of a scale, red, green and blue after one another. */
const table = (() => {
  const made = {};
  return (name) => {
    if (made[name]) return made[name];
    const stops = parsed[name], colours = new Uint8ClampedArray(3 * 256);
    for (let k = 0; k < 256; k++) {
      const at = (k / 255) * (stops.length - 1), i = Math.min(Math.floor(at), stops.length - 2);
      for (let c = 0; c < 3; c++) colours[3 * k + c] = stops[i][c] + (at - i) * (stops[i + 1][c] - stops[i][c]);
    }
    return (made[name] = colours);
  };
})();

let gradients = 0;

/** A scale beside a plot, drawn into its overlay: ticks, unit, and arrows where values lie beyond. */
function colourBar(overlay, ramp, [low, high], unit, { x, y, height, beyond = [false, false] }) {
  const id = `ramp${gradients++}`, width = 13;
  const stops = RAMPS[ramp].map((colour, i, all) =>
    svg("stop", { offset: i / (all.length - 1), "stop-color": colour }));
  const { factor, label } = scaleOf(Math.max(Math.abs(low), Math.abs(high)), unit);
  const place = (value) => y + height * (1 - (value - low) / (high - low));
  overlay.append(
    svg("defs", {}, svg("linearGradient", { id, x1: 0, y1: 1, x2: 0, y2: 0 }, stops)),
    svg("rect", { x, y, width, height, fill: `url(#${id})`, class: "bar-of-colours" }),
    svg("rect", { x, y, width, height, class: "frame" }),
    svg("text", { x: x - 2, y: y - 8 }, label),
  );
  for (const value of ticks(low * factor, high * factor, Math.max(3, height / 45))) {
    const at = place(value / factor);
    overlay.append(
      svg("line", { x1: x + width, x2: x + width + 4, y1: at, y2: at, class: "axis" }),
      svg("text", { x: x + width + 7, y: at + 4 }, digits(value, 5)),
    );
  }
  if (beyond[1]) overlay.append(svg("path", { d: `M${x} ${y - 1}h${width}l${-width / 2} -6z`, fill: RAMPS[ramp].at(-1), class: "frame" }));
  if (beyond[0]) overlay.append(svg("path", { d: `M${x} ${y + height + 1}h${width}l${-width / 2} 6z`, fill: RAMPS[ramp][0], class: "frame" }));
}
