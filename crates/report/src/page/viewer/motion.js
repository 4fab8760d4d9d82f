// The state of all objects at each moment, and the navigation between moments.
class Motion {
  // Returns the index of a record among the stored ones: mid records come before the end of their step.
  record(step, mid = false) {
    const base = (step - this.data.first) * this.data.per;
    return mid ? base - 1 : base;
  }
  // Returns the positions and velocities of a track's record, or null.
  state(track, step, mid = false) {
    const values = this.tracks[track];
    const size = 4 * this.data.n;
    const at = this.record(step, mid) * size;
    if (!values || at < 0 || at + size > values.length) return null;
    return values.subarray(at, at + size);
  }
  // Returns whether a record is exact; all are, unless the motions are too large for the page.
  isExact(step = this.step, mid = this.mid) {
    const { rounded } = this.data;
    return !rounded || (rounded.exact.includes(this.record(step, mid)) && this.t >= 1);
  }
  closeUp(step = this.step) {
    return this.data.closeUps.find((closeUp) => closeUp.step === step) || null;
  }
  // Returns the submission's positions at the current moment, with straight lines within a step.
  positions(track) {
    const end = this.state(track, this.step, this.mid);
    if (this.t >= 1 && this.pass < 0) return end;
    const start = this.state(track, this.step - 1);
    const close = this.closeUp();
    const target = track === "submission" && close && this.pass >= 0 ? close.passes[this.pass].q : end;
    if (!start || !target) return end;
    const out = new Float64Array(2 * this.data.n);
    for (let i = 0; i < out.length; i++) out[i] = start[i] + this.t * (target[i] - start[i]);
    return out;
  }
  // Returns the state in which the step should have ended, computed from the submission's own state.
  expected() {
    const close = this.closeUp();
    if (!close || (this.t < 1 && this.pass < 0)) return null;
    if (this.pass >= 0) return null;
    return this.mid ? close.mid : close.end || close.mid;
  }
  // Returns whether the impulses of a hybrid step already lead to a wrong state. The step's end starts from that state
  // and may be right.
  isMidWrong() {
    const close = this.closeUp(),
      own = this.state("submission", this.step, true);
    if (this.data.collision !== "hybrid" || !close || !close.mid || !own) return false;
    return close.mid.some((value, k) => !(Math.abs(value - own[k]) <= 1e-10));
  }
  // Returns the state that differences are compared with.
  baseline() {
    const expected = this.show.expected && this.expected();
    return expected || (this.show.reference ? this.positions("reference") : null);
  }

