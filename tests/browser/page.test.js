// Tests the page in a browser: traces are dropped, scenes written, and pairs moved. Its answers equal the program's bit
// for bit. FOSSSIM_PAGE names the page (scripts/browser-page); without it, and without the target, nothing is tried.
import { strict as assert } from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  readdirSync,
  rmSync,
  statSync,
  symlinkSync,
  truncateSync,
  writeFileSync,
} from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test as node } from "node:test";
import { gzipSync, inflateRawSync } from "node:zlib";
import { checkAccessibility, launch, openPage, programs, root } from "./browser.js";

const html = resolve(process.env.FOSSSIM_PAGE ?? join(root, "target/page/oracle.html"));
const skip = existsSync(html) ? false : `there is no ${html}: scripts/browser-page makes it`;
const test = (name, run) => node(name, { skip }, run);
const MOST_BYTES = 2_500_000;

let browser, folder;
before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "fosssim-page-"));
  browser = await launch();
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

const scene = (name) => join(root, "assets/t2m2", `${name}.xml`);
const runOracle = (...words) =>
  spawnSync(join(programs, "fosssim-oracle"), words, { encoding: "utf8", cwd: folder, maxBuffer: 1 << 28 });

function trace(name, mistake, file = "trace.bin") {
  execFileSync(join(programs, "fosssim-sample"), [
    ...(mistake ? ["--mistake", mistake] : []),
    "-s",
    scene(name),
    "-d",
    "0",
    "-o",
    join(folder, file),
  ]);
  return join(folder, file);
}

// Returns a zstd frame whose blocks contain the bytes uncompressed.
function packZstd(bytes) {
  const blocks = [];
  for (let at = 0; at < bytes.length; at += 1 << 16) {
    const piece = bytes.subarray(at, at + (1 << 16)),
      head = Buffer.alloc(4);
    head.writeUInt32LE((piece.length << 3) | (at + piece.length === bytes.length ? 1 : 0));
    blocks.push(head.subarray(0, 3), piece);
  }
  return Buffer.concat([Buffer.from([0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x58]), ...blocks]);
}

const WRONG = ["GeometricTests/pair-becomes-rigid", "failsafe-angular-overwritten"];
const readStatus = (page) => page.locator("#said").innerText();
async function drop(page, files) {
  const before = await page.evaluate(() => document.documentElement.dataset.checked ?? "0");
  await page.locator("#pick").setInputFiles(files);
  await page.waitForFunction((before) => (document.documentElement.dataset.checked ?? "0") !== before, before);
}
const report = (page) => page.frameLocator("#frame");
async function saveFile(page, name, selector = page.getByRole("button", { name, exact: true })) {
  const [download] = await Promise.all([page.waitForEvent("download"), selector.click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

test("the page is one file of a bounded size, whose policy names no address", (t) => {
  t.diagnostic(`${statSync(html).size} bytes`);
  const page = readFileSync(html, "utf8");
  assert.ok(statSync(html).size < MOST_BYTES, `${statSync(html).size} bytes`);
  const [, policy] = page.match(/http-equiv="Content-Security-Policy" content="([^"]*)"/);
  assert.match(policy, /^default-src 'none'; /);
  assert.ok(!/https?:|\*|'unsafe-(inline|eval)'|'self'/.test(policy), policy);
  assert.ok(!/<(script|link|img)[^>]*\b(src|href)=/.test(page.replace(/srcdoc/g, "")));
});

test("a correct trace is recognized and accepted", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  await drop(page, trace("ContinuousTimeTests/head-on-equal-masses"));
  assert.match(await readStatus(page), /^trace\.bin: accepted, judged in/);
  assert.match(await report(page).locator("h1").innerText(), /accepted/);
  assert.deepEqual(complaints, []);
  await close();
});

test("who has no trace at hand sees the report on a wrong one", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  assert.ok(await page.locator("#judge").isDisabled());
  await page.getByRole("button", { name: "See a wrong trace" }).click();
  await page.waitForFunction(() => document.documentElement.dataset.checked === "1");
  assert.match(await readStatus(page), /^flawed\.bin: wrong answer/);
  assert.deepEqual(complaints, []);
  await close();
});

