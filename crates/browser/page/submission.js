// Grades the traces of a submission, which is a folder with Group/name.bin. The result has the points by a suite, a row
// for each scene, and the changes since the last drop.
const courseSuite = course && {
  name: "",
  isForStudents: course.isForStudents,
  text: bytesOf(course.suite),
  scenes: course.scenes.map(({ name }) => name),
  xml: course.scenes.map(({ xml }) => bytesOf(xml)),
};
const marks = { oracle: new Oracle(), files: new Map(), suite: courseSuite, last: null, json: null };

// Collects all files below a dropped folder, with their paths.
async function walk(entry, handle, path, found) {
  if (handle?.kind === "directory") {
    for await (const [name, inner] of handle.entries())
      await walk(null, inner, `${path}${name}${inner.kind === "directory" ? "/" : ""}`, found);
  } else if (handle) {
    found.push({ path, file: await handle.getFile() });
  } else if (entry?.isDirectory) {
    const reader = entry.createReader();
    for (;;) {
      const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (!some.length) break;
      for (const inner of some) await walk(inner, null, `${path}${inner.name}${inner.isDirectory ? "/" : ""}`, found);
    }
  } else if (entry) {
    found.push({ path, file: await new Promise((resolve, reject) => entry.file(resolve, reject)) });
  }
  return found;
}

// If a suite is dropped, its scenes are the XML files next to it or below. All other files belong to the submission.
async function takeFolder(name, found) {
  const suite = found.find(({ path }) => /(^|\/)[^/]*\.toml$/i.test(path));
  if (suite) {
    const beside = suite.path.replace(/[^/]*$/, "");
    const scenes = found.filter(({ path }) => path.startsWith(beside) && /\.xml$/i.test(path));
    marks.suite = {
      name: suite.file.name,
      text: bytesOf(await suite.file.text()),
      scenes: scenes.map(({ path }) => path.slice(beside.length)),
      xml: await Promise.all(scenes.map(async ({ file }) => new Uint8Array(await file.arrayBuffer()))),
    };
    $("suite-name").textContent = `${suite.file.name} with ${counted(scenes.length, "scene")} of its own`;
  }
  const traces = found.filter(({ path }) => /\.bin(\.(zst|gz))?$/i.test(path));
  if (traces.length) {
    marks.name = name;
    // If a trace is there both compressed and decompressed, the decompressed file is newer.
    marks.files = new Map(
      traces
        .sort((a, b) => b.path.length - a.path.length)
        .map(({ path, file }) => [path.replace(/\.(zst|gz)$/i, ""), file]),
    );
    $("folder-name").textContent = `${name}, ${counted(traces.length, "trace")}`;
  }
  if (marks.files.size) return mark_all();
  $("marks-said").textContent = suite
    ? "Now drop the folder of traces."
    : "There is no trace in that folder. Traces are called Group/name.bin.";
}

// Returns the trace of a scene. Its file has the full name, or the name without the group. If the first group is in a
// subfolder, that folder is searched.
function traceOf(scene, below) {
  const paths = [`${below}${scene}.bin`, `${below}${scene.split("/").pop()}.bin`];
  return paths.find((path) => marks.files.has(path)) ?? null;
}
function beginning(names) {
  const paths = [...marks.files.keys()];
  if (names.some(({ scene }) => marks.files.has(`${scene}.bin`))) return "";
  for (const { scene } of names) {
    const path = paths.find((path) => path.endsWith(`/${scene}.bin`));
    if (path) return path.slice(0, -`${scene}.bin`.length);
  }
  return "";
}

