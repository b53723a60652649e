// The page: controls, panels and the camera. #frame=120&colour=gap&mesh=all in the address choose what is shown first.
"use strict";

const element = id => document.getElementById(id);
const kFieldOfView = 30;
const kIcons = {play: "M5 3l12 7-12 7z", pause: "M4 3h4v14H4zM12 3h4v14h-4z"};

class Player {
  constructor(replay) {
    this.replay = replay;
    const turn = new THREE.Quaternion().setFromUnitVectors(
      new THREE.Vector3().fromArray(replay.runs[0].up), new THREE.Vector3(0, 1, 0));
    this.box = boundsOf(replay.runs[0], replay.step, turn);
    this.scenes = replay.runs.map(run => new RunScene(run, replay.step, this.box));
    this.frames = Math.max(...replay.runs.map(run => run.frames));
    this.frameTime = replay.runs[0].frameTime;
    this.frame = 0;
    this.time = 0;  // s; between this frame and the next
    this.playing = false;
    this.makeRenderer();
    this.makeLabels();
    this.makeControls();
    this.resetView();
    this.readAddress();
    this.draw();
  }

  makeRenderer() {
    this.renderer = new THREE.WebGLRenderer({canvas: element("view"), antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.gammaOutput = true;
    this.renderer.gammaFactor = 2.2;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    this.renderer.setScissorTest(true);
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.01, 100);
    this.orbit = new THREE.OrbitControls(this.camera, element("view"));
    this.orbit.addEventListener("change", () => this.drawSoon());
    window.addEventListener("resize", () => this.drawSoon());
  }

  makeLabels() {
    this.labels = this.replay.runs.map(run => {
      const label = element("labels").appendChild(document.createElement("div"));
      label.appendChild(document.createElement("h2")).textContent = run.title;
      label.appendChild(document.createElement("p")).textContent = run.remark;
      return label;
    });
  }

  makeControls() {
    const names = new Set();
    for (const run of this.replay.runs)
      for (const body of run.bodies) for (const channel of body.channels || []) names.add(channel.name);
    for (const name of names) element("colour").add(new Option(name, name));
    element("time").max = this.frames - 1;
    element("time").addEventListener("input", () => this.seek(Number(element("time").value)));
    element("play").addEventListener("click", () => this.play(!this.playing));
    element("reset").addEventListener("click", () => this.resetView());
    for (const id of ["colour", "mesh"]) element(id).addEventListener("change", () => this.changed());
    element("controls").addEventListener("submit", event => event.preventDefault());
    window.addEventListener("keydown", event => this.key(event));
    window.addEventListener("hashchange", () => this.readAddress());
    element("controls").hidden = false;
    element("message").hidden = true;
  }

  key(event) {
    if (event.target.tagName === "SELECT" || event.ctrlKey || event.metaKey || event.altKey) return;
    const next = id => {
      element(id).selectedIndex = (element(id).selectedIndex + 1) % element(id).length;
      this.changed();
    };
    const actions = {
      " ": () => this.play(!this.playing), ArrowRight: () => this.seek(this.frame + 1), ArrowLeft: () => this.seek(this.frame - 1),
      Home: () => this.seek(0), End: () => this.seek(this.frames - 1), c: () => next("colour"), m: () => next("mesh"),
      r: () => this.resetView()
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  readAddress() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    for (const id of ["colour", "mesh"])
      if (Array.from(element(id).options).some(option => option.value === wanted.get(id))) element(id).value = wanted.get(id);
    if (wanted.has("frame")) this.seek(Number(wanted.get("frame")) || 0);
    this.changed();
  }

  changed() {
    const name = element("colour").value;
    element("legend").hidden = name === "";
    const channels = this.replay.runs.flatMap(run => run.bodies.flatMap(body => body.channels || []));
    const channel = channels.find(candidate => candidate.name === name);
    if (channel) {
      const text = value => `${value > 0 && channel.low < 0 ? "+" : ""}${Number(value.toPrecision(3))} ${channel.unit}`;
      element("low").textContent = name === "contact" ? "no contact" : text(channel.low);
      element("high").textContent = name === "contact" ? "in contact" : text(channel.high);
      element("scale").style.background =
        `linear-gradient(90deg, ${scaleOf(name).map(([place, colour]) => `${colour} ${100 * place}%`).join(", ")})`;
    }
    this.drawSoon();
  }

  seek(frame) {
    this.frame = Math.max(0, Math.min(this.frames - 1, Math.round(frame)));
    this.time = this.frame * this.frameTime;
    this.drawSoon();
  }

  play(playing) {
    this.playing = playing;
    element("play-icon").setAttribute("d", playing ? kIcons.pause : kIcons.play);
    element("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    if (!playing) return;
    if (this.frame === this.frames - 1) this.seek(0);
    let before = performance.now();
    const advance = now => {
      if (!this.playing) return;
      const time = this.time + Math.min(now - before, 100) / 1000 * Number(element("speed").value);
      before = now;
      this.seek(Math.floor(time / this.frameTime + 1e-6));
      this.time = time;
      if (this.frame < this.frames - 1) requestAnimationFrame(advance);
      else this.play(false);
    };
    requestAnimationFrame(advance);
  }

  resetView() {
    const {center, radius} = this.box.getBoundingSphere(new THREE.Sphere());
    const [panel] = this.panels(), narrow = Math.min(1, panel.width / panel.height);
    const distance = 0.8 * radius / Math.sin(0.5 * kFieldOfView * Math.PI / 180) / narrow;
    this.camera.near = 0.01 * radius;
    this.camera.far = 100 * radius;
    this.camera.position.set(-1, 0.32, 0.75).normalize().multiplyScalar(distance).add(center);
    this.orbit.target.copy(center);
    this.orbit.maxDistance = 20 * radius;
    this.orbit.update();
    this.drawSoon();
  }

  // Returns the rectangles of the runs, side by side, or above one another where that leaves them larger.
  panels() {
    const width = window.innerWidth, height = window.innerHeight - element("controls").offsetHeight - 12;
    const count = this.scenes.length, stacked = count > 1 && Math.min(width, height / count) > Math.min(width / count, height);
    element("labels").className = stacked ? "stacked" : "";
    return this.scenes.map((scene, i) => (stacked
      ? {left: 0, top: i * height / count, width, height: height / count}
      : {left: i * width / count, top: 0, width: width / count, height}));
  }

  drawSoon() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  draw() {
    const {renderer, camera} = this, width = window.innerWidth, height = window.innerHeight;
    renderer.setSize(width, height, false);
    for (const [i, panel] of this.panels().entries()) {
      const scene = this.scenes[i], bottom = height - panel.top - panel.height;
      scene.show(this.frame, element("colour").value, element("mesh").value);
      for (const set of ["setViewport", "setScissor"]) renderer[set](panel.left, bottom, panel.width, panel.height);
      camera.aspect = panel.width / panel.height;
      camera.updateProjectionMatrix();
      renderer.render(scene.scene, camera);
      const ended = this.frame > scene.run.frames - 1 ? `ended at ${((scene.run.frames - 1) * scene.run.frameTime).toFixed(2)} s` : "";
      this.labels[i].lastChild.textContent = [scene.run.remark, ended].filter(Boolean).join(" · ");
      Object.assign(this.labels[i].style, {
        left: `${panel.left}px`, top: `${panel.top}px`, width: `${panel.width}px`, height: `${panel.height}px`
      });
    }
    element("time").value = this.frame;
    element("clock").value = `${(this.frame * this.frameTime).toFixed(2)} s · ${this.frame} / ${this.frames - 1}`;
    document.body.dataset.frame = this.frame;
  }
}

decodeReplay(element("data").textContent)
  .then(replay => { window.player = new Player(replay); })
  .catch(error => {
    element("message").hidden = false;
    element("message").textContent = `This replay cannot be shown: ${error.message || error}. It needs WebGL and a browser of 2023 or newer.`;
  });
