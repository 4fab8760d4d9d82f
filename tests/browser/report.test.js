// Tests real reports in a real browser: Debian's Chromium, driven by playwright-core. FOSSSIM_BIN names the folder with
// fosssim-oracle and fosssim-sample; CHROMIUM the browser.
import { strict as assert } from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { checkAccessibility, launch, openPage, programs, root } from "./browser.js";

let browser, folder;

const CASES = {
  accepted: ["ContinuousTimeTests/head-on-equal-masses", null],
  polynomial: ["ContinuousTimeTests/spinning-edge-sweeps-balls", "pe-linear-one-ab"],
  contact: ["ContinuousTimeTests/head-on-equal-masses", "pp-contact-reversed"],
  impulses: ["ImpulsesTests/off-centre-on-turning-edge", "decision-alpha-margin"],
  failsafe: ["GeometricTests/pair-becomes-rigid", "failsafe-angular-overwritten"],
  pruned: ["ContinuousTimeTests/spinning-edge-sweeps-balls", "pairs-pruned"],
  missed: ["ContinuousTimeTests/row-struck-in-one-step", "decision-half-step"],
};

function writeReport(name, { traceName = `${name}.bin`, cut = null } = {}) {
  const [scene, mistake] = CASES[name];
  const trace = join(folder, traceName);
  const html = join(folder, `${name}.html`);
  execFileSync(join(programs, "fosssim-sample"), [
    ...(mistake ? ["--mistake", mistake] : []),
    "-s",
    join(root, "assets/t2m2", `${scene}.xml`),
    "-d",
    "0",
    "-o",
    trace,
  ]);
  if (cut) execFileSync("truncate", ["-s", String(cut), trace]);
  const run = spawnSync(
    join(programs, "fosssim-oracle"),
    ["check", join(root, "assets/t2m2", `${scene}.xml`), trace, "--format", "html", "--output", html],
    { encoding: "utf8" },
  );
  assert.ok(run.status === 0 || run.status === 1, run.stderr);
  return html;
}

const openReport = (html, how) => openPage(browser, html, how);

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "fosssim-browser-"));
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

for (const name of Object.keys(CASES)) {
  test(`${name}: no complaint, no request, accessible in light and dark`, async () => {
    const html = writeReport(name);
    assert.ok(statSync(html).size < 700_000);
    for (const scheme of ["light", "dark"]) {
      const { page, complaints, close } = await openReport(html, { scheme });
      await page.locator("details").evaluateAll((all) => all.forEach((one) => (one.open = true)));
      await checkAccessibility(page);
      // The start has no numbers of a step.
      assert.equal(await page.locator(".facts").isVisible(), name !== "accepted");
      assert.deepEqual(complaints, []);
      await close();
    }
  });
}

test("without script the essentials are there", async () => {
  const { page, close } = await openReport(writeReport("polynomial"), { script: false });
  const text = await page.locator("main").innerText();
  for (const words of [/wrong answer/, /Likely mistake/, /First difference/, /differs/, /needs JavaScript/])
    assert.match(text, words);
  assert.ok((await page.locator("figure svg").count()) >= 1);
  await close();
});

