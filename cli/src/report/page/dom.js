// Elements of the page. Texts of users become text nodes alone, so no text of theirs is ever markup.

const SVG = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return element;
}

const el = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);

const svg = (tag, attributes = {}, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

/** A text in which words between backticks are code. */
function rich(text) {
  return String(text).split("`").map((part, i) => (i % 2 ? el("code", {}, part) : part));
}

/** A button that keeps whether it is pressed. */
function toggle(label, pressed, change) {
  const button = el("button", { type: "button", "aria-pressed": String(pressed) }, label);
  button.addEventListener("click", () => {
    const now = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(now));
    change(now);
  });
  return button;
}

/** A labelled choice among texts; nothing where there is none to make. */
function choice(label, options, change) {
  if (options.length < 2) return null;
  const select = el("select", {}, options.map((text, i) => el("option", { value: i }, text)));
  select.addEventListener("change", () => change(Number(select.value)));
  return el("label", {}, label, select);
}

/** Calls back with the width of an element [px], now and where it changes. */
function onWidth(element, draw) {
  let last = 0;
  const look = () => {
    const width = Math.round(element.clientWidth);
    if (width > 0 && width !== last) draw((last = width));
  };
  // Drawing changes heights, which an observer must not see within its own notice.
  new ResizeObserver(() => requestAnimationFrame(look)).observe(element);
  look();
}

/** Calls back where the colours of the page change: theme of the system, of the reader, of paper. */
const recolour = (() => {
  const listeners = [];
  const all = () => listeners.forEach((listener) => listener());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", all);
  return { add: (listener) => listeners.push(listener), all };
})();
