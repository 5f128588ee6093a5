// Tables of the document: texts, numbers with the unit of their column or their own, and bars of shares.

/** A table of { title, head: [{ name, unit }], rows }. */
function tableOf({ title, head, rows }) {
  const columns = head.map((column) => (typeof column === "string" ? { name: column } : column));
  const isNumber = columns.map((_, i) => rows.length > 0 && rows.every((row) => row[i] === null || typeof row[i] !== "string"));
  const cell = (value, i) => {
    if (value === null || value === undefined) return "–";
    if (typeof value === "object") return quantity(value.value, value.unit);
    return typeof value === "number" ? quantity(value, columns[i].unit) : rich(value);
  };
  return el("div", { class: "scroll" }, el("table", {},
    title ? el("caption", {}, title) : null,
    el("thead", {}, el("tr", {}, columns.map((column, i) => el("th", { scope: "col", class: isNumber[i] ? "number" : null }, column.name)))),
    el("tbody", {}, rows.map((row) => el("tr", {}, row.map((value, i) => el("td", { class: isNumber[i] ? "number" : null }, cell(value, i))))))));
}

/** Pairs of a label and a text. */
function factsOf(facts) {
  return el("dl", { class: "facts" }, facts.flatMap(({ label, text }) => [el("dt", {}, label), el("dd", {}, text)]));
}

/** A length for a share of the largest. */
const bar = (share, isOver = false) =>
  el("span", { class: isOver ? "bar over" : "bar", style: `width:${Math.min(Math.max(share, 0), 1) * 9}rem`, "aria-hidden": "true" });

/** Balances: what came in, what is there, and what is missing of it. */
function balanceOf({ title, unit, terms, residual, expected, about }) {
  const isFine = expected === null || residual <= expected;
  const most = Math.max(...terms.map(({ value }) => Math.abs(value)), 1e-300);
  return el("div", {},
    el("h3", {}, title),
    el("table", { class: "balance" }, el("tbody", {}, terms.map(({ label, value }) =>
      el("tr", {}, el("th", { scope: "row" }, label), el("td", { class: "number" }, quantity(value, unit)), el("td", {}, bar(Math.abs(value) / most)))))),
    residual === null ? null : el("p", { class: isFine ? "good" : "bad" },
      `${isFine ? "✓" : "✗"} missing: ${digits(residual, 2)} of the largest${expected === null ? "" : `, at most ${digits(expected, 2)} expected`}`),
    about ? el("p", { class: "small soft" }, about) : null);
}

/** Estimated errors of the outputs of bodies, beside the tolerance. */
function errorsOf({ tolerance, bodies }) {
  return bodies.map(({ body, outputs, notes }) => {
    const rows = outputs.map((one) => ({ ...one, total: one.along + one.through })).sort((a, b) => b.total - a.total);
    const most = Math.max(tolerance, ...rows.map(({ total }) => total));
    const line = ({ name, along, through, total }) => el("tr", {},
      el("td", {}, el("code", {}, name)), el("td", { class: "number" }, percent(along)), el("td", { class: "number" }, percent(through)),
      el("td", { class: "number" }, percent(total)), el("td", {}, bar(total / most, total > tolerance)));
    return el("div", {}, el("h3", {}, body),
      rows.length ? el("div", { class: "scroll" }, el("table", { class: "errors" },
        el("thead", {}, el("tr", {}, ["output", "along the surface", "through the thickness", "of its range", ""].map((name) => el("th", { scope: "col" }, name)))),
        el("tbody", {}, rows.map(line)))) : null,
      notes.length ? el("ul", { class: "plain small soft" }, notes.map((note) => el("li", {}, rich(note)))) : null);
  });
}

/** Seconds of each part of a run. */
function timingsOf(timings) {
  const most = Math.max(...timings.map(({ seconds }) => seconds), 1e-9);
  return el("table", { class: "timings" }, el("tbody", {}, timings.map(({ label, seconds }) =>
    el("tr", {}, el("th", { scope: "row" }, label), el("td", { class: "number" }, quantity(seconds, "s", 3)), el("td", {}, bar(seconds / most))))));
}

/** Warnings, each with its remedy and its id. */
function warningsOf(warnings) {
  return warnings.map(({ place, message, remedy, id }) => el("div", { class: "warning" },
    el("p", {}, place ? el("b", {}, place, ": ") : null, rich(message), id ? el("span", { class: "small soft" }, ` [${id}]`) : null),
    remedy ? el("p", {}, el("b", {}, "Remedy: "), rich(remedy)) : null));
}
