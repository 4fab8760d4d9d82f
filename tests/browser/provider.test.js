// Tests signing in at an OpenID Connect provider in Debian's Chromium. The provider is `oidc-provider`, which its
// authors had certified. FOSSSIM_BIN names the folder with fosssim-server and fosssim-oracle; CHROMIUM the browser.
import { strict as assert } from "node:assert";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { Provider } from "oidc-provider";
import { checkAccessibility, launch, programs } from "./browser.js";

let browser, folder, server, address, link, web;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "fosssim-provider-"));
  web = createServer();
  await new Promise((listening) => web.listen(0, "127.0.0.1", listening));
  // The provider is on another site than the server, so cookies are not shared.
  const issuer = `http://localhost:${web.address().port}`;
  const options = ["--listen", "127.0.0.1:0", "--workers", "0", "--oidc-issuer", issuer, "--oidc-client", "grades"];
  server = spawn(
    join(programs, "fosssim-server"),
    ["serve", "--data", join(folder, "data"), ...options, "--oidc-label", "Uni", "--oidc-domain", "uni.example"],
    { stdio: ["ignore", "pipe", "inherit"], env: { ...process.env, FOSSSIM_OIDC_SECRET: "a secret & more" } },
  );
  const lines = createInterface({ input: server.stdout })[Symbol.asyncIterator]();
  address = (await lines.next()).value.split(" ").at(-1);
  link = (await lines.next()).value.split(" ").at(-1);
  const provider = new Provider(issuer, {
    clients: [
      {
        client_id: "grades",
        client_secret: "a secret & more",
        redirect_uris: [`${address}/sign-in/provider/answer`],
      },
    ],
    claims: { openid: ["sub"], email: ["email", "email_verified"], profile: ["name"] },
    pkce: { required: () => true },
    // The provider names people by their addresses.
    findAccount: (_, id) => ({
      accountId: id,
      claims: () => ({ sub: id, name: `The ${id}`, email: id, email_verified: !id.startsWith("new") }),
    }),
  });
  web.on("request", provider.callback());
  browser = await launch();
});
after(async () => {
  await browser?.close();
  web?.closeAllConnections();
  web?.close();
  if (server && server.exitCode === null) {
    const ended = new Promise((done) => server.once("exit", done));
    server.kill("SIGTERM");
    assert.equal(await ended, 0);
  }
  rmSync(folder, { recursive: true, force: true });
});

async function newPerson() {
  const context = await browser.newContext();
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  return page;
}

async function signInAtProvider(page, id) {
  await page.locator("input[name=login]").fill(id);
  await page.locator("input[name=password]").fill("x");
  await page.locator("button[type=submit]").click();
  await page.locator("form[action*=interaction] button[type=submit]").click();
}

test("people sign in where their organization has them do so", async () => {
  const admin = await newPerson();
  await admin.goto(link);
  await admin.getByRole("button", { name: "Sign in" }).click();
  await admin.goto(`${address}/admin`);
  const course = admin.locator("form[action='/admin/courses']");
  await course.getByLabel("Name in URLs").fill("physics");
  await course.getByLabel("Title").fill("Physics");
  await course.getByRole("button").click();
  await admin.goto(`${address}/c/physics/members`);
  await admin.getByLabel("Login", { exact: true }).fill("ada");
  await admin.getByLabel("Name", { exact: true }).fill("Ada");
  await admin.getByRole("button", { name: "Add", exact: true }).click();
  await admin.getByText("Change ada").click();
  await admin.getByRole("button", { name: "New link for ada" }).waitFor();

  // A member reaches the requested page, and needs no link.
  const ada = await newPerson();
  await ada.goto(`${address}/c/physics`);
  await checkAccessibility(ada);
  await ada.getByRole("link", { name: "Sign in with Uni" }).click();
  await signInAtProvider(ada, "ada@uni.example");
  await ada.waitForURL(`${address}/c/physics`);
  await ada.getByRole("heading", { name: "Physics" }).waitFor();
  const cookies = await ada.context().cookies(address);
  assert.ok(cookies.every(({ httpOnly, sameSite }) => httpOnly && sameSite === "Lax"));
  await ada.goto(`${address}/account`);
  await ada.getByText("You sign in with Uni").waitFor();
  await checkAccessibility(ada);

  // After a sign-out on the server, the person is still signed in at the provider, so one click signs them in again.
  await ada.getByRole("button", { name: "Sign out" }).click();
  await ada.waitForURL(`${address}/sign-in`);
  await ada.goto(`${address}/account`);
  await ada.getByRole("link", { name: "Sign in with Uni" }).click();
  await ada.getByRole("heading", { name: "The ada@uni.example" }).waitFor();

  // A second person has an account, and no course yet.
  const bob = await newPerson();
  await bob.goto(address);
  await bob.getByRole("link", { name: "Sign in with Uni" }).click();
  await signInAtProvider(bob, "bob@uni.example");
  await bob.waitForURL(`${address}/`);
  await bob.getByRole("link", { name: "bob", exact: true }).waitFor();
  await bob.goto(`${address}/c/physics`);
  await bob.getByRole("heading", { name: "Not found" }).waitFor();

  // People with other addresses, or with addresses that are not confirmed, cannot sign in.
  for (const id of ["eve@other.example", "new@uni.example"]) {
    const eve = await newPerson();
    await eve.goto(address);
    await eve.getByRole("link", { name: "Sign in with Uni" }).click();
    await signInAtProvider(eve, id);
    await eve.getByRole("heading", { name: "This sign-in is not possible" }).waitFor();
    await eve.goto(address);
    await eve.waitForURL(`${address}/sign-in`);
  }

  // The administrator connects the account of the link, and then signs in at the provider.
  await admin.goto(`${address}/account`);
  await admin.getByRole("link", { name: "Connect with Uni" }).click();
  await signInAtProvider(admin, "root@uni.example");
  await admin.waitForURL(`${address}/account`);
  await admin.getByText("You sign in with Uni").waitFor();
  assert.equal(await admin.getByRole("link", { name: "Administration" }).count(), 1);
});
