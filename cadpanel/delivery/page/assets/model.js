// The numbers and shapes that the page holds, unpacked and put together.

function read(id) {
  return JSON.parse(document.getElementById(id).textContent);
}

function bytes(text) {
  const raw = atob(text);
  const found = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i += 1) found[i] = raw.charCodeAt(i);
  return found;
}

// The lower byte comes first, as on every machine that runs a browser.
function wholes(text) {
  return new Uint16Array(bytes(text).buffer);
}

function unboxed(box) {
  const counts = wholes(box.data);
  const columns = box.low.length;
  const found = new Float64Array(counts.length);
  for (let i = 0; i < counts.length; i += 1) found[i] = box.low[i % columns] + counts[i] * box.step[i % columns];
  return found;
}

// Edges that one triangle only has: the border of a skin.
function borderOf(triangles) {
  const seen = new Map();
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; k += 1) {
      const a = triangles[i + k];
      const b = triangles[i + ((k + 1) % 3)];
      const back = b * 65536 + a;
      if (seen.has(back)) seen.delete(back);
      else seen.set(a * 65536 + b, [a, b]);
    }
  }
  return Array.from(seen.values());
}

function meanNormal(points, triangles) {
  const sum = [0, 0, 0];
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[i + k]);
    const u = [0, 1, 2].map((x) => points[b + x] - points[a + x]);
    const v = [0, 1, 2].map((x) => points[c + x] - points[a + x]);
    for (let x = 0; x < 3; x += 1) sum[x] += u[(x + 1) % 3] * v[(x + 2) % 3] - u[(x + 2) % 3] * v[(x + 1) % 3];
  }
  return sum;
}

function boxOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 1) {
    low[i % 3] = Math.min(low[i % 3], points[i]);
    high[i % 3] = Math.max(high[i % 3], points[i]);
  }
  const middle = low.map((value, x) => 0.5 * (value + high[x]));
  return { low, high, middle, radius: 0.5 * Math.hypot(...high.map((value, x) => value - low[x])) };
}

function loadModel() {
  const numbers = read("cadpanel-numbers");
  const shapes = read("cadpanel-shapes");
  const topologies = shapes.topologies.map((text) => {
    const triangles = wholes(text);
    return { triangles, border: borderOf(triangles) };
  });
  const panels = numbers.panels.map((told, index) => {
    const shape = shapes.panels[index];
    const points = unboxed(shape.points);
    return {
      ...told,
      index,
      seams: [],
      points,
      other: unboxed(shape.other),
      topology: topologies[shape.topology],
      deviations: unboxed(shape.deviation),
      ghost: { points: unboxed(shape.ghost), outline: shape.outline, triangles: wholes(shape.ghost_triangles) },
      flat: shapes.flats[index],
      box: boxOf(points),
      normal: meanNormal(points, topologies[shape.topology].triangles),
    };
  });
  const named = new Map(panels.map((panel) => [panel.name, panel]));
  const seams = numbers.seams.map((told, index) => seamOf(told, index, shapes.seams[index], named));
  return { ...numbers, panels, seams, named, box: boxOf(panels.flatMap((panel) => [...panel.box.low, ...panel.box.high])) };
}

function seamOf(told, index, shape, named) {
  const rows = unboxed(shape.profile);
  const column = (which) => Float64Array.from({ length: rows.length / 5 }, (_, i) => rows[5 * i + which]);
  const points = unboxed(shape.points);
  const seam = {
    ...told,
    index,
    name: seamName(told.panels),
    points,
    box: boxOf(points),
    profile: { along: column(0), gap: column(1), width: column(2), step: column(3), kink: column(4) },
    sides: told.panels.map((name) => named.get(name)).filter((panel) => panel !== undefined),
  };
  for (const panel of seam.sides) panel.seams.push(seam);
  return seam;
}
