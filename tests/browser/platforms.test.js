// Tests signing in from a learning platform in Debian's Chromium: a frame in a page of another origin, a window of its
// own, the form by which the platform answers, and what staff chooses. The platform is a small one, with a key of its
// own. FOSSSIM_BIN names the folder with fosssim-server and fosssim-oracle; CHROMIUM the browser.
import { strict as assert } from "node:assert";
import { spawn } from "node:child_process";
import { createPublicKey, generateKeyPairSync, sign, verify } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";

const root = resolve(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "../..");
const programs = process.env.FOSSSIM_BIN ?? join(root, "target/debug");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const { privateKey, publicKey } = generateKeyPairSync("rsa", { modulusLength: 2048 });
const CLAIM = "https://purl.imsglobal.org/spec/lti/claim";
const LINKING = "https://purl.imsglobal.org/spec/lti-dl/claim";
let browser, folder, server, address, link, platform, place;
// The person who is signed in on the platform, the page that they open, and the received answers.
let visit, answered;

const base64 = (value) => Buffer.from(typeof value === "string" ? value : JSON.stringify(value)).toString("base64url");
const escape = (text) => text.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");

function message(nonce) {
  const now = Math.floor(Date.now() / 1000);
  const claims = {
    iss: place,
    aud: "client",
    sub: visit.subject,
    name: visit.name,
    nonce,
    iat: now,
    exp: now + 300,
    [`${CLAIM}/version`]: "1.3.0",
    [`${CLAIM}/deployment_id`]: "1",
    [`${CLAIM}/message_type`]: "LtiResourceLinkRequest",
    [`${CLAIM}/roles`]: [`http://purl.imsglobal.org/vocab/lis/v2/membership#${visit.role}`],
    [`${CLAIM}/context`]: { id: "c", label: "PHYS 1", title: "Physics" },
    [`${CLAIM}/resource_link`]: { id: "link", title: "First milestone" },
    [`${CLAIM}/target_link_uri`]: `${address}/lti/launch`,
    ...visit.more,
  };
  const text = `${base64({ alg: "RS256", kid: "key" })}.${base64(claims)}`;
  return `${text}.${sign("sha256", Buffer.from(text), privateKey).toString("base64url")}`;
}

async function respond(request, response) {
  const url = new URL(request.url, place);
  const html = (text) =>
    response
      .writeHead(200, { "content-type": "text/html" })
      .end(`<!doctype html><html lang="en"><title>Platform</title>${text}`);
  if (url.pathname === "/keys") {
    return response
      .writeHead(200, { "content-type": "application/json" })
      .end(
        JSON.stringify({ keys: [{ ...publicKey.export({ format: "jwk" }), kid: "key", alg: "RS256", use: "sig" }] }),
      );
  }
  const begin = `${address}/lti/login?${new URLSearchParams({ iss: place, login_hint: "somebody", lti_message_hint: "a message", target_link_uri: `${address}/lti/launch`, client_id: "client" })}`;
  if (url.pathname === "/course")
    return html(`<iframe title="The tool" width="900" height="600" src="${escape(begin)}"></iframe>`);
  if (url.pathname === "/open") return response.writeHead(302, { location: begin }).end();
  if (url.pathname === "/auth") {
    const asked = url.searchParams;
    assert.deepEqual([asked.get("login_hint"), asked.get("lti_message_hint")], ["somebody", "a message"]);
    const fields = { state: asked.get("state"), id_token: message(asked.get("nonce")) };
    const inputs = Object.entries(fields).map(
      ([name, value]) => `<input type="hidden" name="${name}" value="${escape(value)}">`,
    );
    return html(
      `<form method="post" action="${escape(asked.get("redirect_uri"))}">${inputs.join("")}</form><script>document.forms[0].submit()</script>`,
    );
  }
  if (url.pathname === "/return") {
    let body = "";
    for await (const chunk of request) body += chunk;
    answered = new URLSearchParams(body).get("JWT");
    return html("<h1>The link is there</h1>");
  }
  return response.writeHead(404).end();
}

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "fosssim-platforms-"));
  server = spawn(
    join(programs, "fosssim-server"),
    ["serve", "--data", join(folder, "data"), "--listen", "127.0.0.1:0", "--workers", "0", "--lti-over-http"],
    { stdio: ["ignore", "pipe", "inherit"] },
  );
  const lines = createInterface({ input: server.stdout })[Symbol.asyncIterator]();
  address = (await lines.next()).value.split(" ").at(-1);
  link = (await lines.next()).value.split(" ").at(-1);
  platform = createServer((request, response) =>
    respond(request, response).catch((error) => response.writeHead(500).end(String(error))),
  );
  await new Promise((listening) => platform.listen(0, "127.0.0.1", listening));
  place = `http://127.0.0.1:${platform.address().port}`;
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
  platform?.close();
  if (server && server.exitCode === null) {
    const ended = new Promise((done) => server.once("exit", done));
    server.kill("SIGTERM");
    assert.equal(await ended, 0);
  }
  rmSync(folder, { recursive: true, force: true });
});

