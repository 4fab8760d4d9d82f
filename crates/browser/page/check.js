// Checks a trace. The report is the same file that the command line writes, and is shown in a frame. The reader chooses
// the scene in the list. As long as the first entry is chosen, the scene of each trace is recognized. `given` is the
// name of the scene that was given together with a trace.
const check = { oracle: new Oracle(), trace: null, given: null, others: [], own: null, report: null, run: 0 };
// The strict reader points at a place in its excerpt, so a monospaced font is needed.
const showStatus = (message, className = "") => {
  $("said").textContent = message;
  $("said").className = message.includes("\n") ? `${className} excerpt` : className;
};

// A dropped file that can be read again later. The file's handle returns the current contents. Browsers unpack gzip
// themselves.
async function readCurrentFile(item) {
  const file = item.handle?.getFile ? await item.handle.getFile() : item.file;
  if (!/\.gz$/i.test(file.name)) return file;
  try {
    const unpacked = await new Response(file.stream().pipeThrough(new DecompressionStream("gzip"))).blob();
    return new File([unpacked], file.name.replace(/\.gz$/i, ""));
  } catch {
    throw new Error(`cannot read the trace ${file.name}: the gzip data is cut short or damaged; copy it again`);
  }
}
const isReport = (file) => /\.html?$/i.test(file?.name ?? "");
const removeExtension = (name) => name.replace(/\.bin(\.(zst|gz))?$/i, "");

async function acceptFiles(items, scene = null) {
  const scenes = items.filter(({ file }) => /\.xml$/i.test(file.name)),
    traces = items.filter((item) => !scenes.includes(item));
  const last = traces.at(-1);
  if (last) {
    Object.assign(check, { trace: last, given: scene, others: traces.slice(0, -1).map(({ file }) => file.name) });
    $("trace-name").textContent = `${last.file.name}, ${formatCount(last.file.size, "byte")}`;
  }
  try {
    for (const item of scenes) await acceptScene(item);
  } catch (error) {
    if (!check.trace) return showFailure(error);
  }
  $("judge").disabled = !check.trace;
  if (check.trace) return judge();
  if (check.own) showStatus("Now drop the trace.");
}

// Reads a scene that was dropped, and shows its errors immediately.
async function acceptScene({ file }) {
  check.own = { name: file.name, xml: new Uint8Array(await file.arrayBuffer()) };
  let own = $("scene").querySelector("option.own");
  if (!own) $("scene").options[0].after((own = el("option", { class: "own", value: "own" })));
  own.textContent = `your file ${file.name}`;
  own.selected = true;
  check.oracle.stop();
  await check.oracle.ask({ do: "read", name: file.name }, { blobs: [check.own.xml] });
}

// Returns a scene for a request. The XML of dropped scenes and of a course's scenes is included.
function sceneRequest(value) {
  const own = findCourseScene(value);
  if (own) return { name: own.name, xml: toBytes(own.xml) };
  return value === "own" ? check.own : { name: `asset:${value}` };
}

// Recognizes the scene of a trace if the reader chose none. A trace begins with the state at the start of its scene.
async function recognizeScene(file) {
  const name = removeExtension(file.name);
  const own =
    course?.scenes.findIndex(
      (scene) =>
        scene.name
          .replace(/\.xml$/, "")
          .split("/")
          .pop() === name,
    ) ?? -1;
  if (own >= 0) return sceneRequest(`course:${own}`);
  const answer = await check.oracle.ask({ do: "recognize" }, { files: [file] });
  if (!answer) return null;
  const { scenes, looks_like } = answer.value;
  const found =
    scenes.find((scene) => scene === name || scene.endsWith(`/${name}`)) ?? (scenes.length === 1 ? scenes[0] : null);
  if (found) return sceneRequest(found);
  if (looks_like)
    throw new Error(
      `${file.name} is not a trace: it ${looks_like}. Run ./FOSSSim -s scene.xml -d 0 -o trace.bin, and drop trace.bin.`,
    );
  throw new Error(
    scenes.length
      ? `The trace begins like those of ${scenes.join(" and ")}: choose its scene, or drop its XML.`
      : "Which scene does this trace belong to? Choose one, or drop its XML.",
  );
}

// Removes the report, which belongs to an earlier trace.
function showFailure(error) {
  $("frame").hidden = $("save-html").hidden = $("save-json").hidden = true;
  $("doing").hidden = !check.trace;
  document.body.classList.remove("reads");
  $("ask").open = true;
  showStatus(error.message, "bad");
}

