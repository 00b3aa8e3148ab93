// Plays frames of a mesh: drag to turn it, wheel to zoom, slider and space bar for time. No network, no WebGL: triangles
// are drawn into pixels with a buffer of depths. `data` holds `title`, `every` (s), `frames`, `vertices`, `low` and `step`
// (m: a coordinate is low + step * number), `places` (16-bit numbers, base64) and `triangles` (32-bit numbers, base64).
function motionPlayer(root, data) {
  'use strict';
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const places = new Uint16Array(bytes(data.places));
  const triangles = new Uint32Array(bytes(data.triangles));
  const count = data.vertices;
  const canvas = document.createElement('canvas');
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', 'the garment in motion: drag or use the arrow keys to turn it');
  const bar = document.createElement('div');
  bar.className = 'bar';
  const make = (tag, set) => Object.assign(document.createElement(tag), set);
  const play = make('button', { type: 'button', textContent: 'Play' });
  const slider = make('input', { type: 'range', min: 0, max: data.frames - 1, step: 1, value: 0 });
  slider.setAttribute('aria-label', 'frame');
  const speed = make('select', {});
  speed.setAttribute('aria-label', 'speed');
  for (const s of [0.1, 0.25, 0.5, 1, 2]) speed.append(make('option', { value: s, textContent: `${s} x`, selected: s === 1 }));
  const told = make('output', {});
  bar.append(play, slider, speed, told);
  root.append(canvas, bar);

  const view = { azimuth: 25, elevation: 10, zoom: 1 };
  const x = new Float32Array(3 * count), normals = new Float32Array(3 * count), seen = new Float32Array(3 * count);
  let time = 0, playing = false, last = 0, asked = false;

  // The middle and size of all frames: the camera does not follow.
  const low = data.low, high = [...low];
  for (let i = 0; i < places.length; i++) high[i % 3] = Math.max(high[i % 3], low[i % 3] + data.step * places[i]);
  const middle = low.map((l, k) => (l + high[k]) / 2);
  const radius = Math.max(1e-6, Math.hypot(...low.map((l, k) => (high[k] - l) / 2)));

  // Places between two frames, and the normals of their vertices.
  function pose() {
    const at = Math.min(time / data.every, data.frames - 1), first = Math.floor(at), share = at - first;
    const a = 3 * count * first, b = 3 * count * Math.min(first + 1, data.frames - 1);
    for (let i = 0; i < 3 * count; i++) x[i] = low[i % 3] + data.step * (places[a + i] * (1 - share) + places[b + i] * share);
    normals.fill(0);
    for (let t = 0; t < triangles.length; t += 3) {
      const [i, j, k] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
      const ux = x[j] - x[i], uy = x[j + 1] - x[i + 1], uz = x[j + 2] - x[i + 2];
      const vx = x[k] - x[i], vy = x[k + 1] - x[i + 1], vz = x[k + 2] - x[i + 2];
      const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      for (const v of [i, j, k]) for (let c = 0; c < 3; c++) normals[v + c] += n[c];
    }
  }

  // Every vertex as the camera sees it: pixels, depth; `normals` become brightness in their first number.
  function project(width, height) {
    const [a, e] = [view.azimuth, view.elevation].map((d) => (d * Math.PI) / 180);
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    const turn = (px, py, pz) => {
      const u = ca * px - sa * pz, w = sa * px + ca * pz;
      return [u, ce * py - se * w, se * py + ce * w];
    };
    const far = 4 * radius, scale = (0.95 * view.zoom * Math.min(width, height) * far) / (2 * radius);
    for (let v = 0; v < 3 * count; v += 3) {
      const [u, y, w] = turn(x[v] - middle[0], x[v + 1] - middle[1], x[v + 2] - middle[2]);
      const depth = Math.max(far - w, 0.05 * radius);
      seen[v] = width / 2 + (scale * u) / depth;
      seen[v + 1] = height / 2 - (scale * y) / depth;
      seen[v + 2] = depth;
      const [nu, ny, nw] = turn(normals[v], normals[v + 1], normals[v + 2]);
      const size = Math.hypot(nu, ny, nw) || 1;
      // A light beside the camera, from above; cloth is lit on both sides.
      normals[v] = Math.abs(0.3 * nu + 0.45 * ny + 0.84 * nw) / size;
    }
  }

  function draw() {
    asked = false;
    const width = canvas.width, height = canvas.height;
    if (!width || !height) return;
    pose();
    project(width, height);
    const context = canvas.getContext('2d'), image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer), depths = new Float32Array(width * height).fill(Infinity);
    pixels.fill(0xfff2f4f4);
    for (let t = 0; t < triangles.length; t += 3) fill(3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2], width, height, pixels, depths);
    context.putImageData(image, 0, 0);
    slider.value = Math.round(time / data.every);
    told.textContent = `${time.toFixed(2)} s of ${((data.frames - 1) * data.every).toFixed(2)} s`;
  }

  function fill(i, j, k, width, height, pixels, depths) {
    const ax = seen[i], ay = seen[i + 1], bx = seen[j], by = seen[j + 1], cx = seen[k], cy = seen[k + 1];
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (!area) return;
    const from = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5)), to = Math.min(height - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
    const left = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5)), right = Math.min(width - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
    // The wrong side, which faces away, is darker. Rows run downwards, so the right side has a negative area.
    const tone = area < 0 ? 1 : 0.72;
    for (let row = from; row <= to; row++) {
      const py = row + 0.5;
      for (let column = left; column <= right; column++) {
        const px = column + 0.5;
        const b = ((px - ax) * (cy - ay) - (py - ay) * (cx - ax)) / area;
        const c = ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / area;
        const a = 1 - b - c;
        if (a < 0 || b < 0 || c < 0) continue;
        const depth = a * seen[i + 2] + b * seen[j + 2] + c * seen[k + 2], place = row * width + column;
        if (depth >= depths[place]) continue;
        depths[place] = depth;
        const light = tone * (0.35 + 0.65 * (a * normals[i] + b * normals[j] + c * normals[k]));
        pixels[place] = 0xff000000 | ((190 * light) << 16) | ((202 * light) << 8) | (212 * light);
      }
    }
  }

  function ask() {
    if (!asked) { asked = true; requestAnimationFrame(draw); }
  }

  function advance(now) {
    if (!playing) return;
    const end = (data.frames - 1) * data.every;
    time += (Math.min(now - last, 100) / 1000) * speed.value;
    last = now;
    if (time >= end) { time = end; set(false); }
    draw();
    if (playing) requestAnimationFrame(advance);
  }

  function set(on) {
    if (on && time >= (data.frames - 1) * data.every) time = 0;
    playing = on && data.frames > 1;
    play.textContent = playing ? 'Pause' : 'Play';
    last = performance.now();
    if (playing) requestAnimationFrame(advance);
  }

  function size() {
    const box = canvas.getBoundingClientRect(), ratio = Math.min(devicePixelRatio || 1, 1.5);
    const [width, height] = [box.width, box.height].map((s) => Math.max(1, Math.round(s * ratio)));
    if (canvas.width === width && canvas.height === height) return;
    // A canvas is empty once it has another size: it is drawn before the page is shown again.
    [canvas.width, canvas.height] = [width, height];
    draw();
  }

  function show(wanted) {
    if ('frame' in wanted) { set(false); time = Math.max(0, Math.min(data.frames - 1, wanted.frame)) * data.every; }
    if ('azimuth' in wanted) view.azimuth = wanted.azimuth;
    if ('elevation' in wanted) view.elevation = Math.max(-89, Math.min(89, wanted.elevation));
    if ('zoom' in wanted) view.zoom = Math.max(0.2, Math.min(20, wanted.zoom));
    ask();
  }

  const turnBy = (right, up) => show({ azimuth: view.azimuth + right, elevation: view.elevation + up });
  canvas.addEventListener('pointerdown', (e) => canvas.setPointerCapture(e.pointerId));
  canvas.addEventListener('pointermove', (e) => { if (canvas.hasPointerCapture(e.pointerId)) turnBy(0.4 * e.movementX, 0.4 * e.movementY); });
  canvas.addEventListener('wheel', (e) => { e.preventDefault(); show({ zoom: view.zoom * Math.exp(-e.deltaY / 500) }); }, { passive: false });
  const keys = { ArrowLeft: () => turnBy(-5, 0), ArrowRight: () => turnBy(5, 0), ArrowUp: () => turnBy(0, 5), ArrowDown: () => turnBy(0, -5), ' ': () => set(!playing) };
  canvas.addEventListener('keydown', (e) => { if (keys[e.key]) { e.preventDefault(); keys[e.key](); } });
  play.addEventListener('click', () => set(!playing));
  slider.addEventListener('input', () => show({ frame: +slider.value }));
  new ResizeObserver(size).observe(canvas);
  size();
  return { show, play: () => set(true), frame: () => Math.round(time / data.every) };
}
