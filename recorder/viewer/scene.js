// Builds a three.js scene of a run, and shows one of its frames.
"use strict";

const kColours = {cloth: "#b3262f", back: "#d39a45", stone: "#b9b7b1", edge: "#3a0d12", stoneEdge: "#6c6a66", none: "#c9ced6"};
const kCrease = Math.cos(40 * Math.PI / 180);

// Colour scales by the name of a channel: places between 0 and 1, and colours.
const kScales = {
  contact: [[0, "#c9ced6"], [1, "#e8590c"]],
  gap: [[0, "#5f0f6b"], [0.42, "#e03131"], [0.5, "#ffd43b"], [0.58, "#40c057"], [1, "#1c7ed6"]],
  stretch: [[0, "#3b6fb6"], [0.35, "#8ecae6"], [0.6, "#ffe066"], [1, "#c92a2a"]],
  other: [[0, "#440154"], [0.33, "#31688e"], [0.66, "#35b779"], [1, "#fde725"]]
};

function scaleOf(name) {
  return kScales[name] || kScales.other;
}

function linear(colour) {
  return new THREE.Color(colour).convertGammaToLinear(2.2);
}

// Returns the colours of the levels 0 (no value) to 255 of a channel, r g b each.
function paletteOf(name) {
  const stops = scaleOf(name), palette = new Float32Array(3 * 256);
  linear(kColours.none).toArray(palette, 0);
  for (let level = 1; level < 256; ++level) {
    const place = Math.min((level - 1) / 254, 1);
    let k = 1;
    while (k < stops.length - 1 && stops[k][0] < place) ++k;
    const [start, low] = stops[k - 1], [end, high] = stops[k];
    linear(low).lerp(linear(high), (place - start) / (end - start)).toArray(palette, 3 * level);
  }
  return palette;
}

// Returns each edge of the triangles once, as pairs of vertices.
function edgesOf(corners) {
  const seen = new Set(), edges = [];
  for (let i = 0; i < corners.length; ++i) {
    const a = corners[i], b = corners[i % 3 === 2 ? i - 2 : i + 1], key = Math.min(a, b) * 4294967296 + Math.max(a, b);
    if (seen.has(key)) continue;
    seen.add(key);
    edges.push(a, b);
  }
  return edges;
}

// Returns x y z per vertex of a frame whose arrays have one axis after the other.
function interleaved(values, start, count, step, out) {
  for (let i = 0; i < count; ++i)
    for (let axis = 0; axis < 3; ++axis) out[3 * i + axis] = step * values[start + axis * count + i];
  return out;
}

// Returns a normal for each corner: the mean of the faces at its vertex that lean less than 40 degrees from its own.
function creasedNormals(positions, corners) {
  const faces = corners.length / 3, areas = new Float32Array(3 * faces), lengths = new Float32Array(faces);
  const starts = new Uint32Array(positions.length / 3 + 1);
  const a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3();
  for (let face = 0; face < faces; ++face) {
    a.fromArray(positions, 3 * corners[3 * face]);
    b.fromArray(positions, 3 * corners[3 * face + 1]).sub(a);
    c.fromArray(positions, 3 * corners[3 * face + 2]).sub(a);
    b.cross(c).toArray(areas, 3 * face);
    lengths[face] = b.length() || 1;
    for (let k = 0; k < 3; ++k) ++starts[corners[3 * face + k] + 1];
  }
  for (let i = 1; i < starts.length; ++i) starts[i] += starts[i - 1];
  const next = starts.slice(), around = new Uint32Array(corners.length);
  for (let i = 0; i < corners.length; ++i) around[next[corners[i]]++] = Math.floor(i / 3);
  const normals = new Float32Array(3 * corners.length);
  for (let i = 0; i < corners.length; ++i) {
    const own = Math.floor(i / 3);
    a.set(0, 0, 0);
    for (let k = starts[corners[i]]; k < starts[corners[i] + 1]; ++k) {
      b.fromArray(areas, 3 * own);
      c.fromArray(areas, 3 * around[k]);
      if (b.dot(c) > kCrease * lengths[own] * lengths[around[k]]) a.add(c);
    }
    a.normalize().toArray(normals, 3 * i);
  }
  return normals;
}

