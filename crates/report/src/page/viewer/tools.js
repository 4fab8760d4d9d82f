// Texts, packed numbers and SVG drawings: the functions that are independent of a case.
const SVG = "http://www.w3.org/2000/svg";
const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const areFinite = (...values) => values.every(Number.isFinite);
const formatShort = (value) =>
  value === null || Number.isNaN(value) ? "nan" : Number(value.toPrecision(6)).toString();
// Formats two numbers in the same notation, just long enough to show where they begin to differ; the second is marked from
// there on.
function formatPair(one, other) {
  const largest = Math.max(Math.abs(one), Math.abs(other));
  if (!areFinite(one, other) || largest === 0) return [formatShort(one), formatShort(other)];
  const exponentOf = (value) => Math.floor(Math.log10(value));
  const exponent = exponentOf(largest),
    gap = Math.abs(one - other),
    digits = Math.max(6, Math.min(17, gap > 0 ? exponent - exponentOf(gap) + 2 : 6));
  const isScientific = exponent < -4 || exponent > 8;
  const [right, own] = [one, other].map(
    (value) =>
      (isScientific ? value / 10 ** exponent : value).toFixed(
        Math.max(0, Math.min(20, isScientific ? digits - 1 : digits - 1 - exponent)),
      ) + (isScientific ? `e${exponent}` : ""),
  );
  let place = 0;
  if (right.length === own.length) while (place < own.length && own[place] === right[place]) place += 1;
  return [right, right === own ? own : el("span", {}, own.slice(0, place), el("mark", {}, own.slice(place)))];
}
const toHex = (value) => {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, value);
  return "0x" + view.getBigUint64(0).toString(16).padStart(16, "0");
};

const formatTimes = (count) => (count === 1 ? "once" : `${count} times`);
const prefersReducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