for (const [name, mistake, words] of [
  [...WRONG, /angular momentum is overwritten/],
  ["ContinuousTimeTests/spinning-edge-sweeps-balls", "pe-linear-one-ab", /likely mistake/],
  ["ContinuousTimeTests/row-struck-in-one-step", "decision-half-step", /likely mistake/],
  ["ContinuousTimeTests/head-on-equal-masses", "pp-contact-reversed", /likely mistake/],
  ["ImpulsesTests/off-centre-on-turning-edge", "decision-alpha-margin", /likely mistake/],
]) {
  test(`${mistake}: the page's files are the program's, byte for byte, and its viewer runs`, async () => {
    const { page, complaints, close } = await openPage(browser, html);
    await drop(page, trace(name, mistake));
    assert.match(await readStatus(page), /^trace\.bin: wrong answer/);
    await report(page).locator("html[data-ready]").waitFor();
    assert.match(await report(page).locator("main").innerText(), words);
    for (const [button, format] of [
      ["Save report", "html"],
      ["Save JSON", "json"],
    ]) {
      const { bytes } = await saveFile(page, button);
      const own = runOracle("check", `asset:${name}`, "trace.bin", "--format", format);
      assert.equal(own.status, 1, own.stderr);
      assert.ok(bytes.toString() === own.stdout, `${format} differs: ${bytes.length} and ${own.stdout.length} bytes`);
    }
    assert.deepEqual(complaints, []);
    await close();
  });
}

test("a trace that is cut, one of another scene, a text, an empty file: each has its words, and nothing breaks", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const file = trace("ContinuousTimeTests/head-on-equal-masses");
  truncateSync(file, 1501);
  await drop(page, file);
  assert.match(await readStatus(page), /bad trace/);
  trace("ContinuousTimeTests/head-on-equal-masses", null, "other.bin");
  await page.getByRole("button", { name: "Another trace" }).click();
  await page.locator("#scene").selectOption("GeometricTests/pair-becomes-rigid");
  await page.waitForFunction(() => document.documentElement.dataset.checked === "2");
  await drop(page, join(folder, "other.bin"));
  assert.match(await report(page).locator("main").innerText(), /Does this trace belong to this scene\?/);
  for (const [content, words] of [
    ["Dear grader", /looks like text/],
    ["", /is empty/],
  ]) {
    writeFileSync(join(folder, "notes.bin"), content);
    await drop(page, join(folder, "notes.bin"));
    const { bytes } = await saveFile(page, "Save JSON");
    assert.match(bytes.toString(), words);
  }
  assert.deepEqual(complaints, []);
  await close();
});

test("each trace is recognized anew, and a scene that its reader chooses or drops stays", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const names = [
    "ContinuousTimeTests/head-on-equal-masses",
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    WRONG[0],
  ];
  const scenes = async () => (await report(page).locator(".names").innerText()).match(/scene (\S+)/)[1];
  for (const [number, name] of names.entries()) {
    await drop(page, trace(name, null, `trace${number}.bin`));
    assert.match(await readStatus(page), /: accepted/, name);
    assert.equal(await scenes(), `asset:${name}`);
  }
  const chosen = async (choice, name) => {
    const before = await page.evaluate(() => document.documentElement.dataset.checked);
    await page.locator("#ask").evaluate((ask) => {
      ask.open = true;
    });
    await page.locator("#scene").selectOption(choice);
    await page.waitForFunction((before) => document.documentElement.dataset.checked !== before, before);
    assert.equal(await scenes(), name);
  };
  copyFileSync(scene(names[0]), join(folder, "own.xml"));
  await drop(page, [join(folder, "own.xml"), join(folder, "trace0.bin")]);
  assert.equal(await scenes(), "own.xml");
  await drop(page, join(folder, "trace1.bin"));
  assert.equal(await scenes(), "own.xml");
  await chosen("", `asset:${names[1]}`);
  await chosen("own", "own.xml");
  await chosen(names[2], `asset:${names[2]}`);
  await chosen("", `asset:${names[1]}`);
  // One of two traces is checked, and the page says so.
  await drop(page, [join(folder, "trace1.bin"), join(folder, "trace0.bin")]);
  assert.match(await readStatus(page), /^trace0\.bin: accepted.*Not checked: trace1\.bin/s);
  assert.deepEqual(complaints, []);
  await close();
});

test("what is no trace, and a broken scene, are told at once", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  for (const [content, words] of [
    ["Dear grader", /is not a trace: it looks like text/],
    ["", /is not a trace: it is empty/],
    [Buffer.from(Array.from({ length: 4000 }, (_, k) => (k * 167 + (k >> 3) * 59) % 256)), /it begins with numbers/],
  ]) {
    writeFileSync(join(folder, "notes.bin"), content);
    await drop(page, join(folder, "notes.bin"));
    assert.match(await readStatus(page), words);
    const [said, steps] = await Promise.all(["#said", "#check .steps"].map((one) => page.locator(one).boundingBox()));
    assert.ok(said.y < steps.y, "the reason is next to the drop");
  }
  await page.reload();
  await page.waitForSelector("html[data-ready]");
  writeFileSync(join(folder, "broken.xml"), readFileSync(scene(WRONG[0]), "utf8").replace('radius="', 'radios="'));
  await page.locator("#pick").setInputFiles(join(folder, "broken.xml"));
  await page.getByText("did you mean `radius`").waitFor();
  assert.match(await page.locator("#said").evaluate((element) => getComputedStyle(element).fontFamily), /mono/i);
  assert.deepEqual(complaints, []);
  await close();
});