async function judge() {
  if (!check.trace) return showStatus("Choose a trace first.", "bad");
  check.oracle.stop();
  const run = ++check.run,
    started = performance.now(),
    chosen = $("scene").value;
  $("bar").hidden = $("stop").hidden = false;
  $("bar").removeAttribute("value");
  showStatus(`Checking ${check.trace.file.name} ...`);
  try {
    const file = await readCurrentFile(check.trace);
    const scene = chosen ? sceneRequest(chosen) : (check.given ?? (await recognizeScene(file)));
    const request = scene && { do: "check", scene: scene.name, trace: file.name, rules: $("rules").value, html: true };
    const progress = (done, all) => {
      if (done < all) {
        $("bar").max = all;
        $("bar").value = done;
        return;
      }
      $("bar").removeAttribute("value");
      showStatus(`Writing the report on ${file.name} ...`);
    };
    const answer =
      request && (await check.oracle.ask(request, { blobs: scene.xml ? [scene.xml] : [], files: [file], progress }));
    if (run !== check.run) return;
    if (!answer) return showStatus($("frame").hidden ? "Stopped." : "Stopped. The report is from the previous run.");
    const [json, html] = answer.parts;
    check.report = { name: removeExtension(file.name), json, html };
    $("frame").srcdoc = decodeText(html);
    const hadFocus = document.activeElement?.closest("#ask, #check > .steps");
    $("ask").open = false;
    $("frame").hidden = $("doing").hidden = $("save-html").hidden = $("save-json").hidden = false;
    if (hadFocus) $("again").focus();
    document.body.classList.toggle("reads", currentPanel() === "check");
    const { verdict, accepted, difference } = answer.value;
    const others = check.others.length
      ? ` Not checked: ${check.others.join(", ")}. One trace is checked at a time; drop a folder of traces under All traces.`
      : "";
    showStatus(
      `${file.name}: ${verdict}${difference ? ` (${difference})` : ""}, judged in ${((performance.now() - started) / 1000).toFixed(2)} s on this computer.${others}`,
      accepted ? (difference ? "" : "good") : "bad",
    );
  } catch (error) {
    if (run === check.run) showFailure(error);
  } finally {
    if (run === check.run) $("bar").hidden = $("stop").hidden = true;
    document.documentElement.dataset.checked = String(Number(document.documentElement.dataset.checked ?? 0) + 1);
  }
}

addSceneOptions($("scene"));
$("scene").addEventListener("change", () => {
  check.given = null;
  if (check.trace) judge();
});
$("rules").addEventListener("change", () => {
  if (check.report) judge();
});
$("judge").addEventListener("click", judge);
$("again").addEventListener("click", judge);
$("stop").addEventListener("click", () => check.oracle.stop());
$("other").addEventListener("click", () => {
  $("ask").open = true;
  $("pick").focus();
});
$("save-html").addEventListener("click", () => save(`${check.report.name}.html`, check.report.html, "text/html"));
$("save-json").addEventListener("click", () =>
  save(`${check.report.name}.json`, check.report.json, "application/json"),
);
$("example").addEventListener("click", async () => {
  const answer = await check.oracle.ask({ do: "example" });
  if (!answer) return;
  $("scene").value = "";
  acceptFiles([{ file: new File([answer.parts[0]], "flawed.bin") }], sceneRequest(answer.value.scene));
});
$("pick").addEventListener("change", async ({ target }) => {
  await acceptFiles([...target.files].map((file) => ({ file })));
  target.value = "";
});
function repeatOnKey(event) {
  const isTextField = /^(input|select|textarea)$/i.test(event.target.tagName ?? "");
  if (
    event.key === "r" &&
    !event.ctrlKey &&
    !event.metaKey &&
    !event.altKey &&
    !isTextField &&
    currentPanel() === "check" &&
    check.report
  )
    judge();
}

async function handleDrop(event) {
  event.preventDefault();
  document.body.classList.remove("drops");
  // Handles must be requested before the first `await`.
  const items = [...event.dataTransfer.items].filter((item) => item.kind === "file");
  const handles = items.map((item) => item.getAsFileSystemHandle?.().catch(() => null));
  const entries = items.map((item, number) => ({
    entry: item.webkitGetAsEntry?.(),
    file: item.getAsFile(),
    handle: handles[number],
  }));
  if (isReport(entries[0]?.file)) openPanel("try");
  if (currentPanel() === "try") return openSceneFile(entries[0]?.file);
  const folder = entries.find(({ entry }) => entry?.isDirectory);
  if (folder || entries.some(({ file }) => /\.toml$/i.test(file?.name ?? ""))) {
    openPanel("submission");
    const found = [];
    for (const { entry, handle } of entries) {
      const own = await handle;
      await collectFiles(entry, own, entry?.isDirectory ? "" : (entry?.name ?? ""), found);
    }
    return acceptFolder(folder?.entry.name ?? grading.name ?? "traces", found);
  }
  openPanel("check");
  const files = [];
  for (const { file, handle } of entries) if (file) files.push({ file, handle: await handle });
  acceptFiles(files);
}

// Accepts drops and the shortcut key everywhere, including in the report's own document.
function acceptDrops(target) {
  target.addEventListener("keydown", repeatOnKey);
  target.addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("drops");
  });
  target.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) document.body.classList.remove("drops");
  });
  target.addEventListener("drop", handleDrop);
}
acceptDrops(window);
$("frame").addEventListener("load", () => acceptDrops($("frame").contentWindow));
