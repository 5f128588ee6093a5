// One time for all that moves: droplets, maps and the cursor of histories.

const clock = {
  times: [],
  place: 0,
  /** Time at which the page opens [s], instead of the last one. */
  first: null,
  hasMoved: false,
  timer: null,
  listeners: [],
  /** The time that is shown [s]. */
  get time() { return this.times[this.place]; },
  /** Adds what shows times of its own; it is told the time whenever that changes. */
  add(times, listener) {
    this.times = [...new Set([...this.times, ...times])].sort((a, b) => a - b);
    this.place = this.first === null ? this.times.length - 1 : frameAt(this.times, this.first);
    this.listeners.push(listener);
  },
  go(place) {
    this.place = Math.min(Math.max(place, 0), this.times.length - 1);
    for (const listener of this.listeners) listener(this.time);
  },
  get isRunning() { return this.timer !== null; },
  stop() {
    clearInterval(this.timer);
    this.timer = null;
  },
  /** Plays all times within some seconds, from the start if it stands at the end or where the page has opened. */
  run(changed) {
    if (!this.hasMoved || this.place === this.times.length - 1) this.place = -1;
    this.hasMoved = true;
    const pause = Math.min(Math.max(6000 / this.times.length, 40), 400);
    this.timer = setInterval(() => {
      this.go(this.place + 1);
      if (this.place === this.times.length - 1) this.stop();
      changed();
    }, pause);
  },
};

/** The last of these times that is not after `time`, as a place. */
function frameAt(times, time) {
  let place = 0;
  while (place + 1 < times.length && times[place + 1] <= time * (1 + 1e-12)) place++;
  return place;
}

/** Play, pause and scrub; arrow keys step where the slider has the focus. */
function transport() {
  const play = el("button", { type: "button", id: "play" }, "▶ Play");
  const slider = el("input", { type: "range", id: "scrub", min: 0, max: clock.times.length - 1, value: clock.place, step: 1, "aria-label": "Time" });
  const shown = el("output", { for: "scrub", id: "now" });
  const refresh = () => {
    slider.value = clock.place;
    const text = quantity(clock.time, "s", 4);
    slider.setAttribute("aria-valuetext", text);
    shown.textContent = text;
    play.textContent = clock.isRunning ? "⏸ Pause" : "▶ Play";
  };
  play.addEventListener("click", () => {
    if (clock.isRunning) clock.stop();
    else clock.run(refresh);
    refresh();
  });
  slider.addEventListener("input", () => {
    clock.stop();
    clock.hasMoved = true;
    clock.go(Number(slider.value));
  });
  clock.listeners.push(refresh);
  refresh();
  return el("div", { class: "transport", role: "group", "aria-label": "Time of droplets and maps" }, play, slider, shown);
}