test("without a mouse one goes on from the report", async () => {
  const { page, close } = await openPage(browser, html);
  await page.locator("#pick").focus();
  await drop(page, trace(...WRONG));
  assert.equal(await page.evaluate(() => document.activeElement.id), "again");
  await close();
});

test("a trace that may be one of several scenes is asked about by their names", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const names = ["implicit-euler-stiff-chain", "linearized-implicit-chain"];
  execFileSync(join(programs, "fosssim-sample"), [
    "-s",
    join(root, `assets/t1m3/IntegratorTests/${names[0]}.xml`),
    "-d",
    "0",
    "-o",
    join(folder, "alike.bin"),
  ]);
  await page.locator("#pick").setInputFiles(join(folder, "alike.bin"));
  await page.getByText("The trace begins like those of").waitFor();
  for (const name of names) assert.ok((await readStatus(page)).includes(name), await readStatus(page));
  await page.locator("#scene").selectOption(`IntegratorTests/${names[0]}`);
  await page.getByText("accepted, judged in").waitFor();
  assert.match(await readStatus(page), /^alike\.bin: accepted/);
  assert.deepEqual(complaints, []);
  await close();
});

test("a scene of one's own is dropped with its trace; a broken one gets the strict reader's words", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const file = trace(...WRONG);
  copyFileSync(scene(WRONG[0]), join(folder, "own.xml"));
  await drop(page, [join(folder, "own.xml"), file]);
  const { bytes } = await saveFile(page, "Save JSON");
  assert.equal(bytes.toString(), runOracle("check", "own.xml", "trace.bin", "--format", "json").stdout);
  writeFileSync(join(folder, "broken.xml"), readFileSync(scene(WRONG[0]), "utf8").replace('radius="', 'radios="'));
  await drop(page, [join(folder, "broken.xml"), file]);
  assert.match(await readStatus(page), /broken\.xml:\d+:\d+: unknown attribute `radios`.*did you mean `radius`/s);
  assert.deepEqual(complaints, []);
  await close();
});

test("packed traces are unpacked on the way; what is damaged is told", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const bytes = readFileSync(trace(...WRONG));
  const packed = { "trace.bin.zst": packZstd(bytes), "trace.bin.gz": gzipSync(bytes) };
  for (const [name, content] of Object.entries(packed)) {
    writeFileSync(join(folder, name), content);
    await drop(page, join(folder, name));
    assert.match(await readStatus(page), /^trace\.bin.*: wrong answer/, name);
    assert.match(await report(page).locator("main").innerText(), /angular momentum is overwritten/);
    writeFileSync(join(folder, name), content.subarray(0, content.length / 2));
    await drop(page, join(folder, name));
    assert.match(await readStatus(page), /cut short or damaged; copy it again/, name);
  }
  assert.deepEqual(complaints, []);
  await close();
});

test("a trace of 1 GiB is read piece by piece", async (t) => {
  const { page, complaints, close } = await openPage(browser, html);
  const file = trace("ContinuousTimeTests/head-on-equal-masses", null, "huge.bin");
  truncateSync(file, 2 ** 30);
  await drop(page, file);
  t.diagnostic(await readStatus(page));
  assert.match(await readStatus(page), /huge\.bin: /);
  const { bytes } = await saveFile(page, "Save JSON");
  assert.equal(
    bytes.toString(),
    runOracle("check", "asset:ContinuousTimeTests/head-on-equal-masses", "huge.bin", "--format", "json").stdout,
  );
  rmSync(file);
  assert.deepEqual(complaints, []);
  await close();
});

