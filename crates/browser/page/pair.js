// Shows a pair and the reference's result for it. Both are drawn again after each change.
const PAIRS = {
  pe: {
    points: [
      ["x1", "the particle"],
      ["x2", "the edge's first end"],
      ["x3", "the edge's second end"],
    ],
    radii: ["the particle", "the edge"],
  },
  pp: {
    points: [
      ["x1", "the first particle"],
      ["x2", "the second particle"],
    ],
    radii: ["the first particle", "the second particle"],
  },
  ph: { points: [["x1", "the particle"]], radii: ["the particle"], plane: true },
};
const PRESETS = {
  first: {
    kind: "pe",
    points: [
      [3, 1, 4, 1],
      [5, 9, 2, 6],
      [5, 3, 5, 8],
    ],
    radii: [1, 1],
  },
  second: {
    kind: "pe",
    points: [
      [1, 4, 1, 4],
      [2, 1, 3, 5],
      [6, 2, 3, 7],
    ],
    radii: [1, 2],
  },
  balls: {
    kind: "pp",
    points: [
      [-2, 0, 3, 0.5],
      [2, 0.3, -3, 0],
    ],
    radii: [0.5, 0.7],
  },
  edge: {
    kind: "pe",
    points: [
      [0, 2, 0.5, -4],
      [-3, 0, 0, 0.5],
      [3, 0, 0, -0.5],
    ],
    radii: [0.4, 0.2],
  },
  plane: { kind: "ph", points: [[0, 2, 1, -3]], radii: [0.5], plane: [0, 0, 0.2, 1] },
};
const pair = { oracle: new Oracle(), now: structuredClone(PRESETS.balls) };

function renderFields() {
  const { kind, points, radii, plane } = pair.now,
    { points: names, radii: owners } = PAIRS[kind];
  // Returns a number field and a slider with the same value.
  const field = (label, list, index, minimum) => {
    const value = list[index];
    const number = el("input", { type: "number", step: "any", min: minimum ?? false, value, "aria-label": label });
    const slider = el("input", {
      type: "range",
      min: minimum ?? Math.min(-10, value - 10),
      max: Math.max(10, value + 10),
      step: "0.05",
      "aria-label": `${label}, slider`,
    });
    slider.value = value;
    pair.fields.push(() => {
      number.value = slider.value = list[index];
    });
    const change = (from, other) => () => {
      if (from.value === "" || !Number.isFinite(from.valueAsNumber)) return;
      list[index] = from.valueAsNumber;
      other.value = from.value;
      updateResult();
    };
    number.addEventListener("input", change(number, slider));
    slider.addEventListener("input", change(slider, number));
    return el(
      "div",
      { class: "field" },
      el("span", { "aria-hidden": "true" }, label.replace(/^.*: /, "")),
      number,
      slider,
    );
  };
  const group = (name, ...fields) => el("fieldset", {}, el("legend", {}, name), ...fields);
  const parts = ["x", "y", "dx", "dy"];
  pair.fields = [];
  $("numbers").replaceChildren(
    ...names.map(([short, name], point) =>
      group(`${short}: ${name}`, ...parts.map((part, index) => field(`${short}: ${part}`, points[point], index))),
    ),
    ...(plane
      ? [
          group(
            "the half-plane",
            ...["point x", "point y", "normal x", "normal y"].map((name, index) =>
              field(`half-plane: ${name}`, plane, index),
            ),
          ),
        ]
      : []),
    group("radii", ...owners.map((owner, index) => field(`radius: ${owner}`, radii, index, 0))),
  );
}

