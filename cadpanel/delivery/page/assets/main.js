// Puts the page together.

const model = loadModel();
const get = (id) => document.getElementById(id);
const largest = (things, value) => things.reduce((most, thing) => Math.max(most, value(thing)), 0);

const features = [...new Set(model.panels.map((panel) => panel.feature))].sort();
const radii = model.panels.flatMap((panel) => panel.radii.map((pair) => pair[0]));
const neutral = linearColour(NEUTRAL);
const dark = linearColour(SEAM);
const THINNEST = 20; // thousandths of the way along an axis that a section leaves

function bySeams(label, unit, key) {
  const scale = ramp(SEQUENTIAL, 0, roundUp(largest(model.seams, (seam) => Math.max(...seam.profile[key]))));
  return { label, unit, scale, words: `${label} along the seams, ${unit}`, paint: () => neutral, along: (seam, i) => scale.colour(seam.profile[key][i]), thick: true };
}

function modesOf() {
  const most = roundUp(largest(model.panels, (panel) => Math.max(...panel.deviations.map(Math.abs))));
  const deviation = ramp(DIVERGING, -most, most);
  const least = Math.min(...radii);
  const radius = radii.length ? ramp(SEQUENTIAL, Math.log(least), Math.log(Math.max(...radii))) : null;
  const colours = new Map(features.map((feature, i) => [feature, CATEGORIES[i % CATEGORIES.length]]));
  const flat = linearColour(FLAT);
  const plain = { along: () => dark, thick: false };
  const panelRadius = (panel) => (panel.radii.length ? radius.colour(Math.log(Math.min(...panel.radii.map((pair) => pair[0])))) : flat);
  return [
    { label: "Deviation", scale: deviation, words: "Reference inside (−) or outside (+) of the panel, mm", paint: (panel, i) => deviation.colour(panel.deviations[i]), ...plain },
    bySeams("Gap", "mm", "gap"),
    bySeams("Step", "mm", "step"),
    bySeams("Kink", "degrees", "kink"),
    { label: "Feature", keys: features.map((feature) => [colours.get(feature), feature]), words: "Feature", paint: (panel) => linearColour(colours.get(panel.feature)), ...plain },
    { label: "Radius", scale: radius, exp: true, keys: radius ? [[FLAT, "flat"]] : [[FLAT, "all flat"]], words: "Smallest radius of the skin, mm", paint: panelRadius, ...plain },
  ];
}

function showLegend(mode) {
  const parts = [element("b", {}, mode.words)];
  if (mode.scale) {
    const { from, to, stops } = mode.scale;
    const bar = element("div", { class: "ramp" });
    bar.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
    const value = (share) => {
      const at = from + share * (to - from);
      return mode.exp ? digits(Math.exp(at), 0) : String(Number(at.toPrecision(3))).replace("-", "\u2212");
    };
    const ticks = [...new Set([0, 0.5, 1].map(value))].map((words) => element("span", {}, words));
    parts.push(bar, element("div", { class: "ticks" }, ...ticks));
  }
  if (mode.keys) {
    parts.push(element("div", { class: "keys" }, ...mode.keys.map(([colour, words]) => {
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = colour;
      return element("span", {}, swatch, words);
    })));
  }
  const legend = get("legend");
  legend.replaceChildren(...parts);
  legend.setAttribute("aria-label", `Colours: ${legend.textContent}`);
}

// A browser without WebGL still has all numbers.
function stageOf() {
  if (document.createElement("canvas").getContext("webgl2")) return new Stage(model, get("canvas"), get("legend"));
  get("nothing").hidden = false;
  get("canvas").hidden = true;
  return null;
}

const stage = stageOf();
const picker = stage && new Picker(stage);
const openTab = tabs(["panels", "seams"]);
const tables = [
  new Table(model.panels, PANEL_COLUMNS, (thing) => choose(thing, true)),
  new Table(model.seams, SEAM_COLUMNS, (thing) => choose(thing, true)),
];

function choose(thing, near = true) {
  if (stage) {
    stage.mark(thing);
    if (thing && near) {
      // What is looked for is never found cut away.
      if (stage.hides(stage.middleOf(thing))) wholeAgain();
      stage.approach(thing);
    }
  }
  for (const table of tables) table.mark(thing);
  if (thing) openTab(thing.profile ? "seams" : "panels");
  document.body.dataset.chosen = thing ? thing.name : "";
  showDetails(get("details"), thing, model, choose);
}

function wholeAgain() {
  get("axis").value = "";
  get("axis").dispatchEvent(new Event("change"));
}

