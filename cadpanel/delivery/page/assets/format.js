// Words and numbers as people read them, and the elements that hold them. Names are text, never markup.

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "onclick") made.addEventListener("click", value);
    else if (value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

const SVG = "http://www.w3.org/2000/svg";

function drawn(tag, attributes = {}, ...children) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

function digits(value, most = 2) {
  const size = Math.abs(value);
  const shown = value.toFixed(size >= 1000 ? 0 : size >= 100 ? Math.min(1, most) : most);
  return Number(shown) === 0 ? (0).toFixed(size >= 1000 ? 0 : most) : shown.replace("-", "\u2212");
}

const mm = (value) => `${digits(value)} mm`;
const degrees = (value) => `${digits(value)}°`;
const squareMetres = (value) => `${digits(value / 1e6)} m²`;
const between = (least, most) => (Math.abs(most - least) < 0.05 ? digits(least, 1) : `${digits(least, 1)}–${digits(most, 1)}`);
const seamName = (panels) => panels.join(" | ");
const counted = (count, one, more) => `${count} ${count === 1 ? one : more}`;