test("everybody can use it: light, dark, a phone's width, without a mouse", async () => {
  const file = trace(...WRONG);
  for (const [scheme, width] of [
    ["light", 1440],
    ["dark", 1440],
    ["dark", 390],
  ]) {
    const { page, complaints, close } = await openPage(browser, html, { scheme });
    await page.setViewportSize({ width, height: 844 });
    const looks = async () => {
      await checkAccessibility(page);
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width);
    };
    await looks();
    await drop(page, file);
    await looks();
    // The arrow keys move from tab to tab.
    await page.locator("#tab-check").focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => document.activeElement.id), "tab-submission");
    await looks();
    await page.keyboard.press("ArrowRight");
    await page.waitForSelector("html[data-tried]");
    await looks();
    await page.keyboard.press("End");
    await page.waitForSelector("html[data-looked]");
    await looks();
    if (width === 390) {
      // The picture stays while the last slider is moved.
      await page.locator("#numbers input").last().scrollIntoViewIfNeeded();
      const box = await page.locator("#pair svg[viewBox]").first().boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height < 844, JSON.stringify(box));
    }
    await page.keyboard.press("Home");
    assert.equal(await page.evaluate(() => document.activeElement.id), "tab-check");
    // One key reads the last trace again.
    await report(page).locator("h1").click();
    await page.keyboard.press("r");
    await page.waitForFunction(() => document.documentElement.dataset.checked === "2");
    // axe communicates with frames by messages, which frames of a local file reject.
    assert.deepEqual(
      complaints.filter((one) => !one.includes("postMessage")),
      [],
    );
    await close();
  }
});

test("a report's smallest scenes are tried with one drop", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const program = "fosssim-sample.pe-linear-one-sh";
  symlinkSync(join(programs, "fosssim-sample"), join(folder, program));
  const run = runOracle("shrink", program, "--suite", "t2m2", "--format", "html", "--unsafe-no-sandbox");
  assert.equal(run.status, 1, run.stderr);
  writeFileSync(join(folder, "report.html"), run.stdout);
  await drag(page, [join(folder, "report.html")]);
  await page.locator("#try-said", { hasText: "1 step, 3 particles, 1 edge" }).waitFor();
  assert.match(await page.locator("#source").inputValue(), /^<scene>/);
  assert.equal(await page.locator("#start").inputValue(), "smallest scene 1");
  writeFileSync(join(folder, "other.html"), "<p>nothing</p>");
  await page.locator("#open-xml").setInputFiles(join(folder, "other.html"));
  await page.locator("#try-said", { hasText: "other.html has no smallest scene" }).waitFor();
  assert.deepEqual(complaints, []);
  await close();
});

test("a folder of traces gets the points of the suite, as grade --traces gives them, and says what became right", async (t) => {
  const { page, complaints, close } = await openPage(browser, html);
  const traces = join(folder, "traces");
  for (const group of ["GeometricTests", "ImpulsesTests"]) {
    mkdirSync(join(traces, group), { recursive: true });
    for (const file of readdirSync(join(root, "assets/t2m2", group)))
      trace(
        `${group}/${file.replace(".xml", "")}`,
        `pp-radius-not-squared,${WRONG[1]}`,
        `traces/${group}/${file.replace(".xml", ".bin")}`,
      );
  }
  await page.locator("#tab-submission").click();
  const marked = async (times) => {
    await page.locator("#pick-folder").setInputFiles(traces);
    await page.waitForFunction((times) => document.documentElement.dataset.marked === times, String(times), {
      timeout: 60_000,
    });
    const { bytes } = await saveFile(page, "Save JSON", page.locator("#save-marks"));
    assert.equal(bytes.toString(), runOracle("grade", "--traces", "traces", "--format", "json").stdout);
  };
  await marked(1);
  t.diagnostic(await page.locator("#marks-said").innerText());
  // Each likely mistake has one card, with the numbers that the program gives.
  const { stdout } = runOracle("grade", "--traces", "traces");
  const likely = [...stdout.matchAll(/^ {2}- (.*) \(explains (\d+) of \d+ wrong scenes; (f.*)\)$/gm)];
  assert.deepEqual(
    await page.locator("details.mistake > summary").allInnerTexts(),
    likely.map(([, what, count, worth]) => `${what} (${count} scenes) F${worth.slice(1)}.`),
  );
  assert.equal(likely.length, 2);
  trace(WRONG[0], null, `traces/${WRONG[0]}.bin`);
  await marked(2);
  assert.match(
    await page.locator("#marks-list").innerText(),
    /1 scene became right since the last drop: GeometricTests\/pair-becomes-rigid/,
  );
  await checkAccessibility(page);
  // Compressed traces count like others.
  const plain = join(traces, `${WRONG[0]}.bin`);
  writeFileSync(`${plain}.zst`, packZstd(readFileSync(plain)));
  rmSync(plain);
  trace(WRONG[0], null, "traces/GeometricTests/pair-becomes-rigit.bin");
  await marked(3);
  assert.match(
    await page.locator("#marks-list").innerText(),
    /1 trace belongs to no scene of .*: GeometricTests\/pair-becomes-rigit\.bin/,
  );
  // Only wrong scenes that no card names are not folded. A scene links to its report.
  assert.ok(!(await page.getByRole("button", { name: "pair-becomes-rigid" }).isVisible()));
  const group = page.locator("#marks-list > details", { hasText: "GeometricTests:" });
  assert.equal(await group.locator("> .scroll tbody tr").count(), 1);
  assert.equal(await page.locator("#marks-list > details", { hasText: "ImpulsesTests:" }).getAttribute("open"), null);
  await group.locator("details summary", { hasText: " right" }).click();
  await page.getByRole("button", { name: "pair-becomes-rigid" }).click();
  await page.waitForFunction(() => document.documentElement.dataset.checked === "1");
  assert.match(await readStatus(page), /^pair-becomes-rigid\.bin.*: accepted/);
  assert.deepEqual(
    complaints.filter((one) => !one.includes("postMessage")),
    [],
  );
  await close();
});