  goToStep(step) {
    if (!Number.isFinite(step)) return;
    this.step = Math.max(this.data.first, Math.min(this.data.last, Math.round(step)));
    this.t = 1;
    this.pass = -1;
    this.mid = this.isMidWrong();
    this.magnify = null;
    this.update();
  }
  goToWrongStep(direction) {
    const { strip } = this.data;
    for (let step = this.step + direction; step >= 1 && step <= strip.length; step += direction) {
      if (strip[step - 1] === "w") return this.goToStep(step);
    }
    this.say.textContent = direction > 0 ? "There is no later wrong step." : "There is no earlier wrong step.";
  }
  togglePlay() {
    if (this.playing) {
      cancelAnimationFrame(this.playing);
      this.playing = 0;
      this.play.textContent = "Play";
      return this.update();
    }
    this.play.textContent = "Pause";
    let last = null;
    if (this.step >= this.data.last) this.goToStep(this.data.first);
    const playFrame = (now) => {
      // With reduced motion, play one step per second.
      const rate = prefersReducedMotion.matches ? 1 : this.speed * Math.max(4, Math.min(60, 1 / this.data.dt));
      const elapsedSteps = last === null ? 0 : ((now - last) / 1000) * rate;
      if (last === null || elapsedSteps >= 1) {
        last = now;
        if (this.step >= this.data.last) return this.togglePlay();
        this.goToStep(this.step + Math.max(1, Math.floor(elapsedSteps)));
      }
      this.playing = requestAnimationFrame(playFrame);
    };
    this.playing = requestAnimationFrame(playFrame);
  }
  handleKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const isTyping = event.target.tagName === "SELECT" || event.target.type === "number";
    const isSlider = event.target.type === "range";
    const action = {
      n: () => this.goToWrongStep(1),
      p: () => this.goToWrongStep(-1),
      0: () => this.showEverything(),
      z: () => {
        this.zoomToDifference();
        this.update();
      },
      s: () => this.toggleSideBySide(),
      "?": () => {
        this.keys.open = !this.keys.open;
      },
      " ": () => this.togglePlay(),
      ArrowRight: () => this.goToStep(this.step + (event.shiftKey ? 10 : 1)),
      ArrowLeft: () => this.goToStep(this.step - (event.shiftKey ? 10 : 1)),
      Home: () => this.goToStep(this.data.first),
      End: () => this.goToStep(this.data.last),
      "+": () => {
        this.zoom *= 1.25;
        this.update();
      },
      "-": () => {
        this.zoom /= 1.25;
        this.update();
      },
    }[event.key];
    if (
      !action ||
      isTyping ||
      (isSlider && event.key.startsWith("Arrow")) ||
      (event.key === " " && /^(BUTTON|SUMMARY|INPUT)$/.test(event.target.tagName))
    )
      return;
    event.preventDefault();
    action();
  }
  fit() {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    const extend = (x, y, r) => {
      if (!areFinite(x, y) || Math.abs(x) > 1e12 || Math.abs(y) > 1e12) return;
      x0 = Math.min(x0, x - r);
      y0 = Math.min(y0, y - r);
      x1 = Math.max(x1, x + r);
      y1 = Math.max(y1, y + r);
    };
    const { n, per, first, last, radii } = this.data;
    const stride = Math.max(1, Math.floor((last - first) / 400));
    for (const track of ["reference", "submission"]) {
      for (let step = first; step <= last; step += stride) {
        const state = this.state(track, step);
        if (!state) break;
        if (
          track === "submission" &&
          x1 > x0 &&
          Math.max(...[...state.subarray(0, 2 * n)].map(Math.abs)) >
            20 * (1 + Math.max(Math.abs(x0), x1, Math.abs(y0), y1))
        )
          break;
        for (let k = 0; k < n; k++) extend(state[2 * k], state[2 * k + 1], radii[k]);
      }
    }
    if (!(x1 > x0)) [x0, y0, x1, y1] = [-1, -1, 1, 1];
    const margin = 0.05 * Math.max(x1 - x0, y1 - y0);
    this.box = [x0 - margin, y0 - margin, x1 + margin, y1 + margin];
    this.extent = Math.max(x1 - x0, y1 - y0);
  }
  showEverything() {
    this.zoom = 1;
    this.pan = [0, 0];
    this.update();
  }
  // Zooms in on the differences and the selected pair.
  zoomToDifference() {
    this.zoom = 1;
    this.pan = [0, 0];
    const difference = this.difference(),
      own = this.positions("submission"),
      near = new Set();
    if (difference && difference.most > 0)
      difference.list.forEach((d, k) => {
        if (Math.hypot(...d) > difference.most * 1e-3) near.add(k);
      });
    if (this.selected && this.selected.pair) {
      const { kind, first, second } = parsePair(this.selected.pair);
      for (const k of [first, ...(kind === "pp" ? [second] : kind === "pe" ? this.data.edges[second].slice(0, 2) : [])])
        near.add(k);
    }
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const k of own ? near : []) {
      for (const at of difference ? [own, difference.base] : [own]) {
        const [x, y, r] = [at[2 * k], at[2 * k + 1], 2.5 * this.data.radii[k] + 0.02 * this.extent];
        if (areFinite(x, y))
          [x0, y0, x1, y1] = [Math.min(x0, x - r), Math.min(y0, y - r), Math.max(x1, x + r), Math.max(y1, y + r)];
      }
    }
    if (!(x1 > x0)) return;
    const zoom = Math.min(8, Math.min(this.view[1] / (x1 - x0), this.canvas.height / (y1 - y0)) / this.scale());
    if (zoom < 1.2) return;
    const [bx0, by0, bx1, by1] = this.box;
    this.zoom = zoom;
    this.pan = [((bx0 + bx1 - x0 - x1) / 2) * this.scale(), ((y0 + y1 - by0 - by1) / 2) * this.scale()];
  }
  scale() {
    const [x0, y0, x1, y1] = this.box;
    return this.zoom * Math.min(this.view[1] / (x1 - x0), this.canvas.height / (y1 - y0));
  }
  toPixels(x, y) {
    const [x0, y0, x1, y1] = this.box;
    const scale = this.scale();
    return [
      this.view[0] + this.view[1] / 2 + (x - (x0 + x1) / 2) * scale + this.pan[0],
      this.canvas.height / 2 - (y - (y0 + y1) / 2) * scale + this.pan[1],
    ];
  }
}
