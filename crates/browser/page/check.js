// A trace is checked: the report is the file that the command line writes, in a frame of its own.
const check = { oracle: new Oracle(), trace: null, scene: null, report: null };
const say = (words, look = "") => { $("said").textContent = words; $("said").className = look; };

// A dropped file that may be read again later: the handle sees what was written since. Browsers unpack gzip themselves.
async function freshFile(item) {
  const file = item.handle?.getFile ? await item.handle.getFile() : item.file;
  if (!/\.gz$/i.test(file.name)) return file;
  try {
    const unpacked = await new Response(file.stream().pipeThrough(new DecompressionStream("gzip"))).blob();
    return new File([unpacked], file.name.replace(/\.gz$/i, ""));
  } catch {
    throw new Error(`cannot read the trace ${file.name}: the gzip data is cut short or damaged; copy it again`);
  }
}
const bare = (name) => name.replace(/\.bin(\.(zst|gz))?$/i, "");

async function takeFiles(items) {
  for (const item of items) {
    const { name } = item.file;
    if (/\.xml$/i.test(name)) await takeScene(item);
    else check.trace = item;
  }
  $("trace-name").textContent = check.trace ? `${check.trace.file.name}, ${counted(check.trace.file.size, "byte")}` : "none yet";
  if (check.trace && !check.scene && !$("scene").value) await recognise();
  if (check.trace && (check.scene || $("scene").value)) return judge();
  if (check.trace) say(check.alike?.length > 1 ? `The trace begins like those of ${check.alike.join(" and ")}: choose its scene, or drop its XML.` : "Which scene is this a trace of? Choose one, or drop its XML.");
  else if (check.scene) say("Now drop the trace.");
}

async function takeScene(item) {
  check.scene = { name: item.file.name, xml: new Uint8Array(await item.file.arrayBuffer()) };
  let own = $("scene").querySelector("option.own");
  if (!own) $("scene").prepend(own = el("option", { class: "own", value: "" }));
  own.textContent = `your file ${item.file.name}`;
  own.selected = true;
}

// A trace begins with the state of its scene.
async function recognise() {
  check.alike = [];
  const name = bare(check.trace.file.name);
  const own = course?.scenes.findIndex((scene) => scene.name.replace(/\.xml$/, "").split("/").pop() === name) ?? -1;
  if (own >= 0) { $("scene").value = `course:${own}`; return; }
  const file = await freshFile(check.trace).catch(() => null);
  if (!file) return;
  const { value } = await check.oracle.ask({ do: "recognise" }, { files: [file] });
  const found = value.scenes.find((scene) => scene === name || scene.endsWith(`/${name}`)) ?? (value.scenes.length === 1 ? value.scenes[0] : null);
  check.alike = value.scenes;
  if (found) $("scene").value = found;
}

async function judge() {
  const own = ownScene($("scene").value), asset = own ? "" : $("scene").value;
  const scene = own ? { name: own.name, xml: bytesOf(own.xml) } : check.scene;
  if (!check.trace) return say("Choose a trace first.", "bad");
  if (!asset && !scene) return say("Choose a scene first.", "bad");
  check.oracle.stop();
  const started = performance.now();
  $("bar").hidden = $("stop").hidden = false;
  $("bar").removeAttribute("value");
  say(`Checking ${check.trace.file.name} ...`);
  try {
    const file = await freshFile(check.trace);
    const request = { do: "check", scene: asset ? `asset:${asset}` : scene.name, trace: file.name, rules: $("rules").value, html: true };
    const progress = (done, all) => { $("bar").max = all; $("bar").value = done; };
    const answer = await check.oracle.ask(request, { blobs: asset ? [] : [scene.xml], files: [file], progress });
    if (!answer) return say("Stopped.");
    const [json, html] = answer.parts;
    check.report = { name: bare(file.name), json, html };
    $("frame").srcdoc = text(html);
    $("ask").open = false;
    $("frame").hidden = $("doing").hidden = false;
    document.body.classList.toggle("reads", current() === "check");
    say(`${file.name}: ${answer.value.verdict}, judged in ${((performance.now() - started) / 1000).toFixed(2)} s on this computer.`, answer.value.accepted ? "good" : "bad");
  } catch (error) {
    $("frame").hidden = $("doing").hidden = true;
    document.body.classList.remove("reads");
    $("ask").open = true;
    say(error.message, "bad");
  } finally {
    $("bar").hidden = $("stop").hidden = true;
    document.documentElement.dataset.checked = String(Number(document.documentElement.dataset.checked ?? 0) + 1);
  }
}

choices($("scene"));
$("scene").addEventListener("change", () => { if (check.trace && $("scene").selectedIndex > 0) judge(); });
$("rules").addEventListener("change", () => { if (check.report) judge(); });
$("judge").addEventListener("click", judge);
$("again").addEventListener("click", judge);
$("stop").addEventListener("click", () => check.oracle.stop());
$("other").addEventListener("click", () => { $("ask").open = true; $("pick").focus(); });
$("save-html").addEventListener("click", () => save(`${check.report.name}.html`, check.report.html, "text/html"));
$("save-json").addEventListener("click", () => save(`${check.report.name}.json`, check.report.json, "application/json"));
$("pick").addEventListener("change", async ({ target }) => { await takeFiles([...target.files].map((file) => ({ file }))); target.value = ""; });
function readsAgain(event) {
  const writes = /^(input|select|textarea)$/i.test(event.target.tagName ?? "");
  if (event.key === "r" && !event.ctrlKey && !event.metaKey && !event.altKey && !writes && current() === "check" && check.report) judge();
}

async function dropped(event) {
  event.preventDefault();
  document.body.classList.remove("drops");
  // Handles have to be asked for before anything is waited for.
  const items = [...event.dataTransfer.items].filter((item) => item.kind === "file");
  const handles = items.map((item) => item.getAsFileSystemHandle?.().catch(() => null));
  const entries = items.map((item, number) => ({ entry: item.webkitGetAsEntry?.(), file: item.getAsFile(), handle: handles[number] }));
  if (current() === "try") return tryFile(entries[0]?.file);
  const folder = entries.find(({ entry }) => entry?.isDirectory);
  if (folder || entries.some(({ file }) => /\.toml$/i.test(file?.name ?? ""))) {
    open("submission");
    const found = [];
    for (const { entry, handle } of entries) {
      const own = await handle;
      await walk(entry, own, entry?.isDirectory ? "" : entry?.name ?? "", found);
    }
    return takeFolder(folder?.entry.name ?? marks.name ?? "traces", found);
  }
  open("check");
  const files = [];
  for (const { file, handle } of entries) if (file) files.push({ file, handle: await handle });
  takeFiles(files);
}

// Files may be dropped anywhere, also on the report, which is a document of its own; so it is with the key.
function listens(target) {
  target.addEventListener("keydown", readsAgain);
  target.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("drops"); });
  target.addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("drops"); });
  target.addEventListener("drop", dropped);
}
listens(window);
$("frame").addEventListener("load", () => listens($("frame").contentWindow));
