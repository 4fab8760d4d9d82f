// Grades the traces of a submission, which is a folder with Group/name.bin. The result has the points by a suite, a row
// for each scene, and the changes since the last drop.
const courseSuite = course && {
  name: "",
  isForStudents: course.isForStudents,
  text: toBytes(course.suite),
  scenes: course.scenes.map(({ name }) => name),
  xml: course.scenes.map(({ xml }) => toBytes(xml)),
};
const grading = { oracle: new Oracle(), files: new Map(), suite: courseSuite, last: null, json: null };

// Collects all files below a dropped folder, with their paths.
async function collectFiles(entry, handle, path, found) {
  if (handle?.kind === "directory") {
    for await (const [name, inner] of handle.entries())
      await collectFiles(null, inner, `${path}${name}${inner.kind === "directory" ? "/" : ""}`, found);
  } else if (handle) {
    found.push({ path, file: await handle.getFile() });
  } else if (entry?.isDirectory) {
    const reader = entry.createReader();
    for (;;) {
      const batch = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (!batch.length) break;
      for (const inner of batch)
        await collectFiles(inner, null, `${path}${inner.name}${inner.isDirectory ? "/" : ""}`, found);
    }
  } else if (entry) {
    found.push({ path, file: await new Promise((resolve, reject) => entry.file(resolve, reject)) });
  }
  return found;
}

// If a suite is dropped, its scenes are the XML files next to it or below. All other files belong to the submission.
async function acceptFolder(name, found) {
  const suite = found.find(({ path }) => /(^|\/)[^/]*\.toml$/i.test(path));
  if (suite) {
    const suiteFolder = suite.path.replace(/[^/]*$/, "");
    const scenes = found.filter(({ path }) => path.startsWith(suiteFolder) && /\.xml$/i.test(path));
    grading.suite = {
      name: suite.file.name,
      text: toBytes(await suite.file.text()),
      scenes: scenes.map(({ path }) => path.slice(suiteFolder.length)),
      xml: await Promise.all(scenes.map(async ({ file }) => new Uint8Array(await file.arrayBuffer()))),
    };
    $("suite-name").textContent = `${suite.file.name} with ${formatCount(scenes.length, "scene")} of its own`;
  }
  const traces = found.filter(({ path }) => /\.bin(\.(zst|gz))?$/i.test(path));
  if (traces.length) {
    grading.name = name;
    // If a trace is there both compressed and decompressed, the decompressed file is newer.
    grading.files = new Map(
      traces
        .sort((a, b) => b.path.length - a.path.length)
        .map(({ path, file }) => [path.replace(/\.(zst|gz)$/i, ""), file]),
    );
  }
  if (grading.files.size) return gradeAll();
  $("marks-said").textContent = suite
    ? "Now drop the folder of traces."
    : "There is no trace in that folder. Traces are called Group/name.bin.";
}

// Returns the trace of a scene. Its file has the full name, or the name without the group. If the first group is in a
// subfolder, that folder is searched.
function findTrace(scene, topFolder) {
  const paths = [`${topFolder}${scene}.bin`, `${topFolder}${scene.split("/").pop()}.bin`];
  return paths.find((path) => grading.files.has(path)) ?? null;
}
function findTopFolder(names) {
  const paths = [...grading.files.keys()];
  if (names.some(({ scene }) => grading.files.has(`${scene}.bin`))) return "";
  for (const { scene } of names) {
    const path = paths.find((path) => path.endsWith(`/${scene}.bin`));
    if (path) return path.slice(0, -`${scene}.bin`.length);
  }
  return "";
}

