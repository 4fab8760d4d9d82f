// Edits a scene. The messages of the strict reader are shown at their places, and the reference's motion next to the
// text.
const film = { oracle: new Oracle(), now: null, step: 0, isPlaying: false, revision: 0 };
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

// The scenes to begin with, by the names that the reader types or chooses.
const starts = new Map();
function addStart(name, openScene) {
  starts.set(name, openScene);
  $("starts").append(el("option", { value: name }));
}

function editScene(xml, name) {
  film.name = name;
  $("source").value = xml;
  simulateChange();
}
// The smallest scenes of a dropped report are added to the list.
async function openSceneFile(file) {
  if (!file) return;
  const content = await file.text();
  if (!isReport(file)) return editScene(content, file.name);
  const report = new DOMParser().parseFromString(content, "text/html");
  const scenes = [...report.querySelectorAll('pre[aria-label="The scene"]')].map((pre) => pre.textContent);
  if (!scenes.length) return ($("try-said").textContent = `${file.name} has no smallest scene.`);
  scenes.forEach((xml, number) => addStart(`smallest scene ${number + 1}`, () => editScene(xml, "small.xml")));
  $("start").value = "smallest scene 1";
  editScene(scenes[0], "small.xml");
}

// The marks are behind the text. They are in a transparent copy of the text, with the same letters at the same places.
function markProblems(problems) {
  const source = toBytes($("source").value),
    nodes = [];
  let offset = 0;
  for (const { error, from, to } of [...problems].sort((a, b) => a.from - b.from)) {
    if (from < offset) continue;
    const end = Math.max(to, Math.min(from + 1, source.length));
    nodes.push(
      decodeText(source.slice(offset, from)),
      el("mark", { class: error ? "bad" : "warn" }, decodeText(source.slice(from, end))),
    );
    offset = end;
  }
  $("marks").replaceChildren(...nodes, decodeText(source.slice(offset)) + "\n");
}

async function simulateChange() {
  const revision = ++film.revision;
  await new Promise((wait) => setTimeout(wait, 250));
  if (revision !== film.revision) return;
  // A simulation that is still running is stopped, because its result is outdated.
  if (film.oracle.isBusy) film.oracle.stop();
  $("try-said").textContent = "Reading the scene ...";
  const source = toBytes($("source").value);
  const request = { do: "simulate", scene: film.name ?? "scene.xml" };
  const progress = (done, all) => {
    $("try-said").textContent = `Simulating: step ${done} of ${all}`;
  };
  try {
    const answer = await film.oracle.ask(request, { blobs: [source], progress });
    if (!answer || revision !== film.revision) return;
    showResult(answer.value);
  } catch (error) {
    $("try-said").textContent = error.message;
  }
  document.documentElement.dataset.tried = $("source").value.length;
}

function showResult(value) {
  const { problems, more, steps, of, particles, edges, halfPlanes, stopped } = value;
  markProblems(problems);
  const errorCount = problems.filter((problem) => problem.error).length;
  // Faults of the markup come first, because other errors may follow from them.
  problems.sort((one, other) => other.isMarkup - one.isMarkup);
  $("problems").replaceChildren(
    ...problems.map(({ error, line, column, message, help, from, to }) =>
      el(
        "li",
        {},
        el(
          "button",
          { class: error ? "bad" : "", type: "button", onclick: () => selectText(from, to) },
          `${line}:${column}`,
        ),
        ` ${error ? "" : "warning: "}${message}${help ? ` (${help})` : ""}`,
      ),
    ),
  );
  if (more) $("problems").append(el("li", {}, `and ${more} more`));
  const isValid = steps !== undefined;
  film.now = isValid ? value : null;
  for (const id of ["play", "step", "save-png", "save-svg", "save-gif", "save-trace"]) $(id).disabled = !isValid;
  if (!isValid) {
    $("try-said").textContent =
      formatCount(errorCount, "error") +
      ($("canvas").dataset.step ? ": the picture shows the last scene without errors." : ".");
    return;
  }
  $("try-said").textContent =
    `${formatCount(steps, "step")}, ${formatCount(particles, "particle")}, ${formatCount(edges, "edge")}, ${formatCount(halfPlanes, "half-plane")}.` +
    (stopped ? ` The motion ends after step ${steps} of ${of}: ${stopped}.` : "");
  $("step").max = steps;
  film.step = Math.min(film.step, steps);
  draw();
}

// Selects the text that a message is about.
function selectText(from, to) {
  const source = toBytes($("source").value);
  const [first, last] = [from, to].map((at) => decodeText(source.slice(0, at)).length);
  $("source").focus();
  $("source").setSelectionRange(first, Math.max(last, first + 1));
}