test("a wrong failsafe is found by keyboard", async () => {
  const { page, complaints, close } = await openReport(writeReport("failsafe"));
  const step = () => page.locator(".stepbox").inputValue().then(Number);
  const said = () => page.locator(".say").innerText();
  const first = await step();
  assert.match(await said(), /is wrong by itself/);
  assert.match(await said(), /with the named mistake is in the same state, bit for bit/);
  await page.locator(".viewer canvas.picture").focus();
  await page.keyboard.press("n");
  assert.ok((await step()) > first || /no later wrong step/.test(await said()));
  await page.keyboard.press("Home");
  assert.equal(await step(), 0);
  await page.keyboard.press("n");
  assert.equal(await step(), first);
  await page.keyboard.press("ArrowRight");
  assert.equal(await step(), first + 1);
  await page.keyboard.press("Shift+ArrowLeft");
  assert.equal(await step(), Math.max(0, first - 9));
  await page.keyboard.press("p");
  await page.locator(".stepbox").fill(String(first));
  await page.locator(".stepbox").press("Enter");
  assert.equal(await step(), first);
  assert.match(await page.locator(".facts").innerText(), /momentum after the impulses.*momentum after the failsafe/s);
  // The difference is too small or too large to be judged by eye, so the factor is shown.
  assert.match(await page.locator(".viewer").innerText(), /magnified .*times \(largest difference/s);
  assert.deepEqual(complaints, []);
  await close();
});

test("the picture is on the first screen, near the difference, and no width is too small", async () => {
  const { page, complaints, close } = await openReport(writeReport("missed"));
  const top = () =>
    page.locator(".viewer canvas.picture").evaluate((canvas) => canvas.getBoundingClientRect().top + scrollY);
  for (const [width, height] of [
    [1440, 900],
    [1024, 768],
    [390, 844],
  ]) {
    await page.setViewportSize({ width, height });
    // The sentence about the wrong step does the same.
    const said = await page.locator(".say").evaluate((say) => say.getBoundingClientRect().top + scrollY);
    assert.ok(said < height - 20, `${width}: ${said}`);
    assert.ok((await top()) < 0.7 * height, `${width}: ${await top()}`);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `${width}`);
  }
  // The timeline previews a moment. The expected motion can be shown next to the actual one.
  await page.setViewportSize({ width: 1440, height: 900 });
  const picture = () => page.locator(".viewer canvas.picture").evaluate((canvas) => canvas.toDataURL());
  await page.locator(".viewer canvas.picture").focus();
  await page.keyboard.press("z");
  const near = await picture();
  const step = await page.locator(".stepbox").inputValue();
  await page.locator("canvas.strip").hover({ position: { x: 5, y: 5 } });
  assert.match(await page.locator(".preview").innerText(), /^1: /);
  assert.equal(await page.locator(".stepbox").inputValue(), step);
  assert.ok((await picture()) === near);
  await page.locator(".viewer canvas.picture").focus();
  await page.keyboard.press("s");
  assert.equal(await page.getByRole("button", { name: "Side by side" }).getAttribute("aria-pressed"), "true");
  assert.ok((await picture()) !== near);
  await page.keyboard.press("s");
  await page.keyboard.press("0");
  assert.ok((await picture()) !== near);
  await page.keyboard.press("z");
  assert.ok((await picture()) === near);
  // A pointer is dragged along the timeline. The shown moment is under it, and keys continue from there.
  const strip = await page.locator("canvas.strip").boundingBox(),
    steps = Number(await page.locator(".stepbox").getAttribute("max"));
  const over = (step) => [strip.x + (strip.width * (step - 0.5)) / steps, strip.y + 10];
  await page.mouse.move(...over(2));
  await page.mouse.down();
  assert.equal(await page.locator(".stepbox").inputValue(), "2");
  await page.mouse.move(...over(5));
  await page.mouse.up();
  assert.equal(await page.locator(".stepbox").inputValue(), "5");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.locator(".stepbox").inputValue(), "6");
  // The key ? shows and hides the list of all keys.
  assert.equal(await page.locator(".keys").isVisible(), false);
  await page.keyboard.press("?");
  assert.match(await page.locator(".keys").innerText(), /next wrong step.*side by side/s);
  await page.keyboard.press("?");
  assert.equal(await page.locator(".keys").isVisible(), false);
  assert.deepEqual(complaints, []);
  await close();
});