test("who has no traces sees some, and gets a script that makes them", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  await page.locator("#tab-submission").click();
  await page.getByRole("button", { name: "See some traces" }).click();
  await page.locator("#marks-list h2").first().waitFor();
  assert.match(await page.locator("#marks-list").innerText(), /A product is missing .*\(1 scene\)/);
  await page.getByText("The folder and its suite").click();
  const { bytes } = await saveFile(page, "Save the script", page.locator("#save-script"));
  const made = join(folder, "made");
  mkdirSync(made);
  writeFileSync(join(made, "make-traces.sh"), bytes);
  execFileSync("sh", ["make-traces.sh", join(programs, "fosssim-sample")], { cwd: made, stdio: "ignore" });
  const { status, stdout } = runOracle("grade", "--traces", "made/traces");
  assert.equal(status, 0, stdout);
  assert.deepEqual(complaints, []);
  await close();
});

test("a suite of one's own brings its scenes along; what is wrong with it is told with its place", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const course = join(folder, "course");
  mkdirSync(course);
  copyFileSync(scene(WRONG[0]), join(course, "own.xml"));
  const suite = (scenes) => `schema = 1\nname = "Mine"\n[[group]]\nname = "a"\npoints = 7\nscenes = [${scenes}]\n`;
  writeFileSync(join(course, "suite.toml"), suite('"own.xml", "asset:ImpulsesTests/off-centre-on-turning-edge"'));
  trace(...WRONG, "course/own.bin");
  await page.locator("#tab-submission").click();
  await page.locator("#pick-folder").setInputFiles(course);
  await page.waitForFunction(() => document.documentElement.dataset.marked === "1");
  const { bytes } = await saveFile(page, "Save JSON", page.locator("#save-marks"));
  assert.equal(
    bytes.toString(),
    runOracle("grade", "--traces", "course", "--suite", "course/suite.toml", "--format", "json").stdout,
  );
  writeFileSync(join(course, "suite.toml"), suite('"none*.xml"'));
  await page.locator("#pick-folder").setInputFiles(course);
  await page.waitForFunction(() => document.documentElement.dataset.marked === "2");
  assert.match(await page.locator("#marks-said").innerText(), /suite\.toml:6:\d+: no scene file matches none\*\.xml/);
  assert.deepEqual(complaints, []);
  await close();
});

// Drags files onto the page, so that the browser creates files, folders and handles, which a file picker does not.
async function drag(page, paths) {
  const debug = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"])
    await debug.send("Input.dispatchDragEvent", { type, x: 300, y: 200, data });
  await debug.detach();
}

test("what is dragged onto the page is taken, whichever tab is open: a trace, a folder, a suite with it", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const right = trace("ContinuousTimeTests/head-on-equal-masses");
  await page.locator("#tab-submission").click();
  await drag(page, [right]);
  await page.waitForFunction(() => document.documentElement.dataset.checked === "1");
  assert.match(await readStatus(page), /^trace\.bin: accepted/);
  // The program has run again. The key reads the file again without another drop.
  trace("ContinuousTimeTests/head-on-equal-masses", "pp-contact-reversed");
  await page.keyboard.press("r");
  await page.waitForFunction(() => document.documentElement.dataset.checked === "2");
  assert.match(await readStatus(page), /^trace\.bin: wrong answer/);
  // The report fills the page, so the next drop is on the report.
  mkdirSync(join(folder, "dragged/GeometricTests"), { recursive: true });
  trace(WRONG[0], null, `dragged/${WRONG[0]}.bin`);
  await drag(page, [join(folder, "dragged")]);
  await page.waitForFunction(() => document.documentElement.dataset.marked === "1", null, { timeout: 60_000 });
  assert.match(await page.locator("#folder-name").textContent(), /^dragged, 1 of \d+ traces$/);
  const suite = join(folder, "dragged.toml");
  writeFileSync(suite, `schema = 1\nname = "one"\n[[group]]\nname = "G"\npoints = 7\nscenes = ["asset:${WRONG[0]}"]\n`);
  await drag(page, [suite]);
  await page.waitForFunction(() => document.documentElement.dataset.marked === "2", null, { timeout: 60_000 });
  assert.match(await page.locator("#marks-said").innerText(), /\b7\b/);
  assert.deepEqual(
    complaints.filter((one) => !one.includes("postMessage")),
    [],
  );
  await close();
});

