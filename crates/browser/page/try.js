// Edits a scene. The messages of the strict reader are shown at their places, and the reference's motion next to the
// text.
const film = { oracle: new Oracle(), now: null, step: 0, plays: false, round: 0 };
const SIZE = { width: 800, height: 500 };
const STARTER = `<scene>
  <description text="A ball falls on an edge"/>
  <duration time="3"/>
  <integrator type="symplectic-euler" dt="0.01"/>
  <collision type="continuous-time" COR="0.8"/>
  <maxsimfreq max="500"/>

  <particle m="1" px="0" py="3" vx="0.5" vy="0" fixed="0" radius="0.3"/>
  <particle m="1" px="-2" py="0" vx="0" vy="0" fixed="1" radius="0.1"/>
  <particle m="1" px="3" py="0.5" vx="0" vy="0" fixed="1" radius="0.1"/>
  <edge i="1" j="2" radius="0.1"/>

  <simplegravity fx="0" fy="-9.81"/>
</scene>
`;

function tryScene(words, name) {
  film.name = name;
  $("source").value = words;
  changed();
}
// The smallest scenes of a dropped report become options of the list.
async function tryFile(file) {
  if (!file) return;
  const words = await file.text();
  if (!isReport(file)) return tryScene(words, file.name);
  const report = new DOMParser().parseFromString(words, "text/html");
  const scenes = [...report.querySelectorAll('pre[aria-label="The scene"]')].map((pre) => pre.textContent);
  const options = scenes.map((xml, number) => el("option", { value: xml }, `smallest scene ${number + 1}`));
  if (!scenes.length) return ($("try-said").textContent = `${file.name} has no smallest scene.`);
  $("start").append(el("optgroup", { label: file.name }, ...options));
  $("start").value = scenes[0];
  tryScene(scenes[0], "small.xml");
}

// The marks are behind the text. They are in a transparent copy of the text, with the same letters at the same places.
function mark(problems) {
  const source = bytesOf($("source").value),
    nodes = [];
  let at = 0;
  for (const { error, from, to } of [...problems].sort((a, b) => a.from - b.from)) {
    if (from < at) continue;
    const end = Math.max(to, Math.min(from + 1, source.length));
    nodes.push(
      text(source.slice(at, from)),
      el("mark", { class: error ? "bad" : "warn" }, text(source.slice(from, end))),
    );
    at = end;
  }
  $("marks").replaceChildren(...nodes, text(source.slice(at)) + "\n");
}

async function changed() {
  const round = ++film.round;
  await new Promise((wait) => setTimeout(wait, 250));
  if (round !== film.round) return;
  // A simulation that is still running is stopped, because its result is outdated.
  if (film.oracle.isBusy) film.oracle.stop();
  $("try-said").textContent = "Reading the scene ...";
  const source = bytesOf($("source").value);
  const request = { do: "simulate", scene: film.name ?? "scene.xml" };
  const progress = (done, all) => {
    $("try-said").textContent = `Simulating: step ${done} of ${all}`;
  };
  try {
    const answer = await film.oracle.ask(request, { blobs: [source], progress });
    if (!answer || round !== film.round) return;
    told(answer.value);
  } catch (error) {
    $("try-said").textContent = error.message;
  }
  document.documentElement.dataset.tried = $("source").value.length;
}

function told(value) {
  const { problems, more, steps, of, particles, edges, halfPlanes, stopped } = value;
  mark(problems);
  const errors = problems.filter((problem) => problem.error).length;
  $("problems").replaceChildren(
    ...problems.map(({ error, line, column, message, help, from, to }) =>
      el(
        "li",
        {},
        el("button", { class: error ? "bad" : "", type: "button", onclick: () => show(from, to) }, `${line}:${column}`),
        ` ${error ? "" : "warning: "}${message}${help ? ` (${help})` : ""}`,
      ),
    ),
  );
  if (more) $("problems").append(el("li", {}, `and ${more} more`));
  const good = steps !== undefined;
  film.now = good ? value : null;
  for (const id of ["play", "step", "save-png", "save-svg", "save-gif", "save-trace"]) $(id).disabled = !good;
  if (!good) {
    $("try-said").textContent = `${counted(errors, "error")}: the picture shows the last scene without errors.`;
    return;
  }
  $("try-said").textContent =
    `${counted(steps, "step")}, ${counted(particles, "particle")}, ${counted(edges, "edge")}, ${counted(halfPlanes, "half-plane")}.` +
    (stopped ? ` The motion ends after step ${steps} of ${of}: ${stopped}.` : "");
  $("step").max = steps;
  film.step = Math.min(film.step, steps);
  draw();
}

