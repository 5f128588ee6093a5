// Values over time: a chart for each quantity, all zoomed together.

const SHOWN_AT_FIRST = 6;
const MOST_BUTTONS = 10;
const HUES = 8;

class Histories {
  constructor(histories) {
    this.axis = { ...histories.axis, values: unpack(histories.axis.values) };
    this.whole = widened(extent(this.axis.values));
    this.range = this.whole;
    const groups = new Map();
    for (const series of histories.series) {
      const key = `${series.group}|${series.unit}`;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push({ ...series, values: unpack(series.values) });
    }
    this.charts = [...groups.values()].map((series) => new Chart(this, series));
    const zoom = (label, name, change) => el("button", { type: "button", "aria-label": name, title: name, onclick: change }, label);
    this.element = el("div", {},
      el("div", { class: "tools" },
        zoom("+", "Zoom in", () => this.zoom(0.5)), zoom("−", "Zoom out", () => this.zoom(2)), zoom("Whole run", "Show all times", () => this.go(this.whole)),
        el("span", { class: "small soft" }, "Drag across a chart to zoom; with the keyboard: arrows move the time that is read, + and − zoom, 0 shows all.")),
      el("div", { class: "grid" }, this.charts.map((chart) => chart.element)));
    clock.listeners.push((time) => this.read(time, false));
  }

  go([low, high]) {
    const [start, end] = this.whole;
    if (high - low < (end - start) * 1e-6) return;
    this.range = [Math.max(low, start), Math.min(high, end)];
    for (const chart of this.charts) chart.draw();
  }

  zoom(factor) {
    const [low, high] = this.range;
    const middle = this.time >= low && this.time <= high ? this.time : (low + high) / 2;
    this.go([middle - (middle - low) * factor, middle + (high - middle) * factor]);
  }

  /** Reads all charts at a time; nothing ends that. */
  read(time) {
    this.time = time;
    for (const chart of this.charts) chart.read();
  }
}

class Chart {
  constructor(histories, series) {
    this.histories = histories;
    this.series = series.map((one, i) => ({ ...one, isShown: i < SHOWN_AT_FIRST, colour: `var(--s${i % HUES})`, dash: i < HUES ? null : "5 3" }));
    this.unit = series[0].unit;
    this.svg = svg("svg", { class: "chart", tabindex: 0, role: "img", "aria-label": `${series[0].group} over ${histories.axis.name}: ${series.map(({ name }) => name).join(", ")}` });
    const buttons = this.series.map((one) => {
      one.value = el("em", {});
      const button = toggle("", one.isShown, (on) => { one.isShown = on; this.draw(); });
      button.title = one.about || one.name;
      button.append(el("i", { style: `border-top-color:${one.colour};${one.dash ? "border-top-style:dashed" : ""}` }), el("span", {}, one.name), one.value);
      return button;
    });
    const hidden = buttons.splice(buttons.length > MOST_BUTTONS ? SHOWN_AT_FIRST : buttons.length);
    this.legend = el("div", {}, el("div", { class: "legend" }, buttons),
      hidden.length ? el("details", {}, el("summary", { class: "small" }, `${hidden.length} more`), el("div", { class: "legend" }, hidden)) : null);
    this.element = el("figure", {}, el("figcaption", {}, el("b", {}, series[0].group)), this.legend, this.svg);
    this.listen();
    onWidth(this.element, (width) => { this.width = width; this.draw(); });
  }