test("a scene with errors from the first moment on is not said to be in the picture", async () => {
  const { page, close } = await openPage(browser, html);
  await page.evaluate(() => {
    document.getElementById("tab-try").click();
    const source = document.getElementById("source");
    source.value = "<scene>";
    source.dispatchEvent(new Event("input"));
  });
  await page.waitForSelector("html[data-tried]");
  assert.match(await page.locator("#try-said").innerText(), /^\d+ errors?\.$/);
  // A name that is no scene's is taken back.
  await page.locator("#start").fill("nothing");
  await page.locator("#source").focus();
  assert.equal(await page.locator("#start").inputValue(), "a small scene");
  await close();
});

test("a scene is written: messages in place, its motion, and files that are the program's", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  await page.locator("#tab-try").click();
  await page.waitForSelector("#canvas[data-step]");
  const before = await page.locator("#source").inputValue();
  // A scene is found by typing a part of its name.
  await page.locator("#start").fill("ContinuousTimeTests/head-on-equal-masses");
  await page.locator("#start").press("Enter");
  await page.waitForFunction((before) => {
    const { value } = document.getElementById("source");
    return value !== before && document.documentElement.dataset.tried === String(value.length);
  }, before);
  const { bytes } = await saveFile(page, "trace", page.locator("#save-trace"));
  const own = runOracle("simulate", "asset:ContinuousTimeTests/head-on-equal-masses", "--output", "own.bin");
  assert.equal(own.status, 0, own.stderr);
  assert.ok(bytes.equals(readFileSync(join(folder, "own.bin"))));
  const film = await saveFile(page, "film (GIF)");
  runOracle(
    "render",
    "asset:ContinuousTimeTests/head-on-equal-masses",
    "--size",
    "640x400",
    "--fps",
    "25",
    "--output",
    "own.gif",
  );
  assert.ok(film.bytes.equals(readFileSync(join(folder, "own.gif"))));
  await page.locator("#source").fill('<scene>\n  <duration time="x"/>\n</scene>\n');
  await page.getByRole("button", { name: "2:19" }).click();
  assert.equal(
    await page.locator("#source").evaluate((area) => area.value.slice(area.selectionStart, area.selectionEnd)),
    "x",
  );
  assert.match(await page.locator("#problems").innerText(), /`time` of .* must be a number, not `x`/);
  assert.equal(await page.locator("#marks mark").last().innerText(), "x");
  // Faults of the markup come first, because other errors may follow from them.
  await page.locator("#source").fill('<scene>\n  <duration time="x"/>\n  <integrator type="none"\n</scene>\n');
  await page.getByRole("button", { name: "4:1" }).waitFor();
  assert.match(await page.locator("#problems").innerText(), /^3:3 [^]*4:1 [^]*2:19 /);
  await page.locator("#source").fill('<scene>\n  <duration time="x"/>\n  <integrator type"none"/>\n</scene>\n');
  await page.getByText("`=` and a value are missing").waitFor();
  assert.match(await page.locator("#problems").innerText(), /^3:15 [^]*2:19 /);
  assert.deepEqual(complaints, []);
  await close();
});

test("the address names the open tab, and Back returns to the one before", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  const selected = () => page.locator("[role=tab][aria-selected=true]").innerText();
  await page.getByRole("tab", { name: "All traces" }).click();
  await page.getByRole("tab", { name: "One pair" }).click();
  assert.equal(new URL(page.url()).hash, "#pair");
  await page.goBack();
  assert.deepEqual([new URL(page.url()).hash, await selected()], ["#traces", "All traces"]);
  await page.goBack();
  assert.deepEqual([new URL(page.url()).hash, await selected()], ["", "Check a trace"]);
  await page.goForward();
  await page.evaluate(() => {
    location.hash = "#try";
  });
  await page.locator("#source").waitFor();
  // A link to a place in the page keeps the tab, and a new window opens the tab in its address.
  await page.evaluate(() => {
    location.hash = "#content";
  });
  assert.equal(await selected(), "Try a scene");
  await page.goto(`file://${html}?new#pair`);
  assert.equal(await selected(), "One pair");
  await page.locator("#decision").waitFor();
  assert.equal(await page.title(), "One pair - fosssim-oracle");
  assert.deepEqual(complaints, []);
  await close();
});

