// A study: its rows as a table, lines across parallel axes, points of two columns, sensitivities.

const isVarying = ({ values }) => values.some((value) => typeof value === "number") && new Set(values).size > 1;

class StudyView {
  constructor(study) {
    this.study = study;
    this.columns = study.columns.map((column) => ({ ...column, isNumeric: column.values.every((value) => value === null || typeof value === "number") }));
    this.count = study.columns.length ? study.columns[0].values.length : 0;
    this.drawn = this.columns.filter((column) => column.isNumeric && isVarying(column));
    const outputs = this.drawn.filter(({ role }) => role === "output");
    this.colourBy = outputs[0] || this.drawn[0];
    this.brushes = new Map();
    this.chosen = null;
    this.order = { column: null, isDown: false };
    this.table = el("div", { class: "scroll" });
    this.parallel = svg("svg", { class: "chart", role: "img", "aria-label": "Rows as lines across parallel axes" });
    this.scatter = svg("svg", { class: "chart", role: "img", "aria-label": "Rows as points" });
    this.readout = el("div", { class: "readout", "aria-live": "polite" });
    this.element = el("div", {}, this.graphs(), el("h3", {}, `Rows (${this.count})`), this.table);
    this.drawTable();
  }

  graphs() {
    if (this.drawn.length < 2) return null;
    const names = this.drawn.map(({ name }) => name);
    const parameter = Math.max(this.drawn.findIndex(({ role }) => role === "parameter"), 0);
    this.x = this.drawn[parameter];
    this.y = this.colourBy === this.x ? this.drawn[1] : this.colourBy;
    const pick = (label, chosen, change) => {
      const made = choice(label, names, (i) => { change(this.drawn[i]); this.drawGraphs(); });
      made.querySelector("select").selectedIndex = this.drawn.indexOf(chosen);
      return made;
    };
    const lines = el("figure", {}, el("figcaption", {}, el("b", {}, "All rows across all columns"), " ", el("span", { class: "soft" }, "drag along an axis to select rows")),
      el("div", { class: "tools" }, pick("Colour", this.colourBy, (column) => { this.colourBy = column; }),
        el("button", { type: "button", onclick: () => { this.brushes.clear(); this.drawGraphs(); this.drawTable(); } }, "Select all rows")),
      this.parallel, this.readout);
    const points = el("figure", {}, el("figcaption", {}, el("b", {}, "Two columns")),
      el("div", { class: "tools" }, pick("Across", this.x, (column) => { this.x = column; }), pick("Up", this.y, (column) => { this.y = column; })), this.scatter);
    onWidth(lines, (width) => { this.width = width; this.drawGraphs(); });
    onWidth(points, (width) => { this.side = width; this.drawGraphs(); });
    this.listen();
    return el("div", {}, lines, points);
  }

  rows() {
    return Array.from({ length: this.count }, (_, row) => row);
  }

  /** Whether all brushes hold a row. */
  isSelected(row) {
    return [...this.brushes].every(([column, [low, high]]) => column.values[row] !== null && column.values[row] >= low && column.values[row] <= high);
  }

  colour(row) {
    const value = this.colourBy.values[row], [low, high] = widened(extent(this.colourBy.values.filter((v) => v !== null)));
    if (value === null) return "var(--line)";
    const colours = table("stress"), k = 3 * Math.round(40 + (175 * (value - low)) / (high - low));
    return `rgb(${colours[k]} ${colours[k + 1]} ${colours[k + 2]})`;
  }

  drawGraphs() {
    if (this.width) this.drawParallel();
    if (this.side) this.drawScatter();
  }

