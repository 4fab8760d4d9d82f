// Tests pages of whole gradings in a real browser: one submission, and a class of three hundred. FOSSSIM_BIN names the
// folder with fosssim-oracle and fosssim-sample; CHROMIUM the browser.
import { strict as assert } from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import { chmodSync, mkdirSync, mkdtempSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { checkAccessibility, launch, openPage, programs, writeSample } from "./browser.js";

let browser, folder;
const HOSTILE = "<img src=x onerror=alert(1)>'&";

// Without a sandbox, nothing can be graded.
const doctor = spawnSync(join(programs, "fosssim-oracle"), ["doctor"]);
const required = (process.env.FOSSSIM_REQUIRE ?? "").split(",");
const skip =
  doctor.status !== 0 && !required.includes("sandbox") && !required.includes("all")
    ? "programs can't be run safely here"
    : false;

const SUITE = `schema = 1
name = "Browser <b>suite</b>"
hints = "full"
show_output = true
[limits]
output_mib = 16
wall_seconds = 60
cpu_seconds = 60
[[group]]
name = "Detection"
scenes = ["asset:ContinuousTimeTests/spinning-edge*", "asset:ContinuousTimeTests/head-on-equal*"]
points = 10
[[group]]
name = "Zones"
scenes = ["asset:GeometricTests/pair-becomes-rigid"]
points = 10
`;

// Writes a copy of the sample program. Its name selects the mistake that it makes.
function copySample(where, mistake) {
  const path = join(where, mistake ? `fosssim-sample.${mistake}` : "fosssim-sample");
  writeSample(path);
  return path;
}
function writeScript(where, name, text) {
  const path = join(where, name);
  writeFileSync(path, `#!/bin/sh\n${text}\n`);
  chmodSync(path, 0o755);
  return path;
}
function grade(...words) {
  const run = spawnSync(join(programs, "fosssim-oracle"), ["grade", ...words], { encoding: "utf8", cwd: folder });
  assert.ok(run.status === 0 || run.status === 1, run.stderr + run.stdout);
}

before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "fosssim-browser-"));
  writeFileSync(join(folder, "suite.toml"), SUITE);
  mkdirSync(join(folder, "class"));
  for (const mistake of ["", "pe-linear-one-ab", "failsafe-angular-overwritten", "pp-contact-reversed"])
    copySample(join(folder, "class"), mistake);
  // 10 MB of markup on standard output.
  writeScript(
    join(folder, "class"),
    "noisy",
    "l='<script>alert(1)</script><b>&amp;'; i=0; while [ $i -lt 11 ]; do l=$l$l; i=$((i+1)); done\ni=0; while [ $i -lt 160 ]; do echo \"$l\"; i=$((i+1)); done; exit 3",
  );
  writeScript(join(folder, "class"), HOSTILE, "echo '\u202e<svg onload=alert(1)>' >&2; exit 4");
  for (let number = readdirSync(join(folder, "class")).length; number < 300; number++)
    writeScript(join(folder, "class"), `student ${number}`, `exit ${1 + (number % 7)}`);
  grade("class", "--suite", "suite.toml", "--output", "out");
  browser = await launch();
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

const report = (start) =>
  join(
    folder,
    "out/reports",
    readdirSync(join(folder, "out/reports")).find((name) => name.startsWith(start)),
  );

for (const [name, start] of [
  ["accepted", "fosssim-sample.html"],
  ["wrong polynomial", "fosssim-sample.pe-linear"],
  ["wrong failsafe", "fosssim-sample.failsafe"],
  ["10 MB of output", "noisy"],
  ["hostile name", "_img"],
]) {
  test(`${name}: no complaint, no request, accessible in light and dark, text without script`, { skip }, async () => {
    const html = report(start);
    assert.ok(statSync(html).size < 700_000, `${statSync(html).size}`);
    for (const scheme of ["light", "dark"]) {
      const { page, complaints, close } = await openPage(browser, html, { scheme });
      page.on("dialog", () => assert.fail("a dialog"));
      await page.locator("details").evaluateAll((all) => all.forEach((one) => (one.open = true)));
      await checkAccessibility(page);
      assert.equal(await page.locator("img, b, main svg[onload]").count(), 0);
      // The command names the scene in the form that commands accept.
      if (name === "wrong polynomial")
        assert.match(await page.locator("main").innerText(), /detect --scene asset:ContinuousTimeTests\/spinning-edge/);
      assert.deepEqual(complaints, []);
      await close();
    }
    const { page, close } = await openPage(browser, html, { script: false });
    assert.match(
      await page.locator("h1").innerText(),
      name === "accepted" ? /accepted/ : /wrong answer|run-time error/,
    );
    assert.match(await page.locator("main").innerText(), /Groups/);
    await close();
  });
}

test("what a program printed is text, and no more of it than there is room for", { skip }, async () => {
  const { page, close } = await openPage(browser, report("noisy"));
  await page.locator("details").evaluateAll((all) => all.forEach((one) => (one.open = true)));
  const text = await page.getByRole("region", { name: "Standard output" }).first().innerText();
  assert.match(text, /^<script>alert\(1\)<\/script><b>&amp;/);
  assert.match(text, /\[cut short\]$/);
  await close();
});

