// What lies under a place of the picture: a seam that passes close by, else the panel in front.

const NEAR_SEAM = 7;

class Picker {
  constructor(stage) {
    this.stage = stage;
  }

  // The thing at x, y of the canvas in CSS pixels, or null.
  at(x, y) {
    const { canvas, camera } = this.stage;
    camera.updateMatrixWorld();
    const there = new THREE.Vector3((2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight, 0.5);
    const ray = new THREE.Ray(camera.position.clone(), there.unproject(camera).sub(camera.position).normalize());
    const hit = this.panelAt(ray);
    return this.seamAt(x, y, hit ? hit.distance : Infinity) || (hit ? hit.panel : null);
  }

  panelAt(ray) {
    const { model, sheets } = this.stage;
    const points = sheets.geometry.attributes.position.array;
    const corner = [0, 1, 2].map(() => new THREE.Vector3());
    const found = new THREE.Vector3();
    let nearest = null;
    for (const panel of model.panels) {
      const middle = new THREE.Vector3(...panel.box.middle).sub(this.stage.middle).add(new THREE.Vector3(...this.stage.shiftOf(panel)));
      if (ray.distanceToPoint(middle) > panel.box.radius) continue;
      const { triangles } = panel.topology;
      for (let i = 0; i < triangles.length; i += 3) {
        corner.forEach((vector, k) => vector.fromArray(points, 3 * (panel.first + triangles[i + k])));
        if (!ray.intersectTriangle(...corner, false, found)) continue;
        if (this.stage.hides(found)) continue;
        const distance = found.distanceTo(ray.origin);
        if (!nearest || distance < nearest.distance) nearest = { panel, distance };
      }
    }
    return nearest;
  }

  // The closest seam within a few pixels that does not lie behind the panel in front.
  seamAt(x, y, depth) {
    const { model } = this.stage;
    let nearest = null;
    for (const seam of model.seams) {
      const shift = this.stage.shiftOfSeam(seam);
      let before = null;
      for (let i = 0; i < seam.points.length; i += 3) {
        const place = new THREE.Vector3(...[0, 1, 2].map((k) => seam.points[i + k] - model.box.middle[k] + shift[k]));
        const hidden = this.stage.hides(place);
        const distance = place.distanceTo(this.stage.camera.position);
        const here = hidden || distance > depth * 1.01 ? null : this.onCanvas(place);
        if (before && here) {
          const off = toSegment([x, y], before, here);
          if (off < NEAR_SEAM && (!nearest || off < nearest.off)) nearest = { seam, off };
        }
        before = here;
      }
    }
    return nearest && nearest.seam;
  }

  onCanvas(place) {
    const { canvas, camera } = this.stage;
    const seen = place.clone().project(camera);
    return [0.5 * (1 + seen.x) * canvas.clientWidth, 0.5 * (1 - seen.y) * canvas.clientHeight];
  }

  // Where the middle vertex of a panel, or the middle of a seam, is on the canvas.
  placeOf(thing) {
    const { model } = this.stage;
    const shift = thing.profile ? this.stage.shiftOfSeam(thing) : this.stage.shiftOf(thing);
    const distances = Array.from({ length: thing.points.length / 3 }, (_, i) =>
      Math.hypot(...[0, 1, 2].map((x) => thing.points[3 * i + x] - thing.box.middle[x])));
    const at = 3 * distances.indexOf(Math.min(...distances));
    this.stage.camera.updateMatrixWorld();
    return this.onCanvas(new THREE.Vector3(...[0, 1, 2].map((x) => thing.points[at + x] - model.box.middle[x] + shift[x])));
  }
}

function toSegment(point, start, stop) {
  const way = [stop[0] - start[0], stop[1] - start[1]];
  const square = way[0] ** 2 + way[1] ** 2;
  const share = square ? ((point[0] - start[0]) * way[0] + (point[1] - start[1]) * way[1]) / square : 0;
  const at = Math.min(Math.max(share, 0), 1);
  return Math.hypot(point[0] - start[0] - at * way[0], point[1] - start[1] - at * way[1]);
}
