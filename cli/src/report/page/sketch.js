// The scene to scale: shapes in metres, drawn as SVG from two sides, as a whole and where it acts.

const SIGNS = {
  solid: "solid", layer: "layer", reservoir: "reservoir of one temperature", drop: "droplet", velocity: "impact velocity",
  load: "load", wall: "wall of cells", probe: "probe", field: "field of outputs", face: "thermal condition",
  clamped: "clamped", roller: "roller", symmetry: "plane of symmetry", axis: "axis of symmetry",
};

/** A view with its detail, if it has one. */
function sketchView(view) {
  const parts = [panel(view, view.bounds, view.focus ? `${view.title}, whole` : view.title, view.focus)];
  if (view.focus) parts.push(panel(view, view.focus, `${view.title}, detail`, null));
  return parts;
}

function panel(view, bounds, title, focus) {
  const drawing = svg("svg", { class: "chart sketch", role: "img", "aria-label": `${title}: ${spoken(view)}` });
  const figure = el("figure", {}, el("figcaption", {}, el("b", {}, title)), drawing);
  onWidth(figure, (width) => drawSketch(drawing, view, bounds, focus, width));
  return figure;
}

/** What a view holds, in words. */
function spoken(view) {
  const labels = view.shapes.map((shape) => shape.label).filter(Boolean);
  return [...new Set(labels)].join("; ");
}

function drawSketch(drawing, view, [x0, y0, x1, y1], focus, width) {
  const room = 30, most = 360;
  const scale = Math.min((width - 2 * room) / (x1 - x0), (most - 2 * room) / (y1 - y0));
  const height = Math.max((y1 - y0) * scale, 24) + 2 * room + 26;
  const left = (width - (x1 - x0) * scale) / 2;
  const map = {
    x: (value) => left + (value - x0) * scale,
    y: (value) => room + (y1 - value) * scale,
    scale,
  };
  drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
  drawing.replaceChildren();
  const id = `clip${gradients++}`;
  drawing.append(svg("defs", {}, svg("clipPath", { id }, svg("rect", { x: 0, y: 0, width, height: height - 26 }))));
  const shapes = svg("g", { "clip-path": `url(#${id})` });
  drawing.append(shapes);
  const labels = [];
  for (const shape of view.shapes) draw(shapes, shape, map, labels);
  // What lies within a detail is named there.
  const frame = focus && box(focus, map);
  const isFree = ({ x, y }) => !frame || x < frame.x || x > frame.x + frame.width || y < frame.y || y > frame.y + frame.height;
  placeLabels(drawing, labels.filter(isFree), width, height - 26);
  if (focus) drawing.append(svg("rect", { class: "focus", ...box(focus, map, 6) }));
  scaleBar(drawing, scale, width, height);
}

/** A rectangle in pixels, not smaller than `least`. */
function box([x0, y0, x1, y1], map, least = 0) {
  let width = (x1 - x0) * map.scale, height = (y1 - y0) * map.scale;
  let x = map.x(x0), y = map.y(y1);
  if (width < least) { x -= (least - width) / 2; width = least; }
  if (height < least) { y -= (least - height) / 2; height = least; }
  return { x, y, width, height };
}