// Draws the pair at the start (lines) and at the end (dashes), with arrows between.
function drawPair() {
  const { kind, points, radii, plane } = pair.now;
  const corners = points.flatMap(([x, y, dx, dy], point) => {
    const r = kind === "pe" && point > 0 ? radii[1] : radii[Math.min(point, radii.length - 1)];
    return [
      [x - r, y - r],
      [x + r, y + r],
      [x + dx - r, y + dy - r],
      [x + dx + r, y + dy + r],
    ];
  });
  if (plane) corners.push([plane[0], plane[1]]);
  const low = [0, 1].map((axis) => Math.min(...corners.map((corner) => corner[axis]))),
    high = [0, 1].map((axis) => Math.max(...corners.map((corner) => corner[axis])));
  // The view does not move while the reader holds a point.
  pair.view = pair.held
    ? pair.view
    : {
        size: Math.max(high[0] - low[0], (high[1] - low[1]) * 1.5, 1e-9) * 1.1,
        middle: [0, 1].map((axis) => (low[axis] + high[axis]) / 2),
      };
  const { size, middle } = pair.view;
  const X = (x) => 300 + ((x - middle[0]) / size) * 600,
    Y = (y) => 200 - ((y - middle[1]) / size) * 600,
    R = (r) => (r / size) * 600;
  const svg = (tag, attributes) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    return node;
  };
  const shapes = [];
  if (plane) {
    const [x, y, nx, ny] = plane,
      length = Math.hypot(nx, ny) || 1,
      [tx, ty] = [(-ny / length) * size, (nx / length) * size],
      [dx, dy] = [(-nx / length) * size, (-ny / length) * size];
    shapes.push(
      svg("path", {
        class: "ground",
        d: `M${X(x - tx)} ${Y(y - ty)}L${X(x + tx)} ${Y(y + ty)}L${X(x + tx + dx)} ${Y(y + ty + dy)}L${X(x - tx + dx)} ${Y(y - ty + dy)}Z`,
      }),
    );
  }
  for (const t of [1, 0]) {
    const className = t ? "then" : "now",
      at = points.map(([x, y, dx, dy]) => [x + t * dx, y + t * dy]);
    if (kind === "pe")
      shapes.push(
        svg("line", {
          class: `edge ${className}`,
          x1: X(at[1][0]),
          y1: Y(at[1][1]),
          x2: X(at[2][0]),
          y2: Y(at[2][1]),
          "stroke-width": Math.max(2, 2 * R(radii[1])),
        }),
        svg("line", { class: `axis ${className}`, x1: X(at[1][0]), y1: Y(at[1][1]), x2: X(at[2][0]), y2: Y(at[2][1]) }),
      );
    const discs = kind === "pp" ? at : [at[0]];
    discs.forEach(([x, y], number) =>
      shapes.push(svg("circle", { class: className, cx: X(x), cy: Y(y), r: Math.max(1, R(radii[number])) })),
    );
  }
  for (const [x, y, dx, dy] of points)
    if (dx || dy)
      shapes.push(
        svg("line", { class: "way", x1: X(x), y1: Y(y), x2: X(x + dx), y2: Y(y + dy), "marker-end": "url(#tip)" }),
      );
  points.forEach(([x, y, dx, dy], point) => {
    // The name of a point is next to its arrow.
    const length = Math.hypot(dx, dy);
    const [along, up] = length ? [dx / length, dy / length] : [0.7, 0.7];
    const label = svg("text", { x: X(x) - 14 * up, y: Y(y) - 14 * along + 4, "text-anchor": "middle" });
    label.textContent = `x${point + 1}`;
    shapes.push(label);
  });
  listHandles().forEach(({ at: [x, y] }, handle) =>
    shapes.push(
      svg("circle", { class: "handle", cx: X(x), cy: Y(y), r: 5 }),
      svg("circle", { class: "grip", cx: X(x), cy: Y(y), r: 18, "data-handle": handle }),
    ),
  );
  $("sketch").replaceChildren(...shapes);
}

// Returns the places that can be dragged: the tips of displacements, and the points. If a tip and a point are at the
// same place, the point is found first.
function listHandles() {
  const { points, plane } = pair.now;
  const createHandle = (list, from, base) => ({
    at: [base[0] + list[from], base[1] + list[from + 1]],
    move: (to) =>
      [0, 1].forEach((axis) => {
        list[from + axis] = to[axis] - base[axis];
      }),
  });
  const zero = [0, 0];
  return [
    ...points.map((point) => createHandle(point, 2, point)),
    ...points.map((point) => createHandle(point, 0, zero)),
    ...(plane ? [createHandle(plane, 2, plane), createHandle(plane, 0, zero)] : []),
  ];
}