async function unpack(id) {
  const block = document.getElementById(id);
  if (!block) return null;
  const packed = Uint8Array.from(atob(block.textContent.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Response(stream).arrayBuffer();
}
// Unpacks rounded motions. First come the exact records, then the differences of positions from record to record, in
// units, as numbers of seven bits per byte. Velocities are not stored, and values beyond the range are NaN.
function unround(buffer, { unit, exact }, n) {
  const size = 4 * n,
    bytes = new Uint8Array(buffer);
  const positionsByRecord = [],
    positions = new Float64Array(2 * n);
  const exactCount = new DataView(buffer).getUint32(0, true);
  let at = 8 + 8 * size * exactCount;
  while (at < bytes.length) {
    for (let k = 0; k < 2 * n; k++) {
      let value = 0,
        factor = 1,
        byte;
      do {
        byte = bytes[at++];
        value += (byte & 127) * factor;
        factor *= 128;
      } while (byte > 127);
      positions[k] += value % 2 ? -(value + 1) / 2 : value / 2;
    }
    positionsByRecord.push(positions.slice());
  }
  const out = new Float64Array(positionsByRecord.length * size).fill(NaN);
  positionsByRecord.forEach((recordPositions, record) =>
    recordPositions.forEach((value, k) => {
      out[record * size + k] = Math.abs(value) < 2 ** 40 ? value * unit : NaN;
    }),
  );
  exact
    .slice(0, exactCount)
    .forEach((record, k) => out.set(new Float64Array(buffer, 8 + 8 * size * k, size), record * size));
  return out;
}

// Parses a pair such as "pp:0,1".
const parsePair = (pair) => {
  const [kind, rest] = pair.split(":");
  const [first, second] = rest.split(",").map(Number);
  return { kind, first, second };
};
const PAIRS = { pp: "particle", pe: "edge", ph: "half-plane" };
const pairText = (pair) => {
  const { kind, first, second } = parsePair(pair);
  return `particle ${first} - ${PAIRS[kind]} ${second}`;
};

// Records a drawing as SVG. It implements the part of a canvas context that the viewer uses. Arcs are whole circles.
class Sketch {
  constructor(width, height) {
    Object.assign(this, {
      width,
      height,
      out: [],
      path: "",
      dash: [],
      fillStyle: "#000",
      strokeStyle: "#000",
      lineWidth: 1,
      font: "",
      textAlign: "start",
      lineCap: "butt",
      lineJoin: "miter",
    });
  }
  at(...values) {
    return values.map((value) => Math.round(value * 100) / 100).join(" ");
  }
  beginPath() {
    this.path = "";
  }
  moveTo(x, y) {
    this.path += `M${this.at(x, y)}`;
  }
  lineTo(x, y) {
    this.path += `L${this.at(x, y)}`;
  }
  closePath() {
    this.path += "Z";
  }
  rect(x, y, w, h) {
    this.path += `M${this.at(x, y)}h${this.at(w)}v${this.at(h)}h${this.at(-w)}Z`;
  }
  arc(x, y, r) {
    this.path += `M${this.at(x + r, y)}A${this.at(r, r)} 0 1 1 ${this.at(x - r, y)}A${this.at(r, r)} 0 1 1 ${this.at(x + r, y)}Z`;
  }
  setLineDash(dash) {
    this.dash = dash;
  }
  // Clips become nested groups.
  save() {
    this.clips = (this.clips || 0) + 1;
  }
  clip() {
    this.out.push(
      `<clipPath id="c${this.clips}"><path d="${this.path}"/></clipPath><g clip-path="url(#c${this.clips})">`,
    );
  }
  restore() {
    this.out.push("</g>");
  }
  stroke() {
    this.out.push(
      `<path d="${this.path}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.at(this.lineWidth)}" stroke-dasharray="${this.dash.join(" ") || "none"}" stroke-linecap="${this.lineCap}" stroke-linejoin="${this.lineJoin}"/>`,
    );
  }
  fill() {
    this.out.push(`<path d="${this.path}" fill="${this.fillStyle}"/>`);
  }
  fillRect(x, y, w, h) {
    this.beginPath();
    this.rect(x, y, w, h);
    this.fill();
  }
  fillText(text, x, y) {
    this.out.push(
      `<text x="${this.at(x)}" y="${this.at(y)}" fill="${this.fillStyle}" font-family="sans-serif" font-size="${parseFloat(this.font)}" text-anchor="${this.textAlign === "center" ? "middle" : "start"}">${text}</text>`,
    );
  }
  svg() {
    return `<svg xmlns="${SVG}" viewBox="0 0 ${this.width} ${this.height}" width="${this.width}" height="${this.height}">\n${this.out.join("\n")}\n</svg>\n`;
  }
}

const quoteForShell = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
const areIdentical = (one, other) => one.length === other.length && one.every((value, k) => Object.is(value, other[k]));
function createTable(head, rows, caption) {
  return el(
    "table",
    {},
    el("caption", {}, caption),
    el(
      "thead",
      {},
      el("tr", {}, ...head.map((text) => (text ? el("th", { scope: "col", class: "num" }, text) : el("td")))),
    ),
    el(
      "tbody",
      {},
      ...rows.map(([name, ...cells]) =>
        el(
          "tr",
          {},
          el("th", { scope: "row" }, name),
          ...cells.map((cell) => el("td", { class: "n" }, cell instanceof Node ? cell : String(cell))),
        ),
      ),
    ),
  );
}
function copy(text, button) {
  const done = () => {
    if (button) {
      const old = button.textContent;
      button.textContent = "Copied";
      setTimeout(() => {
        button.textContent = old;
      }, 1200);
    }
  };
  const copyFromTextArea = () => {
    const area = el("textarea", { class: "offscreen" });
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
    done();
  };
  if (navigator.clipboard && isSecureContext) navigator.clipboard.writeText(text).then(done, copyFromTextArea);
  else copyFromTextArea();
}
function drawArrow(context, from, to) {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
  context.beginPath();
  context.moveTo(...to);
  for (const turn of [0.4, -0.4])
    context.lineTo(to[0] - 9 * Math.cos(angle + turn), to[1] - 9 * Math.sin(angle + turn));
  context.fill();
}
// Returns the convex hull (Andrew's monotone chain).
function convexHull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  if (sorted.length < 3) return sorted;
  const halfHull = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...halfHull(sorted), ...halfHull(sorted.reverse())];
}