// Requests one picture at a time. If several requests are pending, only the last one is sent.
async function draw() {
  $("step").value = film.step;
  $("at").textContent =
    `step ${film.step} of ${film.now?.steps ?? 0}, time ${((film.now?.dt ?? 0) * film.step).toFixed(3)}`;
  $("step").setAttribute("aria-valuetext", $("at").textContent);
  if (film.isDrawing) {
    film.isOutdated = true;
    return;
  }
  film.isDrawing = true;
  try {
    do {
      film.isOutdated = false;
      const answer = film.now && (await film.oracle.ask({ do: "picture", step: film.step, form: "pixels", ...SIZE }));
      if (!answer) break;
      const pixels = new Uint8ClampedArray(answer.parts[0].buffer);
      $("canvas")
        .getContext("2d")
        .putImageData(new ImageData(pixels, SIZE.width, SIZE.height), 0, 0);
      $("canvas").dataset.step = film.step;
    } while (film.isOutdated);
  } catch (error) {
    $("try-said").textContent = error.message;
  } finally {
    film.isDrawing = false;
  }
}

function play(isPlaying) {
  film.isPlaying = isPlaying;
  $("play").textContent = isPlaying ? "Pause" : "Play";
  if (!isPlaying || !film.now) return;
  if (film.step >= film.now.steps) film.step = 0;
  const begin = performance.now(),
    from = film.step;
  const reducesMotion = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const tick = () => {
    if (!film.isPlaying || !film.now || currentPanel() !== "try") return play(false);
    const seconds = (performance.now() - begin) / 1000;
    film.step = Math.min(
      film.now.steps,
      from + (reducesMotion ? Math.floor(seconds) : Math.floor(seconds / film.now.dt)),
    );
    draw();
    if (film.step >= film.now.steps) return play(false);
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

async function createAndSave(request, name, type) {
  $("try-said").textContent = `Making ${name} ...`;
  try {
    const progress = (done, all) => {
      $("try-said").textContent = `Making ${name}: ${done} of ${all}`;
    };
    const answer = await film.oracle.ask(request, { progress });
    if (!answer) return;
    save(name, answer.parts[0], type);
    $("try-said").textContent = `${name}: ${formatCount(answer.parts[0].length, "byte")}.`;
  } catch (error) {
    $("try-said").textContent = error.message;
  }
}
const fileStem = () => (film.name ?? "scene.xml").replace(/\.xml$/i, "").replace(/^.*\//, "");

$("source").addEventListener("input", simulateChange);
$("source").addEventListener("scroll", () => {
  $("marks").scrollTop = $("source").scrollTop;
  $("marks").scrollLeft = $("source").scrollLeft;
});
$("play").addEventListener("click", () => play(!film.isPlaying));
$("step").addEventListener("input", () => {
  play(false);
  film.step = Number($("step").value);
  draw();
});
$("save-png").addEventListener("click", () =>
  createAndSave(
    { do: "picture", step: film.step, form: "png", width: 1280, height: 800 },
    `${fileStem()}-${film.step}.png`,
    "image/png",
  ),
);
$("save-svg").addEventListener("click", () =>
  createAndSave(
    { do: "picture", step: film.step, form: "svg", width: 1280, height: 800 },
    `${fileStem()}-${film.step}.svg`,
    "image/svg+xml",
  ),
);
$("save-gif").addEventListener("click", () =>
  createAndSave({ do: "film", width: 640, height: 400 }, `${fileStem()}.gif`, "image/gif"),
);
$("save-trace").addEventListener("click", () =>
  createAndSave({ do: "trace" }, `${fileStem()}.bin`, "application/octet-stream"),
);
$("save-xml").addEventListener("click", () => save(`${fileStem()}.xml`, $("source").value, "application/xml"));
$("open-xml").addEventListener("change", ({ target }) => {
  openSceneFile(target.files[0]);
  target.value = "";
});
const start = () => starts.get($("start").value)?.();
$("start").addEventListener("change", start);
// Browsers report a choice in the list as the insertion of a whole text.
$("start").addEventListener("input", ({ inputType }) => {
  if (!inputType || inputType === "insertReplacementText") start();
});
// The list shows all scenes until something is typed.
$("start").addEventListener("focus", ({ target }) => {
  target.placeholder = target.value;
  target.value = "";
});
$("start").addEventListener("blur", ({ target }) => {
  if (!starts.has(target.value)) target.value = target.placeholder;
});
addStart("a small scene", () => editScene(STARTER, "scene.xml"));
for (const { name, xml } of course?.scenes ?? []) addStart(name.replace(/\.xml$/, ""), () => editScene(xml, name));
embeddedScenes.then((assignments) => {
  for (const { groups } of assignments)
    for (const { group, names } of groups)
      for (const scene of names)
        addStart(`${group}/${scene}`, async () => {
          const { parts } = await film.oracle.ask({ do: "scene", name: `${group}/${scene}` });
          editScene(decodeText(parts[0]), `${group}/${scene}.xml`);
        });
});
panelActions.set("try", () => {
  if (!$("source").value) editScene(STARTER, "scene.xml");
});
