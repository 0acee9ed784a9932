// Colours that can be told apart by everybody, and the scales that they stand for.

const DIVERGING = ["#1f5fa8", "#6fa6d6", "#f1f1ee", "#ec9178", "#ad1f2d"];
const SEQUENTIAL = ["#f6e3bd", "#f3b266", "#e2704f", "#b23a6b", "#5c1b73"];
const CATEGORIES = ["#4e79a7", "#f0a43a", "#6aa36f", "#b07aa1", "#8c6d4f", "#d4a6a0", "#59a5b8", "#8a8f98"];
const NEUTRAL = "#c3ccd4";
const FLAT = "#d9dee2";
const CHOSEN = "#0b5cad";
const SEAM = "#4a5662";

function channels(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}

// WebGL adds light, not what screens are told: colours go in as linear values.
function linear(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

function linearColour(hex) {
  return channels(hex).map(linear);
}

function onRamp(stops, share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const low = Math.min(Math.floor(at), stops.length - 2);
  return stops[low].map((value, i) => linear(value + (at - low) * (stops[low + 1][i] - value)));
}

// A scale turns a value into a linear colour, and tells how: from, to, stops for the legend.
function ramp(stops, from, to) {
  const parts = stops.map(channels);
  const span = to > from ? to - from : 1;
  return { from, to, stops, colour: (value) => onRamp(parts, (value - from) / span) };
}

// The least round number that is not below a value: ends of scales are read, not measured.
function roundUp(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].map((step) => step * power).find((step) => step >= value * (1 - 1e-6));
}
