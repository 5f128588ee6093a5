// Axes around a plot: ticks below and to the left, with the unit they are in.

/** Draws both axes into a group; `x` and `y` are { range, unit, name, place }. */
function drawAxes(group, { left, top, width, height }, x, y, grid = true) {
  const bottom = top + height;
  const scaleX = scaleOf(Math.max(...x.range.map(Math.abs)), x.unit);
  const scaleY = scaleOf(Math.max(...y.range.map(Math.abs)), y.unit);
  for (const value of ticks(x.range[0] * scaleX.factor, x.range[1] * scaleX.factor, width / 75)) {
    const at = x.place(value / scaleX.factor);
    if (grid) group.append(svg("line", { x1: at, x2: at, y1: top, y2: bottom, class: "rule" }));
    group.append(svg("text", { x: at, y: bottom + 17, "text-anchor": "middle" }, digits(value, 6)));
  }
  for (const value of ticks(y.range[0] * scaleY.factor, y.range[1] * scaleY.factor, height / 38)) {
    const at = y.place(value / scaleY.factor);
    if (grid) group.append(svg("line", { x1: left, x2: left + width, y1: at, y2: at, class: "rule" }));
    group.append(svg("text", { x: left - 6, y: at + 4, "text-anchor": "end" }, digits(value, 6)));
  }
  const title = ({ name }, { label }) => [name, label && `[${label}]`].filter(Boolean).join(" ");
  group.append(
    svg("rect", { x: left, y: top, width, height, class: "frame" }),
    svg("text", { x: left + width, y: bottom + 33, "text-anchor": "end", class: "soft" }, title(x, scaleX)),
    svg("text", { x: 2, y: top - 8, class: "soft" }, title(y, scaleY)),
  );
}
