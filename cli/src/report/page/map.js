// Maps: values at the nodes of a grid, between which they are linear, over a face or a section.

/** Puts a canvas below the plot of an overlay, in shares of it: so they stay together on paper. */
function cover(canvas, { left, top, width, height }, whole, tall) {
  const share = (value, of) => `${(100 * value) / of}%`;
  Object.assign(canvas.style, { left: share(left, whole), top: share(top, tall), width: share(width, whole), height: share(height, tall) });
}

const MAP_SIZE = { left: 52, right: 96, top: 26, bottom: 44, least: 90, most: 430 };

class FieldMap {
  constructor(map) {
    this.map = map;
    this.axes = map.axes.map((axis) => ({ ...axis, values: unpack(axis.values) }));
    this.fields = map.fields.map((field) => ({ ...field, values: unpack(field.values) }));
    this.cells = this.axes[0].values.length * this.axes[1].values.length;
    this.field = 0;
    this.frame = map.times.length - 1;
    this.isDetail = Boolean(map.focus);
    this.cursor = null;
    this.canvas = el("canvas", { "aria-hidden": "true" });
    this.overlay = svg("svg", { tabindex: 0, role: "img" });
    this.readout = el("div", { class: "readout", "aria-live": "polite" });
    this.plot = el("div", { class: "plot" }, this.canvas, this.overlay);
    this.note = el("span", { class: "soft" });
    this.element = el("figure", { class: "map" }, el("figcaption", {}, el("b", {}, map.title), " ", this.note), this.tools(), this.plot, this.readout);
    this.listen();
    if (map.layout !== "profile") clock.first = clock.first ?? map.times[this.fullest()];
    if (map.layout !== "profile") clock.add(map.times, (time) => this.show(time));
    recolour.add(() => this.draw());
    onWidth(this.element, (width) => { this.width = width; this.draw(); });
  }

  /** The place of the time at which values of the first field differ most. */
  fullest() {
    const { values } = this.fields[0];
    let [best, most] = [this.map.times.length - 1, -Infinity];
    this.map.times.forEach((_, frame) => {
      let [low, high] = [Infinity, -Infinity];
      for (const value of values.subarray(frame * this.cells, (frame + 1) * this.cells)) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
      if (high - low > most) [best, most] = [frame, high - low];
    });
    return best;
  }

  tools() {
    const fields = choice("Show", this.fields.map((field) => field.name), (i) => { this.field = i; this.draw(); });
    const near = this.map.focus && toggle("Detail", true, (on) => { this.isDetail = on; this.draw(); });
    return el("div", { class: "tools" }, fields, near);
  }

  show(time) {
    const frame = frameAt(this.map.times, time);
    if (frame !== this.frame) { this.frame = frame; this.draw(); }
  }

  /** The part that is shown, along both axes; sections of discs have both sides of the axis. */
  range() {
    const whole = this.axes.map(({ values }) => [values[0], values[values.length - 1]]);
    if (this.map.layout !== "grid" && this.map.layout !== "profile") whole[0] = [-whole[0][1], whole[0][1]];
    if (this.map.layout === "round") whole[1] = whole[0];
    return this.isDetail ? [this.map.focus.slice(0, 2), this.map.focus.slice(2)] : whole;
  }

  draw() {
    if (!this.width) return;
    const { left, right, top, bottom, least, most } = MAP_SIZE;
    const [x, y] = this.range();
    const width = Math.max(this.width - left - right, 60);
    const wanted = (width * (y[1] - y[0])) / (x[1] - x[0]);
    const isFree = this.map.layout === "profile";
    const height = isFree ? 230 : Math.min(Math.max(wanted, least), most);
    const isToScale = !isFree && Math.abs(height - wanted) < 1;
    // What is too high for its width is drawn to scale and narrower.
    const used = !isFree && wanted > most ? (width * most) / wanted : width;
    this.place = { left, top, width: used, height };
    this.height = top + height + bottom;
    const stretch = height / (wanted * (used / width));
    const [low, high] = extent(this.fields[this.field].values);
    this.note.textContent = low === high ? "(the same everywhere)" : isFree || isToScale || Math.abs(stretch - 1) < 0.02 ? "" : `(${this.axes[1].name} drawn ${digits(stretch, 2)} times as large)`;
    this.colour(x, y);
    this.annotate(x, y);
  }

