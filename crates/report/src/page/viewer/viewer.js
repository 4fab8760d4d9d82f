// The viewer of one case, which is created when its card is opened, and the page around it.
class Viewer extends Words {
  constructor(article, data, tracks) {
    super();
    Object.assign(this, { article, data, tracks });
    this.key = article.dataset.case;
    this.name = article.dataset.scene;
    // Start at the first wrong step, or at the last judged one if the trace ends early.
    const wrong = data.strip.indexOf("w"),
      end = Math.max(0, data.strip.indexOf("u"));
    this.step = Math.max(data.first, Math.min(data.last, wrong >= 0 ? wrong + 1 : data.focus || end || data.first));
    this.t = 1;
    this.pass = -1;
    this.zoom = 1;
    this.pan = [0, 0];
    this.magnify = null;
    this.playing = 0;
    this.speed = 1;
    this.selected = null;
    this.show = { reference: data.full, expected: data.full, what: !!data.whatIf, arrows: data.full };
    this.beside = false;
    this.build();
    this.fit();
    this.update();
    this.zoomToDifference();
    this.update();
  }

  build() {
    const { data } = this;
    const button = (text, label, act, key) =>
      el(
        "button",
        {
          type: "button",
          onclick: act,
          title: key ? `${label} (${key})` : label,
          "aria-label": /[a-z]/i.test(text) ? `${text}: ${label}` : label,
        },
        text,
      );
    const check = (name, text, mark) => {
      const box = el("input", {
        type: "checkbox",
        onchange: (event) => {
          this.show[name] = event.target.checked;
          this.update();
        },
      });
      box.checked = this.show[name];
      return el("label", { class: "check" }, box, el("span", { class: `key ${mark}` }, ""), text);
    };
    this.canvas = el("canvas", {
      width: 960,
      height: 540,
      class: "picture",
      tabindex: 0,
      role: "img",
      "aria-label": "Both motions, drawn on top of each other",
      "aria-describedby": `say-${this.key}`,
    });
    this.view = [0, this.canvas.width];
    this.play = button("Play", "Play or pause", () => this.togglePlay(), "space");
    this.stepBox = el("input", {
      type: "number",
      min: data.first,
      max: data.last,
      class: "stepbox",
      "aria-label": "Step",
      onchange: (event) => this.goToStep(Number(event.target.value)),
    });
    // Keys and screen readers use the slider; pointers use the strip above it.
    this.slider = el("input", {
      type: "range",
      min: data.first,
      max: data.last,
      "aria-label": "Step",
      oninput: (event) => this.goToStep(Number(event.target.value)),
    });
    this.inside = el("input", {
      type: "range",
      min: 0,
      max: 1,
      step: 0.001,
      "aria-label": "Time within the step",
      class: "wide",
      oninput: (event) => {
        this.t = Number(event.target.value);
        this.update();
      },
    });
    this.insideText = el("output", {}, "");
    this.passes = el("select", {
      "aria-label": "Which motion within the step",
      onchange: (event) => {
        this.pass = Number(event.target.value);
        this.update();
      },
    });
    this.midBox = el("input", {
      type: "checkbox",
      onchange: (event) => {
        this.mid = event.target.checked;
        this.update();
      },
    });
    this.mid = this.isMidWrong();
    this.factor = el("input", {
      type: "range",
      min: 0,
      max: 15,
      step: 0.1,
      "aria-label": "Magnification of differences, power of ten",
      oninput: (event) => {
        this.magnify = 10 ** Number(event.target.value);
        this.update();
      },
    });
    this.factorText = el("output", {}, "");
    this.magnified = el("label", { class: "grow within" }, el("span", {}, "magnified ", this.factorText), this.factor);
    this.ticks = document.createElementNS(SVG, "svg");
    this.ticks.setAttribute("viewBox", "0 0 1000 12");
    this.ticks.setAttribute("preserveAspectRatio", "none");
    this.ticks.setAttribute("aria-hidden", "true");
    this.ticks.classList.add("ticks");
    const stepUnder = (event) => {
      const box = this.strip.getBoundingClientRect();
      return [
        1 + Math.floor(((event.clientX - box.left) / box.width) * data.steps),
        event.clientX - box.left,
        box.width,
      ];
    };
    this.strip = el("canvas", {
      width: 960,
      height: 34,
      class: "strip",
      role: "img",
      "aria-label": this.stripText(),
      onpointerdown: (event) => {
        this.strip.setPointerCapture(event.pointerId);
        this.goToStep(stepUnder(event)[0]);
        this.slider.focus();
        event.preventDefault();
      },
      onpointerleave: () => {
        this.preview.hidden = true;
      },
      onpointermove: (event) => {
        const [step, x, width] = stepUnder(event);
        if (event.buttons) this.goToStep(step);
        this.preview.hidden = event.buttons || step < data.first || step > data.last || event.pointerType === "touch";
        if (this.preview.hidden) return;
        this.preview.style.left = `${Math.max(0, Math.min(width - 192, x - 96))}px`;
        this.drawPreview(step);
      },
    });
    this.preview = el(
      "div",
      { class: "preview", hidden: true, "aria-hidden": "true" },
      el("canvas", { width: 384, height: 216 }),
      el("div"),
    );
    this.besideButton = button(
      "Side by side",
      "Expected and actual motion side by side",
      () => this.toggleSideBySide(),
      "s",
    );
    this.keys = el(
      "details",
      { class: "table help" },
      el("summary", {}, "Keys ", el("kbd", {}, "?")),
      el(
        "div",
        { class: "keys" },
        ...[
          ["n", "next wrong step"],
          ["p", "previous wrong step"],
          ["space", "play, pause"],
          ["\u2190 \u2192", "a step"],
          ["shift \u2190 \u2192", "ten steps"],
          ["home end", "first, last step"],
          ["z", "near the difference"],
          ["0", "everything"],
          ["+ -", "zoom"],
          ["s", "side by side"],
          ["?", "this list"],
        ].map(([key, text]) => el("span", {}, ...key.split(" ").flatMap((name) => [el("kbd", {}, name), " "]), text)),
      ),
    );
    this.say = el("p", { class: "say", id: `say-${this.key}`, "aria-live": "polite" });
    this.facts = el("div", { class: "facts" });
    this.numbers = el("div", { class: "numbers" });
    this.matrix = el("div", { class: "matrix" });
    this.table = el(
      "details",
      { class: "table", ontoggle: () => this.update() },
      el("summary", {}, "The picture as a table"),
    );
    this.tableBody = el("div");
    this.table.append(this.tableBody);
    const hybrid = data.collision === "hybrid";
    const { rounded } = data;
    const kept = rounded && [...new Set(rounded.exact.map((record) => data.first + Math.ceil(record / data.per)))];
    const remark = rounded
      ? el(
          "p",
          { class: "hint" },
          `This motion is too large for this page: positions are rounded to ${formatShort(rounded.unit)}, and velocities are left out. `,
          kept.length ? `The records around these steps are exact: ${kept.join(", ")}.` : "",
        )
      : "";
    this.root = el(
      "div",
      { class: "viewer", onkeydown: (event) => this.handleKey(event) },
      this.canvas,
      el("div", { class: "timeline" }, this.preview, this.strip, this.slider),
      this.say,
      this.stripLegend(),
      el(
        "div",
        { class: "bar" },
        el(
          "span",
          { class: "group" },
          button("\u00ab wrong", "Previous wrong step", () => this.goToWrongStep(-1), "p"),
          button("\u2039", "One step back", () => this.goToStep(this.step - 1), "left"),
          this.play,
          button("\u203a", "One step on", () => this.goToStep(this.step + 1), "right"),
          button("wrong \u00bb", "Next wrong step", () => this.goToWrongStep(1), "n"),
        ),
        el("label", {}, "step ", this.stepBox, ` of ${data.steps}`),
        this.speeds(),
        el(
          "span",
          { class: "group" },
          data.full
            ? button(
                "Near",
                "Near the difference",
                () => {
                  this.zoomToDifference();
                  this.update();
                },
                "z",
              )
            : "",
          button("All", "Show everything", () => this.showEverything(), "0"),
          data.full ? this.besideButton : "",
        ),
        el(
          "details",
          { class: "save" },
          el("summary", {}, "Save"),
          el(
            "span",
            { class: "group" },
            button("PNG", "Save this picture", () => this.picture()),
            button("SVG", "Save this picture as a drawing", () => this.drawing()),
            button("Clip", "Record a video of the steps", () => this.clip()),
            // A page within a frame has no URL of its own.
            location.protocol === "about:"
              ? ""
              : button("Link", "Copy a link to this step and time", () => this.link()),
          ),
        ),
      ),
      el(
        "div",
        { class: "bar" },
        el(
          "label",
          { class: "grow within" },
          el("span", {}, "inside the step, t = ", this.insideText),
          el("span", {}, this.inside, this.ticks),
        ),
        el("label", { class: "moving" }, "moving ", this.passes),
        hybrid ? el("label", { class: "check" }, this.midBox, "after the impulses") : "",
      ),
      data.full
        ? el(
            "div",
            { class: "bar" },
            el("span", { class: "check" }, el("span", { class: "key k-own" }), "yours"),
            check("reference", "reference from the start", "k-ref"),
            check("expected", "expected from your own state", "k-exp"),
            data.whatIf ? check("what", "the reference with the mistake", "k-what") : "",
            check("arrows", "differences", "k-arrow"),
            this.magnified,
          )
        : "",
      remark,
      this.keys,
    );
    // On wide screens, sums are next to the picture and bodies are below it.
    if (data.full)
      this.article
        .querySelector(".side")
        .append(el("section", { class: "card step", "aria-label": "The step in numbers" }, this.facts));
    this.article
      .querySelector(".seen")
      .append(
        el("section", { class: "card step", "aria-label": "Pairs and bodies" }, this.matrix, this.numbers, this.table),
      );
    this.article.querySelector(".stage").replaceChildren(this.root);
    this.canvas.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && !event.shiftKey && document.activeElement !== this.canvas) return;
        event.preventDefault();
        this.zoom = Math.max(0.2, Math.min(1e6, this.zoom * Math.exp(-event.deltaY / 400)));
        this.update();
      },
      { passive: false },
    );
    let held = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      held = [event.clientX, event.clientY, ...this.pan, false];
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!held) return;
      const ratio = this.canvas.width / this.canvas.getBoundingClientRect().width;
      const move = [(event.clientX - held[0]) * ratio, (event.clientY - held[1]) * ratio];
      if (Math.hypot(...move) > 4) held[4] = true;
      if (held[4]) {
        this.pan = [held[2] + move[0], held[3] + move[1]];
        this.update();
      }
    });
    this.canvas.addEventListener("pointerup", (event) => {
      if (held && !held[4]) this.pick(event);
      held = null;
    });
  }
  speeds() {
    const select = el("select", {
      "aria-label": "Speed",
      onchange: (event) => {
        this.speed = Number(event.target.value);
      },
    });
    for (const speed of [0.03125, 0.125, 0.25, 0.5, 1, 2, 4, 8]) {
      const option = el("option", { value: speed }, speed < 1 ? `1/${1 / speed} x` : `${speed} x`);
      option.selected = speed === 1;
      select.append(option);
    }
    return select;
  }
  toggleSideBySide() {
    this.beside = this.data.full && !this.beside;
    this.besideButton.setAttribute("aria-pressed", this.beside);
    this.zoomToDifference();
    this.update();
  }
  count(letter) {
    return [...this.data.strip].filter((step) => step === letter).length;
  }
  stripText() {
    const [right, wrong, after] = ["r", "w", "i"].map((letter) => this.count(letter));
    return `All steps: ${right} right, ${wrong} wrong by themselves, ${after} right but starting from a wrong state, ${this.data.steps - right - wrong - after} not judged`;
  }
  // The legend of the strip's colors.
  stripLegend() {
    const names = [
      ["r", "right"],
      ["w", this.count("w") === 1 ? "wrong by itself" : "wrong by themselves"],
      ["i", "right, but after a wrong one"],
    ];
    const parts = names
      .filter(([letter]) => this.count(letter))
      .map(([letter, name]) =>
        el("span", {}, el("span", { class: `h is-${letter}` }), ` ${this.count(letter)} ${name}`),
      );
    return parts.length > 1 ? el("p", { class: "hint strip-key" }, "Steps: ", ...parts) : "";
  }

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
    if (typeof MediaRecorder === "undefined" || !this.canvas.captureStream) {
      this.say.textContent = "This browser can't record videos.";
      return;
    }
    const recorder = new MediaRecorder(this.canvas.captureStream(30));
    const parts = [];
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => this.file(new Blob(parts, { type: recorder.mimeType }), "motion.webm");
    const begin = Math.max(this.data.first, this.step - 30),
      end = Math.min(this.data.last, this.step + 30);
    let step = begin;
    recorder.start();
    const recordStep = () => {
      this.goToStep(step);
      if (step++ < end) setTimeout(recordStep, 1000 / 15);
      else recorder.stop();
    };
    recordStep();
  }
  link() {
    const hash = new URLSearchParams({ scene: this.name, step: this.step, t: this.t.toFixed(3) });
    if (this.selected && this.selected.pair) hash.set("pair", this.selected.pair);
    history.replaceState(null, "", "#" + hash);
    copy(location.href, null);
    this.say.textContent = "The URL of this page now leads to this step and time.";
  }
}