// Moves a point by mouse, finger or pen to positions with few digits. With the keyboard, readers use the fields and the
// sliders.
function enableDragging(paper) {
  paper.addEventListener("pointerdown", (event) => {
    const handle = event.target.dataset.handle;
    if (handle === undefined) return;
    event.preventDefault();
    paper.setPointerCapture(event.pointerId);
    pair.held = { handle };
  });
  paper.addEventListener("pointermove", (event) => {
    if (!pair.held) return;
    const box = paper.getBoundingClientRect(),
      { size, middle } = pair.view;
    const unit = 10 ** Math.floor(Math.log10(size / 100));
    const place = [(event.clientX - box.left) / box.width - 0.5, (0.5 - (event.clientY - box.top) / box.height) / 1.5];
    const to = place.map((part, axis) => Math.round((middle[axis] + part * size) / unit) * unit);
    listHandles()[pair.held.handle].move(to);
    for (const list of [...pair.now.points, pair.now.plane ?? []])
      list.forEach((value, index) => {
        list[index] = Number(value.toPrecision(12));
      });
    pair.fields.forEach((fill) => fill());
    updateResult();
  });
  for (const end of ["pointerup", "pointercancel"])
    paper.addEventListener(end, () => {
      if (pair.held) {
        pair.held = null;
        drawPair();
      }
    });
}
enableDragging($("sketch").ownerSVGElement);

const formatNumber = (value) => (Object.is(value, -0) ? "-0" : String(value));
function formatCommand() {
  const { kind, points, radii, plane } = pair.now;
  const moving = ([x, y, dx, dy]) => `${formatNumber(x)},${formatNumber(y)}+${formatNumber(dx)},${formatNumber(dy)}`;
  const rest = plane
    ? [`${formatNumber(plane[0])},${formatNumber(plane[1])}`, `${formatNumber(plane[2])},${formatNumber(plane[3])}`]
    : [];
  return `fosssim-oracle detect ${[kind, ...points.map(moving), ...rest].join(":")} --radii ${radii.map(formatNumber).join(",")}`;
}

function buildRequest() {
  const { kind, points, radii, plane } = pair.now;
  if (kind === "pp") return { do: "detect", kind, centers: points, radii };
  if (kind === "pe") return { do: "detect", kind, center: points[0], ends: points.slice(1), radii };
  return { do: "detect", kind, center: points[0], radius: radii[0], point: plane.slice(0, 2), normal: plane.slice(2) };
}

// Requests one answer at a time. If several requests are pending, only the last one is sent.
async function updateResult() {
  drawPair();
  $("command").textContent = formatCommand();
  if (pair.isUpdating) {
    pair.isOutdated = true;
    return;
  }
  pair.isUpdating = true;
  do {
    pair.isOutdated = false;
    try {
      const { value, parts } = await pair.oracle.ask(buildRequest());
      pair.svg = parts[2];
      pair.json = parts[1];
      $("decision").textContent = value.decision;
      $("decision").className = value.collides ? "hit" : "";
      $("curves").innerHTML = decodeText(parts[3]);
      $("words").textContent = decodeText(parts[0]);
    } catch (error) {
      $("decision").textContent = error.message;
      $("curves").replaceChildren();
      $("words").textContent = "";
    }
  } while (pair.isOutdated);
  pair.isUpdating = false;
  document.documentElement.dataset.looked = formatCommand();
}

$("preset").addEventListener("change", ({ target }) => {
  pair.now = structuredClone(PRESETS[target.value]);
  renderFields();
  updateResult();
});
$("save-curves").addEventListener("click", () => save("pair.svg", pair.svg, "image/svg+xml"));
$("save-pair").addEventListener("click", () => save("pair.json", pair.json, "application/json"));
panelActions.set("pair", () => {
  if (!$("numbers").children.length) {
    renderFields();
    updateResult();
  }
});

showPanel(findPanel());
compiledModule.then(
  () => {
    document.documentElement.dataset.ready = "";
  },
  (error) =>
    showStatus(
      `This browser can't run the checker: ${error.message}. Use Chrome 103, Firefox 113, Safari 16.4 or newer.`,
      "bad",
    ),
);
