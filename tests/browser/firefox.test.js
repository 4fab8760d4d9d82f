// Tests the page in Firefox: its recordings and reports equal the program's bit for bit. Firefox is driven by WebDriver
// BiDi, which Debian's Firefox supports. FOSSSIM_PAGE names the page, FOSSSIM_BIN the programs, FIREFOX the browser.
import { strict as assert } from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test as node } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";
import { programs, root } from "./browser.js";

const html = resolve(process.env.FOSSSIM_PAGE ?? join(root, "target/page/oracle.html"));
const onPath = process.env.PATH.split(":").flatMap((folder) =>
  ["firefox-esr", "firefox"].map((name) => join(folder, name)),
);
const executablePath = process.env.FIREFOX ?? ["/usr/bin/firefox-esr", ...onPath].find((path) => existsSync(path));
const without =
  executablePath && existsSync(executablePath)
    ? false
    : `there is no ${executablePath ?? "firefox-esr or firefox on PATH"}: FIREFOX names one`;
const skip = existsSync(html) ? without : `there is no ${html}: scripts/browser-page makes it`;
const test = (name, run) => node(name, { skip }, run);

let browser, folder;
before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "fosssim-firefox-"));
  const extraPrefsFirefox = {
    "browser.download.folderList": 2,
    "browser.download.dir": folder,
    "browser.download.useDownloadDir": true,
  };
  browser = await puppeteer.launch({
    browser: "firefox",
    executablePath,
    headless: true,
    extraPrefsFirefox,
    protocolTimeout: 300_000,
  });
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

async function openPage() {
  const page = await browser.newPage(),
    complaints = [];
  page.on("console", (message) => ["error", "warn"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(pathToFileURL(html).href);
  await waitUntil(() => page.evaluate(() => "ready" in document.documentElement.dataset), "the page is ready");
  return { page, complaints };
}

// The page's policy forbids functions that are created from text, which puppeteer's own waiting needs.
async function waitUntil(holds, what) {
  for (const end = Date.now() + 60_000; Date.now() < end; await sleep(50)) if (await holds()) return;
  assert.fail(`${what}: not within a minute`);
}

// While it saves, Firefox writes `x.html.part` next to an empty `x.html`.
async function saveFile(page, button, file) {
  const path = join(folder, file);
  await (await page.$(button)).click();
  await waitUntil(() => existsSync(path) && readFileSync(path).length > 0 && !existsSync(`${path}.part`), file);
  return readFileSync(path, "utf8");
}

for (const [name, mistake] of [
  ["ContinuousTimeTests/head-on-equal-masses", null],
  ["GeometricTests/pair-becomes-rigid", "failsafe-angular-overwritten"],
  ["ContinuousTimeTests/spinning-edge-sweeps-balls", "pe-linear-one-ab"],
  ["ContinuousTimeTests/row-struck-in-one-step", "decision-half-step"],
  ["ContinuousTimeTests/head-on-equal-masses", "pp-contact-reversed"],
  ["ImpulsesTests/off-centre-on-turning-edge", "decision-alpha-margin"],
]) {
  test(`Firefox, ${mistake ?? "no mistake"}: the page's files are the program's, byte for byte`, async () => {
    const trace = `${mistake ?? "right"}.bin`;
    execFileSync(join(programs, "fosssim-sample"), [
      ...(mistake ? ["--mistake", mistake] : []),
      "-s",
      join(root, "assets/t2m2", `${name}.xml`),
      "-d",
      "0",
      "-o",
      join(folder, trace),
    ]);
    const { page, complaints } = await openPage();
    await (await page.$("#pick")).uploadFile(join(folder, trace));
    await waitUntil(
      () => page.evaluate(() => document.documentElement.dataset.checked === "1"),
      "the trace is checked",
    );
    assert.match(await page.$eval("#said", (said) => said.textContent), mistake ? /: wrong answer/ : /: accepted/);
    for (const format of ["html", "json"]) {
      const own = spawnSync(join(programs, "fosssim-oracle"), ["check", `asset:${name}`, trace, "--format", format], {
        encoding: "utf8",
        cwd: folder,
        maxBuffer: 1 << 28,
      });
      assert.equal(own.status, mistake ? 1 : 0, own.stderr);
      const file = await saveFile(page, `#save-${format}`, trace.replace(".bin", `.${format}`));
      assert.ok(file === own.stdout, `${format} differs: ${file.length} and ${own.stdout.length} characters`);
    }
    assert.deepEqual(complaints, []);
    await page.close();
  });
}

test("Firefox: all scenes have the same recordings as natively", async (t) => {
  const { page } = await openPage();
  const names = ["t1m1", "t1m2", "t1m3", "t2m1", "t2m2", "t2m3"].flatMap((assignment) =>
    readdirSync(join(root, "assets", assignment), { withFileTypes: true })
      .filter((one) => one.isDirectory())
      .flatMap(({ name: group }) =>
        readdirSync(join(root, "assets", assignment, group)).map((file) => `${group}/${file.replace(".xml", "")}`),
      ),
  );
  // Use the page's worker and module directly, because its script exports nothing.
  await page.evaluate(async () => {
    const worker = new Worker(URL.createObjectURL(new Blob([document.getElementById("worker").textContent])));
    const packed = Uint8Array.from(atob(document.getElementById("module").textContent.trim()), (c) => c.charCodeAt(0));
    const module = await WebAssembly.compile(
      await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"))).arrayBuffer(),
    );
    window.ask = (request, blobs = []) =>
      new Promise((resolve, reject) => {
        worker.onmessage = ({ data }) => {
          if (data.error) reject(new Error(data.error));
          else if (data.value) resolve(data.parts);
        };
        worker.postMessage({ id: 0, request, blobs, files: [], module });
      });
  });
  const digest = async (name) => {
    const [xml] = await window.ask({ do: "scene", name });
    await window.ask({ do: "simulate", scene: name }, [xml]);
    const [trace] = await window.ask({ do: "trace" });
    return [...new Uint8Array(await crypto.subtle.digest("SHA-256", trace))]
      .map((byte) => byte.toString(16).padStart(2, "0"))
      .join("");
  };
  for (const name of names) {
    const own = spawnSync(join(programs, "fosssim-oracle"), ["simulate", `asset:${name}`, "--output", "-", "--quiet"], {
      maxBuffer: 1 << 28,
    });
    assert.equal(await page.evaluate(digest, name), createHash("sha256").update(own.stdout).digest("hex"), name);
  }
  t.diagnostic(`${names.length} scenes recorded`);
  await page.close();
});
