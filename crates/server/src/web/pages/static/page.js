"use strict";
// Follows a submission until it is graded.
const state = document.getElementById("state");
if (state && state.dataset.follow) {
  const look = async () => {
    const answer = await fetch(state.dataset.follow).catch(() => null);
    // A server that is away may come back.
    if (!answer || !answer.ok) return;
    const submission = await answer.json();
    if (submission.state !== "waiting" && submission.state !== "running") {
      location.reload();
      return;
    }
    let text = submission.state === "running" ? "being graded" : "waiting";
    if (submission.progress) text += `, ${submission.progress.done} of ${submission.progress.all} scenes done`;
    if (submission.ahead !== undefined) text += `, ${submission.ahead} before it`;
    if (submission.expected_seconds !== undefined) text += `, about ${submission.expected_seconds} s`;
    state.textContent = text;
  };
  setInterval(look, 2000);
}
// Files can be dropped on the form.
const form = document.querySelector("form[data-drop]");
if (form) {
  const field = form.querySelector("input[type=file]");
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
  // A double click hands in once.
  form.addEventListener("submit", () => {
    form.querySelector("button").disabled = true;
  });
}
// Times in the reader's own zone.
for (const time of document.querySelectorAll("time[datetime]")) {
  time.title = time.textContent;
  time.textContent = new Date(time.dateTime).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
}
// Fields, too: they come in UTC, and say in which zone they go.
for (const field of document.querySelectorAll("input[type=datetime-local]")) {
  const zone = document.getElementById(`${field.id}-zone`);
  const name = document.getElementById(`${field.id}-zone-name`);
  const offset = (date) => -date.getTimezoneOffset();
  if (field.defaultValue) {
    const date = new Date(`${field.defaultValue}Z`);
    field.value = new Date(date.getTime() + offset(date) * 60000).toISOString().slice(0, 16);
  }
  name.textContent = Intl.DateTimeFormat().resolvedOptions().timeZone;
  field.form.addEventListener("submit", () => {
    zone.value = field.value ? offset(new Date(field.value)) : 0;
  });
}
