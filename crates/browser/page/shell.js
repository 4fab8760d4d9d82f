// Code that all parts of the page share: the worker, the tabs, and files to save.
const $ = (id) => document.getElementById(id);
const decodeText = (bytes) => new TextDecoder().decode(bytes);
const toBytes = (words) => new TextEncoder().encode(words);
const formatCount = (count, what) => `${count.toLocaleString("en")} ${what}${count === 1 ? "" : "s"}`;

const compiledModule = (async () => {
  const packed = Uint8Array.from(atob($("module").textContent.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
})();

// A worker that answers one request at a time. Later requests wait. `stop` terminates the worker, and the pending
// requests get no answer.
class Oracle {
  #worker = null;
  #waiting = new Map();
  #last = 0;

  async ask(request, { blobs = [], files = [], progress = () => {} } = {}) {
    const module = await compiledModule;
    if (!this.#worker) this.#start();
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject, progress });
      this.#worker.postMessage({ id, request, blobs, files, module });
    });
  }

  get isBusy() {
    return this.#waiting.size > 0;
  }

  stop() {
    this.#worker?.terminate();
    this.#worker = null;
    for (const { resolve } of this.#waiting.values()) resolve(null);
    this.#waiting.clear();
  }

  #start() {
    const url = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
    this.#worker = new Worker(url);
    this.#worker.onmessage = ({ data: { id, value, parts, error, progress } }) => {
      const pending = this.#waiting.get(id);
      if (!pending) return;
      if (progress) return pending.progress(...progress);
      this.#waiting.delete(id);
      if (error) pending.reject(new Error(error));
      else pending.resolve({ value, parts });
    };
    this.#worker.onerror = (event) => {
      for (const { reject } of this.#waiting.values())
        reject(new Error(`the checker could not be started: ${event.message ?? "unknown"}`));
      this.#waiting.clear();
      this.#worker = null;
    };
  }
}

function save(name, bytes, type) {
  const url = URL.createObjectURL(new Blob([bytes], { type }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

// Tabs that follow the ARIA practices: the arrow keys move from one tab to the next.
const tabs = [...document.querySelectorAll("[role=tab]")];
const panelActions = new Map();
// The address names the open tab, so that links open a tab, and "Back" returns to the one before.
function findPanel() {
  const named = tabs.find((tab) => location.hash === `#${tab.dataset.hash}`);
  const current = location.hash ? tabs.find((tab) => tab.tabIndex === 0) : tabs[0];
  return (named ?? current).dataset.panel;
}
function openPanel(name, focus) {
  if (name === findPanel()) return showPanel(name, focus);
  history.pushState(null, "", `#${tabs.find((tab) => tab.dataset.panel === name).dataset.hash}`);
  showPanel(name, focus);
}
addEventListener("popstate", () => showPanel(findPanel()));
function showPanel(name, focus) {
  for (const tab of tabs) {
    const isSelected = tab.dataset.panel === name;
    tab.setAttribute("aria-selected", String(isSelected));
    tab.tabIndex = isSelected ? 0 : -1;
    $(tab.dataset.panel).hidden = !isSelected;
    if (isSelected) document.title = `${tab.textContent} - fosssim-oracle`;
    if (isSelected && focus) tab.focus();
  }
  document.body.classList.toggle("reads", name === "check" && !$("frame").hidden);
  panelActions.get(name)?.();
}
tabs.forEach((tab, number) => {
  tab.addEventListener("click", () => openPanel(tab.dataset.panel));
  tab.addEventListener("keydown", (event) => {
    const to = { ArrowRight: number + 1, ArrowLeft: number - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    openPanel(tabs[(to + tabs.length) % tabs.length].dataset.panel, true);
  });
});
const currentPanel = () => tabs.find((tab) => tab.getAttribute("aria-selected") === "true").dataset.panel;

// The embedded scenes, as options of the list.
const embeddedScenes = (async () => {
  const { value } = await new Oracle().ask({ do: "scenes" });
  $("suite").append(...value.suites.map(({ name, title }) => el("option", { value: name }, title)));
  if (course) {
    $("suite").prepend(el("option", { value: "" }, course.name));
    $("suite").value = "";
  }
  return value.assignments;
})();
// The suite of the course for which the page was made, and the course's own scenes.
const course = $("course") && JSON.parse($("course").textContent);
const findCourseScene = (value) => {
  const [, number] = value.match(/^course:(\d+)$/) ?? [];
  return number && course.scenes[number];
};
const addSceneOptions = async (select) => {
  if (course?.scenes.length)
    select.append(
      el(
        "optgroup",
        { label: course.name },
        ...course.scenes.map(({ name }, number) =>
          el("option", { value: `course:${number}` }, name.replace(/\.xml$/, "")),
        ),
      ),
    );
  for (const { title, groups } of await embeddedScenes) {
    for (const { group, names } of groups) {
      select.append(
        el(
          "optgroup",
          { label: `${title}: ${group}` },
          ...names.map((name) => el("option", { value: `${group}/${name}` }, name)),
        ),
      );
    }
  }
};