async function newPerson() {
  const context = await browser.newContext();
  const complaints = [];
  // Only messages about the server's pages, because the platform's pages have no icon.
  const isOurs = (message) => message.type() === "error" && message.location().url.startsWith(address);
  context.on("console", (message) => isOurs(message) && complaints.push(message.text()));
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  return { page, context, complaints };
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

test("a course of a platform, from its registration to a link in it", async () => {
  const admin = await newPerson();
  await admin.page.goto(link);
  await admin.page.getByRole("button", { name: "Sign in" }).click();
  await admin.page.goto(`${address}/admin/platforms`);
  const form = admin.page.locator("form[action='/admin/platforms']");
  // Moodle's addresses are derived from its host, and folded. Others are typed.
  await form.getByLabel("Platform", { exact: true }).selectOption("moodle");
  await form.getByLabel("Its host").fill("moodle.example.org");
  assert.equal(await form.getByLabel("Public keyset").inputValue(), "https://moodle.example.org/mod/lti/certs.php");
  assert.ok(!(await form.getByLabel("Public keyset").isVisible()));
  await form.getByText("Its URLs").click();
  for (const [label, value] of [
    ["Name here", "lms"],
    ["Issuer", place],
    ["Client ID", "client"],
    ["Authentication request", `${place}/auth`],
    ["Access token", `${place}/token`],
    ["Public keyset", `${place}/keys`],
    ["Deployment", "1"],
  ]) {
    await form.getByLabel(label).fill(value);
  }
  await form.getByRole("button").click();
  await admin.page.getByRole("cell", { name: place, exact: true }).waitFor();
  await admin.page.getByRole("button", { name: "Copy Initiate login" }).click();
  await admin.page.getByRole("button", { name: "Copied" }).waitFor();
  await checkAccessibility(admin.page);

  // In a frame there is a link, which continues in a new window.
  visit = { subject: "teacher-1", name: "Tea Cher", role: "Instructor" };
  const teacher = await newPerson();
  await teacher.page.goto(`${place}/course`);
  const popup = teacher.context.waitForEvent("page");
  await teacher.page.frameLocator("iframe").getByRole("link", { name: "Open the grading server" }).click();
  const page = await popup;
  page.setDefaultTimeout(120_000);
  await page.getByRole("heading", { name: "Which course is this?" }).waitFor();
  await checkAccessibility(page);
  assert.equal(await page.getByLabel("Name in URLs").inputValue(), "phys-1");
  await page.getByRole("button", { name: "Create the course" }).click();
  // There is no assignment yet, so it is created during the choice.
  await page.getByLabel("Title").fill("Milestone one");
  await checkAccessibility(page);
  await page.getByRole("button", { name: "Create the assignment, and choose it" }).click();
  await page.getByRole("heading", { name: "Milestone one" }).waitFor();
  await page.getByText("The platform's link now opens this assignment.").waitFor();
  await page.getByRole("link", { name: "Settings" }).click();
  await page.getByLabel("Visible").check();
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByText("Saved.").waitFor();

  // A student reaches it directly, in a window of the platform.
  visit = { subject: "student-1", name: "Stu Dent", role: "Learner" };
  const student = await newPerson();
  await student.page.goto(`${place}/open`);
  await student.page.getByRole("heading", { name: "Milestone one" }).waitFor();
  assert.equal(await student.page.getByRole("link", { name: "stu.dent" }).count(), 1);
  assert.equal(await student.page.getByRole("link", { name: "Settings" }).count(), 0);
  // The teacher, in another browser, is still the teacher.
  await page.reload();
  await page.getByRole("link", { name: "Settings" }).waitFor();

  // A chosen link is sent to the platform as a form that the server signed.
  visit = {
    subject: "teacher-1",
    name: "Tea Cher",
    role: "Instructor",
    more: {
      [`${CLAIM}/message_type`]: "LtiDeepLinkingRequest",
      [`${LINKING}/deep_linking_settings`]: {
        deep_link_return_url: `${place}/return`,
        accept_types: ["ltiResourceLink"],
        data: "kept",
      },
    },
  };
  await teacher.page.goto(`${place}/open`);
  await teacher.page.getByRole("radio", { name: /Milestone one/ }).check();
  await checkAccessibility(teacher.page);
  await teacher.page.getByRole("button", { name: "Choose it", exact: true }).click();
  await teacher.page.getByRole("heading", { name: "The link is there" }).waitFor();
  const [header, claims, signature] = answered.split(".");
  const { keys } = await (await fetch(`${address}/lti/keys.json`)).json();
  const { kid } = JSON.parse(Buffer.from(header, "base64url"));
  const key = createPublicKey({ key: keys.find((known) => known.kid === kid), format: "jwk" });
  assert.ok(verify("sha256", Buffer.from(`${header}.${claims}`), key, Buffer.from(signature, "base64url")));
  const said = JSON.parse(Buffer.from(claims, "base64url"));
  assert.equal(said[`${LINKING}/data`], "kept");
  assert.deepEqual(teacher.complaints, []);
  assert.deepEqual(said[`${LINKING}/content_items`][0].custom, { assignment: "milestone-one" });
});
