// Flat patterns and profiles of seams as drawings.

function flatDrawing(panel) {
  const pairs = (row) => Array.from({ length: row.length / 2 }, (_, i) => [row[2 * i] / 10, -row[2 * i + 1] / 10]);
  let outline = pairs(panel.flat.outline);
  let bends = panel.flat.bends.map(pairs);
  const triples = panel.flat.holes ?? [];
  let holes = Array.from({ length: triples.length / 3 }, (_, i) => [triples[3 * i] / 10, -triples[3 * i + 1] / 10]);
  const span = (points, x) => Math.max(...points.map((p) => p[x])) - Math.min(...points.map((p) => p[x]));
  if (span(outline, 1) > span(outline, 0)) {
    // Lying down it takes less of the column.
    const turned = (point) => [-point[1], point[0]];
    outline = outline.map(turned);
    bends = bends.map((line) => line.map(turned));
    holes = holes.map(turned);
  }
  const low = [0, 1].map((x) => Math.min(...outline.map((p) => p[x])));
  const size = [span(outline, 0), span(outline, 1)];
  const edge = 0.02 * Math.max(...size);
  const path = (points) => points.map((p, i) => `${i ? "L" : "M"}${p[0].toFixed(1)} ${p[1].toFixed(1)}`).join("");
  const thin = { fill: "none", "vector-effect": "non-scaling-stroke" };
  return drawn(
    "svg",
    {
      class: "flat",
      viewBox: [low[0] - edge, low[1] - edge, size[0] + 2 * edge, size[1] + 2 * edge].map((v) => v.toFixed(1)).join(" "),
      role: "img",
      "aria-label": `Flat pattern of ${panel.name}`,
    },
    drawn("path", { ...thin, d: `${path(outline)}Z`, fill: "#eef3f8", stroke: "#1c2733", "stroke-width": 1.2 }),
    ...bends.map((line) => drawn("path", { ...thin, d: path(line), stroke: "#0b5cad", "stroke-width": 1, "stroke-dasharray": "5 4" })),
    ...holes.map(([cx, cy], i) => drawn("circle", { ...thin, cx: cx.toFixed(1), cy: cy.toFixed(1), r: (triples[3 * i + 2] / 20).toFixed(2), stroke: "#1c2733", "stroke-width": 1 })),
  );
}

const CHART = { width: 240, height: 84, left: 34, right: 4, top: 6, bottom: 17 };

function profileChart(seam, key, caption, unit) {
  const { along } = seam.profile;
  const values = seam.profile[key];
  const length = along[along.length - 1];
  const top = roundUp(Math.max(...values, key === "kink" ? 0.1 : 0.01));
  const x = (at) => CHART.left + (at / length) * (CHART.width - CHART.left - CHART.right);
  const y = (value) => CHART.height - CHART.bottom - (value / top) * (CHART.height - CHART.top - CHART.bottom);
  const line = Array.from(values, (value, i) => `${i ? "L" : "M"}${x(along[i]).toFixed(1)} ${y(value).toFixed(1)}`).join("");
  const area = `${line}L${x(length).toFixed(1)} ${y(0).toFixed(1)}L${x(0).toFixed(1)} ${y(0).toFixed(1)}Z`;
  const worst = values.indexOf(Math.max(...values));
  const label = (at, words, anchor) => drawn("text", { x: at[0], y: at[1], "text-anchor": anchor, "font-size": 11, fill: "#51606e" }, words);
  const most = `${digits(values[worst])}${unit === "°" ? "" : " "}${unit}`;
  const chart = drawn(
    "svg",
    { viewBox: `0 0 ${CHART.width} ${CHART.height}`, role: "img", "aria-label": `${caption} along the seam, at most ${most}` },
    ...[0, top / 2, top].map((value) =>
      drawn("path", { d: `M${CHART.left} ${y(value)}H${CHART.width - CHART.right}`, stroke: value ? "#e4e9ee" : "#8795a1" })),
    label([CHART.left - 5, y(top) + 4], String(Number(top.toPrecision(3))), "end"),
    label([CHART.left - 5, y(0) + 2], "0", "end"),
    label([CHART.left, CHART.height - 3], "0", "start"),
    label([CHART.width - CHART.right, CHART.height - 3], `${digits(length, 0)} mm`, "end"),
    drawn("path", { d: area, fill: "#0b5cad", opacity: 0.12 }),
    drawn("path", { d: line, fill: "none", stroke: "#0b5cad", "stroke-width": 1.6, "stroke-linejoin": "round" }),
    drawn("circle", { cx: x(along[worst]), cy: y(values[worst]), r: 2.6, fill: "#0b5cad" }),
  );
  return element("figure", {}, element("figcaption", {}, caption, element("b", {}, most)), chart);
}
