"use strict";
// Follows a submission until it is graded.
const state = document.getElementById("state");
if (state && state.dataset.follow) {
    const source = new EventSource(state.dataset.follow);
    source.addEventListener("submission", (event) => {
        const submission = JSON.parse(event.data);
        if (submission.state !== "waiting" && submission.state !== "running") {
            source.close();
            location.reload();
            return;
        }
        let text = submission.state === "running" ? "being graded" : "waiting";
        if (submission.ahead !== undefined) text += `, ${submission.ahead} before it`;
        if (submission.expected_seconds !== undefined) text += `, about ${submission.expected_seconds} s`;
        state.textContent = text;
    });
}
// Files can be dropped on the form.
const form = document.querySelector("form[data-drop]");
if (form) {
    const field = form.querySelector("input[type=file]");
    addEventListener("dragover", (event) => { event.preventDefault(); form.classList.add("over"); });
    addEventListener("dragleave", () => form.classList.remove("over"));
    addEventListener("drop", (event) => {
        event.preventDefault();
        form.classList.remove("over");
        if (event.dataTransfer.files.length > 0) field.files = event.dataTransfer.files;
    });
    // A double click hands in once.
    form.addEventListener("submit", () => { form.querySelector("button").disabled = true; });
}