async function gradeAll() {
  grading.oracle.stop();
  $("marks-stop").hidden = $("marks-bar").hidden = false;
  const started = performance.now(),
    rows = [],
    usedPaths = new Set();
  try {
    const suiteAnswer = await requestSuite();
    if (!suiteAnswer) return;
    const names = suiteAnswer.value.groups.flatMap(({ name, scenes }) =>
      scenes.map((scene) => ({ group: name, scene })),
    );
    const topFolder = findTopFolder(names);
    const foundCount = names.filter(({ scene }) => findTrace(scene, topFolder)).length;
    $("folder-name").textContent = `${grading.name}, ${foundCount} of ${formatCount(names.length, "trace")}`;
    $("marks-bar").max = names.length;
    for (const [number, { group, scene }] of names.entries()) {
      $("marks-bar").value = number;
      $("marks-said").textContent = `${number + 1} of ${names.length}: ${scene}`;
      const path = findTrace(scene, topFolder),
        file = path && grading.files.get(path);
      usedPaths.add(path);
      const answer = await grading.oracle.ask(
        { do: "judge", number, has_trace: file !== null },
        { files: file ? [await readCurrentFile({ file })] : [] },
      );
      if (!answer) {
        $("marks-said").textContent = "Stopped.";
        return;
      }
      rows.push({ group, scene, file, ...answer.value });
    }
    const answer = await grading.oracle.ask({ do: "grade", name: grading.name });
    if (!answer) return;
    answer.value.scenes.forEach((scene, number) => Object.assign(rows[number], scene));
    grading.json = answer.parts[0];
    showGrade(
      suiteAnswer.value,
      answer.value,
      rows,
      [...grading.files.keys()].filter((path) => !usedPaths.has(path)),
    );
    $("marks-said").textContent =
      `${grading.name}: ${answer.value.points} of ${answer.value.of} points by ${suiteAnswer.value.suite}, in ${((performance.now() - started) / 1000).toFixed(1)} s.`;
  } catch (error) {
    $("marks-said").textContent = error.message;
  } finally {
    $("marks-stop").hidden = $("marks-bar").hidden = true;
    document.documentElement.dataset.marked = String(Number(document.documentElement.dataset.marked ?? 0) + 1);
  }
}