  drawParallel() {
    const height = 320, top = 44, bottom = 20, inner = height - top - bottom;
    const step = this.drawn.length > 1 ? (this.width - 100) / (this.drawn.length - 1) : 0;
    this.axes = this.drawn.map((column, i) => {
      const [low, high] = widened(extent(column.values.filter((value) => value !== null)));
      return { column, x: 40 + i * step, low, high, place: (value) => top + inner * (1 - (value - low) / (high - low)), back: (y) => low + (1 - (y - top) / inner) * (high - low) };
    });
    this.parallel.setAttribute("viewBox", `0 0 ${this.width} ${height}`);
    this.parallel.replaceChildren();
    for (const row of this.rows()) {
      if (this.axes.some(({ column }) => column.values[row] === null)) continue;
      const path = this.axes.map(({ column, x, place }, i) => `${i ? "L" : "M"}${x.toFixed(1)} ${place(column.values[row]).toFixed(1)}`).join("");
      const isChosen = row === this.chosen;
      this.parallel.append(svg("path", { d: path, fill: "none", style: `stroke:${isChosen ? "var(--bad)" : this.colour(row)}`, "stroke-width": isChosen ? 3 : 1.2, opacity: this.isSelected(row) ? 0.85 : 0.06 }));
    }
    const often = Math.max(1, Math.ceil(110 / Math.max(step, 1)));
    this.axes.forEach(({ column, x, low, high }, i) => {
      const scale = scaleOf(Math.max(Math.abs(low), Math.abs(high)), column.unit);
      const brush = this.brushes.get(column), end = i === this.axes.length - 1;
      const anchor = i === 0 ? "start" : end ? "end" : "middle";
      this.parallel.append(
        svg("line", { x1: x, x2: x, y1: top, y2: top + inner, class: "axis" }),
        svg("text", { x: x - (i === 0 ? 36 : end ? -36 : 0), y: 14 + 13 * (i % Math.min(often, 2)), "text-anchor": anchor }, `${column.name}${scale.label ? ` [${scale.label}]` : ""}`),
        svg("text", { x: x + 4, y: top - 3, class: "soft" }, digits(high * scale.factor, 4)),
        svg("text", { x: x + 4, y: top + inner + 14, class: "soft" }, digits(low * scale.factor, 4)),
      );
      if (brush) {
        const a = this.axes[i].place(brush[1]), b = this.axes[i].place(brush[0]);
        this.parallel.append(svg("rect", { x: x - 7, width: 14, y: a, height: Math.max(b - a, 2), style: "fill:var(--accent);fill-opacity:0.3" }));
      }
    });
    const selected = this.rows().filter((row) => this.isSelected(row)).length;
    this.readout.textContent = this.brushes.size ? `${selected} of ${this.count} rows selected` : "";
  }

  drawScatter() {
    const place = { left: 62, top: 26, width: Math.max(this.side - 90, 60), height: 280 }, height = place.top + place.height + 44;
    const ends = (column) => {
      const [low, high] = widened(extent(column.values.filter((value) => value !== null)));
      return [low - 0.04 * (high - low), high + 0.04 * (high - low)];
    };
    const [x, y] = [ends(this.x), ends(this.y)];
    const toX = (value) => place.left + (place.width * (value - x[0])) / (x[1] - x[0]);
    const toY = (value) => place.top + (place.height * (y[1] - value)) / (y[1] - y[0]);
    this.scatter.setAttribute("viewBox", `0 0 ${this.side} ${height}`);
    this.scatter.replaceChildren();
    drawAxes(this.scatter, place, { range: x, unit: this.x.unit, name: this.x.name, place: toX }, { range: y, unit: this.y.unit, name: this.y.name, place: toY });
    for (const row of this.rows()) {
      const [a, b] = [this.x.values[row], this.y.values[row]];
      if (a === null || b === null) continue;
      const told = `row ${row}: ${this.x.name} ${quantity(a, this.x.unit)}, ${this.y.name} ${quantity(b, this.y.unit)}`;
      const isChosen = row === this.chosen;
      this.scatter.append(svg("circle", { cx: toX(a), cy: toY(b), r: isChosen ? 7 : 4, style: `fill:${isChosen ? "var(--bad)" : this.colour(row)};stroke:var(--paper)`, opacity: this.isSelected(row) ? 0.9 : 0.08 }, svg("title", {}, told)));
    }
  }

  listen() {
    const at = (event) => {
      const bounds = this.parallel.getBoundingClientRect(), zoom = this.width / bounds.width;
      return [(event.clientX - bounds.left) * zoom, (event.clientY - bounds.top) * zoom];
    };
    let drag = null;
    this.parallel.addEventListener("pointerdown", (event) => {
      const [x, y] = at(event), axis = this.axes.find((one) => Math.abs(one.x - x) < 14);
      if (!axis) return;
      event.preventDefault();
      drag = { axis, from: axis.back(y) };
      this.parallel.setPointerCapture(event.pointerId);
    });
    this.parallel.addEventListener("pointermove", (event) => {
      if (!drag) return;
      const to = drag.axis.back(at(event)[1]);
      this.brushes.set(drag.axis.column, [Math.min(drag.from, to), Math.max(drag.from, to)]);
      this.drawGraphs();
    });
    this.parallel.addEventListener("pointerup", () => {
      if (drag) this.drawTable();
      drag = null;
    });
  }