test("a wrong failsafe is told by its state: the digits of a momentum are marked, and no pair is called wrong", async () => {
  const { page, complaints, close } = await openReport(writeReport("failsafe"));
  const row = page.locator(".facts tr", { hasText: "momentum after the failsafe" });
  assert.equal(await row.locator("mark").count(), 1);
  assert.equal(await page.locator(".lights").count(), 0);
  assert.match(await page.locator(".numbers h4").innerText(), /particle 0 after step 6/);
  assert.match(await page.locator(".viewer").innerText(), /yours.*expected from your own state/s);
  assert.deepEqual(complaints, []);
  await close();
});

test("letters of charts are no smaller on a phone", async () => {
  const { page, close } = await openReport(writeReport("failsafe"));
  for (const width of [1440, 390]) {
    await page.setViewportSize({ width, height: 844 });
    // No part is scrolled out of sight.
    const cut = await page.evaluate(() =>
      [...document.querySelectorAll("figure, .scroll, .bar")]
        .filter((box) => box.scrollWidth > box.clientWidth + 1)
        .map((box) => box.outerHTML.slice(0, 120)),
    );
    assert.deepEqual(cut, [], `${width}`);
    const size = await page
      .locator("figure .fp text")
      .first()
      .evaluate((text) => text.getBoundingClientRect().height);
    assert.ok(size > 9 && size < 20, `${width}: ${size}`);
  }
  await close();
});

test("the picture and the plots of polynomials suit a window that becomes narrow", async () => {
  const { page, complaints, close } = await openReport(writeReport("polynomial"));
  const picture = () => page.locator(".viewer canvas.picture").evaluate((canvas) => canvas.toDataURL());
  const wide = await picture();
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForFunction((before) => document.querySelector(".viewer canvas.picture").toDataURL() !== before, wide);
  const redrawn = await picture();
  await page.reload();
  await page.waitForSelector("html[data-ready]");
  assert.equal(redrawn, await picture(), "as if it had been opened narrow");
  // All letters are readable, and no name runs under its bar.
  await page.locator("details").evaluateAll((all) => all.forEach((one) => (one.open = true)));
  const plots = await page.locator(".call figure").evaluateAll((figures) =>
    figures.map((figure) => {
      const texts = [...figure.querySelectorAll("text")];
      const bars = [...figure.querySelectorAll("rect")].map((bar) => bar.getBoundingClientRect());
      const covers = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
      return [
        Math.min(...texts.map((text) => parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().a)),
        texts
          .filter((text) => bars.some((bar) => covers(text.getBoundingClientRect(), bar)))
          .map((text) => text.textContent),
      ];
    }),
  );
  assert.ok(plots.length >= 2, `${plots.length}`);
  for (const [size, covered] of plots) assert.ok(size > 9 && covered.length === 0, `${size} ${covered}`);
  assert.deepEqual(complaints, []);
  await close();
});

test("a step whose impulses are wrong opens after its impulses, where its end would look right", async () => {
  const { page, complaints, close } = await openReport(writeReport("impulses"));
  const after = page.getByRole("checkbox", { name: "after the impulses" });
  assert.ok(await after.isChecked());
  assert.match(
    await page.locator(".say").innerText(),
    /wrong by itself, and shown after its impulses\. The furthest particle is 0\.\d+ from the right position/,
  );
  await after.uncheck();
  assert.match(
    await page.locator(".say").innerText(),
    /Only polynomials or contacts differ: the positions match the expected ones bit for bit/,
  );
  assert.deepEqual(complaints, []);
  await close();
});

test("the picture, its table and the plots show the same moment", async () => {
  const { page, close } = await openReport(writeReport("failsafe"));
  const before = await page.locator(".viewer canvas.picture").evaluate((canvas) => canvas.toDataURL());
  await page.keyboard.press("Home");
  const atStart = await page.locator(".viewer canvas.picture").evaluate((canvas) => canvas.toDataURL());
  assert.notEqual(atStart, before);
  await page.locator("summary", { hasText: "The picture as a table" }).click();
  await page.locator(".viewer canvas.picture").focus();
  await page.keyboard.press("n");
  assert.match(await page.getByText(/^Positions after step/).innerText(), /Positions after step \d+/);
  const step = Number(await page.locator(".stepbox").inputValue());
  const place = await page.locator("figure[data-plot] svg .cursor").first().getAttribute("x1");
  const [left, right, steps] = await page
    .locator("figure[data-plot]")
    .first()
    .evaluate((figure) => [Number(figure.dataset.left), Number(figure.dataset.right), Number(figure.dataset.steps)]);
  assert.ok(Math.abs(Number(place) - (left + ((step - 1) / (steps - 1)) * (right - left))) < 1e-6);
  await close();
});