  /** Range of colours: of all times, so that they can be compared. */
  limits() {
    const field = this.fields[this.field];
    return widened(field.range || (field.range = extent(field.values)));
  }

  colour(x, y) {
    const { width, height } = this.place, ratio = Math.min(window.devicePixelRatio || 1, 2);
    const columns = Math.max(Math.round(width * ratio), 1), rows = Math.max(Math.round(height * ratio), 1);
    Object.assign(this.canvas, { width: columns, height: rows });
    cover(this.canvas, this.place, this.width, this.height);
    const context = this.canvas.getContext("2d"), image = context.createImageData(columns, rows);
    const colours = table(rampOf(this.fields[this.field].unit)), [low, high] = this.limits();
    const across = Array.from({ length: columns }, (_, i) => x[0] + ((i + 0.5) / columns) * (x[1] - x[0]));
    const sample = this.sampler(across);
    for (let j = 0; j < rows; j++) {
      const values = sample(y[1] - ((j + 0.5) / rows) * (y[1] - y[0]));
      for (let i = 0; i < columns; i++) {
        const value = values(i), at = 4 * (j * columns + i);
        if (Number.isNaN(value)) continue;
        const k = 3 * Math.min(Math.max(Math.round((255 * (value - low)) / (high - low)), 0), 255);
        image.data[at] = colours[k];
        image.data[at + 1] = colours[k + 1];
        image.data[at + 2] = colours[k + 2];
        image.data[at + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
  }

  /** For places along x, a function of y that gives a function of the column. */
  sampler(across) {
    const { layout } = this.map;
    if (layout === "round") {
      const start = this.frame * this.cells, values = this.fields[this.field].values, radii = this.axes[0].values;
      return (y) => (i) => {
        const radius = Math.hypot(across[i], y);
        if (radius > radii[radii.length - 1]) return NaN;
        const [at, share] = this.between(0, radius);
        return values[start + at] * (1 - share) + values[start + Math.min(at + 1, radii.length - 1)] * share;
      };
    }
    const columns = across.map((x) => this.between(0, layout === "section" ? Math.abs(x) : x));
    return (y) => {
      const row = this.between(1, y);
      return (i) => (columns[i] && row ? this.value(columns[i], row) : NaN);
    };
  }

  /** The interval of an axis that holds a value, and the share of it below; nothing outside. */
  between(axis, value) {
    const { values } = this.axes[axis], last = values.length - 1;
    if (this.map.is_cells) {
      const edges = this.axes[axis].edges || (this.axes[axis].edges = edgesOf(values, this.axes[axis].ends));
      if (value < edges[0] || value > edges[last + 1]) return null;
      return [Math.min(upper(edges, value) - 1, last), 0];
    }
    if (value < values[0] || value > values[last]) return null;
    const at = Math.min(Math.max(upper(values, value) - 1, 0), Math.max(last - 1, 0));
    const span = values[Math.min(at + 1, last)] - values[at];
    return [at, span > 0 ? (value - values[at]) / span : 0];
  }

  value([i, u], [j, v]) {
    const columns = this.axes[0].values.length, rows = this.axes[1].values.length;
    const { values } = this.fields[this.field];
    const isProfile = this.map.layout === "profile";
    const start = isProfile ? 0 : this.frame * this.cells;
    const at = (a, b) => values[start + Math.min(b, rows - 1) * columns + Math.min(a, columns - 1)];
    if (u === 0 && v === 0) return at(i, j);
    return (at(i, j) * (1 - u) + at(i + 1, j) * u) * (1 - v) + (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
  }

  /** The value at a place, as it is drawn. */
  read(x, y) {
    return this.sampler([x])(y)(0);
  }

  annotate(x, y) {
    const { overlay, place } = this, field = this.fields[this.field];
    overlay.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    const limits = this.limits(), range = limits.map((value) => quantity(value, field.unit, 4)).join(" to ");
    overlay.setAttribute("aria-label", `${this.map.title}: ${field.name} from ${range}. Arrow keys move the point that is read.`);
    overlay.replaceChildren();
    this.toX = (value) => place.left + (place.width * (value - x[0])) / (x[1] - x[0]);
    this.toY = (value) => place.top + (place.height * (y[1] - value)) / (y[1] - y[0]);
    const axis = (k, range, at) => ({ range, unit: this.axes[k].unit, name: this.axes[k].name, place: at });
    const second = this.map.layout === "round" ? { ...axis(0, y, this.toY), name: "y" } : axis(1, y, this.toY);
    const first = this.map.layout === "round" ? { ...axis(0, x, this.toX), name: "x" } : axis(0, x, this.toX);
    drawAxes(overlay, place, first, second, false);
    for (const mark of this.map.marks || []) {
      const [a, b] = mark.at;
      if (a < x[0] || a > x[1] || b < y[0] || b > y[1]) continue;
      overlay.append(
        svg("circle", { cx: this.toX(a), cy: this.toY(b), r: 4, class: "mark", style: "stroke:#fff" }, svg("title", {}, mark.name)),
        svg("circle", { cx: this.toX(a), cy: this.toY(b), r: 5, class: "mark", style: "stroke:#000;stroke-width:1" }),
      );
    }
    colourBar(overlay, rampOf(field.unit), limits, field.unit, { x: place.left + place.width + 14, y: place.top, height: place.height });
    this.shown = [x, y];
    this.cross = svg("g", {});
    overlay.append(this.cross);
    this.point();
  }

  listen() {
    const { overlay } = this;
    const at = (event) => {
      if (!this.shown) return null;
      const bounds = overlay.getBoundingClientRect(), scale = this.width / bounds.width;
      const [x, y] = this.shown, { left, top, width, height } = this.place;
      const u = ((event.clientX - bounds.left) * scale - left) / width, v = ((event.clientY - bounds.top) * scale - top) / height;
      if (u < 0 || u > 1 || v < 0 || v > 1) return null;
      return [x[0] + u * (x[1] - x[0]), y[1] - v * (y[1] - y[0])];
    };
    overlay.addEventListener("pointermove", (event) => { this.cursor = at(event); this.point(); });
    overlay.addEventListener("pointerdown", (event) => { this.cursor = at(event); this.point(); });
    overlay.addEventListener("pointerleave", () => { this.cursor = null; this.point(); });
    overlay.addEventListener("keydown", (event) => {
      const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
      const move = moves[event.key];
      if (!move || !this.shown) return;
      event.preventDefault();
      const [x, y] = this.shown;
      const from = this.cursor || [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
      this.cursor = [[x, move[0]], [y, move[1]]].map(([range, way], k) =>
        Math.min(Math.max(from[k] + (way * (range[1] - range[0])) / 40, range[0]), range[1]));
      this.point();
    });
  }

  /** The cross and the value that is read at it. */
  point() {
    if (!this.cross) return;
    this.cross.replaceChildren();
    const field = this.fields[this.field];
    const time = this.map.layout === "profile" ? "" : ` at ${quantity(this.map.times[this.frame], "s", 4)}`;
    if (!this.cursor) {
      const start = this.map.layout === "profile" ? 0 : this.frame * this.cells;
      const now = extent(field.values.subarray(start, this.map.layout === "profile" ? undefined : start + this.cells));
      this.readout.textContent = `${now.map((value) => quantity(value, field.unit)).join(" to ")}${time}`;
      return;
    }
    const [x, y] = this.cursor, { left, top, width, height } = this.place;
    this.cross.append(
      svg("line", { class: "cross", x1: this.toX(x), x2: this.toX(x), y1: top, y2: top + height }),
      svg("line", { class: "cross", x1: left, x2: left + width, y1: this.toY(y), y2: this.toY(y) }),
    );
    const value = this.read(x, y);
    const names = this.map.layout === "round" ? ["x", "y"] : this.axes.map(({ name }) => name);
    const units = this.map.layout === "round" ? ["m", "m"] : this.axes.map(({ unit }) => unit);
    this.readout.textContent = `${quantity(value, field.unit)} at ${names[0]} = ${quantity(x, units[0], 3)}, ${names[1]} = ${quantity(y, units[1], 3)}`;
  }
}

/** The first place whose value is larger. */
function upper(values, value) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Edges of cells around their middles, the outermost as far away as inside unless they are given. */
function edgesOf(middles, ends) {
  const count = middles.length, edges = new Float64Array(count + 1);
  for (let i = 1; i < count; i++) edges[i] = (middles[i - 1] + middles[i]) / 2;
  const half = count > 1 ? (middles[1] - middles[0]) / 2 : Math.abs(middles[0]) || 1;
  const last = count > 1 ? (middles[count - 1] - middles[count - 2]) / 2 : half;
  edges[0] = ends ? ends[0] : middles[0] - half;
  edges[count] = ends ? ends[1] : middles[count - 1] + last;
  return edges;
}
