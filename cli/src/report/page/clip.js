// A droplet over time: its particles as dots on a canvas, to scale, above the wall.

class Clip {
  constructor(clip) {
    this.clip = clip;
    this.x = unpack(clip.x);
    this.y = unpack(clip.y);
    this.fields = clip.fields.map((field) => ({ ...field, values: unpack(field.values) }));
    this.starts = clip.counts.reduce((all, count) => [...all, all[all.length - 1] + count], [0]);
    this.field = 0;
    this.frame = clip.times.length - 1;
    this.canvas = el("canvas", { "aria-hidden": "true" });
    this.overlay = svg("svg", { role: "img" });
    this.readout = el("div", { class: "readout", "aria-live": "polite" });
    const fields = choice("Show", clip.fields.map((field) => field.name), (i) => { this.field = i; this.draw(); });
    this.element = el("figure", { class: "clip" },
      el("figcaption", {}, el("b", {}, clip.title), " ", el("span", { class: "soft" }, clip.about)),
      el("div", { class: "tools" }, fields), el("div", { class: "plot" }, this.canvas, this.overlay), this.readout);
    this.overlay.addEventListener("pointermove", (event) => this.point(event));
    this.overlay.addEventListener("pointerdown", (event) => this.point(event));
    this.overlay.addEventListener("pointerleave", () => this.tell());
    clock.add(clip.times, (time) => {
      const frame = frameAt(clip.times, time);
      if (frame !== this.frame) { this.frame = frame; this.draw(); }
    });
    recolour.add(() => this.draw());
    onWidth(this.element, (width) => { this.width = width; this.draw(); });
  }

  /** Colours span all but the last hundredth at either end: a few particles never take them all. */
  limits() {
    const field = this.fields[this.field];
    if (!field.limits) {
      const sorted = Float64Array.from(field.values).sort(), last = sorted.length - 1;
      const ends = [sorted[Math.floor(0.01 * last)], sorted[Math.ceil(0.99 * last)]];
      field.limits = widened(ends);
      field.beyond = [sorted[0] < ends[0], sorted[last] > ends[1]];
    }
    return field.limits;
  }

  draw() {
    if (!this.width) return;
    const { clip } = this, field = this.fields[this.field];
    const left = 52, right = 96, top = 26, bottom = 44;
    const [x0, y0, x1, y1] = clip.bounds;
    const wide = Math.max(this.width - left - right, 60), most = 420;
    const scale = Math.min(wide / (x1 - x0), most / (y1 - y0));
    const width = (x1 - x0) * scale, height = (y1 - y0) * scale;
    this.place = { left, top, width, height, scale };
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    Object.assign(this.canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    cover(this.canvas, this.place, this.width, top + height + bottom);
    const context = this.canvas.getContext("2d");
    context.scale(ratio, ratio);
    this.dots(context, field);
    this.annotate(field, top + height + bottom);
    this.tell();
  }

  dots(context, field) {
    const { clip, place: { scale } } = this, [x0, , , y1] = clip.bounds;
    const [low, high] = this.limits(), colours = table(rampOf(field.unit));
    const radius = Math.max((clip.size * scale) / 2, 1.1) * 1.1;
    for (let i = this.starts[this.frame]; i < this.starts[this.frame + 1]; i++) {
      const k = 3 * Math.min(Math.max(Math.round((255 * (field.values[i] - low)) / (high - low)), 0), 255);
      context.fillStyle = `rgb(${colours[k]} ${colours[k + 1]} ${colours[k + 2]})`;
      for (const side of clip.is_mirrored ? [1, -1] : [1]) {
        context.beginPath();
        context.arc((side * this.x[i] - x0) * scale, (y1 - this.y[i]) * scale, radius, 0, 7);
        context.fill();
      }
    }
  }

  annotate(field, height) {
    const { overlay, clip, place } = this, [x0, y0, x1, y1] = clip.bounds;
    overlay.setAttribute("viewBox", `0 0 ${this.width} ${height}`);
    overlay.setAttribute("aria-label", `${clip.title}, ${clip.about}: ${this.starts[this.frame + 1] - this.starts[this.frame]} particles`);
    overlay.replaceChildren();
    if (y0 < 0) overlay.append(svg("rect", { class: "ground", x: place.left, y: place.top + y1 * place.scale, width: place.width, height: -y0 * place.scale }));
    const [first, second] = clip.axes;
    drawAxes(overlay, place,
      { range: [x0, x1], unit: "m", name: first, place: (value) => place.left + (value - x0) * place.scale },
      { range: [y0, y1], unit: "m", name: second, place: (value) => place.top + (y1 - value) * place.scale }, false);
    const limits = this.limits();
    colourBar(overlay, rampOf(field.unit), limits, field.unit, { x: place.left + place.width + 14, y: place.top, height: Math.max(place.height, 60), beyond: field.beyond });
  }

  tell() {
    const field = this.fields[this.field], [from, to] = [this.starts[this.frame], this.starts[this.frame + 1]];
    const time = quantity(this.clip.times[this.frame], "s", 4);
    if (from === to) { this.readout.textContent = `no particles at ${time}`; return; }
    const range = extent(field.values.subarray(from, to)).map((value) => quantity(value, field.unit));
    this.readout.textContent = `${range.join(" to ")} at ${time}`;
  }

  /** The particle nearest to the pointer. */
  point(event) {
    if (!this.place) return;
    const bounds = this.overlay.getBoundingClientRect(), { left, top, scale } = this.place, [x0, , , y1] = this.clip.bounds;
    const zoom = this.width / bounds.width;
    let x = x0 + ((event.clientX - bounds.left) * zoom - left) / scale;
    const y = y1 - ((event.clientY - bounds.top) * zoom - top) / scale;
    if (this.clip.is_mirrored) x = Math.abs(x);
    let best = -1, least = (2 * this.clip.size + 6 / scale) ** 2;
    for (let i = this.starts[this.frame]; i < this.starts[this.frame + 1]; i++) {
      const away = (this.x[i] - x) ** 2 + (this.y[i] - y) ** 2;
      if (away < least) { least = away; best = i; }
    }
    if (best < 0) { this.tell(); return; }
    const all = this.fields.map((field) => `${field.name} ${quantity(field.values[best], field.unit)}`);
    this.readout.textContent = all.join(", ");
  }
}
