// SPDX-License-Identifier: Apache-2.0
// The page: its canvas, controls and clock. A picture is drawn only when something changes.

class Page {
  constructor(root) {
    this.root = root;
    this.canvas = root.querySelector('canvas');
    this.part = (name) => root.querySelector(`[data-part=${name}]`);
    this.listeners = new AbortController();
    this.start().catch((error) => this.say(error.message));
  }

  say(text) {
    const message = this.part('message');
    message.hidden = !text;
    message.textContent = text;
    if (text) this.root.dataset.state = 'failed';
  }

  async start() {
    const bytes = await unpacked(this.part('data').textContent);
    const start = new Uint32Array(bytes.buffer, 0, 1)[0];
    const page = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + start)));
    this.data = new Data(page, bytes.slice(4 + start));
    this.page = page;
    this.scenes = page.scenes.map((scene) => new Scene(this.data, scene));
    this.scene = this.scenes[0];
    this.camera = null;  // The viewer's own, once it was moved.
    this.picture = 0;
    this.split = new SplitLine(this, page.split);
    this.editor = new Editor(this);
    this.probes = new Probes(this, page.probes);
    this.part('controls').hidden = false;
    this.fillControls();
    this.listen();
    await this.restore();
    this.canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    this.canvas.addEventListener('webglcontextrestored', () => this.restore());
  }

  // Makes everything on the GPU, at the start and after a loss of the context.
  async restore() {
    this.root.dataset.state = 'loading';
    const gl = this.canvas.getContext('webgl2', {antialias: false, alpha: true, premultipliedAlpha: false, depth: true});
    if (!gl) throw new Error('This page draws with WebGL 2, which this browser or device does not offer. ' +
                             'Another browser, or hardware acceleration in its settings, may help.');
    this.painter = null;
    const gpu = new Gpu(gl, this.data);
    await gpu.load();
    if (gl.isContextLost()) return;
    this.painters = this.scenes.map((scene) => new Painter(gpu, scene));
    this.painter = this.painters[0];
    this.root.dataset.state = 'ready';
    this.change();
  }

  // Draws before the browser shows the next frame.
  change() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame((now) => {
      this.isWaiting = false;
      if (!this.painter) return;
      if (this.isPlaying) {
        const seconds = (now - (this.lastFrame || now)) / 1000;
        this.lastFrame = now;
        this.moveTo((this.scene.time + seconds) % (this.scene.duration || 1));
        this.change();
      }
      const scale = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
      this.draw(Math.round(box.width * scale), Math.round(box.height * scale));
    });
  }

  draw(width, height) {
    const {canvas, page} = this;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [Math.max(width, 1), Math.max(height, 1)];
    const right = page.pictures.findIndex((picture) => picture.left === this.picture);
    const line = right < 0 ? canvas.width : Math.round(this.split.at * canvas.width);
    const paint = (i, columns) => {
      const picture = page.pictures[i], scene = this.scenes[picture.scene || 0];
      this.painters[picture.scene || 0].draw(picture, this.fitted(canvas.width / canvas.height, scene), canvas.width, canvas.height, columns);
    };
    paint(this.picture, [0, line]);
    if (right >= 0) paint(right, [line, canvas.width]);
    this.split.show(right >= 0);
    this.probes.show();
  }

  // The camera with the depths of a scene; in a picture that is narrower than that of the command
  // line, it sees as much to the sides.
  fitted(aspect, scene = this.scene) {
    const more = this.page.size[0] / this.page.size[1] / aspect;
    let camera = this.camera || this.scene.camera;
    if (scene !== this.scene) camera = {...camera, ...(this.camera ? depths(camera, scene) : {near: scene.camera.near, far: scene.camera.far})};
    if (!(more > 1.001)) return camera;
    return {...camera, height: camera.height && camera.height * more, fov: 2 * Math.atan(more * Math.tan(camera.fov / 2))};
  }

  // The picture of this size in base64, as rows of RGBA from the bottom.
  pixels(width, height) {
    this.draw(width, height);
    const {gl} = this.painter, codes = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, codes);
    let text = '';
    for (let i = 0; i < codes.length; i += 8192) text += String.fromCharCode(...codes.subarray(i, i + 8192));
    return btoa(text);
  }

  moveTo(seconds) {
    for (const scene of this.scenes) scene.pose(seconds);
    this.part('time').value = seconds;
    this.part('seconds').textContent = `${seconds.toFixed(2)} s`;
  }

  play(isOn) {
    this.isPlaying = isOn && this.scene.duration > 0;
    this.lastFrame = undefined;
    this.part('play').textContent = this.isPlaying ? 'Pause' : 'Play';
    this.change();
  }

  fillControls() {
    const {page, scene} = this;
    const choose = (name, values, chosen, set) => {
      const list = this.part(name);
      list.closest('label').hidden = values.length < 2;
      list.replaceChildren(...values.map((value) => new Option(value, value, false, value === chosen)));
      list.addEventListener('change', () => (set(list.value), this.change()));
    };
    const first = page.pictures[0];
    const unique = (key) => [...new Set(page.pictures.map((p) => p[key]))];
    choose('view', unique('view'), first.view, (view) => this.show({view}));
    choose('variant', unique('variant'), first.variant, (variant) => this.show({variant}));
    const {steps} = page, step = this.part('step');
    step.closest('label').hidden = steps.length < 2;
    step.max = step.value = steps.length;
    step.addEventListener('input', () => this.show({step: step.value - 1}));
    this.show({});
    const clips = ['all', ...scene.clips];
    choose('clip', scene.clips.length > 1 ? clips : [], scene.clip === null ? 'all' : scene.clips[scene.clip], (value) => {
      scene.clip = value === 'all' ? null : scene.clips.indexOf(value);
      scene.duration = scene.clip === null ? page.scenes[0].duration : scene.clipDurations[scene.clip];
      this.part('time').max = scene.duration;
      this.moveTo(0);
    });
    const time = this.part('time');
    this.part('animation').hidden = !(scene.duration > 0);
    time.max = scene.duration;
    time.value = scene.time;
    this.part('seconds').textContent = `${scene.time.toFixed(2)} s`;
    time.addEventListener('input', () => {
      this.play(false);
      this.moveTo(Number(time.value));
    });
    this.part('play').addEventListener('click', () => this.play(!this.isPlaying));
    this.part('reset').addEventListener('click', () => this.reset());
  }

  // Shows a picture with this view, variant or step, and else that of now.
  show(change) {
    const {page} = this, {view, variant} = {...page.pictures[this.picture], ...change}, {step} = change;
    const fits = (p) => p.left === null && p.view === view && p.variant === variant;
    const found = page.pictures.findIndex((p) => fits(p) && p.step === step);
    this.picture = found >= 0 ? found : page.pictures.findIndex(fits);
    const shown = page.steps[page.pictures[this.picture].step];
    this.part('step').value = page.pictures[this.picture].step + 1;
    this.part('what').textContent = shown ? `${shown.name}: ${shown.what}` : '';
    this.editor.fill(shown ? shown.parts : []);
    this.change();
  }

  reset() {
    this.camera = null;
    this.change();
  }

  // Orbit, zoom and pan by pointer, touch, wheel and keyboard.
  listen() {
    const {canvas} = this, {signal} = this.listeners, pointers = new Map();
    const on = (kind, action, options) => canvas.addEventListener(kind, action, {signal, ...options});
    let moved = 0;
    const middleOf = () => times([...pointers.values()].reduce((a, b) => add(a, b), [0, 0]), 1 / pointers.size);
    const spread = () => {
      const [a, b] = [...pointers.values()];
      return b ? size(add(a, b, -1)) : 0;
    };
    on('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (!pointers.size) moved = 0;
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.focus({preventScroll: true});
    });
    const leave = (event) => pointers.delete(event.pointerId);
    on('pointerup', leave);
    on('pointercancel', leave);
    on('pointermove', (event) => {
      if (!pointers.has(event.pointerId)) return;
      const before = middleOf(), gap = spread();
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      const [dx, dy] = add(middleOf(), before, -1);
      moved += Math.abs(dx) + Math.abs(dy);
      if (pointers.size > 1) {
        this.pan(dx, dy);
        if (gap > 0 && spread() > 0) this.zoom(gap / spread());
      } else if (event.shiftKey || event.buttons & 6) {
        this.pan(dx, dy);
      } else {
        this.orbit(-0.01 * dx, 0.01 * dy);
      }
    });
    on('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.0015 * event.deltaY * (event.deltaMode ? 20 : 1)));
    }, {passive: false});
    on('contextmenu', (event) => event.preventDefault());
    on('dblclick', () => this.reset());
    on('click', (event) => moved < 4 && this.probes.pick(event.offsetX, event.offsetY));
    on('keydown', (event) => {
      const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
      if (step && event.shiftKey) this.pan(-20 * step[0], 20 * step[1]);
      else if (step) this.orbit(0.1 * step[0], 0.1 * step[1]);
      else if (event.key === '+' || event.key === '=') this.zoom(1 / 1.1);
      else if (event.key === '-') this.zoom(1.1);
      else if (event.key === 'Home' || event.key === '0') this.reset();
      else if (event.key === ' ') this.play(!this.isPlaying);
      else return;
      event.preventDefault();
    });
    new ResizeObserver(() => this.change()).observe(canvas);
  }

  // The camera that the viewer moves: it begins as that of the scene.
  own() {
    if (!this.camera) {
      const camera = {...this.scene.camera, matrix: [...this.scene.camera.matrix]};
      const {center, radius} = this.scene, eye = column(camera.matrix, 3);
      const ahead = times(column(camera.matrix, 2), -1);
      // It turns about the point in front of it that is next to the middle of the scene.
      let distance = dot(add(center, eye, -1), ahead);
      if (!(distance > 0)) distance = Math.max(radius, 1e-6);
      this.target = add(eye, ahead, distance);
      this.camera = camera;
    }
    return this.camera;
  }

  orbit(right, up) {
    const camera = this.own(), matrix = camera.matrix, eye = column(matrix, 3);
    const back = unit(add(eye, this.target, -1), column(matrix, 2));
    const elevation = Math.asin(Math.max(-1, Math.min(1, back[1])));
    const turn = Math.max(-1.55, Math.min(1.55, elevation + up)) - elevation;
    const turned = product(turnAbout([0, 1, 0], right), turnAbout(column(matrix, 0), -turn));
    const axes = [0, 1, 2].map((i) => transformed(turned, column(matrix, i), 0));
    camera.matrix = fromColumns(...axes, add(this.target, transformed(turned, add(eye, this.target, -1), 0)));
    this.enclose();
  }

  zoom(factor) {
    const camera = this.own(), eye = column(camera.matrix, 3);
    if (camera.height) camera.height *= factor;
    else [camera.matrix[12], camera.matrix[13], camera.matrix[14]] = add(this.target, add(eye, this.target, -1), factor);
    this.enclose();
  }

  pan(dx, dy) {
    const camera = this.own(), distance = size(add(column(camera.matrix, 3), this.target, -1));
    const box = this.canvas.getBoundingClientRect(), shown = this.fitted(box.width / box.height);
    const perPixel = 2 * halfHeight(shown) * (camera.height ? 1 : distance) / box.height;
    const shift = add(times(column(camera.matrix, 0), -dx * perPixel), column(camera.matrix, 1), dy * perPixel);
    this.target = add(this.target, shift);
    for (let k = 0; k < 3; ++k) camera.matrix[12 + k] += shift[k];
    this.enclose();
  }

  // Keeps the scene between the near and the far plane.
  enclose() {
    Object.assign(this.camera, depths(this.camera, this.scene));
    this.change();
  }
}

function depths(camera, {center, radius}) {
  const distance = dot(add(column(camera.matrix, 3), center, -1), column(camera.matrix, 2));
  const far = Math.max(distance + 1.01 * radius, 1e-3 * radius);
  return {near: Math.max(distance - 1.01 * radius, 1e-3 * far), far};
}

// The bytes of a zlib stream in base64.
async function unpacked(text) {
  const coded = atob(text.trim()), bytes = new Uint8Array(coded.length);
  for (let i = 0; i < coded.length; ++i) bytes[i] = coded.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

for (const root of document.querySelectorAll('.relief:not([data-state])')) root.relief = new Page(root);