class RigidView {
  // The mesh's geometry is made once and shared by all bodies and runs that have it.
  constructor(body, step) {
    this.body = body;
    this.step = step;
    const mesh = body.mesh;
    if (!mesh.geometry) {
      const positions = interleaved(mesh.positions, 0, mesh.vertices, step, new Float32Array(3 * mesh.vertices));
      mesh.points = positions;
      mesh.geometry = new THREE.BufferGeometry();
      const expanded = new Float32Array(3 * mesh.corners.length);
      for (let i = 0; i < mesh.corners.length; ++i)
        for (let axis = 0; axis < 3; ++axis) expanded[3 * i + axis] = positions[3 * mesh.corners[i] + axis];
      mesh.geometry.setAttribute("position", new THREE.BufferAttribute(expanded, 3));
      mesh.geometry.setAttribute("normal", new THREE.BufferAttribute(creasedNormals(positions, mesh.corners), 3));
    }
    this.solid = new THREE.Mesh(mesh.geometry, new THREE.MeshStandardMaterial({
      color: linear(kColours.stone), roughness: 0.85, metalness: 0, side: THREE.DoubleSide, shadowSide: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2
    }));
    this.solid.castShadow = this.solid.receiveShadow = true;
    this.group = new THREE.Group();
    this.group.add(this.solid);
  }

  // Adds the edges when they are first asked for: a large mesh has many.
  showEdges(visible) {
    if (visible && !this.edges) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(this.body.mesh.points, 3));
      geometry.setIndex(edgesOf(this.body.mesh.corners));
      this.edges = new THREE.LineSegments(
        geometry, new THREE.LineBasicMaterial({color: linear(kColours.stoneEdge), transparent: true, opacity: 0.35}));
      this.group.add(this.edges);
    }
    if (this.edges) this.edges.visible = visible;
  }

  show(frame) {
    const {origins, turns} = this.body;
    this.group.position.fromArray(origins, 3 * frame).multiplyScalar(this.step);
    this.group.quaternion.fromArray(turns, 4 * frame).normalize();
  }
}

class SoftView {
  constructor(body, step) {
    this.body = body;
    this.step = step;
    const mesh = body.mesh, count = mesh.vertices;
    this.geometry = new THREE.BufferGeometry();
    this.positions = new THREE.BufferAttribute(new Float32Array(3 * count), 3);
    this.colours = new THREE.BufferAttribute(new Float32Array(3 * count), 3);
    this.geometry.setAttribute("position", this.positions);
    this.geometry.setAttribute("color", this.colours);
    this.geometry.setIndex(Array.from(mesh.corners));
    this.group = new THREE.Group();
    this.sides = [THREE.FrontSide, THREE.BackSide].map(side => this.addSide(side));
    this.edges = this.addLines(edgesOf(mesh.corners), {color: linear(kColours.edge), transparent: true, opacity: 0.5});
    this.ropes = this.addLines(Array.from(mesh.lines), {vertexColors: THREE.VertexColors, linewidth: 2});
    this.palettes = {};
  }

  addSide(side) {
    const mesh = new THREE.Mesh(this.geometry, new THREE.MeshStandardMaterial({
      side, shadowSide: THREE.DoubleSide, roughness: 0.75, metalness: 0, vertexColors: THREE.VertexColors,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1
    }));
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    this.group.add(mesh);
    return mesh;
  }

  addLines(indices, options) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("color", this.colours);
    geometry.setIndex(indices);
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(options));
    lines.frustumCulled = false;
    this.group.add(lines);
    return lines;
  }

  showEdges(visible) {
    this.edges.visible = visible;
  }

  show(frame, colour) {
    const count = this.body.mesh.vertices;
    interleaved(this.body.positions, 3 * count * frame, count, this.step, this.positions.array);
    this.positions.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.paint(frame, this.body.channels.find(channel => channel.name === colour));
  }

  paint(frame, channel) {
    const count = this.body.mesh.vertices, colours = this.colours.array;
    for (const [index, side] of this.sides.entries()) {
      const plain = linear(index === 0 ? kColours.cloth : kColours.back);
      side.material.color.copy(channel ? new THREE.Color(1, 1, 1) : plain);
    }
    if (!channel) colours.fill(1);
    else {
      const palette = this.palettes[channel.name] = this.palettes[channel.name] || paletteOf(channel.name);
      for (let i = 0; i < count; ++i) {
        const level = channel.levels[count * frame + i];
        for (let k = 0; k < 3; ++k) colours[3 * i + k] = palette[3 * level + k];
      }
    }
    if (!channel) for (const vertex of this.body.mesh.lines) linear(kColours.cloth).toArray(colours, 3 * vertex);
    this.colours.needsUpdate = true;
  }
}