test("a pair is moved: its numbers are those of the command beside them", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  await page.locator("#tab-pair").click();
  await page.waitForSelector("html[data-looked]");
  assert.match(await page.locator("#decision").innerText(), /they collide/i, "the first pair collides");
  for (const [preset, words] of [
    ["first", /-361 t\^4 - 304 t\^3 - 468 t\^2 - 288 t/],
    ["second", /-16 t\^4 - 68 t\^2 \+ 36 t - 16/],
    ["plane", /half-plane/],
    ["balls", /they collide/],
  ]) {
    await page.locator("#preset").selectOption(preset);
    await page.waitForFunction(
      () => document.documentElement.dataset.looked === document.getElementById("command").textContent,
    );
    assert.match(await page.locator("#words").textContent(), words);
  }
  await page.getByRole("slider", { name: "x1: dy, slider" }).press("ArrowRight");
  await page.waitForFunction(
    () => document.documentElement.dataset.looked === document.getElementById("command").textContent,
  );
  const { bytes } = await saveFile(page, "Save JSON", page.locator("#save-pair"));
  const [, ...words] = (await page.locator("#command").innerText()).split(" ");
  assert.equal(bytes.toString(), runOracle(...words, "--format", "json").stdout);
  assert.deepEqual(complaints, []);
  await close();
});

test("points of a pair are dragged, and the polynomials follow", async () => {
  const { page, complaints, close } = await openPage(browser, html);
  await page.locator("#tab-pair").click();
  await page.locator("#preset").selectOption("balls");
  const settled = () =>
    page.waitForFunction(
      () => document.documentElement.dataset.looked === document.getElementById("command").textContent,
    );
  await settled();
  assert.match(await page.locator("#decision").innerText(), /they collide|collision/i);
  const before = await page.locator("#command").innerText();
  // The tip of the first arrow is moved up and back, away from the other particle.
  const box = await page.locator("#sketch .grip").first().boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x - 350, box.y - 100, { steps: 5 });
  await page.mouse.up();
  await settled();
  const after = await page.locator("#command").innerText();
  assert.notEqual(after, before);
  const [, dx, dy] = after.match(/pp:-2,0\+([^,]*),([^:]*):/).map(Number);
  assert.ok(dx < 1 && dy > 0.6, after);
  // Dragging leaves few digits, and fields and sliders show the same values.
  assert.ok(after.length < 90, after);
  assert.equal(Number(await page.getByRole("spinbutton", { name: "x1: dy" }).inputValue()), dy);
  assert.match(await page.locator("#decision").innerText(), /no collision/i);
  assert.deepEqual(complaints, []);
  await close();
});

test("the page of a course has its suite and scenes, and gives the points of what students may see", async () => {
  const course = join(folder, "of-a-course");
  mkdirSync(join(course, "own"), { recursive: true });
  writeFileSync(
    join(course, "own/mine.xml"),
    readFileSync(scene(WRONG[0]), "utf8").replace("<scene>", "<scene><!-- of the course -->"),
  );
  const groups = (hidden) =>
    `schema = 1\nname = "The course"\n[[group]]\nname = "own"\npoints = 7\nscenes = ["own/*.xml"]\n${hidden}`;
  writeFileSync(
    join(course, "suite.toml"),
    groups('[[group]]\nname = "secret"\nvisibility = "hidden"\nscenes = ["asset:ImpulsesTests/*"]\n'),
  );
  writeFileSync(
    join(course, "module.wasm"),
    inflateRawSync(Buffer.from(readFileSync(html, "utf8").match(/id="module">([^<]*)</)[1], "base64")),
  );
  const made = runOracle(
    "page",
    "--module",
    "of-a-course/module.wasm",
    "--suite",
    "of-a-course/suite.toml",
    "--output",
    "course.html",
  );
  assert.equal(made.status, 0, made.stderr);
  const { page, complaints, close } = await openPage(browser, join(folder, "course.html"));
  mkdirSync(join(folder, "handed/own"), { recursive: true });
  execFileSync(join(programs, "fosssim-sample"), [
    "--mistake",
    WRONG[1],
    "-s",
    join(course, "own/mine.xml"),
    "-d",
    "0",
    "-o",
    join(folder, "handed/own/mine.bin"),
  ]);
  await page.locator("#tab-submission").click();
  await page.locator("#pick-folder").setInputFiles(join(folder, "handed"));
  await page.waitForFunction(() => document.documentElement.dataset.marked === "1");
  assert.match(await page.locator("#marks-said").innerText(), /0 of 7 points by The course/);
  writeFileSync(join(course, "suite.toml"), groups(""));
  const { bytes } = await saveFile(page, "Save JSON", page.locator("#save-marks"));
  assert.equal(
    bytes.toString(),
    runOracle(
      "grade",
      "--traces",
      "handed",
      "--suite",
      "of-a-course/suite.toml",
      "--for",
      "student",
      "--format",
      "json",
    ).stdout,
  );
  // The scene is also found by the trace's name.
  await page.getByRole("button", { name: "own/mine", exact: true }).click();
  await page.waitForFunction(() => document.documentElement.dataset.checked === "1");
  assert.match(await readStatus(page), /^mine\.bin: wrong answer/);
  assert.deepEqual(complaints, []);
  await close();
});

