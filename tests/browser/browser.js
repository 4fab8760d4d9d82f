// The common parts of the browser tests: the browser, a page with its errors and warnings, and axe-core.
import { strict as assert } from "node:assert";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const root = resolve(new URL(".", import.meta.url).pathname, "../..");
export const programs = resolve(process.env.FOSSSIM_BIN ?? join(root, "target/debug"));
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

export const launch = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });

// Writes a program like a student's: the sample without the mark by which the grader recognizes its own programs.
export function writeSample(path, folder = programs) {
  const bytes = readFileSync(join(folder, "fosssim-sample"));
  bytes.write("FOSSSIM", bytes.indexOf("fosssim-sample, with mistake id \0"));
  writeFileSync(path, bytes, { mode: 0o755 });
}

// Opens a page, and collects its errors, its warnings, and all requests to the network.
export async function openPage(browser, html, { scheme = "light", script = true, hash = "" } = {}) {
  const context = await browser.newContext({
    colorScheme: scheme,
    javaScriptEnabled: script,
    viewport: { width: 1200, height: 1000 },
    bypassCSP: false,
  });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on(
    "request",
    (request) => /^(file|blob|data):/.test(request.url()) || complaints.push(`request ${request.url()}`),
  );
  await page.goto(pathToFileURL(html).href + hash);
  // A page without scenes has no script that becomes ready.
  const isScripted = script && (await page.locator("script").count()) > 0;
  if (isScripted) await page.waitForSelector("html[data-ready]");
  return { page, complaints, close: () => context.close() };
}

// Checks that the page is accessible. The page's policy allows no foreign scripts, so the debugger runs axe-core.
export async function checkAccessibility(page) {
  await page.evaluate(axe + ";0");
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  assert.deepEqual(
    serious.map(
      ({ id, nodes }) =>
        `${id}: ${nodes
          .map((node) => node.html)
          .slice(0, 3)
          .join(" ")}`,
    ),
    [],
  );
}