function showGrade(suite, grade, rows, unusedTraces) {
  const right = new Set(rows.filter((row) => row.accepted).map((row) => row.scene));
  const lastGrade = grading.last?.suite === suite.suite ? grading.last : null;
  const changes = lastGrade
    ? [
        ["good", "became right", [...right].filter((scene) => !lastGrade.right.has(scene))],
        ["bad", "stopped being right", [...lastGrade.right].filter((scene) => !right.has(scene))],
      ]
    : [];
  grading.last = { suite: suite.suite, right };
  const changeLines = changes
    .filter(([, , scenes]) => scenes.length)
    .map(([look, words, scenes]) => {
      const line = `${formatCount(scenes.length, "scene")} ${words} since the last drop`;
      return scenes.length > 3
        ? el("details", {}, el("summary", { class: look }, line), el("p", {}, scenes.join(", ")))
        : el("p", { class: look }, `${line}: ${scenes.join(", ")}`);
    });
  if (lastGrade && !changeLines.length)
    changeLines.push(el("p", { class: "hint" }, "Since the last drop nothing changed."));
  const names =
    unusedTraces.slice(0, 12).join(", ") + (unusedTraces.length > 12 ? ` and ${unusedTraces.length - 12} more` : "");
  const unusedLines = unusedTraces.length
    ? [
        el(
          "p",
          { class: "bad" },
          `${formatCount(unusedTraces.length, "trace")} ${unusedTraces.length === 1 ? "belongs" : "belong"} to no scene of ${suite.suite}: ${names}`,
        ),
      ]
    : [];
  const sceneLink = ({ scene, file }, words) =>
    file ? el("button", { type: "button", class: "plain", onclick: () => openReport(scene, file) }, words) : words;
  // The scene that shows a cause best is the first.
  const causes = grade.causes
    .map(({ words, worth, scenes }) => [words, scenes.map((scene) => rows.find((row) => row.scene === scene)), worth])
    .filter(([, own]) => !own[0].isMissing);
  const causeCards = causes.map(([words, own, worth]) =>
    el(
      "details",
      { class: "card mistake", open: causes.length === 1 },
      el(
        "summary",
        {},
        el("b", {}, words),
        el(
          "span",
          { class: "hint" },
          ` (${formatCount(own.length, "scene")})${worth ? ` Fixing it is ${worth}.` : ""}`,
        ),
      ),
      el("p", {}, own.length > 1 ? "Clearest scene: " : "", sceneLink(own[0], own[0].scene)),
      own.length > 1
        ? el(
            "details",
            {},
            el("summary", {}, `and ${own.length - 1} more`),
            el("ul", {}, ...own.slice(1).map((row) => el("li", {}, sceneLink(row, row.scene)))),
          )
        : "",
    ),
  );
  const explained = new Set(causes.flatMap(([, own]) => own));
  const groups = suite.groups.map(({ name, scenes }, number) => {
    const own = rows.filter((row) => row.group === name),
      rightCount = own.filter((row) => row.accepted).length;
    const renderRow = ({ scene, verdict, accepted, right, steps, why, points, of, file, isMissing }) =>
      el(
        "tr",
        {},
        el("th", { scope: "row" }, sceneLink({ scene, file }, scene.split("/").pop())),
        el("td", { class: accepted ? "good" : isMissing ? "" : "bad" }, isMissing ? "no trace" : verdict),
        el("td", { class: "num", "data-label": "steps right" }, isMissing ? "" : `${right} of ${steps}`),
        el("td", { class: "num", "data-label": "points" }, `${points} of ${of}`),
        el("td", { class: "words" }, accepted || isMissing ? "" : why),
      );
    // Wrong scenes that are in no card come first. The others are shown on request.
    const wrong = own.filter((row) => !row.accepted && !row.isMissing && !explained.has(row)),
      missing = own.filter((row) => row.isMissing);
    const renderFolded = (list, words) =>
      list.length
        ? el(
            "details",
            { class: "table", open: list.length === own.length },
            el("summary", {}, `${list.length} ${words}`),
            renderTable(list),
          )
        : "";
    const renderTable = (list) =>
      el(
        "div",
        { class: "scroll", tabindex: "0", role: "region", "aria-label": `Scenes of ${name}` },
        el(
          "table",
          { class: "stack" },
          el(
            "thead",
            {},
            el(
              "tr",
              {},
              ...["scene", "verdict", "steps right", "points", "what is wrong"].map((head) =>
                el("th", { scope: "col", class: /steps|points/.test(head) ? "num" : "" }, head),
              ),
            ),
          ),
          el("tbody", {}, ...list.map(renderRow)),
        ),
      );
    return el(
      "details",
      { class: "card", open: wrong.length > 0 },
      el(
        "summary",
        {},
        el(
          "h2",
          {},
          missing.length === own.length
            ? `${name}: no traces (${formatCount(scenes.length, "scene")}, ${grade.groups[number].of} points)`
            : `${name}: ${rightCount} of ${scenes.length} right, ${grade.groups[number].points} of ${grade.groups[number].of} points`,
        ),
      ),
      wrong.length ? renderTable(wrong) : "",
      renderFolded(
        own.filter((row) => explained.has(row)),
        "with a mistake above",
      ),
      renderFolded(missing, "without a trace"),
      renderFolded(
        own.filter((row) => row.accepted),
        "right",
      ),
    );
  });
  $("marks-list").replaceChildren(
    el("h2", {}, `${right.size} of ${formatCount(rows.length, "scene")} right`),
    ...(grade.unfit ? [el("p", { class: "bad" }, grade.unfit)] : []),
    ...unusedLines,
    ...changeLines,
    ...(causeCards.length
      ? [el("h2", {}, causeCards.length === 1 ? "Likely mistake" : "Likely mistakes"), ...causeCards]
      : []),
    ...groups,
  );
  $("save-marks").hidden = $("marks-again").hidden = false;
  const hadFocus = $("ask-all").contains(document.activeElement);
  $("ask-all").open = false;
  $("ask-all").classList.add("done");
  if (hadFocus) $("marks-again").focus();
}

// Opens the full report on one scene. The choice of the scene applies to this trace only; the scene of the next trace
// is recognized.
function openReport(scene, file) {
  openPanel("check");
  $("scene").value = "";
  const number = grading.suite?.scenes.findIndex((name) => name.replace(/\.xml$/i, "") === scene) ?? -1;
  acceptFiles(
    [{ file }],
    number < 0 ? sceneRequest(scene) : { name: grading.suite.scenes[number], xml: grading.suite.xml[number] },
  );
}

