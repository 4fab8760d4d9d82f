// The text of the viewer: the moment, the pairs, the numbers and the table. Motions that are closer than this differ
// only by round-off.
const ROUND_OFF = 1e-9;
class Words extends Drawing {
  showText() {
    const { data } = this;
    const close = this.closeUp();
    const difference = this.difference();
    const parts = [
      `Step ${this.step} of ${data.steps} is ${this.classText()}${this.mid ? ", and shown after its impulses" : ""}.`,
    ];
    if (difference) {
      const what =
        this.show.expected && this.expected()
          ? "from the right position, given your own state before the step"
          : "from the reference's run";
      const isWrong = this.classText().startsWith("wrong");
      const none = this.isExact()
        ? !isWrong
          ? "Every position matches the expected one bit for bit."
          : "Only polynomials or contacts differ: the positions match the expected ones bit for bit."
        : "No position differs by more than the rounding of this page.";
      const furthest = `furthest particle is ${formatShort(difference.most)} ${what}.`;
      const some =
        isWrong && difference.most < ROUND_OFF
          ? `Only polynomials or contacts differ: the ${furthest}`
          : `The ${furthest}`;
      parts.push(difference.most > 0 ? some : none);
    }
    if (data.whatIf && this.step >= data.first) {
      const own = this.state("submission", this.step),
        what = this.state("what", this.step);
      if (own && what && this.isExact(this.step, false))
        parts.push(
          areIdentical(own, what)
            ? "The reference with the named mistake is in the same state, bit for bit."
            : own.every((value, k) => Math.abs(value - what[k]) < ROUND_OFF)
              ? "The reference with the named mistake is in the same state, up to round-off."
              : "The reference with the named mistake is in another state.",
        );
    }
    this.say.textContent = parts.join(" ");
    // The start has no numbers of a step.
    if (this.facts.parentElement) this.facts.parentElement.hidden = this.step === 0;
    if (this.step === 0) return;
    const rows = [];
    if (close) {
      rows.push(
        ["polynomials", close.polynomials[0], close.polynomials[1]],
        [
          "detection passes",
          close.expectedPasses,
          close.actualPasses === null ? "no whole number" : close.actualPasses,
        ],
      );
      rows.push([
        "collisions in the impulse list",
        data.collision === "hybrid" ? 0 : close.expected.length,
        close.actual.length,
      ]);
    }
    const sums = (state) => {
      if (!state) return null;
      let [px, py, l] = [0, 0, 0];
      for (let k = 0; k < data.n; k++) {
        if (data.fixed[k]) continue;
        const m = data.masses[k],
          v = 2 * data.n + 2 * k;
        px += m * state[v];
        py += m * state[v + 1];
        l += m * (state[2 * k] * state[v + 1] - state[2 * k + 1] * state[v]);
      }
      return [px, py, l];
    };
    const before = sums(this.state("submission", this.step - 1)),
      after = sums(this.state("submission", this.step));
    const right = close && sums(close.end || close.mid);
    // Ignore differences of sums that rounding alone can cause.
    const near = (one, other) => Math.abs(one - other) <= 1e-9 * Math.max(1, Math.abs(one));
    const momentum = ([x, y, l]) => el("span", {}, x, el("br"), y, el("br"), l);
    const both = (right, own) => {
      const known = [right, own].map((s) => s && areFinite(...s));
      if (known[0] && known[1]) {
        const parts = right.map((value, k) =>
          near(value, own[k]) ? [formatShort(value), formatShort(value)] : formatPair(value, own[k]),
        );
        return [0, 1].map((side) => momentum(parts.map((part) => part[side])));
      }
      return [right, own].map((s, side) => (known[side] ? momentum(s.map(formatShort)) : "-"));
    };
    const phases = [["before the step", before, before]];
    if (data.collision === "hybrid")
      phases.push(["after the impulses", close && sums(close.mid), sums(this.state("submission", this.step, true))]);
    phases.push([data.collision === "hybrid" ? "after the failsafe" : "after the step", right, after]);
    this.facts.replaceChildren(
      el(
        "div",
        { class: "scroll", tabindex: 0, role: "region", "aria-label": "This step in numbers" },
        createTable(
          ["", "expected", "yours"],
          this.hideExpected([
            ...rows,
            ...phases.map(([name, expected, own]) => [`momentum ${name}: x, y, angular`, ...both(expected, own)]),
          ]),
          "This step in numbers",
        ),
      ),
    );
    if (close && close.zones.length) {
      this.facts.append(
        el(
          "p",
          {},
          "Impact zones of the reference: " +
            close.zones[close.zones.length - 1].zones
              .map((zone) => `{${zone.particles.join(", ")}${zone.halfPlane ? ", a half-plane" : ""}}`)
              .join(" ") || "none",
        ),
      );
    }
  }
  // Collects the tested pairs of the selected pass or of the whole step: expected and actual calls, contacts, and
  // faults.
  collectTestedPairs() {
    const close = this.closeUp();
    if (!close || !close.passes.length) return null;
    if (this.testedPairs && this.testedPairs.key === `${this.step} ${this.pass}`) return this.testedPairs;
    const passes = this.pass >= 0 ? [close.passes[this.pass]] : close.passes;
    const expected = this.pass >= 0 ? 1 : close.expectedPasses;
    const known = passes.every((pass) => pass.logged);
    const pairs = new Map();
    const entryOf = (pair) => {
      if (!pairs.has(pair)) pairs.set(pair, { made: expected, wrong: [], hit: false });
      return pairs.get(pair);
    };
    for (const pass of passes) {
      for (const [pair] of pass.hits) entryOf(pair).hit = true;
      for (const pair of pass.missing) entryOf(pair).made -= 1;
      for (const pair of pass.repeated) entryOf(pair).made += 1;
      // If earlier passes are wrong, other polynomials are right.
      if (!this.data.follows || pass === close.passes[0])
        for (const pair of pass.differing)
          if (!entryOf(pair).wrong.length) entryOf(pair).wrong.push("its polynomials differ");
    }
    // Each surplus pass tests every pair once more.
    const pairCount = close.polynomials[0] / close.expectedPasses;
    const more =
      this.pass < 0 &&
      !passes.some((pass) => pass.repeated.length) &&
      close.surplus > 0 &&
      close.surplus % pairCount === 0
        ? close.surplus / pairCount
        : 0;
    for (const entry of pairs.values()) {
      entry.made += more;
      if (entry.made < expected)
        entry.wrong.unshift(
          entry.made > 0 ? `tested ${formatTimes(entry.made)}, expected ${formatTimes(expected)}` : "not tested",
        );
      if (entry.made > expected + more) entry.wrong.unshift("tested too often");
    }
    // The impulse lists of hybrid steps are empty.
    if (this.data.collision !== "hybrid" && this.pass <= 0) {
      const [right, own] = [close.expected, close.actual].map(
        (list) => new Map(list.map((contact) => [contact[0], contact])),
      );
      for (const [pair, contact] of right) {
        if (!own.has(pair)) entryOf(pair).wrong.push("its contact is missing");
        else if (
          contact.slice(1).some((value, k) => !(Math.abs(value - own.get(pair)[k + 1]) <= 1e-9 * (1 + Math.abs(value))))
        )
          entryOf(pair).wrong.push("its contact differs");
      }
      for (const pair of own.keys()) if (!right.has(pair)) entryOf(pair).wrong.push("its contact is superfluous");
    }
    this.testedPairs = {
      key: `${this.step} ${this.pass}`,
      expected,
      more,
      known,
      pairs,
      name: this.pass >= 0 ? passes[0].name : "the whole step",
      calls: passes[0].calls,
    };
    return this.testedPairs;
  }
  // Selects the bodies of a wrong pair, or of the first wrong state, unless the reader has selected others.
  selectWrongPair() {
    if (this.selected && !this.selected.auto) return;
    const tested = this.collectTestedPairs();
    const wrong = tested && [...tested.pairs].find(([, entry]) => entry.wrong.length);
    const { focus, particle } = this.data;
    const state = this.step === focus && particle !== null ? { kind: "particle", index: particle, auto: true } : null;
    this.selected = wrong ? { pair: wrong[0], auto: true } : state;
  }
  showMatrix() {
    const tested = this.collectTestedPairs();
    // Keep the focus in the table.
    if (tested && tested.key === this.matrixShown) return;
    this.matrixShown = tested ? tested.key : "";
    if (!tested) return this.matrix.replaceChildren();
    const { n, edges, planes } = this.data;
    const { expected, more, known, pairs } = tested;
    const close = this.closeUp();
    // Report missing tests before wrong results.
    const wrong = [...pairs]
      .filter(([, entry]) => entry.wrong.length)
      .sort(([, a], [, b]) => (a.made !== expected ? 0 : 1) - (b.made !== expected ? 0 : 1));
    const head = el(
      "p",
      {},
      `Tested pairs, ${tested.name}: ${tested.calls} pairs, each expected ${formatTimes(expected)}. `,
      `In the whole step ${close.polynomials[0]} polynomials are expected, and you logged ${close.polynomials[1]}. `,
      more ? `You make ${more === 1 ? "a pass" : `${more} passes`} too many. ` : "",
      close.surplus && !more ? `${close.surplus} of yours belong to no expected call. ` : "",
      known ? "" : "Which of yours belong to which pair can't be told for all. ",
    );
    const list = wrong
      .slice(0, 12)
      .map(([pair, entry]) => this.pairButton(pair, `${pairText(pair)}: ${entry.wrong.join(", ")}`));
    const wrongPairs = wrong.length
      ? el(
          "p",
          { class: "lights" },
          `Wrong ${wrong.length === 1 ? "pair" : "pairs"}: `,
          ...list,
          wrong.length > 12 ? ` and ${wrong.length - 12} more` : "",
        )
      : "";
    const columns = [...Array(n).keys()]
      .map((k) => ["pp", k, `${k}`])
      .concat(
        edges.map((_, k) => ["pe", k, `e${k}`]),
        planes.map((_, k) => ["ph", k, `h${k}`]),
      );
    if (n * columns.length > 1200) return this.matrix.replaceChildren(wrongPairs, head);
    const grid = el(
      "table",
      { class: "pairs" },
      el("caption", {}, "Actual calls / expected calls; * collides, ! has a fault"),
      el("thead", {}, el("tr", {}, el("td"), ...columns.map(([, , text]) => el("th", { scope: "col" }, text)))),
    );
    const body = el("tbody");
    const usual = { made: expected + more, wrong: [], hit: false };
    for (let row = 0; row < n; row++) {
      const cells = columns.map(([kind, k]) => {
        const isTested = kind === "pp" ? k > row : kind === "pe" ? edges[k][0] !== row && edges[k][1] !== row : true;
        if (!isTested) return el("td", { class: "never" }, "");
        const pair = `${kind}:${row},${k}`,
          entry = pairs.get(pair) || usual;
        const text =
          (entry.made === expected ? `${expected}` : `${entry.made}/${expected}`) +
          (entry.hit ? "*" : "") +
          (entry.wrong.length ? "!" : "");
        return el(
          "td",
          { class: entry.wrong.length ? "differs" : entry.hit ? "hits" : "" },
          this.pairButton(pair, text, entry),
        );
      });
      body.append(el("tr", {}, el("th", { scope: "row" }, `${row}`), ...cells));
    }
    grid.append(body);
    const box = el(
      "details",
      { class: "table" },
      el("summary", {}, "Pairs"),
      head,
      el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Pairs of this step" }, grid),
    );
    box.open = this.matrixOpen ?? wrong.some(([, entry]) => entry.made !== expected);
    box.addEventListener("toggle", () => {
      this.matrixOpen = box.open;
    });
    this.matrix.replaceChildren(wrongPairs, box);
  }
  pairButton(pair, text, entry) {
    const label =
      entry &&
      [
        `${text}: ${pairText(pair)}, ${entry.made} of ${this.testedPairs.expected} calls`,
        ...(entry.hit ? ["collide"] : []),
        ...entry.wrong,
      ].join(", ");
    return el(
      "button",
      {
        type: "button",
        class: "pair",
        "aria-label": label || null,
        title: label || null,
        onclick: () => {
          this.selected = { pair };
          this.update();
        },
      },
      text,
    );
  }
  pick(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = ((event.clientX - box.left) * this.canvas.width) / box.width,
      y = ((event.clientY - box.top) * this.canvas.height) / box.height;
    const positions = this.positions("submission");
    if (!positions) return;
    let best = [Infinity, null];
    const near = (distance, kind, index) => {
      if (distance < best[0]) best = [distance, { kind, index }];
    };
    for (let k = 0; k < this.data.n; k++) {
      const at = this.toPixels(positions[2 * k], positions[2 * k + 1]);
      near(Math.max(0, Math.hypot(at[0] - x, at[1] - y) - this.data.radii[k] * this.scale()), "particle", k);
    }
    this.data.edges.forEach(([i, j, r], index) => {
      const a = this.toPixels(positions[2 * i], positions[2 * i + 1]),
        b = this.toPixels(positions[2 * j], positions[2 * j + 1]);
      const d = [b[0] - a[0], b[1] - a[1]],
        size = d[0] * d[0] + d[1] * d[1] || 1;
      const s = Math.max(0, Math.min(1, ((x - a[0]) * d[0] + (y - a[1]) * d[1]) / size));
      near(Math.max(1, Math.hypot(a[0] + s * d[0] - x, a[1] + s * d[1] - y) - r * this.scale()), "edge", index);
    });
    this.data.planes.forEach(([px, py, nx, ny], index) => {
      const a = this.toPixels(px, py),
        depth = ((x - a[0]) * nx - (y - a[1]) * ny) / (Math.hypot(nx, ny) || 1);
      near(depth > 0 ? depth : 12, "half-plane", index);
    });
    const spot = this.spots.find(([, sx, sy]) => Math.hypot(sx - x, sy - y) < 9);
    this.selected = spot ? { pair: spot[0] } : best[0] < 14 ? best[1] : null;
    this.update();
  }
  showNumbers() {
    const { selected, data } = this;
    if (!selected)
      return this.numbers.replaceChildren(
        el(
          "p",
          { class: "hint" },
          "Click a particle, an edge, a half-plane or a contact for its numbers, or a pair in the table of pairs.",
        ),
      );
    const rows = [];
    const list = selected.pair
      ? this.pairParticles(selected.pair)
      : selected.kind === "particle"
        ? [selected.index]
        : selected.kind === "edge"
          ? data.edges[selected.index].slice(0, 2)
          : [];
    const plane =
      selected.kind === "half-plane"
        ? selected.index
        : selected.pair && selected.pair.startsWith("ph")
          ? parsePair(selected.pair).second
          : null;
    if (plane !== null && data.planes[plane]) {
      ["point x", "point y", "normal x", "normal y"].forEach((name, k) =>
        rows.push([`half-plane ${plane} ${name}`, ...Array(3).fill(data.planes[plane][k])]),
      );
    }
    const close = this.closeUp();
    if (selected.pair && close) {
      const [right, own] = [close.expected, close.actual].map((all) => all.find(([pair]) => pair === selected.pair));
      ["time of impact", "normal x", "normal y"].forEach((name, k) => {
        if (right || own)
          rows.push([`contact's ${name}`, ...[right, own].map((contact) => (contact ? contact[k + 1] : "none")), "-"]);
      });
    }
    const expected = this.expected();
    for (const k of list) {
      for (const [name, at] of [
        ["x", 2 * k],
        ["y", 2 * k + 1],
        ["vx", 2 * data.n + 2 * k],
        ["vy", 2 * data.n + 2 * k + 1],
      ]) {
        const own = this.state("submission", this.step, this.mid),
          ref = this.state("reference", this.step, this.mid);
        rows.push([`particle ${k} ${name}`, ...[expected, own, ref].map((state) => (state ? state[at] : "-"))]);
      }
    }
    const number = (value) => typeof value === "number";
    const compared = ([name, right, own, ref]) => {
      const [base, marked] =
        number(own) && number(right) ? formatPair(right, own) : number(own) && number(ref) ? formatPair(ref, own) : [];
      // All numbers of a row have the same number of decimals, so that their digits line up.
      const digits = typeof base === "string" ? base.replace(/^.*\.|e.*$/g, "").length : 0;
      const plain = (value) =>
        !number(value)
          ? value
          : /^-?\d+\.\d+$/.test(base ?? "") && areFinite(value)
            ? value.toFixed(digits)
            : formatShort(value);
      return marked === undefined
        ? [name, plain(right), plain(own), plain(ref)]
        : number(right)
          ? [name, base, marked, plain(ref)]
          : [name, plain(right), marked, base];
    };
    const exact = (value) => (number(value) ? `${value} (${toHex(value)})` : value);
    const bits = el(
      "details",
      {},
      el("summary", {}, "To the last bit"),
      el(
        "div",
        { class: "scroll", tabindex: 0, role: "region", "aria-label": "Exact numbers" },
        createTable(
          this.columns(),
          this.hideExpected(rows.map(([name, ...values]) => [name, ...values.map(exact)])),
          "Decimal and hexadecimal",
        ),
      ),
    );
    bits.open = this.bitsOpen;
    bits.addEventListener("toggle", () => {
      this.bitsOpen = bits.open;
    });
    const isSameEverywhere = (row) => {
      const values = this.hideExpected([row])[0].slice(1).filter(number);
      return data.full && values.every((value) => Object.is(value, values[0]));
    };
    const differingRows = rows.filter((row) => !isSameEverywhere(row));
    const sameCount = rows.length - differingRows.length;
    const title = selected.pair ? pairText(selected.pair) : `${selected.kind} ${selected.index}`;
    const scene = quoteForShell(data.scene),
      trace = quoteForShell(data.traceName || "TRACE.bin");
    const command = selected.pair
      ? `fosssim-oracle detect --scene ${scene} --trace ${trace} --step ${this.step} --pair ${selected.pair}${this.pass > 0 ? ` --pass ${this.pass + 1}` : ""}`
      : `fosssim-oracle trace show ${scene} ${trace} --step ${this.step}`;
    const particles = selected.pair ? list : this.addMetParticles(list);
    const button = (text, act) => el("button", { type: "button", onclick: (event) => copy(act(), event.target) }, text);
    this.numbers.replaceChildren(
      el("h4", {}, title, " after step ", String(this.step)),
      differingRows.length
        ? el(
            "div",
            { class: "scroll", tabindex: 0, role: "region", "aria-label": "Numbers" },
            createTable(
              this.columns(),
              this.hideExpected(differingRows.map(compared)),
              "Digits that differ are marked",
            ),
          )
        : "",
      data.full && sameCount
        ? el(
            "p",
            { class: "hint" },
            selected.pair && !differingRows.length
              ? "Its bodies move as expected, bit for bit. The command below shows its polynomials."
              : `${sameCount} ${differingRows.length ? "more " : ""}numbers of it are the same bit for bit.`,
          )
        : "",
      bits,
      el(
        "p",
        {},
        data.traceName ? "On the command line: " : "On the command line, with a trace that grade --keep-traces keeps: ",
        el("code", {}, command),
        " ",
        button("Copy", () => command),
      ),
      el(
        "p",
        {},
        selected.pair
          ? "Only these bodies, moving as here: "
          : "The selected body and the bodies that it meets in this step, moving as here: ",
        button("Copy as scene", () => this.asScene(particles, false)),
        data.forces.length ? " or from the same state under the same forces: " : "",
        data.forces.length ? button("Copy with forces", () => this.asScene(particles, true)) : "",
        ". Saved as case.xml: ",
        el("code", {}, "./FOSSSim -s case.xml -d 0 -o case.bin; fosssim-oracle check case.xml case.bin"),
      ),
    );
  }
  // Returns the particles of a pair.
  pairParticles(pair) {
    const { kind, first, second } = parsePair(pair);
    return [first, ...(kind === "pp" ? [second] : kind === "pe" ? this.data.edges[second].slice(0, 2) : [])];
  }
  // Returns particles together with those that they meet in the step; alone they would only fly on.
  addMetParticles(list) {
    const close = this.closeUp(),
      all = new Set(list);
    const groups = close
      ? [
          ...close.passes.flatMap((pass) => pass.hits.map(([pair]) => this.pairParticles(pair))),
          ...close.zones.flatMap((round) => round.zones.map((zone) => zone.particles)),
        ]
      : [];
    for (const group of groups) if (group.some((k) => all.has(k))) group.forEach((k) => all.add(k));
    return [...all];
  }
  // Returns the columns; if hints hide the right values, there is only one.
  columns() {
    return this.data.full ? ["", "expected from your own state", "yours", "reference from the start"] : ["", "yours"];
  }
  hideExpected(rows) {
    return this.data.full ? rows : rows.map(([name, , own]) => [name, own]);
  }
  // Returns the bodies at the start of the step as a scene of one step.
  asScene(particles, withForces) {
    const { data } = this;
    const state = this.state("submission", Math.max(data.first, this.step - 1)).slice();
    const close = this.closeUp(),
      pass = close && close.passes[0];
    if (!withForces && pass && pass.q.length === 2 * data.n) {
      // Without forces, the velocities are set so that the bodies move as in the step's first detection.
      for (let k = 0; k < 2 * data.n; k++) state[2 * data.n + k] = (pass.q[k] - state[k]) / data.dt;
    }
    const chosen = [...new Set(particles)].sort((a, b) => a - b);
    const index = new Map(chosen.map((k, place) => [k, place]));
    const lines = [`<scene>`, `  <duration time="${data.dt}"/>`, `  ${data.integrator}`, `  ${data.collisionTag}`];
    for (const k of chosen) {
      lines.push(
        `  <particle m="${data.masses[k]}" px="${state[2 * k]}" py="${state[2 * k + 1]}" vx="${state[2 * data.n + 2 * k]}" vy="${state[2 * data.n + 2 * k + 1]}" fixed="${data.fixed[k] ? 1 : 0}" radius="${data.radii[k]}"/>`,
      );
    }
    const edges = data.edges.map(([i, j], k) => (index.has(i) && index.has(j) ? k : -1)).filter((k) => k >= 0);
    for (const k of edges)
      lines.push(
        `  <edge i="${index.get(data.edges[k][0])}" j="${index.get(data.edges[k][1])}" radius="${data.edges[k][2]}"/>`,
      );
    for (const [px, py, nx, ny] of data.planes)
      lines.push(`  <halfplane px="${px}" py="${py}" nx="${nx}" ny="${ny}"/>`);
    for (const force of withForces ? data.forces : []) {
      // Forces between bodies that are not selected are left out.
      let isComplete = true;
      const line = force.replace(/ (edge|i|j)="(\d+)"/g, (_, name, old) => {
        const now = name === "edge" ? edges.indexOf(Number(old)) : index.has(Number(old)) ? index.get(Number(old)) : -1;
        if (now < 0) isComplete = false;
        return ` ${name}="${now}"`;
      });
      if (isComplete) lines.push(`  ${line}`);
    }
    return [...lines, `</scene>`, ``].join("\n");
  }
  showTable() {
    if (!this.table.open) return;
    const own = this.state("submission", this.step, this.mid),
      ref = this.state("reference", this.step, this.mid),
      expected = this.expected();
    const cell = (state, k) => (state ? `(${formatShort(state[2 * k])}, ${formatShort(state[2 * k + 1])})` : "-");
    const rows = [...Array(this.data.n).keys()].map((k) => [
      `particle ${k}`,
      cell(expected, k),
      cell(own, k),
      cell(ref, k),
    ]);
    this.tableBody.replaceChildren(
      createTable(this.columns(), this.hideExpected(rows), `Positions after step ${this.step}`),
    );
  }
}