  draw() {
    if (!this.width) return;
    const place = { left: 58, top: 26, width: Math.max(this.width - 72, 60), height: 190 };
    const { axis, range } = this.histories, times = axis.values;
    const from = Math.max(upper(times, range[0]) - 2, 0), to = Math.min(upper(times, range[1]) + 1, times.length);
    const shown = this.series.filter((one) => one.isShown);
    let limits = [Infinity, -Infinity];
    for (const one of shown) {
      const [low, high] = extent(one.values.subarray(from, to));
      limits = [Math.min(limits[0], low), Math.max(limits[1], high)];
    }
    limits = shown.length ? widened(limits) : [0, 1];
    const margin = 0.04 * (limits[1] - limits[0]);
    const y = [limits[0] - margin, limits[1] + margin];
    this.place = place;
    this.toX = (value) => place.left + (place.width * (value - range[0])) / (range[1] - range[0]);
    const toY = (value) => place.top + (place.height * (y[1] - value)) / (y[1] - y[0]);
    const height = place.top + place.height + 44;
    this.svg.setAttribute("viewBox", `0 0 ${this.width} ${height}`);
    this.svg.replaceChildren();
    drawAxes(this.svg, place,
      { range, unit: axis.unit, name: axis.name, place: this.toX }, { range: y, unit: this.unit, name: "", place: toY });
    const id = `clip${gradients++}`;
    const lines = svg("g", { "clip-path": `url(#${id})` });
    this.svg.append(svg("defs", {}, svg("clipPath", { id }, svg("rect", { x: place.left, y: place.top - 1, width: place.width, height: place.height + 2 }))), lines);
    for (const one of shown) {
      let path = "", pen = "M";
      for (let i = from; i < to; i++) {
        const value = one.values[i];
        if (Number.isNaN(value)) { pen = "M"; continue; }
        path += `${pen}${this.toX(times[i]).toFixed(1)} ${toY(value).toFixed(1)}`;
        pen = "L";
      }
      lines.append(svg("path", { d: path, fill: "none", stroke: one.colour, "stroke-width": 1.8, "stroke-dasharray": one.dash, style: `stroke:${one.colour}` }));
    }
    this.cursor = svg("g", {});
    this.svg.append(this.cursor);
    this.read();
  }

  /** The values at the time that is read, in the legend. */
  read() {
    if (!this.cursor || !this.place) return;
    const { axis, time, range } = this.histories;
    this.cursor.replaceChildren();
    if (time === undefined) return;
    const at = nearest(axis.values, time), { top, height } = this.place;
    for (const one of this.series) one.value.textContent = one.isShown ? quantity(one.values[at], one.unit, 5) : "";
    const where = axis.values[at];
    if (where < range[0] || where > range[1]) return;
    this.cursor.append(svg("line", { class: "cross", x1: this.toX(where), x2: this.toX(where), y1: top, y2: top + height }));
  }

  listen() {
    const { histories } = this;
    const timeAt = (event) => {
      if (!this.place) return histories.whole[1];
      const bounds = this.svg.getBoundingClientRect(), { left, width } = this.place, [low, high] = histories.range;
      const share = ((event.clientX - bounds.left) * (this.width / bounds.width) - left) / width;
      return low + Math.min(Math.max(share, 0), 1) * (high - low);
    };
    let start = null;
    this.svg.addEventListener("pointerdown", (event) => { start = timeAt(event); histories.read(start); });
    this.svg.addEventListener("pointermove", (event) => {
      const now = timeAt(event);
      histories.read(now);
      if (start === null || event.buttons === 0) return;
      const [a, b] = [this.toX(start), this.toX(now)];
      this.cursor.append(svg("rect", { x: Math.min(a, b), y: this.place.top, width: Math.abs(b - a), height: this.place.height, style: "fill:var(--accent);fill-opacity:0.15" }));
    });
    this.svg.addEventListener("pointerup", (event) => {
      const end = timeAt(event), begin = start;
      start = null;
      if (begin !== null && Math.abs(this.toX(end) - this.toX(begin)) > 8) histories.go([Math.min(begin, end), Math.max(begin, end)]);
    });
    this.svg.addEventListener("dblclick", () => histories.go(histories.whole));
    this.svg.addEventListener("keydown", (event) => {
      const { axis, range, time } = histories, values = axis.values;
      const at = nearest(values, time === undefined ? range[1] : time);
      const step = Math.max(1, Math.round((upper(values, range[1]) - upper(values, range[0])) / 100));
      const actions = {
        ArrowLeft: () => histories.read(values[Math.max(at - step, 0)]),
        ArrowRight: () => histories.read(values[Math.min(at + step, values.length - 1)]),
        "+": () => histories.zoom(0.5), "=": () => histories.zoom(0.5), "-": () => histories.zoom(2), 0: () => histories.go(histories.whole),
      };
      if (!actions[event.key]) return;
      event.preventDefault();
      actions[event.key]();
    });
  }
}

/** The place of the value nearest to another, of ascending ones. */
function nearest(values, value) {
  const after = Math.min(upper(values, value), values.length - 1), before = Math.max(after - 1, 0);
  return value - values[before] <= values[after] - value ? before : after;
}