// Requests the suite that the reader chose.
function requestSuite() {
  const { suite } = grading;
  return grading.oracle.ask(
    suite
      ? { do: "suite", scenes: suite.scenes, is_for_students: suite.isForStudents ?? false }
      : { do: "suite", suite: $("suite").value },
    { blobs: suite ? [suite.text, ...suite.xml] : [] },
  );
}

// Returns the XML of a scene, which is a dropped scene, a scene of the course, or an embedded scene.
async function loadSceneXml(scene) {
  const number = grading.suite?.scenes.findIndex((name) => name.replace(/\.xml$/i, "") === scene) ?? -1;
  if (number >= 0) return grading.suite.xml[number];
  const answer = await grading.oracle.ask({ do: "scene", name: scene });
  return answer && answer.parts[0];
}

// Saves a script that contains all scenes and runs a program on each.
async function saveScript() {
  const suiteAnswer = await requestSuite();
  if (!suiteAnswer) return;
  const parts = [
    `#!/bin/sh
# Runs a program on each scene: sh make-traces.sh ./FOSSSim
# Then drop the folder "traces" on the page.
program=\${1:-./FOSSSim}
run() {
  mkdir -p "traces/\$(dirname "$1")"
  cat > "traces/$1.xml"
  "$program" -s "traces/$1.xml" -d 0 -o "traces/$1.bin" || echo "$1: the program ended with code $?" >&2
}
`,
  ];
  for (const scene of suiteAnswer.value.groups.flatMap(({ scenes }) => scenes))
    parts.push(
      `run '${scene.replaceAll("'", `'\\''`)}' <<'END_OF_SCENE'\n${decodeText(await loadSceneXml(scene)).trimEnd()}\nEND_OF_SCENE\n`,
    );
  save("make-traces.sh", toBytes(parts.join("")), "text/x-shellscript");
}
$("save-script").addEventListener("click", () =>
  saveScript().catch(({ message }) => ($("marks-said").textContent = message)),
);
// The example has a wrong trace, and correct traces of scenes in the same group. The mistake concerns edges, and the
// right scenes have no edges.
$("example-all").addEventListener("click", async () => {
  const flawed = await grading.oracle.ask({ do: "example" });
  if (!flawed) return;
  const own = flawed.value.scene;
  const group = (await embeddedScenes).flatMap(({ groups }) => groups).find(({ group }) => own.startsWith(`${group}/`));
  const found = [{ path: `${own}.bin`, file: new File([flawed.parts[0]], "flawed.bin") }];
  for (const name of group.names) {
    const scene = `${group.group}/${name}`;
    const xml = await loadSceneXml(scene);
    if (/<edge/.test(decodeText(xml))) continue;
    await grading.oracle.ask({ do: "simulate", scene: `${scene}.xml` }, { blobs: [xml] });
    const trace = await grading.oracle.ask({ do: "trace" });
    if (!trace) return;
    found.push({ path: `${scene}.bin`, file: new File([trace.parts[0]], `${name}.bin`) });
  }
  acceptFolder("examples", found);
});

$("pick-folder").addEventListener("change", ({ target }) => {
  const files = [...target.files].map((file) => ({ path: file.webkitRelativePath.replace(/^[^/]*\//, ""), file }));
  const name = target.files[0]?.webkitRelativePath.split("/")[0] ?? "traces";
  target.value = "";
  if (files.length) acceptFolder(name, files);
});
$("pick-suite").addEventListener("change", ({ target }) => {
  const files = [...target.files].map((file) => ({ path: file.name, file }));
  target.value = "";
  acceptFolder(grading.name ?? "traces", files);
});
$("suite").addEventListener("change", () => {
  grading.suite = $("suite").value ? null : courseSuite;
  $("suite-name").textContent = "";
  if (grading.files.size) gradeAll();
});
$("marks-stop").addEventListener("click", () => grading.oracle.stop());
$("marks-again").addEventListener("click", gradeAll);
$("save-marks").addEventListener("click", () => save(`${grading.name}.json`, grading.json, "application/json"));
