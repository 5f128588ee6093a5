// The page: sections in the order in which a reader asks.

const report = JSON.parse(document.getElementById("document").textContent);

const sections = [];

/** Adds a section if it has something to show. */
function section(id, title, ...content) {
  const parts = content.flat(Infinity).filter((part) => part !== null && part !== undefined);
  if (!parts.length) return;
  sections.push([id, title]);
  document.getElementById("content").append(el("section", { id, "aria-labelledby": `${id}-title` }, el("h2", { id: `${id}-title` }, title), parts));
}

function themeButton() {
  const root = document.documentElement, isDark = () => (root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  const button = el("button", { type: "button", class: "theme" });
  const name = () => { button.textContent = isDark() ? "Light" : "Dark"; };
  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    name();
    recolour.all();
  });
  name();
  return button;
}

function head() {
  document.getElementById("head").append(
    el("div", { class: "top" }, el("div", {}, el("h1", {}, report.title), report.description ? el("p", {}, report.description) : null), themeButton()),
    report.figures.length ? el("div", { class: "figures" }, report.figures.map(({ label, value, unit, note }) =>
      el("div", { class: "figure" }, el("span", {}, label), el("strong", {}, typeof value === "number" ? quantity(value, unit, 5) : value), note ? el("span", {}, note) : null))) : null,
  );
  document.getElementById("foot").append(el("p", {}, report.made_by), factsOf(report.source));
}

function modelled() {
  return report.model.map(({ title, facts, lines, tables }) => el("div", {},
    title ? el("h3", {}, title) : null,
    facts.length ? factsOf(facts) : null,
    lines.length ? el("ul", { class: "plain" }, lines.map((line) => el("li", {}, rich(line)))) : null,
    tables.map(tableOf)));
}

function moving() {
  const clips = report.clips.map((clip) => new Clip(clip).element);
  const maps = report.maps.filter(({ layout }) => layout !== "profile").map((map) => new FieldMap(map).element);
  if (!clips.length && !maps.length) return null;
  return [
    clips.length ? el("div", { class: "grid" }, clips) : null,
    maps.length ? el("div", { class: "grid" }, maps) : null,
    clock.times.length > 1 ? transport() : null,
  ];
}

head();
section("warnings", `Warnings (${report.warnings.length})`, warningsOf(report.warnings));
section("scene", "Scene", report.sketches.map((sketch) => el("div", {},
  sketch.title ? el("h3", {}, sketch.title) : null, el("div", { class: "grid" }, sketch.views.flatMap(sketchView)), signs(sketch))));
section("fields", "Droplets and maps", moving());
section("profiles", "Values along radii over time", report.maps.filter(({ layout }) => layout === "profile").length
  ? el("div", { class: "grid" }, report.maps.filter(({ layout }) => layout === "profile").map((map) => new FieldMap(map).element)) : null);
const histories = report.histories && report.histories.series.length ? new Histories(report.histories) : null;
section("histories", "Over time", histories && histories.element, histories && report.histories.note ? el("p", { class: "small soft" }, report.histories.note) : null);
const study = report.study ? new StudyView(report.study) : null;
section("study", "Rows of the study", study && study.element);
section("sensitivities", "Sensitivities", report.study && report.study.sensitivities.length ? el("div", { class: "grid" }, report.study.sensitivities.map(sensitivityOf)) : null);
section("values", "Values", report.tables.map(tableOf));
section("balances", "Balances", report.balances.length ? el("div", { class: "grid" }, report.balances.map(balanceOf)) : null);
section("errors", "Estimated errors of outputs", report.errors ? [el("p", {}, `Share of the range of each output over the run; the scene allows ${percent(report.errors.tolerance)}. Red bars are beyond that.`), errorsOf(report.errors)] : null);
section("model", "What was modelled, and why", modelled());
section("timings", "Time taken", report.timings.length ? timingsOf(report.timings) : null);
section("notes", "Notes", report.notes.length ? el("ul", { class: "plain" }, report.notes.map((note) => el("li", {}, rich(note)))) : null);
looks.forEach((look) => look());
document.getElementById("places").append(el("ul", {}, sections.map(([id, title]) => el("li", {}, el("a", { href: `#${id}` }, title)))));
if (clock.times.length) clock.go(clock.place);
addEventListener("beforeprint", () => recolour.all());
document.documentElement.dataset.ready = "true";
