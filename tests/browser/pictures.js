// Takes the README's picture of an HTML report: docs/report.png.
//   cargo build --release && node tests/browser/pictures.js
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const root = resolve(new URL(".", import.meta.url).pathname, "../..");
const programs = process.env.FOSSSIM_BIN ?? join(root, "target/release");
const folder = mkdtempSync(join(tmpdir(), "fosssim-pictures-"));
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
try {
  const scene = "assets/HolisticTests/balls-in-a-box.xml";
  const trace = join(folder, "submission.bin");
  execFileSync(join(programs, "fosssim-sample"), ["--mistake", "response-halved", "-s", join(root, scene), "-d", "0", "-o", trace]);
  const html = join(folder, "report.html");
  spawnSync(join(programs, "fosssim-oracle"), ["check", scene, trace, "--format", "html", "--output", html], { cwd: root });
  const page = await browser.newPage({ viewport: { width: 1180, height: 1480 } });
  await page.goto(pathToFileURL(html).href);
  await page.waitForSelector("html[data-ready]");
  // The temporary folder is nobody's business.
  await page.locator(".names").evaluate((names) => { names.innerText = names.innerText.replace(/trace .*\//, "trace "); });
  await page.screenshot({ path: join(root, "docs/report.png") });
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