  drawTable() {
    const { column, isDown } = this.order;
    let rows = this.rows().filter((row) => this.isSelected(row));
    if (column) {
      const value = (row) => (column.values[row] === null ? -Infinity : column.values[row]);
      rows.sort((a, b) => (value(a) < value(b) ? -1 : value(a) > value(b) ? 1 : 0) * (isDown ? -1 : 1));
    }
    const shown = this.columns.filter(({ role, values }) => role !== "message" || values.some(Boolean));
    const head = shown.map((one) => {
      const sort = () => { this.order = { column: one, isDown: column === one && !isDown }; this.drawTable(); };
      const mark = column === one ? (isDown ? " ↓" : " ↑") : "";
      return el("th", { scope: "col", class: one.isNumeric ? "number" : null, "aria-sort": column === one ? (isDown ? "descending" : "ascending") : null },
        el("button", { type: "button", onclick: sort, title: one.about || one.name }, one.name + mark));
    });
    const cell = (one, row) => {
      const value = one.values[row];
      return el("td", { class: one.isNumeric ? "number" : null }, value === null ? "–" : typeof value === "number" ? quantity(value, one.unit) : value);
    };
    const line = (row) => {
      const made = el("tr", { tabindex: 0, class: row === this.chosen ? "chosen" : null }, el("td", { class: "number soft" }, String(row)), shown.map((one) => cell(one, row)));
      const choose = () => {
        this.table.querySelectorAll("tr.chosen").forEach((other) => other.classList.remove("chosen"));
        made.classList.add("chosen");
        this.chosen = row;
        this.drawGraphs();
      };
      made.addEventListener("click", choose);
      made.addEventListener("focus", choose);
      return made;
    };
    const hidden = rows.length - 2000;
    this.table.replaceChildren(el("table", { class: "rows" },
      el("thead", {}, el("tr", {}, el("th", { scope: "col", class: "number" }, "row"), head)), el("tbody", {}, rows.slice(0, 2000).map(line))),
    hidden > 0 ? el("p", { class: "soft" }, `${hidden} more rows`) : "");
  }
}

/** Sobol's indices of an output, with their confidence intervals. */
function sensitivityOf({ output, entries }) {
  const width = 460, line = 30, left = 170, inner = width - left - 60, height = entries.length * line + 34;
  const most = Math.max(1, ...entries.flatMap(({ first, first_confidence, total, total_confidence }) => [(first || 0) + (first_confidence || 0), (total || 0) + (total_confidence || 0)]));
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `Sensitivities of ${output}` });
  entries.forEach(({ parameter, first, first_confidence, total, total_confidence }, i) => {
    const y = i * line + 6;
    const one = (value, half, at, colour, label) => {
      if (value === null) return;
      const length = (inner * Math.max(value, 0)) / most, spread = (inner * (half || 0)) / most;
      chart.append(
        svg("rect", { x: left, y: at, width: length, height: 10, style: `fill:${colour}` }, svg("title", {}, `${parameter}: ${label} ${digits(value, 3)} ± ${digits(half || 0, 2)}`)),
        svg("line", { x1: left + length - spread, x2: left + length + spread, y1: at + 5, y2: at + 5, class: "axis" }),
        svg("text", { x: left + length + spread + 5, y: at + 9, class: "soft" }, digits(value, 2)),
      );
    };
    chart.append(svg("text", { x: left - 6, y: y + 14, "text-anchor": "end" }, parameter));
    one(first, first_confidence, y, "var(--s0)", "first order");
    one(total, total_confidence, y + 11, "var(--s3)", "total");
  });
  chart.append(svg("line", { x1: left, x2: left, y1: 0, y2: height - 28, class: "axis" }));
  return el("figure", {}, el("figcaption", {}, el("b", {}, output)), chart,
    el("p", { class: "small" }, el("span", { style: "color:var(--s0)" }, "■ "), "first order: alone, ", el("span", { style: "color:var(--s3)" }, "■ "), "total: with all others; whiskers: confidence intervals"));
}
