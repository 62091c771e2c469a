// Time: play, pause, scrub, step, speed. Tells whoever listens which time is shown.

const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const USUAL = 4;  // s that a motion should at least take to watch

export class Transport {
  constructor(motions, show) {
    this.motions = motions;
    this.show = show;
    this.start = Math.min(...motions.map((m) => m.start));
    this.end = Math.max(...motions.map((m) => m.end));
    this.now = this.start;
    this.playing = false;
    const duration = this.end - this.start;
    this.digits = Math.min(12, Math.max(0, 3 - Math.floor(Math.log10(duration || 1))));

    const by = (id) => document.getElementById(id);
    this.slider = by("time");
    this.clock = by("clock");
    this.button = by("play");
    this.repeat = by("repeat");
    this.speed = by("speed");
    Object.assign(this.slider, { min: this.start, max: this.end, step: "any" });
    this.slider.setAttribute("value", this.start);
    for (const factor of SPEEDS) this.speed.add(new Option(`${factor}×`, factor));
    this.speed.value = [...SPEEDS].reverse().find((f) => f <= 1 && duration / f >= USUAL) ?? SPEEDS[0];
    if (duration > 60) this.speed.value = SPEEDS.find((f) => duration / f <= 60) ?? SPEEDS.at(-1);

    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.slider.addEventListener("keydown", (event) => {  // with step "any" browsers move by hundredths of the unit
      const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (!steps) return;
      event.preventDefault();
      this.step(steps * (event.shiftKey ? 10 : 1));
    });
    this.button.addEventListener("click", () => this.toggle());
    by("first").addEventListener("click", () => this.seek(this.start));
    by("back").addEventListener("click", () => this.step(-1));
    by("forward").addEventListener("click", () => this.step(1));
    by("clock").style.minWidth = `${`${this.text(this.end)} / ${this.text(this.end)} s`.length}ch`;
  }

  text(t) { return t.toFixed(this.digits); }

  seek(t) {
    this.now = Math.min(this.end, Math.max(this.start, t));
    this.slider.value = this.now;
    this.clock.textContent = `${this.text(this.now)} / ${this.text(this.end)} s`;
    this.slider.setAttribute("aria-valuetext", `${this.text(this.now)} of ${this.text(this.end)} seconds`);
    this.show(this.now);
  }

  // By frames of the first motion that goes on so long.
  step(frames) {
    this.pause();
    const motion = this.motions.find((m) => m.end >= this.now && (frames < 0 || m.end > this.now)) ?? this.motions[0];
    const { frame, share } = motion.locate(this.now);
    const from = frames < 0 && share > 0 ? frame + 1 : frame;
    this.seek(motion.t[Math.min(motion.frames - 1, Math.max(0, from + frames))]);
  }

  toggle() { if (this.playing) this.pause(); else this.play(); }
  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.#label("▶\uFE0E", "Play");
    this.show(this.now);
  }
  play() {
    if (this.end <= this.start) return;
    if (this.now >= this.end) this.seek(this.start);
    this.playing = true;
    this.#label("❚❚", "Pause");
    let before = performance.now();
    const tick = (at) => {
      if (!this.playing) return;
      const t = this.now + Math.max(0, at - before) / 1000 * Number(this.speed.value);
      before = Math.max(before, at);
      if (t >= this.end && this.repeat.checked) this.seek(this.start);
      else this.seek(t);
      if (this.now >= this.end && !this.repeat.checked) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
  faster(by) {
    const k = SPEEDS.indexOf(Number(this.speed.value)) + by;
    this.speed.value = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, k))];
  }

  #label(sign, word) {
    this.button.textContent = sign;
    this.button.setAttribute("aria-label", word);
  }
}