test("a pair is chosen, its numbers are exact, and a command line reproduces it", async () => {
  const { page, close } = await openReport(writeReport("polynomial"));
  await page.locator("summary", { hasText: "Pairs" }).click();
  await page.locator("td.differs button").first().click();
  await page.locator("summary", { hasText: "To the last bit" }).click();
  const numbers = await page.locator(".numbers").innerText();
  assert.match(numbers, /0x[0-9a-f]{16}/);
  const command = await page.locator(".numbers code").first().innerText();
  const run = spawnSync("sh", ["-c", command.replace(/^fosssim-oracle/, `'${join(programs, "fosssim-oracle")}'`)], {
    encoding: "utf8",
  });
  assert.equal(run.status, 0, run.stderr);
  assert.match(run.stdout, /overlap/);
  await close();
});

test("a pair that is left out lights up, is selected, and is told with its calls", async () => {
  const { page, complaints, close } = await openReport(writeReport("pruned"));
  assert.match(await page.locator(".lights").innerText(), /Wrong pairs: particle 0 - particle 1: not tested/);
  assert.match(await page.locator(".numbers h4").innerText(), /particle 0 - particle 1/);
  const cell = page.locator(".pairs td.differs button").first();
  assert.equal(await cell.innerText(), "0/1!");
  assert.match(await cell.getAttribute("aria-label"), /0 of 1 calls, not tested/);
  await page.locator(".lights button").nth(1).click();
  assert.match(await page.locator(".numbers h4").innerText(), /particle 0 - particle 2/);
  // Its curves are on the page, without neighbors.
  assert.match(
    await page.locator("section[data-pair]").first().innerText(),
    /Your trace contains no polynomials of this pair/,
  );
  assert.deepEqual(complaints, []);
  await close();
});