test("all scenes have the same recordings as natively", async (t) => {
  const { page, close } = await openPage(browser, html);
  // The module runs in the page's browser, one scene after the other.
  const names = ["t2m2", "t1m1", "t1m2", "t1m3", "t2m1", "t2m3"].flatMap((assignment) =>
    readdirSync(join(root, "assets", assignment), { withFileTypes: true })
      .filter((one) => one.isDirectory())
      .flatMap(({ name: group }) =>
        readdirSync(join(root, "assets", assignment, group)).map((file) => `${group}/${file.replace(".xml", "")}`),
      ),
  );
  const digests = await page.evaluate(async (names) => {
    const worker = new Worker(URL.createObjectURL(new Blob([document.getElementById("worker").textContent])));
    const packed = Uint8Array.from(atob(document.getElementById("module").textContent.trim()), (c) => c.charCodeAt(0));
    const module = await WebAssembly.compile(
      await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"))).arrayBuffer(),
    );
    const ask = (request, blobs = []) =>
      new Promise((resolve, reject) => {
        worker.onmessage = ({ data }) => {
          if (data.error) reject(new Error(data.error));
          else if (data.value) resolve(data.parts);
        };
        worker.postMessage({ id: 0, request, blobs, files: [], module });
      });
    const found = {};
    for (const name of names) {
      const [xml] = await ask({ do: "scene", name });
      await ask({ do: "simulate", scene: name }, [xml]);
      const [trace] = await ask({ do: "trace" });
      found[name] = [...new Uint8Array(await crypto.subtle.digest("SHA-256", trace))]
        .map((byte) => byte.toString(16).padStart(2, "0"))
        .join("");
    }
    return found;
  }, names);
  const { createHash } = await import("node:crypto");
  for (const name of names) {
    const own = spawnSync(join(programs, "fosssim-oracle"), ["simulate", `asset:${name}`, "--output", "-", "--quiet"], {
      maxBuffer: 1 << 28,
    });
    assert.equal(digests[name], createHash("sha256").update(own.stdout).digest("hex"), name);
  }
  t.diagnostic(`${names.length} scenes recorded`);
  await close();
});

const corpus = process.env.FOSSSIM_CORPUS ?? join(root, "../shared/corpus");
const without =
  skip ||
  (existsSync(join(corpus, "submissions")) ? false : `there is no corpus at ${corpus}`) ||
  (spawnSync("zstd", ["--version"]).status === 0 ? false : "there is no zstd");
node("all traces of the corpus have the same reports as natively", { skip: without }, async (t) => {
  // Run the page's module with its own code in this process, to measure the time.
  const engine = new Function(`${readFileSync(join(root, "crates/browser/page/engine.js"), "utf8")}; return engine;`)();
  const packed = readFileSync(html, "utf8").match(/id="module">([^<]*)</)[1];
  const module = new WebAssembly.Module(inflateRawSync(Buffer.from(packed, "base64")));
  let bytes,
    count = 0,
    took = 0;
  const ask = engine(module, {
    progress() {},
    read: (_, offset, into) => {
      const piece = bytes.subarray(offset, offset + into.length);
      into.set(piece);
      return piece.length;
    },
  });
  for (const submission of readdirSync(join(corpus, "submissions"))) {
    for (const file of readdirSync(join(corpus, "submissions", submission))) {
      const [, group, name] = file.match(/^(.*)_([^_]*)\.bin\.zst$/) ?? [];
      const xml = group && join(corpus, "scenes/t2m2", group, `${name}.xml`);
      if (!xml || !existsSync(xml)) continue;
      bytes = execFileSync("zstd", ["-dcqf", join(corpus, "submissions", submission, file)], { maxBuffer: 1 << 30 });
      writeFileSync(join(folder, "trace.bin"), bytes);
      const begin = performance.now();
      const { parts } = ask({ do: "check", scene: xml, trace: "trace.bin" }, readFileSync(xml));
      took += performance.now() - begin;
      assert.equal(
        Buffer.from(parts[0]).toString(),
        runOracle("check", xml, "trace.bin", "--format", "json").stdout,
        `${submission}/${file}`,
      );
      count += 1;
    }
  }
  assert.ok(count > 100, `${count}`);
  t.diagnostic(`${count} traces in ${(took / 1000).toFixed(1)} s`);
});
