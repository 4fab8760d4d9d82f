// The drawing on the canvases.
class Drawing extends Motion {
  update() {
    const { data } = this;
    const close = this.closeUp();
    if (close ? this.pass >= close.passes.length : this.pass >= 0) this.pass = -1;
    this.slider.value = this.step;
    this.midBox.checked = this.mid;
    this.slider.setAttribute("aria-valuetext", `step ${this.step}, ${this.classText()}`);
    this.stepBox.value = this.step;
    this.inside.value = this.t;
    this.insideText.textContent = this.t.toFixed(3);
    this.passes.replaceChildren(
      el("option", { value: -1 }, "as recorded"),
      ...(close ? close.passes.map((pass, k) => el("option", { value: k }, `as detection sees it: ${pass.name}`)) : []),
    );
    this.passes.value = this.pass;
    this.inside.disabled = this.step <= data.first;
    if (!this.playing) this.selectWrongPair();
    this.draw();
    this.drawStrip();
    this.drawTicks();
    this.showText();
    if (!this.playing) {
      this.showMatrix();
      this.showNumbers();
      this.showTable();
    }
    document.dispatchEvent(new CustomEvent("moment", { detail: { key: this.key, step: this.step } }));
  }
  classText(step = this.step) {
    return (
      { r: "right", w: "wrong by itself", i: "right by itself, but it starts from a wrong state" }[
        this.data.strip[step - 1]
      ] || (step === 0 ? "the start" : "not judged")
    );
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
    // Ignore differences that rounding alone can cause.
    const rounding = this.isExact() ? 0 : 2 * this.data.rounded.unit;
    return { list, most: most > rounding ? most : 0, base };
  }
  // The size of letters, which must be readable on a phone.
  letterSize() {
    return Math.round(14 * Math.max(1, Math.min(2.2, 960 / (this.canvas.clientWidth || 960))));
  }
  // Draws both motions on top of each other, or the expected one next to the actual one.
  draw(context = this.canvas.getContext("2d")) {
    const { width, height } = this.canvas;
    const panels = this.beside && this.baseline() ? ["expected", "yours"] : ["both"];
    context.fillStyle = color("--card");
    context.fillRect(0, 0, width, height);
    panels.forEach((panel, place) => {
      this.view = [(place * width) / panels.length, width / panels.length];
      context.save();
      context.beginPath();
      context.rect(this.view[0], 0, this.view[1], height);
      context.clip();
      this.panel(context, panel);
      context.restore();
    });
    context.fillStyle = color("--line");
    if (panels.length > 1) context.fillRect(width / 2 - 1, 0, 2, height);
    this.view = [0, width];
  }
  panel(context, panel) {
    this.planes(context);
    const expected = this.show.expected && this.expected();
    if (panel === "both") {
      this.zones(context);
      if (this.show.reference)
        this.bodies(context, this.positions("reference"), { stroke: color("--ref"), dash: [7, 5] });
      if (expected) this.bodies(context, expected, { stroke: color("--exp"), dash: [2, 3] });
      if (this.show.what && this.data.whatIf)
        this.bodies(context, this.positions("what"), { stroke: color("--what"), dash: [12, 4, 2, 4] });
    }
    if (panel === "expected")
      this.bodies(context, this.baseline(), { stroke: color(expected ? "--exp" : "--ref"), dash: [], label: true });
    else
      this.bodies(context, this.positions("submission"), {
        stroke: color("--own"),
        fill: color("--ownfill"),
        dash: [],
        label: true,
      });
    if (panel === "both" && !this.peeking) this.arrows(context);
    if (panel !== "expected" && !this.peeking) this.contacts(context);
    context.font = `${this.letterSize()}px system-ui, sans-serif`;
    const at = `step ${this.step}${this.t < 1 ? `, t = ${this.t.toFixed(3)}` : ""}`;
    const caption =
      panel === "both" ? at : `${panel === "yours" ? "yours" : expected ? "expected" : "reference"}, ${at}`;
    // Lines of the scene end below the text.
    context.fillStyle = color("--card");
    context.fillRect(this.view[0], 0, 20 + 0.56 * this.letterSize() * caption.length, 14 + this.letterSize());
    context.fillStyle = color("--ink");
    context.fillText(caption, this.view[0] + 10, 6 + this.letterSize());
  }
  // Draws the motion at another step as a small preview.
  drawPreview(step) {
    const { step: now, t, pass, mid } = this;
    const context = this.preview.querySelector("canvas").getContext("2d");
    Object.assign(this, { step, t: 1, pass: -1, mid: false, peeking: true });
    context.setTransform(0.4, 0, 0, 0.4, 0, 0);
    this.draw(context);
    this.preview.lastChild.textContent = `${step}: ${this.classText()}`;
    Object.assign(this, { step: now, t, pass, mid, peeking: false });
  }
  bodies(context, positions, { stroke, fill, dash, label }) {
    if (!positions) return;
    const { radii, edges, n } = this.data;
    const scale = this.scale();
    context.setLineDash(dash);
    context.lineWidth = 2;
    context.strokeStyle = stroke;
    edges.forEach(([i, j, r], index) => {
      const [a, b] = [
        this.toPixels(positions[2 * i], positions[2 * i + 1]),
        this.toPixels(positions[2 * j], positions[2 * j + 1]),
      ];
      if (!areFinite(...a, ...b)) return;
      const chosen = label && this.isSelected("edge", index);
      if (fill && r * scale > 0.5) {
        context.setLineDash([]);
        context.lineCap = "round";
        context.lineWidth = 2 * r * scale;
        context.strokeStyle = fill;
        context.beginPath();
        context.moveTo(...a);
        context.lineTo(...b);
        context.stroke();
        context.lineCap = "butt";
        context.setLineDash(dash);
      }
      context.lineWidth = chosen ? 4 : 2;
      context.strokeStyle = chosen ? color("--bad") : stroke;
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
      const [x, y] = this.toPixels(positions[2 * k], positions[2 * k + 1]);
      if (!areFinite(x, y)) continue;
      const chosen = label && this.isSelected("particle", k);
      const size = Math.max(1.5, radii[k] * scale);
      if (x + size < 0 || y + size < 0 || x - size > this.canvas.width || y - size > this.canvas.height || size > 1e5)
        continue;
      context.beginPath();
      context.arc(x, y, size, 0, 7);
      if (fill) {
        context.fillStyle = fill;
        context.fill();
      }
      context.lineWidth = chosen ? 4 : 2;
      context.strokeStyle = chosen ? color("--bad") : stroke;
      context.stroke();
      if (label && n <= 60) {
        context.fillStyle = color("--ink");
        context.font = `${this.letterSize() - 2}px system-ui, sans-serif`;
        context.textAlign = "center";
        context.fillText(this.data.fixed[k] ? `${k} fixed` : `${k}`, x, y + 4);
        context.textAlign = "start";
      }
    }
    context.setLineDash([]);
  }
  planes(context) {
    const far = (4 * this.extent) / Math.min(1, this.zoom) + 1;
    this.data.planes.forEach(([px, py, nx, ny], index) => {
      const length = Math.hypot(nx, ny);
      if (!(length > 0)) return;
      const [ux, uy] = [nx / length, ny / length];
      const chosen = this.isSelected("half-plane", index);
      context.strokeStyle = chosen ? color("--bad") : color("--ink");
      context.fillStyle = color("--ground");
      context.lineWidth = chosen ? 4 : 2;
      const a = this.toPixels(px - uy * far, py + ux * far);
      const b = this.toPixels(px + uy * far, py - ux * far);
      const depth = [-ux * far * this.scale(), uy * far * this.scale()];
      context.beginPath();
      context.moveTo(...a);
      context.lineTo(...b);
      context.lineTo(b[0] + depth[0], b[1] + depth[1]);
      context.lineTo(a[0] + depth[0], a[1] + depth[1]);
      context.fill();
      context.beginPath();
      context.moveTo(...a);
      context.lineTo(...b);
      context.stroke();
    });
  }
  zones(context) {
    const close = this.closeUp();
    const state = this.positions("submission");
    if (!close || !close.zones.length || !state) return;
    const last = close.zones[close.zones.length - 1];
    context.strokeStyle = color("--zone");
    context.fillStyle = color("--zonefill");
    context.lineWidth = 1.5;
    for (const zone of last.zones) {
      const points = zone.particles
        .map((k) => this.toPixels(state[2 * k], state[2 * k + 1]))
        .filter((p) => areFinite(...p));
      const outline = convexHull(points);
      if (outline.length < 1) continue;
      context.lineJoin = "round";
      context.beginPath();
      outline.forEach((p, k) => (k ? context.lineTo(...p) : context.moveTo(...p)));
      context.closePath();
      context.lineWidth = 26;
      context.strokeStyle = color("--zonefill");
      context.stroke();
      context.fill();
      context.lineJoin = "miter";
    }
  }
  arrows(context) {
    const difference = this.difference();
    this.magnified.hidden = !(difference && difference.most > 0);
    if (this.magnified.hidden) return;
    const wantedFactor = (0.12 * this.extent) / this.zoom / difference.most,
      powerOfTen = 10 ** Math.floor(Math.log10(wantedFactor));
    const automatic = Math.max(
      1,
      powerOfTen * (wantedFactor >= 5 * powerOfTen ? 5 : wantedFactor >= 2 * powerOfTen ? 2 : 1),
    );
    const factor = this.magnify === null ? automatic : this.magnify;
    this.factor.value = Math.log10(factor);
    this.factorText.textContent = `${factor >= 1e4 ? factor.toExponential(1) : formatShort(factor)} times (largest difference ${formatShort(difference.most)})`;
    if (!this.show.arrows) return;
    context.strokeStyle = context.fillStyle = color("--bad");
    context.lineWidth = 2;
    for (let k = 0; k < this.data.n; k++) {
      const [dx, dy] = difference.list[k];
      if (!(Math.hypot(dx, dy) > difference.most * 1e-3)) continue;
      const from = this.toPixels(difference.base[2 * k], difference.base[2 * k + 1]);
      const to = this.toPixels(difference.base[2 * k] + factor * dx, difference.base[2 * k + 1] + factor * dy);
      drawArrow(context, from, to);
      context.beginPath();
      context.arc(...from, 18, 0, 7);
      context.setLineDash([1, 4]);
      context.stroke();
      context.setLineDash([]);
    }
  }
  contacts(context) {
    const close = this.closeUp();
    this.spots = [];
    if (!close) return;
    const draw = (list, stroke, dash, filled) => {
      for (const [pair, time, nx, ny] of list) {
        const place = this.contactPlace(pair, time);
        const length = Math.hypot(nx, ny);
        if (!place || !(length > 0)) continue;
        const from = this.toPixels(...place);
        const to = [from[0] + (nx / length) * 46, from[1] - (ny / length) * 46];
        if (!areFinite(...from, ...to)) continue;
        this.spots.push([pair, ...from]);
        context.strokeStyle = context.fillStyle = stroke;
        context.lineWidth = filled ? 2 : 3;
        context.setLineDash(dash);
        drawArrow(context, from, to);
        context.setLineDash([]);
        context.beginPath();
        if (filled) context.arc(...from, 5, 0, 7);
        else context.rect(from[0] - 6, from[1] - 6, 12, 12);
        if (filled) context.fill();
        else context.stroke();
      }
    };
    const expected = this.pass >= 0 ? close.passes[this.pass].hits : close.expected;
    draw(expected, color("--exp"), [2, 3], true);
    if (this.pass <= 0) draw(close.actual, color("--own"), [], false);
  }
  // The place of a particle's contact at a time within the step: its center as detection computes it.
  contactPlace(pair, time) {
    const { first } = parsePair(pair);
    const start = this.state("submission", this.step - 1);
    const close = this.closeUp();
    const pass = close && close.passes[Math.max(0, this.pass)];
    if (!start || !pass || first >= this.data.n || !areFinite(time)) return null;
    return [0, 1].map((axis) => start[2 * first + axis] + time * (pass.q[2 * first + axis] - start[2 * first + axis]));
  }
  drawStrip() {
    const context = this.strip.getContext("2d");
    const { strip, steps, first, last } = this.data;
    const { width, height } = this.strip;
    const stepWidth = width / Math.max(1, steps);
    context.fillStyle = color("--card");
    context.fillRect(0, 0, width, height);
    const order = { u: 0, r: 1, i: 2, w: 3 };
    const columns = Math.min(steps, width);
    for (let column = 0; column < columns; column++) {
      let worst = "u";
      for (
        let step = Math.floor((column * steps) / columns);
        step < Math.floor(((column + 1) * steps) / columns);
        step++
      ) {
        const letter = strip[step] || "u";
        if (order[letter] > order[worst]) worst = letter;
      }
      const x = (column * width) / columns;
      const barWidth = Math.max(1, width / columns);
      context.fillStyle = color({ r: "--good", w: "--bad", i: "--warn", u: "--faint" }[worst]);
      // The height distinguishes the steps without color.
      const barHeight = { r: 8, i: 14, w: 22, u: 3 }[worst];
      context.fillRect(x, height - 4 - barHeight, barWidth > 3 ? barWidth - 1 : barWidth, barHeight);
    }
    // The current step has a frame, and a marker above it.
    const left = Math.max(0, this.step - 1) * stepWidth,
      most = this.step > 0 ? Math.max(4, stepWidth) : 2,
      middle = left + most / 2;
    context.fillStyle = context.strokeStyle = color("--ink");
    context.lineWidth = 2;
    context.strokeRect(left + 1, 8, most - 2, height - 10);
    context.beginPath();
    context.moveTo(middle - 7, 0);
    context.lineTo(middle + 7, 0);
    context.lineTo(middle, 8);
    context.fill();
    if (first > 0 || last < steps) context.fillRect(first * stepWidth, height - 2, (last - first) * stepWidth, 2);
  }
  drawTicks() {
    const close = this.closeUp();
    const marks = [];
    if (close) {
      const hits = this.pass >= 0 ? close.passes[this.pass].hits : close.expected;
      for (const [, time] of hits) marks.push([time, "tick-exp"]);
      for (const [, time] of close.actual) marks.push([time, "tick-own"]);
      for (const call of this.data.calls)
        if (call.step === this.step) for (const zero of call.zeros) marks.push([zero, "tick-zero"]);
    }
    this.ticks.replaceChildren(
      ...marks
        .filter(([time]) => time >= 0 && time <= 1)
        .map(([time, name]) => {
          const line = document.createElementNS(SVG, "line");
          for (const [key, value] of Object.entries({ x1: 1000 * time, x2: 1000 * time, y1: 0, y2: 12, class: name }))
            line.setAttribute(key, value);
          return line;
        }),
    );
  }
  isSelected(kind, index) {
    const { selected } = this;
    if (!selected) return false;
    if (selected.pair) {
      const { kind: which, first, second } = parsePair(selected.pair);
      return (
        (kind === "particle" && (index === first || (which === "pp" && index === second))) ||
        (kind === PAIRS[which] && index === second && which !== "pp")
      );
    }
    return selected.kind === kind && selected.index === index;
  }
}