test("a contact that is missing lights up; findings and calls lead into the motion", async () => {
  const { page, complaints, close } = await openReport(writeReport("missed"));
  assert.match(await page.locator(".lights").innerText(), /particle 0 - particle 1: its contact is missing/);
  await page.locator(".stepbox").fill("3");
  await page.locator(".stepbox").press("Enter");
  await page.getByRole("button", { name: "Show step 1 in the motion" }).first().click();
  assert.equal(await page.locator(".stepbox").inputValue(), "1");
  await page.locator("summary", { hasText: "To the last bit" }).click();
  assert.match(await page.locator(".numbers").innerText(), /contact's time of impact\s+0\.50\d+.*\s+none/);
  assert.deepEqual(complaints, []);
  await close();
});

test("a link leads to a moment", async () => {
  const html = writeReport("failsafe");
  const scene = join(root, "assets/t2m2", `${CASES.failsafe[0]}.xml`);
  const { page, close } = await openReport(html, { hash: `#${new URLSearchParams({ scene, step: 3, t: 0.25 })}` });
  assert.equal(await page.locator(".stepbox").inputValue(), "3");
  assert.equal(await page.locator("output").first().innerText(), "0.250");
  await close();
});

test("a motion that is too large is rounded, and the page says so", async (t) => {
  const bodies = [...Array(180).keys()].map(
    (k) =>
      `<particle m="1" px="${k % 15}.1${k}" py="${Math.floor(k / 15)}.2${k}" vx="${Math.sin(k)}" vy="${Math.cos(k)}" fixed="0" radius="0.1"/>`,
  );
  const scene = (gravity) =>
    `<scene><duration time="8"/><integrator type="symplectic-euler" dt="0.01"/>${bodies.join("\n")}<simplegravity fx="0" fy="${gravity}"/></scene>`;
  const [right, wrong, trace, html] = ["large.xml", "other.xml", "large.bin", "large.html"].map((name) =>
    join(folder, name),
  );
  writeFileSync(right, scene(-1));
  writeFileSync(wrong, scene(-1.001));
  execFileSync(join(programs, "fosssim-sample"), ["-s", wrong, "-d", "0", "-o", trace]);
  spawnSync(join(programs, "fosssim-oracle"), ["check", right, trace, "--format", "html", "--output", html]);
  assert.ok(statSync(html).size < 3_000_000, `${statSync(html).size}`);
  t.diagnostic(`180 bodies, 800 steps: ${statSync(html).size} bytes`);
  const { page, complaints, close } = await openReport(html);
  assert.match(
    await page.locator(".viewer .hint").first().innerText(),
    /too large for this page: positions are rounded to .* The records around these steps are exact: 0, 1/,
  );
  // The shown values are exact, and distant ones are approximate.
  assert.match(
    await page.locator(".say").innerText(),
    /Step 1 of 800 is wrong by itself\. The furthest particle is 1e-7 from the right position/,
  );
  await page.locator(".stepbox").fill("800");
  await page.locator(".stepbox").press("Enter");
  // Half of 0.001 times 8 squared.
  const furthest = Number(
    (await page.locator(".say").innerText()).match(/furthest particle is ([\d.]+) from the reference/)[1],
  );
  assert.ok(Math.abs(furthest - 0.032) < 0.001, `${furthest}`);
  assert.deepEqual(complaints, []);
  await close();
});

test("a still and a clip are saved", async () => {
  const { page, complaints, close } = await openReport(writeReport("contact"));
  const saved = async (name) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name }).click()]);
    return [download.suggestedFilename(), readFileSync(await download.path())];
  };
  await page.locator("details.save summary").click();
  const [still, png] = await saved("PNG");
  assert.match(still, /^step-\d+\.png$/);
  assert.deepEqual([...png.subarray(0, 8)], [137, 80, 78, 71, 13, 10, 26, 10]);
  const [clip, film] = await saved("Clip");
  assert.equal(clip, "motion.webm");
  // Matroska's first four bytes.
  assert.deepEqual([...film.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3]);
  assert.ok(film.length > 1000, `${film.length}`);
  assert.deepEqual(complaints, []);
  await close();
});

test("who asks for little motion gets a step a second", async () => {
  const { page, close } = await openReport(writeReport("failsafe"));
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.keyboard.press("Home");
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => Number(document.querySelector(".stepbox").value) >= 1);
  assert.ok(Number(await page.locator(".stepbox").inputValue()) <= 2);
  await close();
});

test("what is copied as a scene shows the same mistake when it is run", async () => {
  const { page, complaints, close } = await openReport(writeReport("failsafe"));
  await page.evaluate(() => {
    window.copied = "";
    document.execCommand = () => {
      window.copied = document.activeElement.value ?? "";
      return true;
    };
    Object.defineProperty(navigator, "clipboard", { value: undefined });
  });
  await page.getByRole("button", { name: "Copy as scene" }).click();
  writeFileSync(join(folder, "case.xml"), await page.evaluate(() => window.copied));
  const commands = await page.locator(".numbers code").last().innerText();
  // The shown command, with the sample instead of the student's program.
  const run = spawnSync(
    "sh",
    [
      "-c",
      commands
        .replace("./FOSSSim", `'${join(programs, "fosssim-sample")}' --mistake failsafe-angular-overwritten`)
        .replace("fosssim-oracle", `'${join(programs, "fosssim-oracle")}'`),
    ],
    { encoding: "utf8", cwd: folder },
  );
  assert.equal(run.status, 1, run.stdout + run.stderr);
  assert.match(run.stdout, /The angular momentum is overwritten/);
  assert.deepEqual(complaints, []);
  await close();
});