function draw(group, shape, map, labels) {
  const kind = shape.role, title = shape.label ? svg("title", {}, shape.label) : null;
  const note = (x, y) => shape.short && labels.push({ x, y, text: shape.short, kind });
  switch (shape.shape) {
    case "box": {
      const at = box(shape.at, map, kind === "load" || kind === "wall" ? 6 : 1);
      group.append(svg("rect", { class: kind, ...at }, title));
      note(at.x + 6, at.y + at.height / 2 + 4);
      break;
    }
    case "disc": {
      const [x, y, radius] = shape.at, r = Math.max(radius * map.scale, 1);
      group.append(svg("circle", { class: kind, cx: map.x(x), cy: map.y(y), r }, title));
      note(map.x(x) + r * 0.72 + 4, map.y(y) - r * 0.72 - 2);
      break;
    }
    case "point": {
      const [x, y] = shape.at;
      group.append(svg("circle", { class: kind, cx: map.x(x), cy: map.y(y), r: 4 }, title));
      note(map.x(x) + 7, map.y(y) + 4);
      break;
    }
    case "arrow": {
      const [x, y, dx, dy] = shape.at, size = Math.hypot(dx, dy) || 1, length = 30;
      const end = [map.x(x), map.y(y)], start = [end[0] - (dx / size) * length, end[1] + (dy / size) * length];
      group.append(arrow(start, end, kind, title));
      note(start[0] + 7, start[1] + 2);
      break;
    }
    case "line": {
      const [ax, ay, bx, by] = shape.at;
      const ends = [map.x(ax), map.y(ay), map.x(bx), map.y(by)];
      if (kind === "clamped" || kind === "roller") group.append(support(ends, kind, shape.out, title));
      else group.append(svg("line", { class: kind === "axis" ? "symmetry" : kind, x1: ends[0], y1: ends[1], x2: ends[2], y2: ends[3] }, title));
      note((ends[0] + ends[2]) / 2 + 8, (ends[1] + ends[3]) / 2 + (shape.out && shape.out[1] < 0 ? 18 : -6));
      break;
    }
  }
}

function arrow([x1, y1], [x2, y2], kind, title) {
  const angle = Math.atan2(y2 - y1, x2 - x1), size = 8;
  const wing = (turn) => `${x2 - size * Math.cos(angle + turn)} ${y2 - size * Math.sin(angle + turn)}`;
  return svg("g", { class: kind }, title,
    svg("line", { x1, y1, x2, y2 }), svg("path", { d: `M${x2} ${y2}L${wing(0.45)}L${wing(-0.45)}Z` }));
}

/** Hatches of a clamped edge, wheels of a roller, on the outer side. */
function support([x1, y1, x2, y2], kind, out, title) {
  const length = Math.hypot(x2 - x1, y2 - y1) || 1, group = svg("g", { class: "support" }, title);
  const along = [(x2 - x1) / length, (y2 - y1) / length], outward = [out[0], -out[1]];
  const count = Math.max(2, Math.min(60, Math.round(length / 12)));
  group.append(svg("line", { x1, y1, x2, y2 }));
  for (let i = 0; i < count; i++) {
    const at = (length * (i + 0.5)) / count, x = x1 + along[0] * at, y = y1 + along[1] * at;
    if (kind === "clamped") {
      group.append(svg("line", { x1: x, y1: y, x2: x + 7 * outward[0] - 4 * along[0], y2: y + 7 * outward[1] - 4 * along[1] }));
    } else {
      group.append(svg("circle", { cx: x + 4 * outward[0], cy: y + 4 * outward[1], r: 3 }));
    }
  }
  return group;
}

/** Texts beside what they name, moved down where they would cover each other. */
function placeLabels(drawing, labels, width, height) {
  const taken = [];
  for (const { x, y, text } of labels) {
    const long = 7 * text.length;
    if (x < 0 || y < 8 || x > width || y > height - 4) continue;
    const left = Math.min(x, width - long - 2);
    let at = y;
    while (taken.some((other) => Math.abs(other.y - at) < 14 && left < other.x + other.long && other.x < left + long)) at += 14;
    if (at > height - 2) continue;
    taken.push({ x: left, y: at, long });
    drawing.append(svg("text", { x: Math.max(left, 2), y: at }, text));
  }
}

/** A bar of a round length. */
function scaleBar(drawing, scale, width, height) {
  const rough = (width * 0.25) / scale, power = 10 ** Math.floor(Math.log10(rough));
  const length = [5, 2, 1].map((factor) => factor * power).find((size) => size <= rough);
  const y = height - 8, x = width - length * scale - 8;
  drawing.append(
    svg("path", { class: "axis", d: `M${x} ${y - 5}v5h${length * scale}v-5` }),
    svg("text", { x: x + (length * scale) / 2, y: y - 5, "text-anchor": "middle" }, quantity(length, "m", 3)),
  );
}

/** What the signs of the views mean. */
function signs(sketch) {
  const roles = [...new Set(sketch.views.flatMap((view) => view.shapes.map((shape) => shape.role)))];
  return el("p", { class: "small soft" }, `To scale. Shown: ${roles.map((role) => SIGNS[role]).filter(Boolean).join(", ")}.`);
}