function showHead() {
  const { summary, sheet } = model;
  get("title").textContent = model.title;
  const joint = sheet && sheet.joint > 0 ? `, joints of ${Number(sheet.joint)} mm` : "";
  const thick = sheet ? `, sheet of ${Number(sheet.thickness)} mm${joint}` : "";
  get("subtitle").textContent =
    `${counted(model.panels.length, "panel", "panels")}, ${counted(model.seams.length, "seam", "seams")}${thick}`;
  const verdict = get("verdict");
  verdict.hidden = summary === null;
  if (summary === null) return;
  verdict.className = summary.tolerance_met ? "good" : "bad";
  verdict.textContent = summary.tolerance_met ? "✓ All tolerances held" : "✗ A tolerance is not met";
}

function colourBy(mode) {
  if (stage) stage.colour(mode.paint, mode.along, mode.thick);
  showLegend(mode);
  document.body.dataset.mode = mode.label;
}

function buildToolbar() {
  const modes = modesOf().filter((mode) => model.seams.length || !mode.thick);
  modes.forEach((mode, at) => {
    const input = element("input", { type: "radio", name: "mode", value: mode.label });
    input.checked = at === 0;
    input.addEventListener("change", () => colourBy(mode));
    get("modes").append(element("label", { class: "segment" }, input, element("span", {}, mode.label)));
  });
  for (const [words, way] of VIEWS) {
    get("views").append(element("button", { type: "button", onclick: () => stage && stage.view(way) }, words));
  }
  colourBy(modes[0]);
}

function listen() {
  // What is shown along each axis, in thousandths: a box that is cut out by choosing one axis after the other.
  const whole = () => [[0, 1000], [0, 1000], [0, 1000]];
  const ends = ["cut-from", "cut"].map(get);
  let box = whole();
  const cut = () => stage.cutTo(box.map((range) => range.map((end) => end / 1000)));
  get("apart").addEventListener("input", () => {
    stage.moveApart(Number(get("apart").value) / 100);
    cut();
  });
  get("axis").addEventListener("change", () => {
    const axis = get("axis").value;
    ends.forEach((end) => { end.disabled = axis === ""; });
    if (axis === "") box = whole();
    else {
      if (box[axis].join() === "0,1000") box[axis] = [0, 500];
      ends.forEach((end, k) => { end.value = box[axis][k]; });
    }
    cut();
  });
  ends.forEach((end, k) => end.addEventListener("input", () => {
    const range = box[get("axis").value];
    // Never so thin that nothing is left to see.
    range[k] = k ? Math.max(Number(end.value), range[0] + THINNEST) : Math.min(Number(end.value), range[1] - THINNEST);
    end.value = range[k];
    cut();
  }));
  get("ghost").addEventListener("change", () => stage.showGhost(get("ghost").checked));
  const { canvas } = stage;
  let pressed = null;
  // The left button, or a finger; the others move the picture, also when they are pressed without a move.
  canvas.addEventListener("pointerdown", (event) => { pressed = event.button === 0 && event.isPrimary ? [event.clientX, event.clientY] : null; });
  canvas.addEventListener("pointerup", (event) => {
    // A press that moved has turned the picture.
    if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
    const corner = canvas.getBoundingClientRect();
    choose(picker.at(event.clientX - corner.left, event.clientY - corner.top), false);
  });
  canvas.addEventListener("keydown", (event) => {
    const does = {
      ArrowLeft: () => stage.turn(-0.12, 0), ArrowRight: () => stage.turn(0.12, 0), ArrowUp: () => stage.turn(0, 0.12),
      ArrowDown: () => stage.turn(0, -0.12), "+": () => stage.closer(0.85), "=": () => stage.closer(0.85),
      "-": () => stage.closer(1.18), 0: () => stage.home(), Escape: () => choose(null),
    }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  });
  new ResizeObserver(() => stage.resize()).observe(canvas);
}

// A canvas is not printed by every browser; its picture is.
function preparePrint() {
  const picture = element("img", { class: "printed", alt: "The panels" });
  get("picture").prepend(picture);
  window.addEventListener("beforeprint", () => {
    stage.drawNow();
    picture.src = stage.canvas.toDataURL("image/png");
  });
}

showHead();
tiles(get("tiles"), model, choose);
get("pane-panels").append(tables[0].element);
get("pane-seams").append(tables[1].element);
get("tab-panels").textContent = `Panels (${model.panels.length})`;
get("tab-seams").textContent = `Seams (${model.seams.length})`;
get("find").addEventListener("input", () => tables.forEach((table) => table.find(get("find").value)));
showDetails(get("details"), null, model, choose);
buildToolbar();
if (stage) {
  stage.resize();
  stage.home();
  listen();
  preparePrint();
}

// For scripts that look at the page.
window.cadpanel = {
  choose: (name) => choose([...model.panels, ...model.seams].find((thing) => thing.name === name) ?? null),
  placeOf: (name) => picker.placeOf([...model.panels, ...model.seams].find((thing) => thing.name === name)),
  drawCalls: () => stage.renderer.info.render.calls,
  frames: () => stage.renderer.info.render.frame,
};
document.body.dataset.ready = "true";