async function mark_all() {
  marks.oracle.stop();
  $("marks-stop").hidden = $("marks-bar").hidden = false;
  const started = performance.now(),
    rows = [],
    taken = new Set();
  try {
    const begun = await askSuite();
    if (!begun) return;
    const names = begun.value.groups.flatMap(({ name, scenes }) => scenes.map((scene) => ({ group: name, scene })));
    const below = beginning(names);
    $("marks-bar").max = names.length;
    for (const [number, { group, scene }] of names.entries()) {
      $("marks-bar").value = number;
      $("marks-said").textContent = `${number + 1} of ${names.length}: ${scene}`;
      const path = traceOf(scene, below),
        file = path && marks.files.get(path);
      taken.add(path);
      const answer = await marks.oracle.ask(
        { do: "judge", number, has_trace: file !== null },
        { files: file ? [await freshFile({ file })] : [] },
      );
      if (!answer) {
        $("marks-said").textContent = "Stopped.";
        return;
      }
      rows.push({ group, scene, file, ...answer.value });
    }
    const answer = await marks.oracle.ask({ do: "grade", name: marks.name });
    if (!answer) return;
    answer.value.scenes.forEach((scene, number) => Object.assign(rows[number], scene));
    marks.json = answer.parts[0];
    showMarks(
      begun.value,
      answer.value,
      rows,
      [...marks.files.keys()].filter((path) => !taken.has(path)),
    );
    $("marks-said").textContent =
      `${marks.name}: ${answer.value.points} of ${answer.value.of} points by ${begun.value.suite}, in ${((performance.now() - started) / 1000).toFixed(1)} s.`;
  } catch (error) {
    $("marks-said").textContent = error.message;
  } finally {
    $("marks-stop").hidden = $("marks-bar").hidden = true;
    document.documentElement.dataset.marked = String(Number(document.documentElement.dataset.marked ?? 0) + 1);
  }
}

