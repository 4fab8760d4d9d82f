"use strict";
// Sorts tables after a click on a column heading, and shows only the rows with some text, a verdict or a mistake.
(() => {
  const sortValue = (row, column) => {
    const cell = row.cells[column];
    if (cell.dataset.sort === undefined) return cell.textContent.trim().toLowerCase();
    return cell.dataset.sort === "" ? -Infinity : Number(cell.dataset.sort);
  };
  const compare = (a, b) =>
    typeof a === "number" && typeof b === "number"
      ? a - b || 0
      : String(a).localeCompare(String(b), undefined, { numeric: true });
  for (const table of document.querySelectorAll("table.sortable")) {
    const headings = [...table.tHead.rows[0].cells];
    const rows = [...table.tBodies[0].rows];
    headings.forEach((heading, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.append(...heading.childNodes);
      heading.append(button);
      button.addEventListener("click", () => {
        // The first click sorts numbers from the largest, and text from a.
        const hasNumbers = rows.some((row) => row.cells[column].dataset.sort !== undefined);
        const order = heading.getAttribute("aria-sort");
        const isAscending = order === null ? !hasNumbers : order === "descending";
        headings.forEach((other) => other.removeAttribute("aria-sort"));
        heading.setAttribute("aria-sort", isAscending ? "ascending" : "descending");
        const sorted = rows
          .map((row) => [sortValue(row, column), row])
          .sort(([a], [b]) => (isAscending ? compare(a, b) : compare(b, a)));
        table.tBodies[0].append(...sorted.map(([, row]) => row));
      });
    });
  }
  for (const hidden of document.querySelectorAll(".filter")) hidden.hidden = false;
  for (const button of document.querySelectorAll("[data-copy]")) {
    button.addEventListener("click", () => {
      const area = document.createElement("textarea");
      area.value = button.dataset.copy;
      button.after(area);
      area.select();
      document.execCommand("copy");
      area.remove();
      button.textContent = "Copied";
    });
  }
  // Rows of scenes: the scene under the pointer is named, and a click opens it.
  const block = document.getElementById("scenes");
  const scenes = block ? JSON.parse(block.textContent) : [];
  const sceneLabel = document.querySelector(".pointed");
  for (const svg of document.querySelectorAll("td.heat svg")) {
    const sceneUnder = (event) => {
      const box = svg.getBoundingClientRect();
      return scenes[
        Math.max(0, Math.min(scenes.length - 1, Math.floor(((event.clientX - box.left) / box.width) * scenes.length)))
      ];
    };
    const link = svg.closest("tr").querySelector("a");
    svg.addEventListener("pointermove", (event) => {
      sceneLabel.textContent = `${link.textContent}: ${sceneUnder(event)}`;
    });
    svg.addEventListener("pointerleave", () => {
      sceneLabel.textContent = "";
    });
    svg.addEventListener("click", (event) => {
      location.href = `${link.href}#${new URLSearchParams({ scene: sceneUnder(event) })}`;
    });
  }
  const filter = document.querySelector("p.filter.rows");
  if (filter) {
    const rows = [...document.querySelector("table.sortable").tBodies[0].rows];
    const search = filter.querySelector("input");
    const choices = [...filter.querySelectorAll("select")];
    const applyFilter = () => {
      const wanted = search.value.trim().toLowerCase();
      const isWanted = (row) =>
        row.textContent.toLowerCase().includes(wanted) &&
        choices.every(({ value, dataset }) => !value || (row.dataset[dataset.by] ?? "").split(" ").includes(value));
      for (const row of rows) row.hidden = !isWanted(row);
      const shown = rows.filter((row) => !row.hidden).length;
      filter.querySelector("output").textContent = `${shown} of ${rows.length}`;
    };
    filter.addEventListener("input", applyFilter);
    for (const button of document.querySelectorAll("[data-only]")) {
      button.addEventListener("click", () => {
        choices.find((choice) => choice.dataset.by === "mistakes").value = button.dataset.only;
        applyFilter();
        filter.scrollIntoView();
      });
    }
  }
  document.documentElement.dataset.ready = "yes";
})();
