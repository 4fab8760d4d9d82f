"use strict";
// The motion viewer: one per case, made when its card is opened. Reads the page's data blocks and nothing else.
(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const el = (tag, attributes = {}, ...children) => {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
      else if (value === true) node.setAttribute(name, "");
      else if (value !== false && value !== null) node.setAttribute(name, value);
    }
    node.append(...children);
    return node;
  };
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const finite = (...values) => values.every(Number.isFinite);
  const short = (value) => (value === null || Number.isNaN(value) ? "nan" : Number(value.toPrecision(6)).toString());
  const hex = (value) => {
    const view = new DataView(new ArrayBuffer(8));
    view.setFloat64(0, value);
    return "0x" + view.getBigUint64(0).toString(16).padStart(16, "0");
  };

  async function unpack(id) {
    const block = document.getElementById(id);
    if (!block) return null;
    const packed = Uint8Array.from(atob(block.textContent.trim()), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Float64Array(await new Response(stream).arrayBuffer());
  }

  // "pp:0,1" to its objects.
  const parse = (pair) => {
    const [kind, rest] = pair.split(":");
    const [first, second] = rest.split(",").map(Number);
    return { kind, first, second };
  };
  const PAIRS = { pp: "particle", pe: "edge", ph: "half-plane" };
  const words = (pair) => {
    const { kind, first, second } = parse(pair);
    return `particle ${first} - ${PAIRS[kind]} ${second}`;
  };

  class Viewer {
    constructor(article, data, tracks) {
      Object.assign(this, { article, data, tracks });
      this.key = article.dataset.case;
      this.name = article.dataset.scene;
      const wrong = data.strip.indexOf("w");
      this.step = Math.max(data.first, Math.min(data.last, wrong >= 0 ? wrong + 1 : data.focus || data.first));
      this.t = 1;
      this.pass = -1;
      this.zoom = 1;
      this.pan = [0, 0];
      this.magnify = null;
      this.playing = 0;
      this.speed = 1;
      this.selected = null;
      this.show = { reference: data.full, expected: data.full, what: !!data.whatIf, arrows: data.full };
      this.build();
      this.fit();
      this.look();
    }

    // ---- states ----

    // Index of a record among those that are kept: mid records come before the end of their step.
    record(step, mid = false) {
      const base = (step - this.data.first) * this.data.per;
      return mid ? base - 1 : base;
    }
    // Positions and velocities of a track's record, or null.
    state(track, step, mid = false) {
      const values = this.tracks[track];
      const size = 4 * this.data.n;
      const at = this.record(step, mid) * size;
      if (!values || at < 0 || at + size > values.length) return null;
      return values.subarray(at, at + size);
    }
    close(step = this.step) {
      return this.data.closeUps.find((one) => one.step === step) || null;
    }
    // The submission's positions that are drawn: inside the step on a straight line.
    positions(track) {
      const end = this.state(track, this.step, this.mid);
      if (this.t >= 1 && this.pass < 0) return end;
      const start = this.state(track, this.step - 1);
      const close = this.close();
      const target = track === "submission" && close && this.pass >= 0 ? close.passes[this.pass].q : end;
      if (!start || !target) return end;
      const out = new Float64Array(2 * this.data.n);
      for (let i = 0; i < out.length; i++) out[i] = start[i] + this.t * (target[i] - start[i]);
      return out;
    }
    // Where the step should have ended, from the submission's own state.
    expected() {
      const close = this.close();
      if (!close || (this.t < 1 && this.pass < 0)) return null;
      if (this.pass >= 0) return null;
      return this.mid ? close.mid : close.end || close.mid;
    }
    // Whether the impulses of a hybrid step already lead elsewhere: its end then starts from there and may be right.
    midIsWrong() {
      const close = this.close(), own = this.state("submission", this.step, true);
      if (this.data.collision !== "hybrid" || !close || !close.mid || !own) return false;
      return close.mid.some((value, k) => !(Math.abs(value - own[k]) <= 1e-10));
    }
    // What differences are measured against.
    baseline() {
      const expected = this.show.expected && this.expected();
      return expected || (this.show.reference ? this.positions("reference") : null);
    }

    // ---- the page ----

    build() {
      const { data } = this;
      const button = (text, label, act, key) =>
        el("button", { type: "button", onclick: act, title: key ? `${label} (${key})` : label, "aria-label": /[a-z]/i.test(text) ? `${text}: ${label}` : label }, text);
      const check = (name, text, mark) => {
        const box = el("input", { type: "checkbox", onchange: (event) => { this.show[name] = event.target.checked; this.look(); } });
        box.checked = this.show[name];
        return el("label", { class: "check" }, box, el("span", { class: `key ${mark}` }, ""), text);
      };
      this.canvas = el("canvas", {
        width: 960, height: 540, tabindex: 0, role: "img", "aria-label": "Both motions, drawn on top of each other",
        "aria-describedby": `say-${this.key}`,
      });
      this.play = button("Play", "Play or pause", () => this.toggle(), "space");
      this.stepBox = el("input", { type: "number", min: data.first, max: data.last, class: "stepbox", "aria-label": "Step",
        onchange: (event) => this.go(Number(event.target.value)) });
      this.slider = el("input", { type: "range", min: data.first, max: data.last, "aria-label": "Step", class: "wide",
        oninput: (event) => this.go(Number(event.target.value)) });
      this.inside = el("input", { type: "range", min: 0, max: 1, step: 0.001, "aria-label": "Time within the step", class: "wide",
        oninput: (event) => { this.t = Number(event.target.value); this.look(); } });
      this.insideText = el("output", {}, "");
      this.passes = el("select", { "aria-label": "Which motion within the step",
        onchange: (event) => { this.pass = Number(event.target.value); this.look(); } });
      this.midBox = el("input", { type: "checkbox", onchange: (event) => { this.mid = event.target.checked; this.look(); } });
      this.mid = this.midIsWrong();
      this.factor = el("input", { type: "range", min: 0, max: 15, step: 0.1, "aria-label": "Magnification of differences, power of ten",
        oninput: (event) => { this.magnify = 10 ** Number(event.target.value); this.look(); } });
      this.factorText = el("output", {}, "");
      this.ticks = document.createElementNS(SVG, "svg");
      this.ticks.setAttribute("viewBox", "0 0 1000 12");
      this.ticks.setAttribute("preserveAspectRatio", "none");
      this.ticks.setAttribute("aria-hidden", "true");
      this.ticks.classList.add("ticks");
      this.strip = el("canvas", { width: 960, height: 26, class: "strip", role: "img",
        "aria-label": this.stripWords(), onclick: (event) => {
          const box = this.strip.getBoundingClientRect();
          this.go(1 + Math.floor(((event.clientX - box.left) / box.width) * data.steps));
        } });
      this.say = el("p", { class: "say", id: `say-${this.key}`, "aria-live": "polite" });
      this.facts = el("div", { class: "facts" });
      this.numbers = el("div", { class: "numbers" });
      this.matrix = el("div", { class: "matrix" });
      this.table = el("details", { class: "table", ontoggle: () => this.look() }, el("summary", {}, "The picture as a table"));
      this.tableBody = el("div");
      this.table.append(this.tableBody);
      const hybrid = data.collision === "hybrid";
      this.root = el("div", { class: "viewer", onkeydown: (event) => this.key_down(event) },
        el("div", { class: "bar" },
          button("|<", "Previous wrong step", () => this.finding(-1), "p"), button("<", "One step back", () => this.go(this.step - 1), "left"),
          this.play, button(">", "One step on", () => this.go(this.step + 1), "right"),
          button(">|", "Next wrong step", () => this.finding(1), "n"),
          el("label", {}, "step ", this.stepBox, ` of ${data.steps}`),
          el("label", {}, "speed ", this.speeds()),
          button("Fit", "Show everything", () => { this.zoom = 1; this.pan = [0, 0]; this.look(); }, "0"),
          button("PNG", "Save this picture", () => this.picture()),
          button("SVG", "Save this picture as a drawing", () => this.drawing()),
          button("Clip", "Record a film of the steps", () => this.clip()),
          button("Link", "Copy a link to this moment", () => this.link())),
        this.strip, this.slider,
        this.canvas,
        el("div", { class: "bar" }, el("label", { class: "grow" }, "inside the step, t = ", this.insideText, this.inside, this.ticks),
          el("label", {}, "moving ", this.passes), hybrid ? el("label", { class: "check" }, this.midBox, "after the impulses") : ""),
        el("div", { class: "bar" },
          ...(data.full ? [check("reference", "reference from the start", "k-ref"), check("expected", "expected from your own state", "k-exp"),
            data.whatIf ? check("what", "the reference with the mistake", "k-what") : "",
            check("arrows", "differences", "k-arrow"),
            el("label", { class: "grow" }, "magnified ", this.factorText, this.factor)] : [])),
        this.say, this.facts, this.matrix, this.numbers, this.table);
      this.article.querySelector(".stage").append(this.root);
      this.canvas.addEventListener("wheel", (event) => {
        if (!event.ctrlKey && !event.shiftKey && document.activeElement !== this.canvas) return;
        event.preventDefault();
        this.zoom = Math.max(0.2, Math.min(1e6, this.zoom * Math.exp(-event.deltaY / 400)));
        this.look();
      }, { passive: false });
      let held = null;
      this.canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY, ...this.pan, false]; this.canvas.setPointerCapture(event.pointerId); });
      this.canvas.addEventListener("pointermove", (event) => {
        if (!held) return;
        const ratio = this.canvas.width / this.canvas.getBoundingClientRect().width;
        const move = [(event.clientX - held[0]) * ratio, (event.clientY - held[1]) * ratio];
        if (Math.hypot(...move) > 4) held[4] = true;
        if (held[4]) { this.pan = [held[2] + move[0], held[3] + move[1]]; this.look(); }
      });
      this.canvas.addEventListener("pointerup", (event) => { if (held && !held[4]) this.pick(event); held = null; });
    }
    speeds() {
      const select = el("select", { "aria-label": "Speed", onchange: (event) => { this.speed = Number(event.target.value); } });
      for (const speed of [0.03125, 0.125, 0.25, 0.5, 1, 2, 4, 8]) {
        const option = el("option", { value: speed }, speed < 1 ? `1/${1 / speed}` : `${speed}`);
        option.selected = speed === 1;
        select.append(option);
      }
      return select;
    }
    stripWords() {
      const of = (letter) => [...this.data.strip].filter((one) => one === letter).length;
      return `All steps: ${of("r")} right, ${of("w")} wrong by themselves, ${of("i")} right but following from a wrong one, ` +
        `${this.data.steps - of("r") - of("w") - of("i")} not judged`;
    }

    // ---- moving about ----

    go(step) {
      if (!Number.isFinite(step)) return;
      this.step = Math.max(this.data.first, Math.min(this.data.last, Math.round(step)));
      this.t = 1;
      this.pass = -1;
      this.mid = this.midIsWrong();
      this.magnify = null;
      this.look();
    }
    finding(direction) {
      const { strip } = this.data;
      for (let step = this.step + direction; step >= 1 && step <= strip.length; step += direction) {
        if (strip[step - 1] === "w") return this.go(step);
      }
      this.say.textContent = direction > 0 ? "There is no later wrong step." : "There is no earlier wrong step.";
    }
    toggle() {
      if (this.playing) { cancelAnimationFrame(this.playing); this.playing = 0; this.play.textContent = "Play"; return this.look(); }
      this.play.textContent = "Pause";
      let last = null;
      if (this.step >= this.data.last) this.go(this.data.first);
      const turn = (now) => {
        const gone = last === null ? 0 : ((now - last) / 1000) * this.speed * Math.max(4, Math.min(60, 1 / this.data.dt));
        if (last === null || gone >= 1) {
          last = now;
          if (this.step >= this.data.last) return this.toggle();
          this.go(this.step + Math.max(1, Math.floor(gone)));
        }
        this.playing = requestAnimationFrame(turn);
      };
      this.playing = requestAnimationFrame(turn);
    }
    key_down(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const typing = event.target.tagName === "SELECT" || event.target.type === "number";
      const ranging = event.target.type === "range";
      const act = {
        n: () => this.finding(1), p: () => this.finding(-1), 0: () => { this.zoom = 1; this.pan = [0, 0]; this.look(); },
        " ": () => this.toggle(),
        ArrowRight: () => this.go(this.step + (event.shiftKey ? 10 : 1)),
        ArrowLeft: () => this.go(this.step - (event.shiftKey ? 10 : 1)),
        Home: () => this.go(this.data.first), End: () => this.go(this.data.last),
        "+": () => { this.zoom *= 1.25; this.look(); }, "-": () => { this.zoom /= 1.25; this.look(); },
      }[event.key];
      if (!act || typing || (ranging && event.key.startsWith("Arrow")) || (event.key === " " && /^(BUTTON|SUMMARY|INPUT)$/.test(event.target.tagName))) return;
      event.preventDefault();
      act();
    }
    fit() {
      let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
      const reach = (x, y, r) => {
        if (!finite(x, y) || Math.abs(x) > 1e12 || Math.abs(y) > 1e12) return;
        x0 = Math.min(x0, x - r); y0 = Math.min(y0, y - r); x1 = Math.max(x1, x + r); y1 = Math.max(y1, y + r);
      };
      const { n, per, first, last, radii } = this.data;
      const every = Math.max(1, Math.floor((last - first) / 400));
      for (const track of ["reference", "submission"]) {
        for (let step = first; step <= last; step += every) {
          const state = this.state(track, step);
          if (!state) break;
          if (track === "submission" && x1 > x0 && Math.max(...[...state.subarray(0, 2 * n)].map(Math.abs)) > 20 * (1 + Math.max(Math.abs(x0), x1, Math.abs(y0), y1))) break;
          for (let k = 0; k < n; k++) reach(state[2 * k], state[2 * k + 1], radii[k]);
        }
      }
      if (!(x1 > x0)) [x0, y0, x1, y1] = [-1, -1, 1, 1];
      const margin = 0.05 * Math.max(x1 - x0, y1 - y0);
      this.box = [x0 - margin, y0 - margin, x1 + margin, y1 + margin];
      this.extent = Math.max(x1 - x0, y1 - y0);
    }
    scale() {
      const [x0, y0, x1, y1] = this.box;
      return this.zoom * Math.min(this.canvas.width / (x1 - x0), this.canvas.height / (y1 - y0));
    }
    to(x, y) {
      const [x0, y0, x1, y1] = this.box;
      const scale = this.scale();
      return [this.canvas.width / 2 + (x - (x0 + x1) / 2) * scale + this.pan[0], this.canvas.height / 2 - (y - (y0 + y1) / 2) * scale + this.pan[1]];
    }

    // ---- drawing ----

    look() {
      const { data } = this;
      const close = this.close();
      if (close ? this.pass >= close.passes.length : this.pass >= 0) this.pass = -1;
      this.slider.value = this.step;
      this.midBox.checked = this.mid;
      this.slider.setAttribute("aria-valuetext", `step ${this.step}, ${this.classWords()}`);
      this.stepBox.value = this.step;
      this.inside.value = this.t;
      this.insideText.textContent = this.t.toFixed(3);
      this.passes.replaceChildren(el("option", { value: -1 }, "as recorded"),
        ...(close ? close.passes.map((pass, k) => el("option", { value: k }, `as detection sees it: ${pass.name}`)) : []));
      this.passes.value = this.pass;
      this.inside.disabled = this.step <= data.first;
      this.draw();
      this.drawStrip();
      this.drawTicks();
      this.tell();
      if (!this.playing) { this.tellMatrix(); this.tellNumbers(); this.tellTable(); }
      document.dispatchEvent(new CustomEvent("moment", { detail: { key: this.key, step: this.step } }));
    }
    classWords(step = this.step) {
      return { r: "right", w: "wrong by itself", i: "right by itself, but it starts from where a wrong step has led" }[this.data.strip[step - 1]] ||
        (step === 0 ? "the start" : "not judged");
    }
    difference() {
      const own = this.positions("submission");
      const base = this.baseline();
      if (!own || !base) return null;
      const list = [];
      let most = 0;
      for (let k = 0; k < this.data.n; k++) {
        const d = [own[2 * k] - base[2 * k], own[2 * k + 1] - base[2 * k + 1]];
        list.push(d);
        const size = Math.hypot(...d);
        if (Number.isFinite(size)) most = Math.max(most, size);
      }
      return { list, most, base };
    }
    draw(context = this.canvas.getContext("2d")) {
      const { width, height } = this.canvas;
      context.fillStyle = colour("--paper");
      context.fillRect(0, 0, width, height);
      this.planes(context);
      this.zones(context);
      if (this.show.reference) this.bodies(context, this.positions("reference"), { stroke: colour("--ref"), dash: [7, 5] });
      const expected = this.show.expected && this.expected();
      if (expected) this.bodies(context, expected, { stroke: colour("--exp"), dash: [2, 3] });
      if (this.show.what && this.data.whatIf) this.bodies(context, this.positions("what"), { stroke: colour("--what"), dash: [12, 4, 2, 4] });
      this.bodies(context, this.positions("submission"), { stroke: colour("--own"), fill: colour("--ownfill"), dash: [], label: true });
      this.arrows(context);
      this.contacts(context);
      context.fillStyle = colour("--ink");
      context.font = "14px system-ui, sans-serif";
      context.fillText(`step ${this.step}${this.t < 1 ? `, t = ${this.t.toFixed(3)}` : ""}`, 10, 20);
    }
    bodies(context, positions, { stroke, fill, dash, label }) {
      if (!positions) return;
      const { radii, edges, n } = this.data;
      const scale = this.scale();
      context.setLineDash(dash);
      context.lineWidth = 2;
      context.strokeStyle = stroke;
      edges.forEach(([i, j, r], index) => {
        const [a, b] = [this.to(positions[2 * i], positions[2 * i + 1]), this.to(positions[2 * j], positions[2 * j + 1])];
        if (!finite(...a, ...b)) return;
        const chosen = label && this.isSelected("edge", index);
        if (fill && r * scale > 0.5) {
          context.setLineDash([]);
          context.lineCap = "round";
          context.lineWidth = 2 * r * scale;
          context.strokeStyle = fill;
          context.beginPath(); context.moveTo(...a); context.lineTo(...b); context.stroke();
          context.lineCap = "butt";
          context.setLineDash(dash);
        }
        context.lineWidth = chosen ? 4 : 2;
        context.strokeStyle = chosen ? colour("--bad") : stroke;
        const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
        const side = [(-(b[1] - a[1]) / length) * r * scale, ((b[0] - a[0]) / length) * r * scale];
        for (const sign of [1, -1]) {
          context.beginPath();
          context.moveTo(a[0] + sign * side[0], a[1] + sign * side[1]);
          context.lineTo(b[0] + sign * side[0], b[1] + sign * side[1]);
          context.stroke();
        }
      });
      for (let k = 0; k < n; k++) {
        const [x, y] = this.to(positions[2 * k], positions[2 * k + 1]);
        if (!finite(x, y)) continue;
        const chosen = label && this.isSelected("particle", k);
        const size = Math.max(1.5, radii[k] * scale);
        if (x + size < 0 || y + size < 0 || x - size > this.canvas.width || y - size > this.canvas.height || size > 1e5) continue;
        context.beginPath();
        context.arc(x, y, size, 0, 7);
        if (fill) { context.fillStyle = fill; context.fill(); }
        context.lineWidth = chosen ? 4 : 2;
        context.strokeStyle = chosen ? colour("--bad") : stroke;
        context.stroke();
        if (label && n <= 60) {
          context.fillStyle = colour("--ink");
          context.font = "12px system-ui, sans-serif";
          context.textAlign = "center";
          context.fillText(this.data.fixed[k] ? `${k} fixed` : `${k}`, x, y + 4);
          context.textAlign = "start";
        }
      }
      context.setLineDash([]);
    }
    planes(context) {
      const far = 4 * this.extent / Math.min(1, this.zoom) + 1;
      this.data.planes.forEach(([px, py, nx, ny], index) => {
        const length = Math.hypot(nx, ny);
        if (!(length > 0)) return;
        const [ux, uy] = [nx / length, ny / length];
        const chosen = this.isSelected("half-plane", index);
        context.strokeStyle = chosen ? colour("--bad") : colour("--ink");
        context.fillStyle = colour("--ground");
        context.lineWidth = chosen ? 4 : 2;
        const a = this.to(px - uy * far, py + ux * far);
        const b = this.to(px + uy * far, py - ux * far);
        const deep = [-ux * far * this.scale(), uy * far * this.scale()];
        context.beginPath();
        context.moveTo(...a); context.lineTo(...b); context.lineTo(b[0] + deep[0], b[1] + deep[1]); context.lineTo(a[0] + deep[0], a[1] + deep[1]);
        context.fill();
        context.beginPath(); context.moveTo(...a); context.lineTo(...b); context.stroke();
      });
    }
    zones(context) {
      const close = this.close();
      const state = this.positions("submission");
      if (!close || !close.zones.length || !state) return;
      const last = close.zones[close.zones.length - 1];
      context.strokeStyle = colour("--zone");
      context.fillStyle = colour("--zonefill");
      context.lineWidth = 1.5;
      for (const zone of last.zones) {
        const points = zone.particles.map((k) => this.to(state[2 * k], state[2 * k + 1])).filter((p) => finite(...p));
        const around = hull(points);
        if (around.length < 1) continue;
        context.lineJoin = "round";
        context.beginPath();
        around.forEach((p, k) => (k ? context.lineTo(...p) : context.moveTo(...p)));
        context.closePath();
        context.lineWidth = 26;
        context.strokeStyle = colour("--zonefill");
        context.stroke();
        context.fill();
        context.lineJoin = "miter";
      }
    }
    arrows(context) {
      const apart = this.difference();
      if (!apart || !(apart.most > 0)) { this.factorText.textContent = apart ? "(no difference)" : "(nothing to compare)"; return; }
      const auto = Math.max(1, 10 ** Math.floor(Math.log10((0.12 * this.extent) / this.zoom / apart.most)));
      const factor = this.magnify === null ? auto : this.magnify;
      this.factor.value = Math.log10(factor);
      this.factorText.textContent = `${factor >= 1e4 ? factor.toExponential(1) : short(factor)} times (largest difference ${short(apart.most)})`;
      if (!this.show.arrows) return;
      context.strokeStyle = context.fillStyle = colour("--bad");
      context.lineWidth = 2;
      for (let k = 0; k < this.data.n; k++) {
        const [dx, dy] = apart.list[k];
        if (!(Math.hypot(dx, dy) > apart.most * 1e-3)) continue;
        const from = this.to(apart.base[2 * k], apart.base[2 * k + 1]);
        const to = this.to(apart.base[2 * k] + factor * dx, apart.base[2 * k + 1] + factor * dy);
        arrow(context, from, to);
        context.beginPath(); context.arc(...from, 18, 0, 7); context.setLineDash([1, 4]); context.stroke(); context.setLineDash([]);
      }
    }
    contacts(context) {
      const close = this.close();
      this.spots = [];
      if (!close) return;
      const draw = (list, stroke, dash, filled) => {
        for (const [pair, time, nx, ny] of list) {
          const place = this.place(pair, time);
          const length = Math.hypot(nx, ny);
          if (!place || !(length > 0)) continue;
          const from = this.to(...place);
          const to = [from[0] + (nx / length) * 46, from[1] - (ny / length) * 46];
          if (!finite(...from, ...to)) continue;
          this.spots.push([pair, ...from]);
          context.strokeStyle = context.fillStyle = stroke;
          context.lineWidth = filled ? 2 : 3;
          context.setLineDash(dash);
          arrow(context, from, to);
          context.setLineDash([]);
          context.beginPath();
          if (filled) context.arc(...from, 5, 0, 7); else context.rect(from[0] - 6, from[1] - 6, 12, 12);
          if (filled) context.fill(); else context.stroke();
        }
      };
      const expected = this.pass >= 0 ? close.passes[this.pass].hits : close.expected;
      draw(expected, colour("--exp"), [2, 3], true);
      if (this.pass <= 0) draw(close.actual, colour("--own"), [], false);
    }
    // Where a particle touches at a time of the step: its centre as detection sees it.
    place(pair, time) {
      const { first } = parse(pair);
      const start = this.state("submission", this.step - 1);
      const close = this.close();
      const pass = close && close.passes[Math.max(0, this.pass)];
      if (!start || !pass || first >= this.data.n || !finite(time)) return null;
      return [0, 1].map((axis) => start[2 * first + axis] + time * (pass.q[2 * first + axis] - start[2 * first + axis]));
    }
    drawStrip() {
      const context = this.strip.getContext("2d");
      const { strip, steps, first, last } = this.data;
      const { width, height } = this.strip;
      const wide = width / Math.max(1, steps);
      context.fillStyle = colour("--paper");
      context.fillRect(0, 0, width, height);
      const order = { u: 0, r: 1, i: 2, w: 3 };
      const columns = Math.min(steps, width);
      for (let column = 0; column < columns; column++) {
        let worst = "u";
        for (let step = Math.floor((column * steps) / columns); step < Math.floor(((column + 1) * steps) / columns); step++) {
          const letter = strip[step] || "u";
          if (order[letter] > order[worst]) worst = letter;
        }
        const x = (column * width) / columns;
        const w = Math.max(1, width / columns);
        context.fillStyle = colour({ r: "--good", w: "--bad", i: "--inherit", u: "--faint" }[worst]);
        // Height tells them apart without colour.
        const tall = { r: 8, i: 14, w: 22, u: 3 }[worst];
        context.fillRect(x, height - 4 - tall, w > 3 ? w - 1 : w, tall);
      }
      context.fillStyle = colour("--ink");
      context.fillRect((Math.max(0, this.step - 0.5) * wide) - 1, 0, 2, height);
      if (first > 0 || last < steps) context.fillRect(first * wide, height - 2, (last - first) * wide, 2);
    }
    drawTicks() {
      const close = this.close();
      const marks = [];
      if (close) {
        const hits = this.pass >= 0 ? close.passes[this.pass].hits : close.expected;
        for (const [, time] of hits) marks.push([time, "tick-exp"]);
        for (const [, time] of close.actual) marks.push([time, "tick-own"]);
        for (const call of this.data.calls) if (call.step === this.step) for (const zero of call.zeros) marks.push([zero, "tick-zero"]);
      }
      this.ticks.replaceChildren(...marks.filter(([time]) => time >= 0 && time <= 1).map(([time, name]) => {
        const line = document.createElementNS(SVG, "line");
        for (const [key, value] of Object.entries({ x1: 1000 * time, x2: 1000 * time, y1: 0, y2: 12, class: name })) line.setAttribute(key, value);
        return line;
      }));
    }
    isSelected(kind, index) {
      const { selected } = this;
      if (!selected) return false;
      if (selected.pair) {
        const { kind: which, first, second } = parse(selected.pair);
        return (kind === "particle" && (index === first || (which === "pp" && index === second))) || (kind === PAIRS[which] && index === second && which !== "pp");
      }
      return selected.kind === kind && selected.index === index;
    }

    // ---- words ----

    tell() {
      const { data } = this;
      const close = this.close();
      const apart = this.difference();
      const parts = [`Step ${this.step} of ${data.steps} is ${this.classWords()}${this.mid ? ", and shown after its impulses" : ""}.`];
      if (apart) {
        const what = this.show.expected && this.expected() ? "from where it should be, given your own state before the step" : "from the reference's run";
        parts.push(apart.most > 0 ? `The furthest particle is ${short(apart.most)} ${what}.` : `Every position is the same to the last bit as expected.`);
      }
      if (data.whatIf && this.step >= data.first) {
        const own = this.state("submission", this.step), what = this.state("what", this.step);
        if (own && what) parts.push(same(own, what) ? "The reference with the named mistake is here to the last bit." : "The reference with the named mistake is elsewhere.");
      }
      this.say.textContent = parts.join(" ");
      const rows = [];
      if (close) {
        rows.push(["polynomials", close.polynomials[0], close.polynomials[1]], ["detection passes", close.expectedPasses, close.actualPasses === null ? "no whole number" : close.actualPasses]);
        rows.push(["collisions in the impulse list", data.collision === "hybrid" ? "none is logged" : close.expected.length, close.actual.length]);
      }
      const sums = (state) => {
        if (!state) return null;
        let [px, py, l] = [0, 0, 0];
        for (let k = 0; k < data.n; k++) {
          if (data.fixed[k]) continue;
          const m = data.masses[k], v = 2 * data.n + 2 * k;
          px += m * state[v]; py += m * state[v + 1];
          l += m * (state[2 * k] * state[v + 1] - state[2 * k + 1] * state[v]);
        }
        return [px, py, l];
      };
      const before = sums(this.state("submission", this.step - 1)), after = sums(this.state("submission", this.step));
      const right = close && sums(close.end || close.mid);
      const momentum = (s) => (s ? `(${short(s[0])}, ${short(s[1])}), angular ${short(s[2])}` : "-");
      this.facts.replaceChildren(table(data.full ? ["", "expected", "yours"] : ["", "yours"], this.cut([
        ...rows,
        ["momentum before the step", "", momentum(before)],
        ["momentum after the step", right ? momentum(right) : "-", momentum(after)],
      ]), "This step in numbers"));
      if (close && close.zones.length) {
        this.facts.append(el("p", {}, "Impact zones of the reference: " + close.zones[close.zones.length - 1].zones
          .map((zone) => `{${zone.particles.join(", ")}${zone.halfPlane ? ", a half-plane" : ""}}`).join(" ") || "none"));
      }
    }
    tellMatrix() {
      const close = this.close();
      const shown = `${this.step} ${this.pass}`;
      // Whoever stands in the table stays there.
      if (shown === this.matrixShown) return;
      this.matrixShown = shown;
      if (!close || !close.passes.length) return this.matrix.replaceChildren();
      const pass = close.passes[Math.max(0, this.pass)];
      const { n, edges, planes } = this.data;
      const columns = [...Array(n).keys()].map((k) => ["pp", k, `${k}`]).concat(edges.map((_, k) => ["pe", k, `e${k}`]), planes.map((_, k) => ["ph", k, `h${k}`]));
      const head = el("p", {}, `Who is tested with whom, ${pass.name}: ${pass.calls} calls expected. In the whole step ${close.polynomials[0]} polynomials are expected, and you logged ${close.polynomials[1]}. `,
        pass.logged ? "Marked with ! where your polynomials differ by more than a factor (as far as their order tells)." : "Your list of polynomials does not reach through this pass.");
      const hits = new Map(pass.hits.map(([pair, time]) => [pair, time]));
      const differing = new Set(pass.differing);
      if (n * columns.length > 1200) {
        const list = [...new Set([...hits.keys(), ...differing])].slice(0, 60);
        return this.matrix.replaceChildren(head, el("p", {}, ...list.map((pair) => this.pairButton(pair, `${words(pair)}${hits.has(pair) ? " *" : ""}${differing.has(pair) ? " !" : ""}`))));
      }
      const grid = el("table", { class: "pairs" }, el("thead", {}, el("tr", {}, el("th", {}, ""), ...columns.map(([, , text]) => el("th", { scope: "col" }, text)))));
      const body = el("tbody");
      for (let row = 0; row < n; row++) {
        const cells = columns.map(([kind, k]) => {
          const tested = kind === "pp" ? k > row : kind === "pe" ? edges[k][0] !== row && edges[k][1] !== row : true;
          if (!tested) return el("td", { class: "never" }, "");
          const pair = `${kind}:${row},${k}`;
          const text = (hits.has(pair) ? "*" : "") + (differing.has(pair) ? "!" : "") || ".";
          return el("td", { class: differing.has(pair) ? "differs" : hits.has(pair) ? "hits" : "" }, this.pairButton(pair, text));
        });
        body.append(el("tr", {}, el("th", { scope: "row" }, `${row}`), ...cells));
      }
      grid.append(body);
      const box = el("details", { class: "table" }, el("summary", {}, "Pairs"), head, el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Pairs of this step" }, grid));
      box.open = this.matrixOpen === true;
      box.addEventListener("toggle", () => { this.matrixOpen = box.open; });
      this.matrix.replaceChildren(box);
    }
    pairButton(pair, text) {
      return el("button", { type: "button", class: "pair", "aria-label": `${words(pair)}: ${text.includes("*") ? "collide" : "tested"}${text.includes("!") ? ", yours differs" : ""}`,
        onclick: () => { this.selected = { pair }; this.look(); } }, text);
    }
    pick(event) {
      const box = this.canvas.getBoundingClientRect();
      const x = ((event.clientX - box.left) * this.canvas.width) / box.width, y = ((event.clientY - box.top) * this.canvas.height) / box.height;
      const positions = this.positions("submission");
      if (!positions) return;
      let best = [Infinity, null];
      const near = (distance, kind, index) => { if (distance < best[0]) best = [distance, { kind, index }]; };
      for (let k = 0; k < this.data.n; k++) {
        const at = this.to(positions[2 * k], positions[2 * k + 1]);
        near(Math.max(0, Math.hypot(at[0] - x, at[1] - y) - this.data.radii[k] * this.scale()), "particle", k);
      }
      this.data.edges.forEach(([i, j, r], index) => {
        const a = this.to(positions[2 * i], positions[2 * i + 1]), b = this.to(positions[2 * j], positions[2 * j + 1]);
        const d = [b[0] - a[0], b[1] - a[1]], size = d[0] * d[0] + d[1] * d[1] || 1;
        const s = Math.max(0, Math.min(1, ((x - a[0]) * d[0] + (y - a[1]) * d[1]) / size));
        near(Math.max(1, Math.hypot(a[0] + s * d[0] - x, a[1] + s * d[1] - y) - r * this.scale()), "edge", index);
      });
      this.data.planes.forEach(([px, py, nx, ny], index) => {
        const a = this.to(px, py), depth = ((x - a[0]) * nx - (y - a[1]) * ny) / (Math.hypot(nx, ny) || 1);
        near(depth > 0 ? depth : 12, "half-plane", index);
      });
      const spot = this.spots.find(([, sx, sy]) => Math.hypot(sx - x, sy - y) < 9);
      this.selected = spot ? { pair: spot[0] } : best[0] < 14 ? best[1] : null;
      this.look();
    }
    tellNumbers() {
      const { selected, data } = this;
      if (!selected) return this.numbers.replaceChildren(el("p", { class: "hint" }, "Click a particle, an edge, a half-plane or a contact for its numbers, or a pair in the table of pairs."));
      const rows = [];
      const list = selected.pair ? [parse(selected.pair).first, ...(selected.pair.startsWith("pp") ? [parse(selected.pair).second] : selected.pair.startsWith("pe") ? data.edges[parse(selected.pair).second].slice(0, 2) : [])]
        : selected.kind === "particle" ? [selected.index] : selected.kind === "edge" ? data.edges[selected.index].slice(0, 2) : [];
      const exact = (value) => `${value} (${hex(value)})`;
      const plane = selected.kind === "half-plane" ? selected.index : selected.pair && selected.pair.startsWith("ph") ? parse(selected.pair).second : null;
      if (plane !== null && data.planes[plane]) {
        ["point x", "point y", "normal x", "normal y"].forEach((name, k) => rows.push([`half-plane ${plane} ${name}`, ...Array(3).fill(exact(data.planes[plane][k]))]));
      }
      const close = this.close();
      if (selected.pair && close) {
        const [right, own] = [close.expected, close.actual].map((all) => all.find(([pair]) => pair === selected.pair));
        ["time of impact", "normal x", "normal y"].forEach((name, k) => {
          if (right || own) rows.push([`contact's ${name}`, ...[right, own].map((one) => (one ? exact(one[k + 1]) : "none")), "-"]);
        });
      }
      const expected = this.expected();
      for (const k of list) {
        for (const [name, at] of [["x", 2 * k], ["y", 2 * k + 1], ["vx", 2 * data.n + 2 * k], ["vy", 2 * data.n + 2 * k + 1]]) {
          const own = this.state("submission", this.step, this.mid), ref = this.state("reference", this.step, this.mid);
          const cell = (state) => (state ? exact(state[at]) : "-");
          rows.push([`particle ${k} ${name}`, cell(expected), cell(own), cell(ref)]);
        }
      }
      const title = selected.pair ? words(selected.pair) : `${selected.kind} ${selected.index}`;
      const command = !data.traceName ? "" : selected.pair
        ? `fosssim-oracle detect --scene ${quoted(data.scene)} --trace ${quoted(data.traceName)} --step ${this.step} --pair ${selected.pair}`
        : `fosssim-oracle trace show ${quoted(data.scene)} ${quoted(data.traceName)} --step ${this.step}`;
      this.numbers.replaceChildren(
        el("h4", {}, title, " after step ", String(this.step)),
        el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Numbers" }, table(this.columns(), this.cut(rows), "Exact numbers")),
        command ? el("p", {}, "On the command line: ", el("code", {}, command), " ",
          el("button", { type: "button", onclick: (event) => copy(command, event.target) }, "Copy")) : "",
        el("p", {}, "The same bodies alone, moving as here: ",
          el("button", { type: "button", onclick: (event) => copy(this.asScene(list), event.target) }, "Copy as scene"),
          ". Saved as case.xml: ", el("code", {}, "./FOSSSim -s case.xml -d 0 -o case.bin; fosssim-oracle check case.xml case.bin")));
    }
    // Where hints hide what is right, there is only one column.
    columns() {
      return this.data.full ? ["", "expected from your own state", "yours", "reference from the start"] : ["", "yours"];
    }
    cut(rows) {
      return this.data.full ? rows : rows.map(([name, , own]) => [name, own]);
    }
    // The bodies at the start of the step as a scene of one step, without forces.
    asScene(particles) {
      const { data } = this;
      const state = this.state("submission", Math.max(data.first, this.step - 1)).slice();
      // Forces are left out: velocities are such that the bodies move as the step's first detection saw them.
      const close = this.close(), pass = close && close.passes[0];
      if (pass && pass.q.length === 2 * data.n) {
        for (let k = 0; k < 2 * data.n; k++) state[2 * data.n + k] = (pass.q[k] - state[k]) / data.dt;
      }
      const chosen = [...new Set(particles)].sort((a, b) => a - b);
      const index = new Map(chosen.map((k, place) => [k, place]));
      const lines = [`<scene>`, `  <duration time="${data.dt}"/>`, `  ${data.integrator}`, `  ${data.collisionTag}`];
      for (const k of chosen) {
        lines.push(`  <particle m="${data.masses[k]}" px="${state[2 * k]}" py="${state[2 * k + 1]}" vx="${state[2 * data.n + 2 * k]}" vy="${state[2 * data.n + 2 * k + 1]}" fixed="${data.fixed[k] ? 1 : 0}" radius="${data.radii[k]}"/>`);
      }
      for (const [i, j, r] of data.edges) if (index.has(i) && index.has(j)) lines.push(`  <edge i="${index.get(i)}" j="${index.get(j)}" radius="${r}"/>`);
      for (const [px, py, nx, ny] of data.planes) lines.push(`  <halfplane px="${px}" py="${py}" nx="${nx}" ny="${ny}"/>`);
      return [...lines, `</scene>`, ``].join("\n");
    }
    tellTable() {
      if (!this.table.open) return;
      const own = this.state("submission", this.step, this.mid), ref = this.state("reference", this.step, this.mid), expected = this.expected();
      const cell = (state, k) => (state ? `(${short(state[2 * k])}, ${short(state[2 * k + 1])})` : "-");
      const rows = [...Array(this.data.n).keys()].map((k) => [`particle ${k}`, cell(expected, k), cell(own, k), cell(ref, k)]);
      this.tableBody.replaceChildren(table(this.columns(), this.cut(rows), `Positions after step ${this.step}`));
    }

    // ---- taking along ----

    file(blob, name) {
      const link = el("a", { href: URL.createObjectURL(blob), download: name });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }
    picture() {
      this.canvas.toBlob((blob) => blob && this.file(blob, `step-${this.step}.png`));
    }
    drawing() {
      const sketch = new Sketch(this.canvas.width, this.canvas.height);
      this.draw(sketch);
      this.file(new Blob([sketch.svg()], { type: "image/svg+xml" }), `step-${this.step}.svg`);
    }
    clip() {
      if (typeof MediaRecorder === "undefined" || !this.canvas.captureStream) { this.say.textContent = "This browser can't record films."; return; }
      const recorder = new MediaRecorder(this.canvas.captureStream(30));
      const parts = [];
      recorder.ondataavailable = (event) => parts.push(event.data);
      recorder.onstop = () => this.file(new Blob(parts, { type: recorder.mimeType }), "motion.webm");
      const began = Math.max(this.data.first, this.step - 30), until = Math.min(this.data.last, this.step + 30);
      let step = began;
      recorder.start();
      const turn = () => {
        this.go(step);
        if (step++ < until) setTimeout(turn, 1000 / 15); else recorder.stop();
      };
      turn();
    }
    link() {
      const hash = new URLSearchParams({ scene: this.name, step: this.step, t: this.t.toFixed(3) });
      if (this.selected && this.selected.pair) hash.set("pair", this.selected.pair);
      history.replaceState(null, "", "#" + hash);
      copy(location.href, null);
      this.say.textContent = "The address of this page leads to this moment now.";
    }
  }

  // Takes down as SVG what is drawn: as much of a canvas's context as the viewer uses. Arcs are whole circles.
  class Sketch {
    constructor(width, height) {
      Object.assign(this, { width, height, out: [], path: "", dash: [], fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, font: "", textAlign: "start", lineCap: "butt", lineJoin: "miter" });
    }
    at(...values) { return values.map((value) => Math.round(value * 100) / 100).join(" "); }
    beginPath() { this.path = ""; }
    moveTo(x, y) { this.path += `M${this.at(x, y)}`; }
    lineTo(x, y) { this.path += `L${this.at(x, y)}`; }
    closePath() { this.path += "Z"; }
    rect(x, y, w, h) { this.path += `M${this.at(x, y)}h${this.at(w)}v${this.at(h)}h${this.at(-w)}Z`; }
    arc(x, y, r) { this.path += `M${this.at(x + r, y)}A${this.at(r, r)} 0 1 1 ${this.at(x - r, y)}A${this.at(r, r)} 0 1 1 ${this.at(x + r, y)}Z`; }
    setLineDash(dash) { this.dash = dash; }
    stroke() {
      this.out.push(`<path d="${this.path}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.at(this.lineWidth)}" stroke-dasharray="${this.dash.join(" ") || "none"}" stroke-linecap="${this.lineCap}" stroke-linejoin="${this.lineJoin}"/>`);
    }
    fill() { this.out.push(`<path d="${this.path}" fill="${this.fillStyle}"/>`); }
    fillRect(x, y, w, h) { this.beginPath(); this.rect(x, y, w, h); this.fill(); }
    fillText(text, x, y) {
      this.out.push(`<text x="${this.at(x)}" y="${this.at(y)}" fill="${this.fillStyle}" font-family="sans-serif" font-size="${parseFloat(this.font)}" text-anchor="${this.textAlign === "center" ? "middle" : "start"}">${text}</text>`);
    }
    svg() {
      return `<svg xmlns="${SVG}" viewBox="0 0 ${this.width} ${this.height}" width="${this.width}" height="${this.height}">\n${this.out.join("\n")}\n</svg>\n`;
    }
  }

  const quoted = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
  const same = (one, other) => one.length === other.length && one.every((value, k) => Object.is(value, other[k]));
  function table(head, rows, caption) {
    return el("table", {}, el("caption", {}, caption), el("thead", {}, el("tr", {}, ...head.map((text) => el("th", { scope: "col" }, text)))),
      el("tbody", {}, ...rows.map(([name, ...cells]) => el("tr", {}, el("th", { scope: "row" }, name), ...cells.map((cell) => el("td", {}, String(cell)))))));
  }
  function copy(text, button) {
    const done = () => { if (button) { const old = button.textContent; button.textContent = "Copied"; setTimeout(() => { button.textContent = old; }, 1200); } };
    const by_hand = () => {
      const area = el("textarea", { class: "offscreen" });
      area.value = text;
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
      done();
    };
    if (navigator.clipboard && isSecureContext) navigator.clipboard.writeText(text).then(done, by_hand); else by_hand();
  }
  function arrow(context, from, to) {
    const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
    context.beginPath(); context.moveTo(...from); context.lineTo(...to); context.stroke();
    context.beginPath();
    context.moveTo(...to);
    for (const turn of [0.4, -0.4]) context.lineTo(to[0] - 9 * Math.cos(angle + turn), to[1] - 9 * Math.sin(angle + turn));
    context.fill();
  }
  // Andrew's monotone chain.
  function hull(points) {
    const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    if (sorted.length < 3) return sorted;
    const half = (list) => {
      const chain = [];
      for (const p of list) {
        while (chain.length > 1) {
          const [a, b] = chain.slice(-2);
          if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
          chain.pop();
        }
        chain.push(p);
      }
      return chain.slice(0, -1);
    };
    return [...half(sorted), ...half(sorted.reverse())];
  }

  const viewers = new Map();
  async function open(article) {
    const key = article.dataset.case;
    if (viewers.has(key)) return viewers.get(key);
    const block = document.getElementById(`case-${key}`);
    if (!block || viewers.get(key) === null) return null;
    viewers.set(key, null);
    const data = JSON.parse(block.textContent);
    const tracks = {};
    for (const name of ["reference", "submission", "what"]) tracks[name] = await unpack(`${name}-${key}`);
    const viewer = new Viewer(article, data, tracks);
    viewers.set(key, viewer);
    return viewer;
  }
  // The cursor of the plots over the steps: their horizontal axis is given with them.
  document.addEventListener("moment", ({ detail: { key, step } }) => {
    for (const figure of document.querySelectorAll(`[data-plot="${key}"]`)) {
      const svg = figure.querySelector("svg");
      const [left, right, steps] = ["left", "right", "steps"].map((name) => Number(figure.dataset[name]));
      let line = svg.querySelector(".cursor");
      if (!line) {
        line = document.createElementNS(SVG, "line");
        line.classList.add("cursor");
        line.setAttribute("y1", 24);
        line.setAttribute("y2", svg.viewBox.baseVal.height - 20);
        svg.append(line);
        svg.addEventListener("click", async (event) => {
          const box = svg.getBoundingClientRect();
          const x = ((event.clientX - box.left) / box.width) * svg.viewBox.baseVal.width;
          const viewer = viewers.get(key);
          if (viewer) viewer.go(1 + Math.round(((x - left) / (right - left)) * (steps - 1)));
        });
      }
      const x = left + (steps > 1 ? (Math.max(1, step) - 1) / (steps - 1) : 0) * (right - left);
      line.setAttribute("x1", x);
      line.setAttribute("x2", x);
    }
  });
  async function start() {
    const wish = new URLSearchParams(location.hash.slice(1));
    const articles = [...document.querySelectorAll("article.case")];
    for (const article of articles) {
      const details = article.querySelector("details.motion");
      if (!details) continue;
      details.hidden = false;
      details.addEventListener("toggle", () => { if (details.open) open(article); });
      const card = article.querySelector("details.card");
      if (card) card.addEventListener("toggle", () => { if (card.open) details.open = true; }, { once: true });
    }
    const named = articles.find((article) => article.dataset.scene === wish.get("scene"));
    const first = [named, ...articles].find((article) => article && article.querySelector("details.motion"));
    if (!first) { document.documentElement.dataset.ready = "yes"; return; }
    const details = first.querySelector("details.motion");
    if (!details) return;
    const card = first.querySelector("details.card");
    if (card) card.open = true;
    details.open = true;
    const viewer = await open(first);
    if (viewer && named) {
      if (wish.has("step")) viewer.go(Number(wish.get("step")));
      if (wish.has("t")) viewer.t = Math.max(0, Math.min(1, Number(wish.get("t")) || 0));
      if (/^p[peh]:\d+,\d+$/.test(wish.get("pair") || "")) viewer.selected = { pair: wish.get("pair") };
      viewer.look();
      first.scrollIntoView();
    }
    document.documentElement.dataset.ready = "yes";
  }
  addEventListener("hashchange", () => location.reload());
  document.addEventListener("keydown", (event) => {
    if (event.target === document.body) { const viewer = [...viewers.values()].find(Boolean); if (viewer) viewer.key_down(event); }
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => viewers.forEach((viewer) => viewer && viewer.look()));
  start();
})();