// Selects the text that a message is about.
function show(from, to) {
  const source = bytesOf($("source").value);
  const [first, last] = [from, to].map((at) => text(source.slice(0, at)).length);
  $("source").focus();
  $("source").setSelectionRange(first, Math.max(last, first + 1));
}

// Requests one picture at a time. If several requests are pending, only the last one is sent.
async function draw() {
  $("step").value = film.step;
  $("at").textContent =
    `step ${film.step} of ${film.now?.steps ?? 0}, time ${((film.now?.dt ?? 0) * film.step).toFixed(3)}`;
  $("step").setAttribute("aria-valuetext", $("at").textContent);
  if (film.drawing) {
    film.again = true;
    return;
  }
  film.drawing = true;
  try {
    do {
      film.again = false;
      const answer = film.now && (await film.oracle.ask({ do: "picture", step: film.step, form: "pixels", ...SIZE }));
      if (!answer) break;
      const pixels = new Uint8ClampedArray(answer.parts[0].buffer);
      $("canvas")
        .getContext("2d")
        .putImageData(new ImageData(pixels, SIZE.width, SIZE.height), 0, 0);
      $("canvas").dataset.step = film.step;
    } while (film.again);
  } catch (error) {
    $("try-said").textContent = error.message;
  } finally {
    film.drawing = false;
  }
}

function play(on) {
  film.plays = on;
  $("play").textContent = on ? "Pause" : "Play";
  if (!on || !film.now) return;
  if (film.step >= film.now.steps) film.step = 0;
  const begin = performance.now(),
    from = film.step;
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const tick = () => {
    if (!film.plays || !film.now || current() !== "try") return play(false);
    const seconds = (performance.now() - begin) / 1000;
    film.step = Math.min(film.now.steps, from + (calm ? Math.floor(seconds) : Math.floor(seconds / film.now.dt)));
    draw();
    if (film.step >= film.now.steps) return play(false);
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

async function saved(request, name, type) {
  $("try-said").textContent = `Making ${name} ...`;
  try {
    const progress = (done, all) => {
      $("try-said").textContent = `Making ${name}: ${done} of ${all}`;
    };
    const answer = await film.oracle.ask(request, { progress });
    if (!answer) return;
    save(name, answer.parts[0], type);
    $("try-said").textContent = `${name}: ${counted(answer.parts[0].length, "byte")}.`;
  } catch (error) {
    $("try-said").textContent = error.message;
  }
}
const stem = () => (film.name ?? "scene.xml").replace(/\.xml$/i, "").replace(/^.*\//, "");

$("source").addEventListener("input", changed);
$("source").addEventListener("scroll", () => {
  $("marks").scrollTop = $("source").scrollTop;
  $("marks").scrollLeft = $("source").scrollLeft;
});
$("play").addEventListener("click", () => play(!film.plays));
$("step").addEventListener("input", () => {
  play(false);
  film.step = Number($("step").value);
  draw();
});
$("save-png").addEventListener("click", () =>
  saved(
    { do: "picture", step: film.step, form: "png", width: 1280, height: 800 },
    `${stem()}-${film.step}.png`,
    "image/png",
  ),
);
$("save-svg").addEventListener("click", () =>
  saved(
    { do: "picture", step: film.step, form: "svg", width: 1280, height: 800 },
    `${stem()}-${film.step}.svg`,
    "image/svg+xml",
  ),
);
$("save-gif").addEventListener("click", () =>
  saved({ do: "film", width: 640, height: 400 }, `${stem()}.gif`, "image/gif"),
);
$("save-trace").addEventListener("click", () => saved({ do: "trace" }, `${stem()}.bin`, "application/octet-stream"));
$("save-xml").addEventListener("click", () => save(`${stem()}.xml`, $("source").value, "application/xml"));
$("open-xml").addEventListener("change", ({ target }) => {
  tryFile(target.files[0]);
  target.value = "";
});
$("start").addEventListener("change", async ({ target }) => {
  if (!target.value) return tryScene(STARTER, "scene.xml");
  if (target.value.startsWith("<")) return tryScene(target.value, "small.xml");
  const own = ownScene(target.value);
  if (own) return tryScene(own.xml, own.name);
  const { parts } = await film.oracle.ask({ do: "scene", name: target.value });
  tryScene(text(parts[0]), `${target.value}.xml`);
});
choices($("start"));
shown.set("try", () => {
  if (!$("source").value) tryScene(STARTER, "scene.xml");
});