test("a trace that is cut opens at its last step, and says why it ends", async () => {
  const { page, complaints, close } = await openReport(writeReport("contact", { cut: 1501 }));
  assert.match(await page.locator(".mistakes").innerText(), /Stopped at step \d+ of.*the trace ends/s);
  assert.ok(Number(await page.locator(".stepbox").inputValue()) > 0);
  assert.deepEqual(complaints, []);
  await close();
});

test("hostile names are text, and a damaged trace has its page", async () => {
  const { page, complaints, close } = await openReport(
    writeReport("contact", { traceName: "<img src=x onerror=alert(1)>'\"\u202e.bin", cut: 1501 }),
  );
  page.on("dialog", () => assert.fail("a dialog"));
  assert.equal(await page.locator("img").count(), 0);
  assert.match(await page.locator(".names").innerText(), /<img src=x onerror=alert\(1\)>/);
  assert.ok(!(await page.content()).includes("\u202e"), "nothing turns the direction of writing");
  assert.deepEqual(complaints, []);
  await close();
});

test("a picture is saved as a drawing, and bodies as a scene that has the same case", async () => {
  const { page, complaints, close } = await openReport(writeReport("contact"));
  await page.locator("details.save summary").click();
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "SVG" }).click(),
  ]);
  assert.match(download.suggestedFilename(), /^step-\d+\.svg$/);
  const svg = readFileSync(await download.path(), "utf8");
  assert.match(svg, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg" viewBox="0 0 960 540"/);
  assert.ok((svg.match(/<path/g) ?? []).length > 8 && !svg.includes("NaN"), svg);
  // A click selects a contact. Its numbers are shown, and its bodies can be saved as a scene that the program accepts.
  const canvas = page.locator(".viewer canvas.picture");
  await page.evaluate(() => {
    window.copied = "";
    document.execCommand = () => {
      window.copied = document.activeElement.value ?? "";
      return true;
    };
    Object.defineProperty(navigator, "clipboard", { value: undefined });
  });
  const spot = await canvas.evaluate((canvas) => {
    const box = canvas.getBoundingClientRect();
    return [box.width / canvas.width, box.height / canvas.height];
  });
  const contact = svg.match(/<path d="M([\d.]+) ([\d.]+)h12v12h-12Z"/);
  assert.ok(contact, svg);
  await canvas.click({ position: { x: (Number(contact[1]) + 6) * spot[0], y: (Number(contact[2]) + 6) * spot[1] } });
  assert.match(await page.locator(".numbers").innerText(), /particle 0 - particle 1/);
  assert.match(await page.locator(".numbers").innerText(), /contact's normal x\s+0\.5/);
  await page.getByRole("button", { name: "Copy as scene" }).click();
  const scene = await page.evaluate(() => window.copied);
  const file = join(folder, "case.xml");
  writeFileSync(file, scene);
  const run = spawnSync(
    join(programs, "fosssim-oracle"),
    ["detect", "--scene", file, "--step", "1", "--pair", "pp:0,1", "--format", "json"],
    { encoding: "utf8" },
  );
  assert.equal(run.status, 0, `${run.stderr}\n${scene}`);
  // The contact is at the same time there.
  const { answer } = JSON.parse(run.stdout);
  await page.locator("summary", { hasText: "To the last bit" }).click();
  const told = (await page.getByRole("region", { name: "Exact numbers" }).innerText()).match(
    /contact's time of impact\s+([\d.e-]+)/,
  );
  assert.ok(answer.collides && Math.abs(answer.time - Number(told[1])) < 1e-9, `${run.stdout}\n${told}`);
  assert.deepEqual(complaints, []);
  await close();
});