test("where hints hide what is expected, no table has a lone column", { skip }, async () => {
  writeFileSync(join(folder, "few.toml"), SUITE.replace('hints = "full"', 'hints = "what"'));
  const program = "class/fosssim-sample.pe-linear-one-ab";
  grade(program, "--suite", "few.toml", "--for", "student", "--format", "html=few.html");
  const { page, complaints, close } = await openPage(browser, join(folder, "few.html"));
  await page.locator(".viewer canvas.picture").waitFor();
  assert.equal(await page.getByText("This step in numbers").count(), 0);
  await checkAccessibility(page);
  assert.deepEqual(complaints, []);
  await close();
});

test("a whole diagnosis by keyboard", { skip }, async () => {
  const { page, complaints, close } = await openPage(browser, report("fosssim-sample.failsafe"));
  const tabs = async (wanted, most = 60) => {
    for (let times = 0; times < most; times++) {
      await page.keyboard.press("Tab");
      if (await page.evaluate((wanted) => document.activeElement.matches(wanted), wanted)) return;
    }
    assert.fail(`${wanted} is not reached`);
  };
  // The first card is open at its first wrong step.
  const article = page.locator("article.case").first();
  assert.match(await article.locator(".say").innerText(), /is wrong by itself/);
  const first = await article.locator(".stepbox").inputValue();
  await tabs(".viewer canvas.picture");
  await page.keyboard.press("ArrowLeft");
  assert.equal(Number(await article.locator(".stepbox").inputValue()), Number(first) - 1);
  await page.keyboard.press("n");
  assert.equal(await article.locator(".stepbox").inputValue(), first);
  // After the impulses and before the failsafe, and then the tested pairs.
  await tabs("input[type=checkbox]");
  await page.keyboard.press("Space");
  assert.match(await article.locator(".facts").innerText(), /Impact zones of the reference/);
  await tabs(".matrix summary");
  await page.keyboard.press("Enter");
  await tabs(".pair");
  await page.keyboard.press("Enter");
  await tabs(".numbers summary");
  await page.keyboard.press("Enter");
  assert.match(await article.locator(".numbers").innerText(), /0x[0-9a-f]{16}/);
  // Opening and closing a card.
  await article.locator("details.scene > summary").focus();
  await page.keyboard.press("Enter");
  assert.equal(await article.locator("details.scene").getAttribute("open"), null);
  assert.deepEqual(complaints, []);
  await close();
});

test("a class of three hundred is sorted, searched, and grouped by mistake", { skip }, async (t) => {
  const html = join(folder, "out/index.html");
  const began = performance.now();
  const { page, complaints, close } = await openPage(browser, html);
  t.diagnostic(`class page: ${statSync(html).size} bytes, open after ${Math.round(performance.now() - began)} ms`);
  assert.ok(statSync(html).size < 5_000_000);
  const rows = page.locator("table.sortable").first().locator("tbody tr");
  assert.equal(await rows.count(), 300);
  await page.getByRole("button", { name: "points" }).click();
  assert.match(await rows.first().innerText(), /^fosssim-sample\s+accepted/);
  await page.getByRole("button", { name: "points" }).click();
  assert.match(await rows.last().innerText(), /^fosssim-sample\s+accepted/);
  await page.getByRole("searchbox").fill("pe-linear");
  assert.equal(await rows.filter({ visible: true }).count(), 1);
  // Submissions that end with the same exit code form a cluster.
  assert.ok((await page.locator(".cluster").count()) >= 7);
  await checkAccessibility(page);
  await rows.filter({ visible: true }).getByRole("link").click();
  await page.waitForSelector("html[data-ready]");
  assert.match(await page.locator("h1").innerText(), /pe-linear-one-ab: wrong answer/);
  assert.deepEqual(complaints, []);
  await close();
});

test("a page of eighty scenes that fail stays small", { skip }, async (t) => {
  const program = copySample(folder, "response-halved");
  grade(program, "--hints", "full", "--format", "html=whole.html");
  const html = join(folder, "whole.html");
  assert.ok(statSync(html).size < 3_000_000, `${statSync(html).size}`);
  const began = performance.now();
  const { page, complaints, close } = await openPage(browser, html);
  t.diagnostic(`suite page: ${statSync(html).size} bytes, open after ${Math.round(performance.now() - began)} ms`);
  // Scenes are searched by their texts.
  await page.getByLabel("Filter").fill("Head-On-Equal");
  assert.deepEqual(await page.locator("article.case:visible h3").allInnerTexts(), [
    "wrong answer ContinuousTimeTests/head-on-equal-masses",
  ]);
  await page.getByLabel("Filter").fill("");
  assert.ok((await page.locator("article.case").count()) >= 60);
  assert.deepEqual(complaints, []);
  await close();
  execFileSync("rm", [html]);
});
