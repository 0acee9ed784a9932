// The picture in three dimensions: all sheets in one mesh, all seams in one set of lines, drawn when something changes.

const VIEWS = [
  ["All", null],
  ["North", [0, 1, 0.25]],
  ["East", [1, 0, 0.25]],
  ["South", [0, -1, 0.25]],
  ["West", [-1, 0, 0.25]],
  ["Top", [0, -0.02, 1]],
];
const THICK = 6;
const THIN = 1.4;
const CHOSEN_WIDTH = 4;
const HALO = 11;
const CLOSER = 0.994;
const ROOM = 1.12;

class Stage {
  constructor(model, canvas, legend) {
    this.model = model;
    this.canvas = canvas;
    this.legend = legend;
    this.covered = 0;
    this.middle = new THREE.Vector3(...model.box.middle);
    this.apart = 0;
    this.sections = [];
    this.chosen = null;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 1, 10);
    this.camera.up.set(0, 0, 1);
    this.light();
    this.buildSheets();
    this.buildSeams();
    this.buildGhost();
    this.outline = this.lines(new Float32Array(6), CHOSEN_WIDTH, { color: CHOSEN, depthTest: false, depthWrite: false });
    this.outline.visible = false;
    this.outline.renderOrder = 0.5; // under the seams, whose colours stay to be seen
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.home();
  }

  light() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xc8ced6, 2.1));
    this.sun = new THREE.DirectionalLight(0xffffff, 1.15);
    this.scene.add(this.sun, this.sun.target);
  }

  // Skin, other face and walls of each panel; vertices of neighbours are not shared, so that creases stay sharp.
  buildSheets() {
    const points = [];
    const indices = [];
    let count = 0;
    for (const panel of this.model.panels) {
      const { triangles, border } = panel.topology;
      const each = panel.points.length / 3;
      panel.first = count;
      points.push(panel.points, panel.other);
      for (let i = 0; i < triangles.length; i += 3) {
        const [a, b, c] = [triangles[i] + count, triangles[i + 1] + count, triangles[i + 2] + count];
        indices.push(a, b, c, a + each, c + each, b + each);
      }
      // Walls have vertices of their own, or light would run round the edges.
      const wall = count + 2 * each;
      const rim = new Float64Array(12 * border.length);
      border.forEach(([a, b], k) => {
        for (let x = 0; x < 3; x += 1) {
          rim[12 * k + x] = panel.points[3 * a + x];
          rim[12 * k + 3 + x] = panel.points[3 * b + x];
          rim[12 * k + 6 + x] = panel.other[3 * b + x];
          rim[12 * k + 9 + x] = panel.other[3 * a + x];
        }
        const at = wall + 4 * k;
        indices.push(at, at + 3, at + 2, at, at + 2, at + 1);
      });
      points.push(rim);
      panel.count = 2 * each + 4 * border.length;
      count += panel.count;
    }
    this.home_points = new Float32Array(3 * count);
    let at = 0;
    for (const part of points) {
      for (let i = 0; i < part.length; i += 1) this.home_points[at + i] = part[i] - this.model.box.middle[i % 3];
      at += part.length;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.home_points.slice(), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * count), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(indices), 1));
    geometry.computeVertexNormals();
    this.sheets = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: true }));
    this.sheets.frustumCulled = false;
    this.scene.add(this.sheets);
  }

  lines(positions, width, options) {
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(positions);
    const made = new THREE.LineSegments2(geometry, new THREE.LineMaterial({ linewidth: width, ...options }));
    made.frustumCulled = false;
    this.scene.add(made);
    return made;
  }

  buildSeams() {
    this.segments = this.model.seams.reduce((sum, seam) => sum + seam.points.length / 3 - 1, 0);
    if (!this.segments) return;
    this.seams = this.lines(this.seamPositions(), THIN, { vertexColors: true });
    // Closer to the eye by a hair, or the sheets would cut into the lines where they step.
    const { material } = this.seams;
    for (const end of ["Start", "End"]) {
      const place = `modelViewMatrix * vec4( instance${end}, 1.0 );`;
      material.vertexShader = material.vertexShader.replace(place, `${place} ${end.toLowerCase()}.xyz *= ${CLOSER};`);
    }
    this.seams.renderOrder = 1;
  }

  seamPositions() {
    const found = new Float32Array(6 * this.segments);
    let at = 0;
    for (const seam of this.model.seams) {
      const shift = this.shiftOfSeam(seam);
      for (let i = 0; i + 3 < seam.points.length; i += 3) {
        for (let x = 0; x < 6; x += 1) found[at + x] = seam.points[i + x] - this.model.box.middle[x % 3] + shift[x % 3];
        at += 6;
      }
    }
    return found;
  }

  buildGhost() {
    const indices = [];
    let first = 0;
    for (const { ghost } of this.model.panels) {
      for (const corner of ghost.triangles) indices.push(first + corner);
      first += ghost.points.length / 3;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * first), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(indices), 1));
    const look = { color: 0x0f766e, transparent: true, opacity: 0.28, depthWrite: false, side: THREE.DoubleSide };
    this.ghost = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(look));
    this.ghost.renderOrder = 2;
    this.ghost.frustumCulled = false;
    this.scene.add(this.ghost);
    this.ghost_rim = this.lines(new Float32Array(6), 1.2, { color: 0x0f766e });
    this.placeGhost();
    this.showGhost(false);
  }

  // What a panel approximates goes with it where panels stand apart.
  placeGhost() {
    const points = this.ghost.geometry.attributes.position.array;
    const rim = [];
    let at = 0;
    for (const panel of this.model.panels) {
      const { ghost } = panel;
      const shift = this.shiftOf(panel);
      for (let i = 0; i < ghost.points.length; i += 1) {
        points[at + i] = ghost.points[i] - this.model.box.middle[i % 3] + shift[i % 3];
      }
      for (let i = 0; i < ghost.outline; i += 1) {
        for (const k of [i, (i + 1) % ghost.outline]) for (let x = 0; x < 3; x += 1) rim.push(points[at + 3 * k + x]);
      }
      at += ghost.points.length;
    }
    this.ghost.geometry.attributes.position.needsUpdate = true;
    this.ghost_rim.geometry.setPositions(new Float32Array(rim));
  }

  showGhost(shown) {
    this.ghost.visible = shown;
    this.ghost_rim.visible = shown;
    this.draw();
  }

  // paint(panel, vertex) and along(seam, place) give linear colours.
  colour(paint, along, thick) {
    const colours = this.sheets.geometry.attributes.color;
    for (const panel of this.model.panels) {
      const each = panel.points.length / 3;
      for (let i = 0; i < panel.count; i += 1) {
        let vertex = i % each;
        if (i >= 2 * each) {
          const [a, b] = panel.topology.border[Math.floor((i - 2 * each) / 4)];
          vertex = [a, b, b, a][(i - 2 * each) % 4];
        }
        const [red, green, blue] = paint(panel, vertex);
        colours.setXYZ(panel.first + i, red, green, blue);
      }
    }
    colours.needsUpdate = true;
    if (this.seams) {
      const found = new Float32Array(6 * this.segments);
      let at = 0;
      for (const seam of this.model.seams) {
        for (let i = 0; i + 1 < seam.points.length / 3; i += 1) {
          found.set(along(seam, i), at);
          found.set(along(seam, i + 1), at + 3);
          at += 6;
        }
      }
      this.seams.geometry.setColors(found);
      this.seams.material.linewidth = thick ? THICK : THIN;
      this.outline.material.linewidth = thick ? HALO : CHOSEN_WIDTH;
    }
    this.draw();
  }

  shiftOf(panel) {
    return panel.box.middle.map((value, x) => this.apart * (value - this.model.box.middle[x]));
  }

  shiftOfSeam(seam) {
    const shifts = seam.sides.map((panel) => this.shiftOf(panel));
    return [0, 1, 2].map((x) => shifts.reduce((sum, shift) => sum + shift[x], 0) / shifts.length);
  }

  moveApart(share) {
    this.apart = share;
    const position = this.sheets.geometry.attributes.position;
    for (const panel of this.model.panels) {
      const shift = this.shiftOf(panel);
      for (let i = 3 * panel.first; i < 3 * (panel.first + panel.count); i += 1) {
        position.array[i] = this.home_points[i] + shift[i % 3];
      }
    }
    position.needsUpdate = true;
    if (this.seams) this.seams.geometry.setPositions(this.seamPositions());
    this.placeGhost();
    this.mark(this.chosen);
  }

  // Only what lies in a box is drawn: a range for each axis, as shares of the way along it.
  cutTo(box) {
    this.sections = [];
    box.forEach(([from, to], axis) => {
      const reach = (1 + this.apart) * (this.model.box.high[axis] - this.model.box.low[axis]);
      const beyond = (share, side) => {
        const normal = [0, 0, 0];
        normal[axis] = side;
        this.sections.push(new THREE.Plane(new THREE.Vector3(...normal), -side * (share - 0.5) * 1.02 * reach));
      };
      if (from > 0) beyond(from, 1);
      if (to < 1) beyond(to, -1);
    });
    const open = this.sections.length > 0;
    this.renderer.clippingPlanes = this.sections;
    this.sheets.material.side = open ? THREE.DoubleSide : THREE.FrontSide;
    this.sheets.material.needsUpdate = true;
    this.draw();
  }

  // Where the middle of a panel or a seam is in the picture.
  middleOf(thing) {
    const shift = thing.profile ? this.shiftOfSeam(thing) : this.shiftOf(thing);
    return new THREE.Vector3(...thing.box.middle.map((value, x) => value - this.model.box.middle[x] + shift[x]));
  }

  // Whether a place is cut away.
  hides(place) {
    return this.sections.some((section) => section.distanceToPoint(place) < 0);
  }

  // Lines round a panel or along a seam.
  mark(thing) {
    this.chosen = thing;
    this.outline.visible = thing !== null;
    if (thing !== null) this.outline.geometry.setPositions(thing.profile ? this.markOfSeam(thing) : this.markOfPanel(thing));
    this.draw();
  }

  markOfPanel(panel) {
    const shift = this.shiftOf(panel);
    const found = [];
    for (const edge of panel.topology.border) {
      for (const corner of edge) {
        for (let x = 0; x < 3; x += 1) found.push(panel.points[3 * corner + x] - this.model.box.middle[x] + shift[x]);
      }
    }
    return new Float32Array(found);
  }

  markOfSeam(seam) {
    const shift = this.shiftOfSeam(seam);
    const found = [];
    for (let i = 0; i + 3 < seam.points.length; i += 3) {
      for (let x = 0; x < 6; x += 1) found.push(seam.points[i + x] - this.model.box.middle[x % 3] + shift[x % 3]);
    }
    return new Float32Array(found);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // The legend lies on the picture's lower edge: what is shown stands above it, where no panel is hidden.
    const on = getComputedStyle(this.legend).position === "absolute";
    this.covered = on ? Math.min((this.legend.offsetHeight + 16) / height, 0.4) : 0;
    this.camera.setViewOffset(width, height, 0, 0.5 * this.covered * height, width, height);
    // Whoever has not turned it yet sees all of it, also when the page has found its form.
    if (this.first && this.camera.position.equals(this.first)) this.home();
    else this.draw();
  }

  home() {
    const sum = [0, 1, 2].map((x) => this.model.panels.reduce((all, panel) => all + panel.normal[x], 0));
    const area = this.model.panels.reduce((all, panel) => all + Math.hypot(...panel.normal), 0);
    const outward = new THREE.Vector3(...sum).divideScalar(area || 1);
    // Seen from outside where a skin has one, a little from above; a roof or a closed form along its short side.
    const upright = Math.hypot(outward.x, outward.y) > 0.25;
    const [east, north] = upright ? [] : this.shortWay();
    const way = upright ? outward.normalize() : new THREE.Vector3(east, north, Math.max(outward.z, 0));
    way.z = Math.max(way.z, 0) + 0.35;
    this.look(this.model.panels, this.model.box.middle, way);
    this.first = this.camera.position.clone();
  }

  // The direction in plan in which the panels reach less far, from the south; from the south-west where there is none.
  shortWay() {
    const [xx, xy, yy] = this.model.panels.reduce(([a, b, c], { box }) => {
      const [x, y] = [0, 1].map((k) => box.middle[k] - this.model.box.middle[k]);
      return [a + x * x, b + x * y, c + y * y];
    }, [0, 0, 0]);
    const apart = Math.hypot(xx - yy, 2 * xy);
    if (apart < 0.3 * (xx + yy)) return [-0.5, -0.85];
    const long = 0.5 * Math.atan2(2 * xy, xx - yy);
    const side = Math.cos(long) > 0 ? -1 : 1;
    return [-side * Math.sin(long), side * Math.cos(long)];
  }

  // Some panels as large as the picture takes them, the middle of it at a place, seen from a way.
  look(panels, place, way) {
    const target = new THREE.Vector3(...place).sub(this.middle);
    const back = way.clone().normalize();
    const right = new THREE.Vector3(-back.y, back.x, 0).normalize();
    const up = back.clone().cross(right);
    const whole = Math.tan((0.5 * this.camera.fov * Math.PI) / 180);
    const wide = whole * (this.camera.aspect || 1);
    const high = whole * (1 - this.covered);
    const points = this.sheets.geometry.attributes.position.array;
    const here = new THREE.Vector3();
    let distance = 0;
    for (const panel of panels) {
      for (let i = panel.first; i < panel.first + panel.points.length / 3; i += 1) {
        here.fromArray(points, 3 * i).sub(target);
        const aside = Math.max(Math.abs(here.dot(right)) / wide, Math.abs(here.dot(up)) / high);
        distance = Math.max(distance, here.dot(back) + aside);
      }
    }
    this.camera.position.copy(target).addScaledVector(back, ROOM * distance);
    if (this.controls) {
      this.controls.target.copy(target);
      this.controls.update();
    }
    this.draw();
  }

  view(way) {
    if (way === null) this.home();
    else this.look(this.model.panels, this.model.box.middle, new THREE.Vector3(...way));
  }

  // Close to a panel or a seam, seen square from outside and a little from above.
  approach(thing) {
    const sides = thing.profile ? thing.sides : [thing];
    const way = [0, 1, 2].map((x) => sides.reduce((sum, panel) => sum + panel.normal[x] / Math.hypot(...panel.normal), 0));
    const outward = new THREE.Vector3(...way).normalize();
    outward.z += 0.15;
    const shift = thing.profile ? this.shiftOfSeam(thing) : this.shiftOf(thing);
    this.look(sides, thing.box.middle.map((value, x) => value + shift[x]), outward);
  }

  turn(around, up) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const flat = Math.hypot(away.x, away.y);
    const rise = Math.min(Math.max(Math.atan2(away.z, flat) + up, -1.55), 1.55);
    const heading = Math.atan2(away.y, away.x) + around;
    const far = away.length();
    away.set(far * Math.cos(rise) * Math.cos(heading), far * Math.cos(rise) * Math.sin(heading), far * Math.sin(rise));
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
  }

  closer(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    this.waiting = false;
    // As little depth as there is something in: two faces of a sheet are millimetres apart.
    const far = this.camera.position.length();
    const reach = 1.1 * this.model.box.radius * (1 + this.apart);
    this.camera.near = Math.max(far - reach, reach / 2000);
    this.camera.far = far + reach;
    this.camera.updateProjectionMatrix();
    this.sun.position.copy(this.camera.position).add(new THREE.Vector3(0, 0, 0.6 * far));
    this.sun.target.position.copy(this.controls ? this.controls.target : this.middle);
    this.renderer.render(this.scene, this.camera);
  }
}
