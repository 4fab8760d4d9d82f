// Tests the grading server as students and teachers see it: with real processes, Debian's Chromium, and the real
// grader. FOSSSIM_BIN names the folder with fosssim-oracle, fosssim-server and fosssim-sample; CHROMIUM the browser.
import { strict as assert } from "node:assert";
import { spawn, spawnSync } from "node:child_process";
import { linkSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";
import { writeSample } from "./browser.js";

const root = resolve(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "../..");
const programs = process.env.FOSSSIM_BIN ?? join(root, "target/debug");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
// Without a sandbox nothing is graded, so the test is skipped with a reason.
const sandbox = spawnSync(join(programs, "fosssim-oracle"), ["doctor"]).status === 0;
let browser, folder, server, address, link;

before(async () => {
  // The folder is next to the programs, so that links are sufficient.
  folder = mkdtempSync(join(programs, "service-"));
  for (const name of ["fosssim-oracle", "fosssim-server"]) linkSync(join(programs, name), join(folder, name));
  for (const name of ["upload", "suite"]) mkdirSync(join(folder, name));
  writeSample(join(folder, "upload/fosssim-sample.pp-contact-reversed"));
  const suite =
    'schema = 1\nname = "One"\nhints = "full"\n[[group]]\nname = "Contacts"\nscenes = ["asset:ContinuousTimeTests/head-on-equal*"]\npoints = 10\n';
  writeFileSync(join(folder, "suite/suite.toml"), suite);
  assert.equal(
    spawnSync("tar", ["-C", join(folder, "suite"), "-czf", join(folder, "suite.tar.gz"), "suite.toml"]).status,
    0,
  );
  server = spawn(
    join(folder, "fosssim-oracle"),
    ["serve", "--data", join(folder, "data"), "--listen", "127.0.0.1:0", "--workers", "1"],
    { stdio: ["ignore", "pipe", "inherit"] },
  );
  const lines = createInterface({ input: server.stdout })[Symbol.asyncIterator]();
  address = (await lines.next()).value.split(" ").at(-1);
  link = (await lines.next()).value.split(" ").at(-1);
  browser = await chromium.launch({
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
});
after(async () => {
  await browser?.close();
  if (server && server.exitCode === null) {
    const ended = new Promise((done) => server.once("exit", done));
    server.kill("SIGTERM");
    assert.equal(await ended, 0);
  }
  rmSync(folder, { recursive: true, force: true });
});

// Opens a person's browser, which collects errors of pages and requests to other hosts.
async function newPerson({ script = true } = {}) {
  const context = await browser.newContext({
    javaScriptEnabled: script,
    timezoneId: "America/St_Johns",
    viewport: { width: 1200, height: 1000 },
  });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on(
    "request",
    (request) =>
      request.url().startsWith(address) ||
      /^(data|blob):/.test(request.url()) ||
      complaints.push(`request ${request.url()}`),
  );
  return { page, complaints, close: () => context.close() };
}

async function signIn(page, by) {
  await page.goto(by);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByRole("heading", { name: "Courses" }).waitFor();
}

// Checks that the page is not wider than its window.
async function checkWidth(page, places) {
  const before = page.viewportSize();
  for (const width of [1440, 1024, 390]) {
    await page.setViewportSize({ width, height: 900 });
    for (const place of places) {
      await page.goto(address + place);
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `${place} at ${width}`);
    }
  }
  await page.setViewportSize(before);
}

// Checks that the page is accessible, in light and dark.
async function checkAccessibility(page) {
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    await page.evaluate(axe + ";0");
    const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
    const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
    assert.deepEqual(
      serious.map(
        ({ id, nodes }) =>
          `${page.url()} ${id}: ${nodes
            .map((node) => node.html)
            .slice(0, 3)
            .join(" ")}`,
      ),
      [],
    );
  }
}

test("a course from the first link to a regrade", { skip: !sandbox && "no sandbox here" }, async () => {
  const teacher = await newPerson();
  const { page } = teacher;
  await page.goto(`${address}/sign-in`);
  await checkAccessibility(page);
  await signIn(page, link);
  await page.goto(`${address}/admin`);
  await checkAccessibility(page);
  const course = page.locator("form[action='/admin/courses']");
  await course.getByLabel("Name in URLs").fill("physics");
  await course.getByLabel("Title").fill("Physics <b>of</b> spheres");
  await course.getByRole("button").click();
  await page.getByRole("heading", { name: "Physics <b>of</b> spheres" }).waitFor();
  await page.getByLabel("Name in URLs").fill("m1");
  await page.getByLabel("Title").fill("Milestone one");
  await page.getByRole("button", { name: "Create the assignment" }).click();
  await page.getByLabel("Suite file").setInputFiles(join(folder, "suite.tar.gz"));
  await page.getByRole("button", { name: "Upload the suite" }).click();
  assert.match(await page.getByLabel("Suite").locator("option:checked").innerText(), /^One \(uploaded .* UTC\)$/);
  await page.getByLabel("Visible").check();
  await checkAccessibility(page);
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved.").waitFor();
  // A class is imported from a file, which is previewed first.
  await page.goto(`${address}/c/physics/members`);
  const table = { name: "class.csv", mimeType: "text/csv", buffer: Buffer.from("Login,Name,Group\neve,Eve,7\n") };
  await page.getByRole("link", { name: "Import a class" }).click();
  await page.getByLabel("Table").setInputFiles(table);
  await page.getByRole("button", { name: "Preview the file" }).click();
  await page.getByText("Columns that are not used: Group.").waitFor();
  await checkAccessibility(page);
  await page.getByRole("button", { name: "Import these members" }).click();
  await page.getByRole("link", { name: "All links as a table" }).waitFor();
  await page.getByRole("button", { name: "Copy the link of eve" }).waitFor();
  await checkAccessibility(page);
  await page.getByRole("link", { name: "To the members" }).click();
  assert.ok(!(await page.getByLabel("Login", { exact: true }).isVisible()), "one place to add a person");
  await page.getByRole("link", { name: "Add a person" }).click();
  await checkAccessibility(page);
  await page.getByLabel("Login", { exact: true }).fill("ada");
  await page.getByLabel("Name", { exact: true }).fill("Ada");
  await page.getByRole("button", { name: "Add", exact: true }).click();
  const invitation = await page.locator("[role=status] code").innerText();
  // Members are counted, and shown by their role.
  await page.getByText("2 students, 0 staff").waitFor();
  await page.getByLabel("Show").selectOption("staff");
  await page.getByRole("button", { name: "Show", exact: true }).click();
  await page.getByText("No member matches the filter.").waitFor();
  await checkAccessibility(page);

  // A student submits a program with a mistake, watches its state, and reads the report.
  const student = await newPerson();
  await signIn(student.page, invitation);
  await student.page.getByRole("link", { name: "Physics <b>of</b> spheres" }).click();
  await student.page.getByRole("link", { name: "Milestone one", exact: true }).click();
  await checkAccessibility(student.page);
  await student.page.locator("#file").setInputFiles(join(folder, "upload/fosssim-sample.pp-contact-reversed"));
  await student.page.getByRole("button", { name: "Submit" }).click();
  // The page updates itself. From here on, nothing is clicked or loaded again.
  await student.page.locator(".report").waitFor();
  assert.equal(await student.page.locator("#result").innerText(), "wrong answer");
  assert.match(await student.page.locator("h1").innerText(), /0 of 10 points/);
  // The report is a part of the page: it has one heading and no frame, the next step is above it, and the viewer works.
  assert.deepEqual([await student.page.locator("h1").count(), await student.page.locator("iframe").count()], [1, 0]);
  assert.match(
    await student.page.locator("main").innerText(),
    /Next: fix the first mistake in the report[^]*Likely mistake[^]*head-on-equal-masses/,
  );
  await student.page.locator("html[data-ready]").waitFor({ state: "attached" });
  await student.page.locator(".report canvas").first().waitFor();
  await checkAccessibility(student.page);

  // The course page shows the state.
  await student.page.goto(`${address}/c/physics`);
  assert.match(
    await student.page.getByRole("row", { name: /Milestone one/ }).innerText(),
    /wrong answer\s+Submit\s+: Milestone one\s+0 of 10\s+1\s+never/,
  );
  await checkAccessibility(student.page);
  const own = ["/c/physics", "/c/physics/a/m1", "/c/physics/s/1", "/account"];
  await checkWidth(student.page, own);
  // A file that cannot be graded is rejected on the same page, and the next try works.
  await student.page.goto(`${address}/c/physics/a/m1`);
  await student.page
    .locator("#file")
    .setInputFiles({ name: "a.txt", mimeType: "text/plain", buffer: Buffer.from("?") });
  await student.page.getByRole("button", { name: "Submit" }).click();
  await student.page.getByText(/expected a program for Linux/).waitFor();
  assert.ok(await student.page.getByRole("button", { name: "Submit" }).isEnabled());
  student.complaints.splice(0);

  // The essentials work without JavaScript.
  const plain = await newPerson({ script: false });
  await plain.page.goto(`${address}/c/physics`);
  await plain.page.waitForURL(`${address}/sign-in?to=%2Fc%2Fphysics`);
  await plain.close();

  // The home page lists open assignments and their state.
  await student.page.goto(address);
  await student.page.getByRole("link", { name: /Submit.*Milestone one/ }).waitFor();
  await checkAccessibility(student.page);

  // The teacher sees the class, and the changes of a regrade before they are applied.
  await page.goto(`${address}/c/physics/a/m1/class`);
  await page.getByRole("link", { name: "ada, submission 1" }).waitFor();
  // The likely mistakes and their scenes.
  assert.match(
    await page.getByRole("row", { name: /ada, submission 1/ }).innerText(),
    /ada, submission\s+1\s+of 1\s+Particle-particle: \S/,
  );
  // The scenes are also shown as a row of colors.
  assert.match(await page.locator("td.heat svg").getAttribute("aria-label"), /^0 of \d+ scenes accepted$/);
  await checkAccessibility(page);
  // The class can be filtered, and two submissions can be compared.
  await page.getByLabel("Show").selectOption({ label: "no submission (1)" });
  await page.getByRole("button", { name: "Show", exact: true }).click();
  await page.getByRole("rowheader", { name: "Eve" }).waitFor();
  assert.equal(await page.getByRole("link", { name: "ada, submission 1" }).count(), 0);
  await page.goto(`${address}/c/physics/s/1`);
  // The field lists the members, and reports a mistyped login.
  const other = page.getByLabel("Compare with");
  await other.focus();
  await page.waitForFunction(() => document.querySelector("#members [value=ada]")?.label === "Ada");
  await other.fill("adda");
  await page.getByRole("button", { name: "Compare" }).click();
  await page.waitForFunction(() => document.querySelector("input[name=with]:invalid"));
  assert.equal(await other.evaluate((field) => field.validationMessage), "There is no graded submission of adda.");
  assert.equal(await other.inputValue(), "adda");
  teacher.complaints.splice(0);
  await other.fill("ada");
  await page.getByRole("button", { name: "Compare" }).click();
  await page.getByText("Both have the same verdict on every scene").waitFor();
  await checkAccessibility(page);
  // "Back" of an error page returns to the form, which keeps what was typed.
  await page.goto(`${address}/c/physics/s/1`);
  await page.getByText("Points and comment", { exact: true }).click();
  await page.getByLabel("Other points").fill("500");
  await page.getByLabel("Comment").fill("Typed once");
  await page.getByRole("button", { name: "Save points and comment" }).click();
  await page.getByText("points must be a number between 0 and 10").waitFor();
  await page.getByRole("link", { name: "Back" }).click();
  await page.waitForURL(`${address}/c/physics/s/1`);
  assert.equal(await page.locator("#comment").inputValue(), "Typed once");
  assert.ok(await page.locator("#comment").isVisible(), "the form is open");
  teacher.complaints.splice(0);
  await page.goto(`${address}/c/physics/a/m1/class`);
  await page.getByRole("link", { name: "Regrade" }).click();
  await page.getByLabel("Reason").fill("Nobody should fail this");
  await page.getByRole("button", { name: "Regrade all without" }).click();
  await page.waitForURL(/regrades\/\d+$/);
  // The regrade can be applied only after all submissions are graded.
  const [said, applies] = await page.evaluate(() => [
    document.querySelector("[role=status]").innerText,
    document.querySelector("form[action$='/apply']") !== null,
  ]);
  assert.equal(applies, !/still/.test(said), said);
  await page.getByText("1 submission. No grades would change.").waitFor();
  await checkAccessibility(page);
  await page.getByRole("button", { name: "Apply" }).click();
  await page.getByText("applied, by admin").waitFor();
  await student.page.reload();
  await student.page.goto(`${address}/c/physics/s/1`);
  await student.page.getByText("History of the grade").click();
  await student.page.getByText("Nobody should fail this").waitFor();
  const further = [
    "queue",
    "audit",
    "members",
    "members/import",
    "a/m1/class",
    "a/m1/students/ada",
    "a/m1/settings",
    "s/1",
  ];
  const admin = ["", "/people", "/platforms", "/workers", "/log"].map((part) => `/admin${part}`);
  const places = ["/account", "/c/physics", ...further.map((place) => `/c/physics/${place}`), ...admin];
  for (const place of places) {
    await page.goto(address + place);
    await checkAccessibility(page);
  }
  await checkWidth(page, places);
  // On a phone, only the page above is linked.
  await page.setViewportSize({ width: 390, height: 844 });
  for (const [place, above] of [
    ["/c/physics", "Courses"],
    ["/c/physics/members/import", "Physics <b>of</b> spheres"],
    ["/c/physics/a/m1/class", "Physics <b>of</b> spheres"],
    ["/c/physics/a/m1/settings", "Milestone one"],
    ["/c/physics/s/1", "Milestone one"],
  ]) {
    await page.goto(address + place);
    assert.equal(await page.getByLabel("Where you are").innerText(), above, place);
  }
  await page.setViewportSize({ width: 1200, height: 1000 });
  // The log has no codes, and links to submissions.
  await page.goto(`${address}/c/physics/audit`);
  await page.getByText("wrong answer: 0 of 10 points").first().waitFor();
  await page.getByRole("link", { name: "ada, submission 1" }).first().waitFor();
  // A date is typed in the time zone that is set in the form, otherwise in the reader's.
  await page.goto(`${address}/c/physics/a/m1/settings`);
  assert.equal(
    await page.locator("#due-zone-name").innerText(),
    await page.evaluate(() => Intl.DateTimeFormat().resolvedOptions().timeZone),
  );
  // A time zone that does not exist is marked before anything is sent.
  await page.getByLabel("Time zone", { exact: true }).fill("Mars/Base");
  assert.match(
    await page.getByLabel("Time zone", { exact: true }).evaluate((field) => field.validationMessage),
    /Mars/,
  );
  await page.getByLabel("Time zone", { exact: true }).fill("Europe/Berlin");
  await page.getByLabel("Due", { exact: true }).fill("2096-07-01T23:59");
  assert.equal(await page.locator("#due-zone-name").innerText(), "Europe/Berlin");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved.").waitFor();
  await page.goto(`${address}/c/physics/a/m1`);
  const due = await page.locator("time[datetime]").first().getAttribute("datetime");
  assert.equal(new Date(due).getTime(), Date.parse("2096-07-01T21:59Z"));
  // From now on, dates are in the time zone that was set.
  await page.goto(`${address}/c/physics/a/m1/settings`);
  assert.equal(await page.locator("#due-zone-name").innerText(), "Europe/Berlin");
  assert.equal(await page.getByLabel("Due", { exact: true }).inputValue(), "2096-07-01T23:59");
  await page.getByLabel("Due", { exact: true }).fill("2096-12-01T18:00");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved.").waitFor();
  await page.goto(`${address}/c/physics/a/m1`);
  assert.equal(await page.locator("time[datetime]").first().getAttribute("datetime"), "2096-12-01T17:00:00.000+00:00");
  assert.deepEqual(teacher.complaints, []);
  assert.deepEqual(student.complaints, []);
  await teacher.close();
  await student.close();
});

// Tests what the README promises about two commands and an upload, with the programs in one folder, as after a build.
test(
  "the example course takes the program with a mistake that comes with it",
  { skip: !sandbox && "no sandbox here" },
  async () => {
    const place = mkdtempSync(join(programs, "example-"));
    for (const name of ["fosssim-oracle", "fosssim-server"]) linkSync(join(programs, name), join(place, name));
    const example = spawn(
      join(place, "fosssim-oracle"),
      ["serve", "--data", join(place, "course"), "--listen", "127.0.0.1:0", "--example"],
      { stdio: ["ignore", "pipe", "inherit"] },
    );
    try {
      const lines = createInterface({ input: example.stdout })[Symbol.asyncIterator]();
      const word = async () => (await lines.next()).value.split(" ").at(-1);
      const [home, , welcome, flawed] = [await word(), await word(), await word(), await word()];
      const context = await browser.newContext();
      const page = await context.newPage();
      page.setDefaultTimeout(120_000);
      assert.ok(welcome.startsWith(home), welcome);
      await signIn(page, welcome);
      await page.getByRole("link", { name: "Example" }).click();
      await page.getByRole("link", { name: "Theme 2, Milestone 2", exact: false }).first().click();
      await page.locator("#file").setInputFiles(flawed);
      await page.getByRole("button", { name: "Submit" }).click();
      await page.locator(".report").waitFor();
      assert.equal(await page.locator("#result").innerText(), "wrong answer");
      await page.locator("html[data-ready]").waitFor({ state: "attached" });
      assert.match(await page.locator(".report").innerText(), /Likely mistake/i);
      await checkAccessibility(page);
      await context.close();
    } finally {
      const ended = new Promise((done) => example.once("exit", done));
      example.kill("SIGTERM");
      await ended;
      rmSync(place, { recursive: true, force: true });
    }
  },
);
