// What is told of the panel or seam that is chosen, and of the whole.

function fact(what, value, wide = false) {
  return element("div", { class: wide ? "wide" : null }, element("dt", {}, what), element("dd", {}, value));
}

function panelDetails(panel, model, choose) {
  const facts = [
    fact("Largest deviation", mm(panel.deviation)),
    fact("RMS deviation", mm(panel.rms)),
    fact("Corner drift", mm(panel.drift)),
    fact("Area", squareMetres(panel.area)),
  ];
  if (panel.mass !== null) facts.push(fact("Mass", `${digits(panel.mass)} kg`));
  if (panel.blank !== null) facts.push(fact("Blank", `${digits(panel.blank.width, 0)} × ${digits(panel.blank.height, 0)} mm`));
  if (panel.blank !== null && panel.blank.stock !== null) facts.push(fact("Stock", panel.blank.stock));
  for (const bend of panel.bends) {
    facts.push(fact(`Bend ${bend.direction}`, `R ${between(...bend.radius)} mm, ${digits(bend.sweep, 1)}°`, true));
  }
  return [
    element("dl", {}, ...facts),
    element("h3", {}, "Flat pattern, seen from outside; dashed where it bends"),
    flatDrawing(panel),
    ...(panel.notes.length ? [element("h3", {}, "Notes"), element("ul", {}, ...panel.notes.map((note) => element("li", {}, note)))] : []),
    ...(panel.seams.length ? [element("h3", {}, "Seams"), element("div", { class: "seams" }, ...panel.seams.map((seam) =>
      element("button", { type: "button", class: "quiet", onclick: () => choose(seam) },
        `${seam.panels.find((name) => name !== panel.name) ?? panel.name}: ${mm(seam.gap)}`)))] : []),
  ];
}

function seamDetails(seam, model, choose) {
  return [
    element("dl", {},
      fact("Largest gap", mm(seam.gap)), fact("Shift along the seam", mm(seam.shift)),
      fact("Length", `${digits(seam.profile.along[seam.profile.along.length - 1], 0)} mm`)),
    element("div", { class: "charts" },
      profileChart(seam, "gap", "Gap", "mm"), profileChart(seam, "width", "Width", "mm"),
      profileChart(seam, "step", "Step", "mm"), profileChart(seam, "kink", "Kink", "°")),
    element("h3", {}, "Panels"),
    element("div", { class: "seams" }, ...seam.sides.map((panel) =>
      element("button", { type: "button", class: "quiet", onclick: () => choose(panel) }, panel.name))),
  ];
}

function showDetails(place, thing, model, choose) {
  if (thing === null) {
    place.replaceChildren(element("p", { class: "empty" }, "Choose a panel or a seam in the picture or in a table to see its numbers."));
    return;
  }
  const seam = Boolean(thing.profile);
  const kind = seam ? ["Seam", ...(thing.edges.length ? [thing.edges.join(" to ")] : [])].join(", ") : thing.feature;
  place.replaceChildren(
    element("div", { class: "head" },
      element("div", {}, element("h2", {}, thing.name), element("p", { class: "kind" }, kind)),
      element("button", { type: "button", class: "quiet", onclick: () => choose(null) }, "Close")),
    ...(seam ? seamDetails : panelDetails)(thing, model, choose),
  );
}

const worstOf = (things, value) => things.reduce((worst, thing) => (!worst || value(thing) > value(worst) ? thing : worst), null);

// The largest measures, each with the panel or seam where it is one click away.
function tiles(place, model, choose) {
  const all = [["Worst panel by deviation", "mm", worstOf(model.panels, (panel) => panel.deviation), (panel) => panel.deviation]];
  if (model.seams.length) {
    all.push(
      ["Worst seam by gap", "mm", worstOf(model.seams, (seam) => seam.gap), (seam) => seam.gap],
      ["Largest step", "mm", worstOf(model.seams, (seam) => seam.step), (seam) => seam.step],
      ["Largest kink", "°", worstOf(model.seams, (seam) => seam.kink), (seam) => seam.kink],
    );
  }
  place.replaceChildren(...all.map(([what, unit, thing, value]) =>
    element("button", { type: "button", class: "tile", onclick: () => choose(thing) },
      element("span", { class: "what" }, what),
      element("span", { class: "much" }, digits(value(thing)), element("small", {}, unit === "°" ? unit : ` ${unit}`)),
      element("span", { class: "where" }, thing.name))));
}
