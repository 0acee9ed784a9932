// Tables of panels and seams that sort, can be searched, and find in the picture what they list.

const PANEL_COLUMNS = [
  { head: "Panel", value: (panel) => panel.name, name: true },
  { head: "Feature", value: (panel) => panel.feature, word: true },
  { head: "Deviation", title: "largest, mm", value: (panel) => panel.deviation, show: digits },
  { head: "RMS", title: "RMS deviation, mm", value: (panel) => panel.rms, show: digits },
  { head: "Drift", title: "largest corner drift, mm", value: (panel) => panel.drift, show: digits },
  { head: "m²", title: "area", value: (panel) => panel.area / 1e6, show: digits },
];
const SEAM_COLUMNS = [
  { head: "Seam", value: (seam) => seam.name, name: true },
  { head: "Gap", title: "largest along the seam, mm", value: (seam) => seam.gap, show: digits },
  { head: "Width", title: "in the skins, mm", value: (seam) => seam.width, show: digits },
  { head: "Step", title: "out of the skins, mm", value: (seam) => seam.step, show: digits },
  { head: "Kink", title: "degrees", value: (seam) => seam.kink, show: digits },
];

class Table {
  constructor(things, columns, choose) {
    this.things = things;
    this.columns = columns;
    this.sorted = { column: null, ways: 1 };
    this.rows = new Map(things.map((thing) => [thing, this.row(thing, choose)]));
    this.heads = columns.map((column, at) => this.headOf(column, at));
    this.body = element("tbody", {}, ...this.rows.values());
    this.nothing = element("p", { class: "none" }, "Nothing of that name.");
    this.nothing.hidden = things.length > 0;
    if (!things.length) this.nothing.textContent = "There are none.";
    this.element = element("div", {},
      element("table", {}, element("thead", {}, element("tr", {}, ...this.heads)), this.body), this.nothing);
  }

  headOf(column, at) {
    const button = element("button", { type: "button", title: column.title, onclick: () => this.sort(at) }, column.head);
    return element("th", { scope: "col", class: column.word || column.name ? "word" : null }, button);
  }

  row(thing, choose) {
    const cells = this.columns.map((column) => {
      if (column.name) return element("td", {}, element("button", { type: "button", class: "link" }, column.value(thing)));
      return element("td", { class: column.word ? "word" : null }, column.show ? column.show(column.value(thing)) : column.value(thing));
    });
    return element("tr", { onclick: () => choose(thing) }, ...cells);
  }

  sort(at) {
    const { value, show } = this.columns[at];
    // Numbers begin with the largest, as that is what is looked for.
    const ways = this.sorted.column === at ? -this.sorted.ways : show ? -1 : 1;
    this.sorted = { column: at, ways };
    const compare = show ? (a, b) => value(a) - value(b) : (a, b) => value(a).localeCompare(value(b), undefined, { numeric: true });
    const ordered = this.things.slice().sort((a, b) => ways * compare(a, b));
    this.body.append(...ordered.map((thing) => this.rows.get(thing)));
    this.heads.forEach((head, place) => {
      if (place === at) head.setAttribute("aria-sort", ways > 0 ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
    });
  }

  find(words) {
    // Blanks at the ends or about the bar between two panels are nothing that anybody looks for.
    const plain = (text) => text.trim().toLowerCase().replace(/\s*\|\s*/g, "|");
    let count = 0;
    for (const [thing, row] of this.rows) {
      row.hidden = !plain(thing.name).includes(plain(words));
      count += row.hidden ? 0 : 1;
    }
    this.nothing.hidden = count > 0;
  }

  mark(chosen) {
    for (const [thing, row] of this.rows) {
      row.classList.toggle("chosen", thing === chosen);
      if (thing === chosen) row.setAttribute("aria-current", "true");
      else row.removeAttribute("aria-current");
    }
  }
}

function tabs(tables) {
  const all = tables.map((name) => document.getElementById(`tab-${name}`));
  const open = (at) => {
    all.forEach((tab, place) => {
      tab.setAttribute("aria-selected", String(place === at));
      tab.tabIndex = place === at ? 0 : -1;
      document.getElementById(`pane-${tables[place]}`).classList.toggle("closed", place !== at);
    });
  };
  all.forEach((tab, at) => {
    tab.addEventListener("click", () => open(at));
    tab.addEventListener("keydown", (event) => {
      if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
      const next = (at + 1) % all.length;
      open(next);
      all[next].focus();
    });
  });
  return (name) => open(tables.indexOf(name));
}