const viewers = new Map(),
  opening = new Map();
function openViewer(article) {
  const key = article.dataset.case;
  if (!opening.has(key)) opening.set(key, createViewer(article, key));
  return opening.get(key);
}
async function createViewer(article, key) {
  const block = document.getElementById(`case-${key}`);
  if (!block) return null;
  const data = JSON.parse(block.textContent);
  const tracks = {};
  for (const name of ["reference", "submission", "what"]) {
    const buffer = await unpack(`${name}-${key}`);
    tracks[name] = buffer && (data.rounded ? unround(buffer, data.rounded, data.n) : new Float64Array(buffer));
  }
  if (data.whatIf && data.whatIf.equal) tracks.what = tracks.submission;
  const viewer = new Viewer(article, data, tracks);
  viewers.set(key, viewer);
  return viewer;
}
// The plots' cursor, which follows the current step; each plot has the data of its horizontal axis.
document.addEventListener("moment", ({ detail: { key, step } }) => {
  for (const row of document.querySelectorAll(`[data-case="${key}"] [data-step]`))
    row.classList.toggle("now", Number(row.dataset.step) === step);
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
        if (viewer) viewer.goToStep(1 + Math.round(((x - left) / (right - left)) * (steps - 1)));
      });
    }
    const x = left + (steps > 1 ? (Math.max(1, step) - 1) / (steps - 1) : 0) * (right - left);
    line.setAttribute("x1", x);
    line.setAttribute("x2", x);
  }
});
// Opens a card with its viewer.
function unfoldCard(article) {
  const card = article.querySelector("details.scene");
  for (const folded of [card, article.closest("details.alike")]) if (folded) folded.open = true;
  return article.querySelector(".stage") ? openViewer(article) : null;
}
// Shows the subject of a clicked finding or call.
function addShowButton(article, row) {
  const act = async () => {
    const viewer = await unfoldCard(article);
    if (!viewer) return;
    viewer.selected = row.dataset.pair ? { pair: row.dataset.pair } : null;
    viewer.goToStep(Number(row.dataset.step));
    viewer.root.scrollIntoView({ block: "start" });
    viewer.canvas.focus({ preventScroll: true });
  };
  const button = el(
    "button",
    { type: "button", onclick: act, "aria-label": `Show step ${row.dataset.step} in the motion` },
    `Show step ${row.dataset.step}`,
  );
  (row.cells ? row.cells[row.cells.length - 1] : row.firstElementChild).append(" ", button);
}
// Opens the card, or the scene and step, that the fragment of the URL names.
async function followFragment(articles) {
  const fragment = new URLSearchParams(location.hash.slice(1));
  const moment = articles.find((article) => article.dataset.scene === fragment.get("scene"));
  const target = moment || articles.find((article) => article.id && `#${article.id}` === location.hash);
  const first =
    target ||
    articles.find((article) => article.querySelector("details.scene[open]")) ||
    articles.find((article) => article.querySelector(".stage") && !article.querySelector("details.scene"));
  const viewer = first && (await unfoldCard(first));
  if (viewer && moment) {
    if (fragment.has("step")) viewer.goToStep(Number(fragment.get("step")));
    if (fragment.has("t")) viewer.t = Math.max(0, Math.min(1, Number(fragment.get("t")) || 0));
    if (/^p[peh]:\d+,\d+$/.test(fragment.get("pair") || "")) viewer.selected = { pair: fragment.get("pair") };
    viewer.update();
  }
  if (target) target.scrollIntoView();
}
// Searches scenes by their names and their text.
function addSceneFilter(articles) {
  const scenes = articles.filter(
    (article) => article.querySelector("details.scene") && !article.id.startsWith("small-"),
  );
  if (scenes.length < 8) return;
  const count = el("output", { class: "hint" });
  const filterInput = el("input", {
    type: "search",
    oninput: () => {
      const wanted = filterInput.value.trim().toLowerCase();
      for (const scene of scenes) scene.hidden = !scene.textContent.toLowerCase().includes(wanted);
      for (const alike of document.querySelectorAll("details.alike")) {
        alike.open = wanted !== "";
        alike.hidden = !alike.querySelector("article:not([hidden])");
      }
      count.textContent = wanted && `${scenes.filter((scene) => !scene.hidden).length} of ${scenes.length}`;
    },
  });
  scenes[0].before(el("p", { class: "filter" }, el("label", {}, "Filter ", filterInput), " ", count));
}
async function start() {
  const articles = [...document.querySelectorAll("article.case")];
  addSceneFilter(articles);
  for (const article of articles) {
    if (!article.querySelector(".stage")) continue;
    const card = article.querySelector("details.scene");
    if (card)
      card.addEventListener("toggle", () => {
        if (card.open) openViewer(article);
      });
    for (const row of article.querySelectorAll("[data-step]")) addShowButton(article, row);
  }
  await followFragment(articles);
  addEventListener("hashchange", () => followFragment(articles));
  document.documentElement.dataset.ready = "yes";
}
document.addEventListener("keydown", (event) => {
  if (event.target === document.body) {
    const viewer = [...viewers.values()].find(Boolean);
    if (viewer) viewer.handleKey(event);
  }
});
// Letters depend on the width of the picture.
const redraw = () => viewers.forEach((viewer) => viewer && viewer.update());
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
addEventListener("resize", redraw);
start();
