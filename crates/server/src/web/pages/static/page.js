"use strict";
// Updates the state of a submission until it is graded.
const state = document.getElementById("state");
if (state && state.dataset.follow) {
  const update = async () => {
    const answer = await fetch(state.dataset.follow).catch(() => null);
    // An unavailable server may return.
    if (!answer || !answer.ok) return;
    const submission = await answer.json();
    if (submission.state !== "waiting" && submission.state !== "running") {
      location.reload();
      return;
    }
    const { ahead, progress, expected_seconds: expected } = submission;
    let text = submission.state === "running" ? "Being graded" : "Waiting";
    if (progress) text += `, ${progress.done} of ${progress.all} scenes done`;
    text += ".";
    if (ahead !== undefined)
      text = ahead ? `${ahead} submission${ahead === 1 ? "" : "s"} before yours.` : "You are next.";
    if (expected !== undefined) text += ` About ${expected} s.`;
    if (submission.lacks_worker) text += " No worker is connected now, so it has to wait; staff can also see this.";
    state.querySelector("[role=status]").textContent = text;
    if (progress) Object.assign(state.querySelector("progress"), { max: progress.all, value: progress.done });
  };
  update();
  setInterval(update, 1000);
}
// Going back keeps what was typed into a form.
document.querySelector("[data-back]")?.addEventListener("click", (event) => {
  if (history.length < 2) return;
  event.preventDefault();
  history.back();
});
// A folded form in which something was typed is open again.
addEventListener("pageshow", () => {
  for (const fold of document.querySelectorAll("details.fold:not([open])"))
    fold.open = [...fold.querySelectorAll("input, textarea")].some((field) => field.value !== field.defaultValue);
});
// Send a form for which a person need not decide anything.
document.querySelector("form[data-send]")?.submit();
// Show elements that need a script.
for (const hidden of document.querySelectorAll("[data-script], [data-copy]")) hidden.hidden = false;
for (const button of document.querySelectorAll("[data-copy]")) {
  button.addEventListener("click", () => {
    const field = document.createElement("textarea");
    field.value = button.dataset.copy;
    button.after(field);
    field.select();
    document.execCommand("copy");
    field.remove();
    button.textContent = "Copied";
  });
}
// Accept dropped files on the form, and show the progress of the upload.
const form = document.querySelector("form[data-drop]");
if (form) {
  const field = form.querySelector("input[type=file]");
  const button = form.querySelector("button");
  const sent = form.querySelector("[data-sent]");
  addEventListener("dragover", (event) => {
    event.preventDefault();
    form.classList.add("over");
  });
  addEventListener("dragleave", () => form.classList.remove("over"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    form.classList.remove("over");
    if (event.dataTransfer.files.length > 0) field.files = event.dataTransfer.files;
  });
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    // Prevent a second upload by a double click.
    button.disabled = true;
    sent.hidden = false;
    sent.removeAttribute("class");
    const bar = document.createElement("progress");
    const showProgress = (words) => sent.replaceChildren(words, document.createElement("br"), bar);
    const showFailure = (words) => {
      sent.className = "bad";
      sent.textContent = words;
      button.disabled = false;
    };
    const request = new XMLHttpRequest();
    request.upload.addEventListener("progress", ({ loaded, total }) => {
      bar.max = total;
      bar.value = loaded;
      showProgress(
        loaded < total
          ? `${Math.floor((100 * loaded) / total)} % sent`
          : "Upload complete. The server is checking the file.",
      );
    });
    request.addEventListener("load", () => {
      if (request.status < 400) {
        location.href = request.responseURL;
        return;
      }
      // A rejection is a page with the reason and the remedy.
      const page = new DOMParser().parseFromString(request.responseText, "text/html");
      const [title, ...words] = [...page.querySelectorAll("main h1, main p")].map((part) => part.textContent.trim());
      showFailure(title ? `${title}: ${words.join(" ")}` : `The server answered ${request.status}.`);
    });
    request.addEventListener("error", () =>
      showFailure("The connection was interrupted. Submit again; the same upload counts only once."),
    );
    request.open("POST", form.action);
    request.send(new FormData(form));
    showProgress("0 % sent");
  });
}
// Show times in the reader's time zone.
for (const time of document.querySelectorAll("time[datetime]")) {
  time.textContent = new Date(time.dateTime).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
}
// Convert fields, too: they arrive in UTC, and are sent with their time zone. This is the assignment's time zone, or
// the one in the same form, if it is set, and otherwise the reader's.
for (const field of document.querySelectorAll("input[type=datetime-local]")) {
  const zone = document.getElementById(`${field.id}-zone`);
  const name = document.getElementById(`${field.id}-zone-name`);
  const zoneField = field.form.elements.time_zone;
  const findTimeZone = () =>
    (zoneField ? zoneField.validity.valid && zoneField.value.trim() : field.dataset.zone) ||
    Intl.DateTimeFormat().resolvedOptions().timeZone;
  // Swedish times have the form of ISO 8601. The offset is in minutes.
  const offset = (date) => {
    const local = date.toLocaleString("sv", { timeZone: findTimeZone() });
    return Math.round((new Date(`${local}Z`) - date) / 60000);
  };
  if (field.defaultValue) {
    const date = new Date(`${field.defaultValue}Z`);
    field.value = new Date(date.getTime() + offset(date) * 60000).toISOString().slice(0, 16);
  }
  const showTimeZone = () => (name.textContent = findTimeZone());
  showTimeZone();
  zoneField?.addEventListener("change", showTimeZone);
  field.form.addEventListener("submit", () => {
    const asUtc = new Date(`${field.value}Z`);
    zone.value = field.value ? offset(new Date(asUtc - offset(asUtc) * 60000)) : 0;
  });
}
// Mark a time zone that does not exist.
const timeZone = document.getElementById("time_zone");
timeZone?.addEventListener("input", () => {
  let fault = "";
  try {
    new Intl.DateTimeFormat("en", { timeZone: timeZone.value.trim() || "UTC" });
  } catch {
    fault = `There is no time zone ${timeZone.value.trim()}. Names are like Europe/Berlin.`;
  }
  timeZone.setCustomValidity(fault);
});
// The field for a login lists the members when it is used. A mistyped login stays in it, and it names the fault.
const comparison = document.querySelector("form[action$='/beside']");
if (comparison) {
  const other = comparison.elements.with;
  const listMembers = async () => {
    const answer = await fetch(other.list.dataset.from).catch(() => null);
    const members = answer?.ok ? await answer.json() : [];
    other.list.append(...members.map(({ login, name }) => new Option(name, login)));
  };
  other.addEventListener("focus", listMembers, { once: true });
  other.addEventListener("input", () => other.setCustomValidity(""));
  comparison.addEventListener("submit", async (event) => {
    event.preventDefault();
    const url = `${comparison.action}?${new URLSearchParams(new FormData(comparison))}`;
    const answer = await fetch(url).catch(() => null);
    if (answer?.status !== 404) {
      location.href = url;
      return;
    }
    other.setCustomValidity(`There is no graded submission of ${other.value.trim()}.`);
    other.reportValidity();
  });
}
// Fill in the URLs of a learning platform from its host.
const kind = document.getElementById("kind");
if (kind) {
  const host = document.getElementById("host");
  const fill = () => {
    const hostName =
      host.value
        .trim()
        .replace(/^https?:\/\//, "")
        .replace(/\/+$/, "") || "HOST";
    const cloud = "https://sso.canvaslms.com";
    const fields = {
      moodle: {
        issuer: `https://${hostName}`,
        login_url: `https://${hostName}/mod/lti/auth.php`,
        token_url: `https://${hostName}/mod/lti/token.php`,
        keys_url: `https://${hostName}/mod/lti/certs.php`,
      },
      canvas: {
        issuer: "https://canvas.instructure.com",
        login_url: `${cloud}/api/lti/authorize_redirect`,
        token_url: `${cloud}/login/oauth2/token`,
        keys_url: `${cloud}/api/lti/security/jwks`,
        hosts: host.value.trim() && hostName,
      },
    }[kind.value];
    for (const [name, value] of Object.entries(fields ?? {})) document.getElementById(name).value = value;
    document.getElementById("addresses").open = !fields;
  };
  kind.addEventListener("change", fill);
  host.addEventListener("input", fill);
}