function showMarks(suite, grade, rows, strange) {
  const right = new Set(rows.filter((row) => row.accepted).map((row) => row.scene));
  const known = marks.last?.suite === suite.suite ? marks.last : null;
  const news = known
    ? [
        ["became right", [...right].filter((scene) => !known.right.has(scene))],
        ["no longer right", [...known.right].filter((scene) => !right.has(scene))],
      ]
    : [];
  marks.last = { suite: suite.suite, right };
  const since = news
    .filter(([, scenes]) => scenes.length)
    .map(([words, scenes]) =>
      el(
        "p",
        { class: words === "became right" ? "good" : "bad" },
        `Since the last drop ${words}: ${scenes.join(", ")}`,
      ),
    );
  if (known && !since.length) since.push(el("p", { class: "hint" }, "Since the last drop nothing changed."));
  const names = strange.slice(0, 12).join(", ") + (strange.length > 12 ? ` and ${strange.length - 12} more` : "");
  const other = strange.length
    ? [
        el(
          "p",
          { class: "bad" },
          `${counted(strange.length, "trace")} ${strange.length === 1 ? "belongs" : "belong"} to no scene of ${suite.suite}: ${names}`,
        ),
      ]
    : [];
  const look = ({ scene, file }, words) =>
    file ? el("button", { type: "button", class: "plain", onclick: () => lookAt(scene, file) }, words) : words;
  // The scene that shows a cause best is the first.
  const causes = grade.causes
    .map(({ words, scenes }) => [words, scenes.map((scene) => rows.find((row) => row.scene === scene))])
    .filter(([, own]) => !own[0].isMissing);
  const likely = causes.map(([words, own]) =>
    el(
      "details",
      { class: "card mistake", open: causes.length === 1 },
      el("summary", {}, el("b", {}, words), el("span", { class: "hint" }, ` (${counted(own.length, "scene")})`)),
      el("ul", {}, ...own.map((row) => el("li", {}, look(row, row.scene)))),
    ),
  );
  const groups = suite.groups.map(({ name, scenes }, number) => {
    const own = rows.filter((row) => row.group === name),
      good = own.filter((row) => row.accepted).length;
    const line = ({ scene, verdict, accepted, right, steps, why, points, of, file, isMissing }) =>
      el(
        "tr",
        {},
        el("th", { scope: "row" }, look({ scene, file }, scene.split("/").pop())),
        el("td", { class: accepted ? "good" : isMissing ? "" : "bad" }, isMissing ? "no trace" : verdict),
        el("td", { class: "num", "data-label": "steps right" }, isMissing ? "" : `${right} of ${steps}`),
        el("td", { class: "num", "data-label": "points" }, `${points} of ${of}`),
        el("td", { class: "words" }, accepted || isMissing ? "" : why),
      );
    // Wrong scenes come first. Right scenes are shown on request.
    const wrong = own.filter((row) => !row.accepted && !row.isMissing),
      missing = own.filter((row) => row.isMissing);
    const folded = (list, words) =>
      list.length
        ? el(
            "details",
            { class: "table", open: list.length === own.length },
            el("summary", {}, `${list.length} ${words}`),
            table(list),
          )
        : "";
    const table = (list) =>
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
          el("tbody", {}, ...list.map(line)),
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
            ? `${name}: no traces (${counted(scenes.length, "scene")}, ${grade.groups[number].of} points)`
            : `${name}: ${good} of ${scenes.length} right, ${grade.groups[number].points} of ${grade.groups[number].of} points`,
        ),
      ),
      wrong.length ? table(wrong) : "",
      folded(missing, "without a trace"),
      folded(
        own.filter((row) => row.accepted),
        "right",
      ),
    );
  });
  $("marks-list").replaceChildren(
    el(
      "h2",
      {},
      `${suite.suite}: ${grade.points} of ${grade.of} points, ${right.size} of ${counted(rows.length, "scene")} right`,
    ),
    ...(grade.unfit ? [el("p", { class: "bad" }, grade.unfit)] : []),
    ...other,
    ...since,
    ...(likely.length ? [el("h2", {}, likely.length === 1 ? "Likely mistake" : "Likely mistakes"), ...likely] : []),
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
function lookAt(scene, file) {
  open("check");
  $("scene").value = "";
  const number = marks.suite?.scenes.findIndex((name) => name.replace(/\.xml$/i, "") === scene) ?? -1;
  takeFiles(
    [{ file }],
    number < 0 ? sceneOf(scene) : { name: marks.suite.scenes[number], xml: marks.suite.xml[number] },
  );
}

// Requests the suite that the reader chose.
function askSuite() {
  const { suite } = marks;
  return marks.oracle.ask(
    suite
      ? { do: "suite", scenes: suite.scenes, is_for_students: suite.isForStudents ?? false }
      : { do: "suite", suite: $("suite").value },
    { blobs: suite ? [suite.text, ...suite.xml] : [] },
  );
}

// Returns the XML of a scene, which is a dropped scene, a scene of the course, or an embedded scene.
async function xmlOf(scene) {
  const number = marks.suite?.scenes.findIndex((name) => name.replace(/\.xml$/i, "") === scene) ?? -1;
  if (number >= 0) return marks.suite.xml[number];
  const answer = await marks.oracle.ask({ do: "scene", name: scene });
  return answer && answer.parts[0];
}

// Saves a script that contains all scenes and runs a program on each.
async function saveScript() {
  const begun = await askSuite();
  if (!begun) return;
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
  for (const scene of begun.value.groups.flatMap(({ scenes }) => scenes))
    parts.push(
      `run '${scene.replaceAll("'", `'\\''`)}' <<'END_OF_SCENE'\n${text(await xmlOf(scene)).trimEnd()}\nEND_OF_SCENE\n`,
    );
  save("make-traces.sh", bytesOf(parts.join("")), "text/x-shellscript");
}
$("save-script").addEventListener("click", () =>
  saveScript().catch(({ message }) => ($("marks-said").textContent = message)),
);
// The example has a wrong trace, and right traces of scenes in the same group. The mistake concerns edges, and the
// right scenes have no edges.
$("example-all").addEventListener("click", async () => {
  const flawed = await marks.oracle.ask({ do: "example" });
  if (!flawed) return;
  const own = flawed.value.scene;
  const group = (await inside).flatMap(({ groups }) => groups).find(({ group }) => own.startsWith(`${group}/`));
  const found = [{ path: `${own}.bin`, file: new File([flawed.parts[0]], "flawed.bin") }];
  for (const name of group.names) {
    const scene = `${group.group}/${name}`;
    const xml = await xmlOf(scene);
    if (/<edge/.test(text(xml))) continue;
    await marks.oracle.ask({ do: "simulate", scene: `${scene}.xml` }, { blobs: [xml] });
    const trace = await marks.oracle.ask({ do: "trace" });
    if (!trace) return;
    found.push({ path: `${scene}.bin`, file: new File([trace.parts[0]], `${name}.bin`) });
  }
  takeFolder("examples", found);
});

$("pick-folder").addEventListener("change", ({ target }) => {
  const files = [...target.files].map((file) => ({ path: file.webkitRelativePath.replace(/^[^/]*\//, ""), file }));
  const name = target.files[0]?.webkitRelativePath.split("/")[0] ?? "traces";
  target.value = "";
  if (files.length) takeFolder(name, files);
});
$("pick-suite").addEventListener("change", ({ target }) => {
  const files = [...target.files].map((file) => ({ path: file.name, file }));
  target.value = "";
  takeFolder(marks.name ?? "traces", files);
});
$("suite").addEventListener("change", () => {
  marks.suite = $("suite").value ? null : courseSuite;
  $("suite-name").textContent = "";
  if (marks.files.size) mark_all();
});
$("marks-stop").addEventListener("click", () => marks.oracle.stop());
$("marks-again").addEventListener("click", mark_all);
$("save-marks").addEventListener("click", () => save(`${marks.name}.json`, marks.json, "application/json"));
