// Takes the README's pictures of HTML reports: docs/report.png and docs/class.png.
//   cargo build --release && node tests/browser/pictures.js
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { writeSample } from "./browser.js";

const root = resolve(new URL(".", import.meta.url).pathname, "../..");
const programs = process.env.FOSSSIM_BIN ?? join(root, "target/release");
const folder = mkdtempSync(join(tmpdir(), "fosssim-pictures-"));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu"],
});
try {
  // Paths are relative, so that the pictures do not show the folder.
  const scene = join(root, "assets/t2m2/HolisticTests/balls-in-a-box.xml");
  execFileSync(
    join(programs, "fosssim-sample"),
    ["--mistake", "response-halved", "-s", scene, "-d", "0", "-o", "submission.bin"],
    { cwd: folder },
  );
  const html = join(folder, "report.html");
  spawnSync(
    join(programs, "fosssim-oracle"),
    ["check", "asset:HolisticTests/balls-in-a-box", "submission.bin", "--format", "html", "--output", html],
    { cwd: folder },
  );
  const page = await browser.newPage({ viewport: { width: 1180, height: 800 } });
  await page.goto(pathToFileURL(html).href);
  await page.waitForSelector("html[data-ready]");
  await page.screenshot({ path: join(root, "docs/report.png") });

  // A class of sample programs.
  const students = [
    "ada",
    "bob.response-halved",
    "eve.pe-linear-one-ab",
    "grace.failsafe-angular-overwritten",
    "kim.pe-linear-one-ab",
    "liu",
    "max.pe-square-no-eh",
    "zoe.response-halved",
  ];
  const sources = students.map((student) => {
    const [name, mistake] = student.split(/\.(.*)/);
    const program = join(folder, name, mistake ? `fosssim-sample.${mistake}` : "fosssim-sample");
    mkdirSync(join(folder, name));
    writeSample(program, programs);
    return program;
  });
  spawnSync(join(programs, "fosssim-oracle"), ["grade", ...sources, "--output", join(folder, "out")], { cwd: root });
  await page.setViewportSize({ width: 1180, height: 1000 });
  await page.goto(pathToFileURL(join(folder, "out/index.html")).href);
  await page.waitForSelector("html[data-ready]");
  // Sample programs are named after their mistake, so the name is replaced by the student's.
  await page.locator("a").evaluateAll((links, students) => {
    for (const link of links) {
      const [, name, mistake] = link.textContent.match(/^(?:.*?([a-z]+)\/)?fosssim-sample\.?(.*)$/) ?? [];
      link.textContent =
        name ??
        students.find((student) => mistake && student.endsWith(`.${mistake}`))?.split(".")[0] ??
        link.textContent;
    }
  }, students);
  await page.screenshot({ path: join(root, "docs/class.png") });
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