// Returns the box of what should be in the picture: the cloths over the run, and rigid bodies not much larger.
function boundsOf(run, step, turn) {
  const box = new THREE.Box3(), point = new THREE.Vector3();
  for (const body of run.bodies.filter(candidate => !candidate.rigid && candidate.frames > 0)) {
    const count = body.mesh.vertices, frames = [0, 0.25, 0.5, 0.75, 1].map(share => Math.round(share * (body.frames - 1)));
    for (const frame of frames)
      for (let i = 0; i < count; ++i) {
        const at = 3 * count * frame + i;
        point.set(body.positions[at], body.positions[at + count], body.positions[at + 2 * count]).multiplyScalar(step);
        box.expandByPoint(point.applyQuaternion(turn));
      }
  }
  const size = box.isEmpty() ? Infinity : 3 * box.getSize(point).length();
  for (const body of run.bodies.filter(candidate => candidate.rigid && candidate.frames > 0)) {
    const own = new THREE.Box3(), pose = new THREE.Quaternion().fromArray(body.turns).normalize();
    const origin = new THREE.Vector3().fromArray(body.origins).multiplyScalar(step), count = body.mesh.vertices;
    for (let i = 0; i < count; ++i) {
      point.set(body.mesh.positions[i], body.mesh.positions[i + count], body.mesh.positions[i + 2 * count]);
      own.expandByPoint(point.multiplyScalar(step).applyQuaternion(pose).add(origin).applyQuaternion(turn));
    }
    if (own.getSize(point).length() < size) box.union(own);
  }
  if (box.isEmpty()) box.setFromCenterAndSize(new THREE.Vector3(), new THREE.Vector3(1, 1, 1));
  return box;
}

class RunScene {
  constructor(run, step, box) {
    this.run = run;
    this.scene = new THREE.Scene();
    this.root = new THREE.Group();
    this.root.quaternion.setFromUnitVectors(new THREE.Vector3().fromArray(run.up), new THREE.Vector3(0, 1, 0));
    this.scene.add(this.root);
    this.views = run.bodies.map(body => (body.rigid ? new RigidView(body, step) : new SoftView(body, step)));
    for (const view of this.views) this.root.add(view.group);
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    this.addLights(sphere);
    this.addFloor(sphere, box.min.y);
  }

  addLights({center, radius}) {
    const key = new THREE.DirectionalLight(linear("#fff4e6"), 0.85);
    key.position.copy(center).addScaledVector(new THREE.Vector3(-0.75, 1, -0.1), 2 * radius);
    key.target.position.copy(center);
    key.castShadow = true;
    key.shadow.mapSize.set(2048, 2048);
    key.shadow.radius = 3;
    key.shadow.bias = -0.0015;
    const camera = key.shadow.camera;
    camera.left = camera.bottom = -1.5 * radius;
    camera.right = camera.top = 1.5 * radius;
    camera.near = 0.2 * radius;
    camera.far = 6 * radius;
    const rim = new THREE.DirectionalLight(linear("#dbe9ff"), 0.25);
    rim.position.copy(center).addScaledVector(new THREE.Vector3(0.8, 0.5, -1), 2 * radius);
    rim.target.position.copy(center);
    this.scene.add(new THREE.HemisphereLight(linear("#f2f6ff"), linear("#b9b3aa"), 0.62), key, key.target, rim, rim.target);
  }

  // A floor that shows nothing but shadows.
  addFloor({center, radius}, height) {
    const floor = new THREE.Mesh(new THREE.PlaneBufferGeometry(20 * radius, 20 * radius), new THREE.ShadowMaterial({opacity: 0.28, depthWrite: false}));
    floor.rotation.x = -Math.PI / 2;
    floor.position.set(center.x, height - 0.002 * radius, center.z);
    floor.receiveShadow = true;
    this.scene.add(floor);
  }

  // Shows a frame of the run; a run that ended before keeps its last one.
  show(frame, colour, edges) {
    const shown = Math.min(frame, this.run.frames - 1);
    for (const view of this.views) {
      const own = shown - view.body.first;
      view.group.visible = own >= 0 && own < view.body.frames;
      if (!view.group.visible) continue;
      view.show(own, colour);
      view.showEdges(edges === "all" || (edges === "cloth" && !view.body.rigid));
    }
  }
}
