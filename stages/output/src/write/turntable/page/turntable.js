// A garment that can be turned, drawn from rendered views through its own mesh.
//
// The mesh says where each pixel of the asked picture lies in space; the rendered views nearest in angle say
// which colour that place has (Buehler and others, "Unstructured lumigraph rendering", 2001).
// turntable(root, data) builds the viewer in the element `root`; docs/reference/turntable.md defines `data`.
// Lengths are metres. Pixel centres lie at half numbers. Depth is kept as 1 / distance along the camera's axis,
// because that is linear across the picture; 0 stands for "nothing there".
const turntable = (() => {
  'use strict';

  const FINE = 3;            // samples across and down in a pixel when the picture rests
  const AGREE = 0.006;       // two depths this close belong to the same surface
  const JUMP = 0.008;        // neighbouring depths further apart than this, and than the slope explains, are an edge
  const EDGE_TRUST = 40;     // weight of a colour read at an edge of its view; 255 is full weight
  const BORDER = 10;         // pixels over which a view fades out towards the border of its picture
  const limit = (x, low, high) => Math.min(high, Math.max(low, x));

  // ---- Data ----

  function bytesOf(base64) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
    return bytes;
  }

  // Corner numbers are stored as differences to the one before: zigzag for the sign, seven bits a byte, low bits first.
  function readCorners(bytes, count) {
    const corners = new Uint32Array(count);
    for (let i = 0, at = 0, value = 0; i < count; i++) {
      let code = 0, shift = 0, byte;
      do { byte = bytes[at++]; code |= (byte & 127) << shift; shift += 7; } while (byte > 127);
      value += (code >>> 1) ^ -(code & 1);
      corners[i] = value;
    }
    return corners;
  }

  // Positions are kept relative to the point all cameras look at.
  function readMesh(data) {
    const { parts, quantum, origin, positions, triangles } = data.mesh;
    const raw = bytesOf(positions), view = new DataView(raw.buffer), place = new Float32Array(raw.length / 2);
    for (let i = 0; i < place.length; i++) place[i] = view.getUint16(2 * i, true) * quantum + origin[i % 3] - data.centre[i % 3];
    const count = parts.reduce((n, part) => Math.max(n, part.first + part.count), 0), vertices = place.length / 3;
    const partOf = new Uint8Array(count);
    parts.forEach((part, i) => partOf.fill(i, part.first, part.first + part.count));
    return {
      parts, partOf, place, corners: readCorners(bytesOf(triangles), 3 * count),
      x: new Float32Array(vertices), y: new Float32Array(vertices), near: new Float32Array(vertices), // last projection
      seen: new Float32Array(4 * vertices), // sums of red, green, blue and their number, from the views opened so far
    };
  }

  const apart = (data, index, at) => Math.hypot(((azimuthOf(data, index) - at.azimuth) % 360 + 540) % 360 - 180, tierOf(data, index) - at.elevation);
  const azimuthOf = (data, index) => (index % data.views) * 360 / data.views;
  const tierOf = (data, index) => data.tiers[Math.floor(index / data.views)];

  // For each view and row of blocks: first block and number of blocks. Blocks follow each other without gaps in a sheet.
  function readSpans(data) {
    const bytes = bytesOf(data.spans), rows = Math.ceil(data.height / 8), first = [];
    for (let index = 0, next = 0; index < bytes.length / (2 * rows); index++) {
      if (index % data.perSheet === 0) next = 0;
      first.push(next);
      for (let row = 0; row < rows; row++) next += bytes[2 * (index * rows + row) + 1];
    }
    return { bytes, rows, first };
  }

  // Puts the packed blocks of one view back in place.
  function unpackView(data, spans, sheet, index) {
    const { width, height, sheetBlocks } = data, out = new Uint32Array(width * height), { bytes, rows } = spans;
    let n = spans.first[index];
    for (let row = 0; row < rows; row++) {
      const start = bytes[2 * (index * rows + row)], end = start + bytes[2 * (index * rows + row) + 1], tall = Math.min(8, height - 8 * row);
      for (let column = start; column < end; column++, n++) {
        const wide = Math.min(8, width - 8 * column);
        let from = (Math.floor(n / sheetBlocks) * sheetBlocks * 8 + n % sheetBlocks) * 8, to = row * 8 * width + column * 8;
        for (let y = 0; y < tall; y++, from += sheetBlocks * 8, to += width) for (let x = 0; x < wide; x++) out[to + x] = sheet[from + x];
      }
    }
    return out;
  }

  // ---- Cameras ----

  // A camera on the sphere round the centre, for a picture of the given size. Angles in degrees, panning in pixels of a view.
  function makeCamera(data, width, height, { azimuth, elevation, zoom = 1, panX = 0, panY = 0 }) {
    const a = azimuth * Math.PI / 180, e = elevation * Math.PI / 180, scale = height / data.height;
    const [sa, ca, se, ce] = [Math.sin(a), Math.cos(a), Math.sin(e), Math.cos(e)];
    return {
      width, height, distance: data.distance, focal: zoom * height / 2 / Math.tan(data.fov * Math.PI / 360),
      cx: width / 2 + panX * scale, cy: height / 2 + panY * scale,
      axes: [[ca, 0, -sa], [-se * sa, ce, -se * ca], [ce * sa, se, ce * ca]], // right, up, back
    };
  }

  // Rotation that takes points in the axes of one camera to those of another, row by row.
  const rotation = (from, to) => to.axes.flatMap(t => from.axes.map(f => t[0] * f[0] + t[1] * f[1] + t[2] * f[2]));

  // The views to read, with weights that are continuous in both angles and sum to 1: each cell between two views
  // and two tiers is cut into two triangles, and the three corners of the asked one share the weight.
  function pickViews(data, azimuth, elevation) {
    const { views, tiers } = data, turn = ((azimuth / 360 * views) % views + views) % views, left = Math.floor(turn), across = turn - left;
    let low = 0;
    while (low < tiers.length - 2 && elevation > tiers[low + 1]) low++;
    const high = Math.min(low + 1, tiers.length - 1);
    const up = high > low ? limit((elevation - tiers[low]) / (tiers[high] - tiers[low]), 0, 1) : 0;
    const at = (tier, step) => tier * views + (left + step) % views;
    const picks = across + up < 1
      ? [[at(low, 0), 1 - across - up], [at(low, 1), across], [at(high, 0), up]]
      : [[at(high, 1), across + up - 1], [at(low, 1), 1 - up], [at(high, 0), 1 - across]];
    return picks.map(([index, weight]) => ({ index, weight })).filter(p => p.weight > 1e-6).sort((p, q) => q.weight - p.weight);
  }

  // Views further away count less, and none beyond 60 degrees.
  const otherWeight = (data, index, at) => 0.2 * Math.max(0, 1 - apart(data, index, at) / 60) ** 4;

  // ---- Mesh to depth ----

  const makeBuffer = (width, height) => ({ width, height, near: new Float32Array(width * height), triangle: new Int32Array(width * height) });

  function project(mesh, camera) {
    const { place, x, y, near } = mesh, { axes: [r, u, b], focal, cx, cy, distance } = camera;
    for (let i = 0, k = 0; i < x.length; i++, k += 3) {
      const px = place[k], py = place[k + 1], pz = place[k + 2], w = 1 / (distance - b[0] * px - b[1] * py - b[2] * pz);
      near[i] = w;
      x[i] = cx + focal * w * (r[0] * px + r[1] * py + r[2] * pz);
      y[i] = cy - focal * w * (u[0] * px + u[1] * py + u[2] * pz);
    }
  }

  // Draws the whole mesh into a depth buffer, `samples` across and down in each pixel of the camera. Cloth has two sides, so none is dropped.
  // Spans take a hair more than their triangle, so that neighbours leave no crack.
  function rasterise(mesh, camera, buffer, samples) {
    project(mesh, camera);
    const { corners, x, y, near } = mesh, { width, height, near: depth, triangle } = buffer, hair = 1e-3;
    depth.fill(0);
    for (let t = 0, k = 0; k < corners.length; t++, k += 3) {
      const a = corners[k];
      let b = corners[k + 1], c = corners[k + 2];
      const x0 = x[a] * samples, y0 = y[a] * samples;
      let area = (x[b] * samples - x0) * (y[c] * samples - y0) - (x[c] * samples - x0) * (y[b] * samples - y0);
      if (area < 0) { const swap = b; b = c; c = swap; area = -area; }
      if (!(area > 1e-9) || near[a] <= 0 || near[b] <= 0 || near[c] <= 0) continue;
      const x1 = x[b] * samples, y1 = y[b] * samples, x2 = x[c] * samples, y2 = y[c] * samples;
      const top = Math.max(0, Math.ceil((y0 < y1 ? (y0 < y2 ? y0 : y2) : (y1 < y2 ? y1 : y2)) - 0.5 - hair));
      const bottom = Math.min(height - 1, Math.floor((y0 > y1 ? (y0 > y2 ? y0 : y2) : (y1 > y2 ? y1 : y2)) - 0.5 + hair));
      if (top > bottom) continue;
      const d0 = y1 - y0, d1 = y2 - y1, d2 = y0 - y2, s0 = (x1 - x0) / d0, s1 = (x2 - x1) / d1, s2 = (x0 - x2) / d2;
      const w0 = near[a], g1 = near[b] - w0, g2 = near[c] - w0;
      const stepX = (g1 * -d2 - g2 * d0) / area, stepY = (g2 * (x1 - x0) - g1 * (x2 - x0)) / area;
      for (let row = top; row <= bottom; row++) {
        const m = row + 0.5;
        let left = -1e9, right = 1e9, e;
        // Edges that go down bound the row on the right, edges that go up on the left.
        if (d0 !== 0) { e = x0 + s0 * (m - y0); if (d0 > 0) { if (e < right) right = e; } else if (e > left) left = e; }
        if (d1 !== 0) { e = x1 + s1 * (m - y1); if (d1 > 0) { if (e < right) right = e; } else if (e > left) left = e; }
        if (d2 !== 0) { e = x2 + s2 * (m - y2); if (d2 > 0) { if (e < right) right = e; } else if (e > left) left = e; }
        let from = Math.ceil(left - 0.5 - hair), to = Math.floor(right - 0.5 + hair);
        if (from < 0) from = 0;
        if (to > width - 1) to = width - 1;
        let w = w0 + stepX * (from + 0.5 - x0) + stepY * (m - y0);
        for (let p = row * width + from, end = row * width + to; p <= end; p++, w += stepX)
          if (w > depth[p]) { depth[p] = w; triangle[p] = t; }
      }
    }
  }

  // ---- Rendered views ----

  // Makes a view ready to be read: its depth from the mesh, its colours cleaned at edges. `colour` holds red, green and blue;
  // its fourth byte becomes the trust in the four pixels right and down from there: 0 where they lie on several surfaces.
  function prepareView(data, mesh, index, pixels) {
    const { width, height } = data, camera = makeCamera(data, width, height, { azimuth: azimuthOf(data, index), elevation: tierOf(data, index) });
    const buffer = makeBuffer(width, height), near = buffer.near, colour = pixels.slice();
    rasterise(mesh, camera, buffer, 1);
    const part = new Uint8Array(near.length);
    for (let p = 0; p < part.length; p++) part[p] = mesh.partOf[buffer.triangle[p]];
    const broken = findEdges(near, part, width, height, JUMP / data.distance ** 2);
    cleanEdges(near, part, colour, broken, width, 2 * JUMP / data.distance ** 2);
    const trust = measureTrust(near, broken, width, height);
    rememberColours(mesh, near, colour, trust, width, height, data.distance ** 2 / AGREE);
    for (let pass = 0; pass < 2; pass++) growDepth(near, part, width, height);
    for (let p = 0; p < colour.length; p++) colour[p] = (colour[p] & 0xffffff) | trust[p] << 24;
    return { camera, near, part, colour, pixels };
  }

  // Bit 1: an edge lies between this pixel and the next to the right; bit 2: and the next below. Bit 4: it lies at an edge to another surface.
  // Between parts (a hem and the body under it) a quarter of the gap is enough; at a seam there is no gap.
  function findEdges(near, part, width, height, jump) {
    const broken = new Uint8Array(width * height);
    for (const [step, bit] of [[1, 1], [width, 2]]) for (let p = 2 * step, end = width * height - 2 * step; p < end; p++) {
      const w = near[p], next = near[p + step];
      if (w === 0 && next === 0) continue;
      if (w === 0 || next === 0) { broken[p] |= bit; continue; }
      const gap = Math.abs(w - next), most = part[p] === part[p + step] ? jump : jump / 4;
      if (gap <= most || gap <= most + 2 * Math.min(Math.abs(w - near[p - step]), Math.abs(next - near[p + 2 * step]))) continue;
      broken[p] |= bit | 4;
      broken[p + step] |= 4;
    }
    return broken;
  }

  // A pixel at an edge between two surfaces holds a mixture of both. It takes the colour of clean neighbours on its own surface.
  function cleanEdges(near, part, colour, broken, width, same) {
    const round = [-1, 1, -width, width, -width - 1, -width + 1, width - 1, width + 1];
    for (let pass = 0; pass < 2; pass++) {
      const done = [];
      for (let p = width + 1; p < near.length - width - 1; p++) {
        if (!(broken[p] & 4)) continue;
        let red = 0, green = 0, blue = 0, n = 0;
        for (const step of round) {
          const q = p + step, c = colour[q];
          if (near[q] === 0 || broken[q] & 4 || part[q] !== part[p] || Math.abs(near[q] - near[p]) > same) continue;
          red += c & 255; green += c >> 8 & 255; blue += c >> 16 & 255; n++;
        }
        if (n) { colour[p] = red / n | (green / n) << 8 | (blue / n) << 16; done.push(p); }
      }
      for (const p of done) broken[p] &= 3;
    }
  }

  // Trust rises from EDGE_TRUST next to an edge to 255 three pixels away, and falls towards the border of the picture.
  function measureTrust(near, broken, width, height) {
    const trust = new Uint8Array(width * height);
    for (let y = 0; y < height - 1; y++) for (let x = 0, p = y * width; x < width - 1; x++, p++) {
      if (near[p] === 0 || near[p + 1] === 0 || near[p + width] === 0 || near[p + width + 1] === 0) continue;
      if ((broken[p] | broken[p + width]) & 1 || (broken[p] | broken[p + 1]) & 2) continue;
      trust[p] = Math.max(1, 255 * Math.min(1, (Math.min(x, y, width - 2 - x, height - 2 - y) + 0.5) / BORDER));
    }
    for (const level of [EDGE_TRUST, 110, 185]) {
      const found = [];
      for (let p = width; p < trust.length - width; p++)
        if (trust[p] > level && (trust[p - 1] < level || trust[p + 1] < level || trust[p - width] < level || trust[p + width] < level)) found.push(p);
      for (const p of found) trust[p] = level;
    }
    return trust;
  }

  // Vertices keep the mean of the colours seen of them, for places that no chosen view sees.
  function rememberColours(mesh, near, colour, trust, width, height, tight) {
    const { x, y, near: w, seen } = mesh;
    for (let i = 0; i < w.length; i++) {
      const px = Math.floor(x[i]), py = Math.floor(y[i]), p = py * width + px;
      if (px < 0 || py < 0 || px >= width || py >= height || trust[p] === 0 || Math.abs(near[p] - w[i]) * tight > 1) continue;
      seen[4 * i] += colour[p] & 255; seen[4 * i + 1] += colour[p] >> 8 & 255; seen[4 * i + 2] += colour[p] >> 16 & 255; seen[4 * i + 3]++;
    }
  }

  // Depth goes one pixel beyond the outline, so that partly covered pixels there can be read as well.
  function growDepth(near, part, width, height) {
    const found = [], made = [];
    for (let y = 1; y < height - 1; y++) for (let x = 1, p = y * width + 1; x < width - 1; x++, p++) {
      if (near[p] !== 0) continue;
      let sum = 0, n = 0;
      for (const q of [p - 1, p + 1, p - width, p + width]) if (near[q] > 0) { sum += near[q]; n++; part[p] = part[q]; }
      if (n) { found.push(p); made.push(sum / n); }
    }
    found.forEach((p, i) => { near[p] = made[i]; });
  }

  // ---- The picture ----

  // Room for one picture. Samples are places to find a colour for: one in most pixels, several where an outline crosses.
  function makeTarget(width, height, fine) {
    const size = width * height, room = fine ? 2 * size : size;
    return {
      width, height, samples: fine ? FINE : 1, buffer: makeBuffer(width * (fine ? FINE : 1), height * (fine ? FINE : 1)), rgba: new Uint8ClampedArray(4 * size),
      list: {
        count: 0, x: new Float32Array(room), y: new Float32Array(room), near: new Float32Array(room), // x and y at distance 1
        triangle: new Int32Array(room), pixel: new Int32Array(room), share: new Uint8Array(room), // share of the pixel, in samples
      },
      sum: new Float32Array(4 * room),
    };
  }

  // x and y count samples, `pixel` is where the colour goes, `share` how many samples it stands for.
  function addSample(target, camera, x, y, pixel, share) {
    const { list, buffer, samples } = target, p = y * buffer.width + x;
    if (buffer.near[p] === 0) return;
    const n = list.count++;
    list.x[n] = ((x + 0.5) / samples - camera.cx) / camera.focal;
    list.y[n] = (camera.cy - (y + 0.5) / samples) / camera.focal;
    list.near[n] = buffer.near[p]; list.triangle[n] = buffer.triangle[p]; list.pixel[n] = pixel; list.share[n] = share;
  }

  // The same with one sample a pixel, for speed.
  function collectSimply({ width, height, list, buffer: { near, triangle } }, { focal, cx, cy }) {
    const { x: listX, y: listY, near: listNear, triangle: listTriangle, pixel: listPixel } = list, scale = 1 / focal;
    let n = 0;
    for (let y = 0, p = 0; y < height; y++) for (let x = 0, up = (cy - y - 0.5) * scale; x < width; x++, p++) {
      if (near[p] === 0) continue;
      listX[n] = (x + 0.5 - cx) * scale; listY[n] = up; listNear[n] = near[p]; listTriangle[n] = triangle[p]; listPixel[n] = p;
      n++;
    }
    list.share.fill(1, 0, n);
    list.count = n;
  }

  // Lists the places of the picture that need a colour.
  function collectSamples(target, camera) {
    if (target.samples === 1) { collectSimply(target, camera); return; }
    const { width, height, list, buffer: { near } } = target, wide = width * FINE;
    const crease = 0.002 / camera.distance ** 2, room = list.x.length - FINE * FINE;
    list.count = 0;
    for (let y = 0, pixel = 0; y < height; y++) for (let x = 0; x < width; x++, pixel++) {
      const middle = (y * FINE + 1) * wide + x * FINE + 1, w = near[middle];
      let plain = true, covered = w > 0;
      // A pixel is plain when its samples lie on one flat piece, or when all are empty.
      for (const step of [1, wide - 1, wide, wide + 1]) {
        const p = near[middle - step], q = near[middle + step];
        if (p > 0 || q > 0) covered = true;
        if (p === 0 || q === 0 || p + q - 2 * w > crease || p + q - 2 * w < -crease) plain = false;
      }
      if (!covered) continue;
      if (plain || list.count > room) addSample(target, camera, x * FINE + 1, y * FINE + 1, pixel, FINE * FINE);
      else for (let j = 0; j < FINE; j++) for (let i = 0; i < FINE; i++) addSample(target, camera, x * FINE + i, y * FINE + j, pixel, 1);
    }
  }

  // Adds what one view knows about each sample. A colour counts as far as the view's own depth agrees with the sample's.
  function readView(view, weight, target, camera, partOf) {
    const { near, part, colour, camera: { width, height, focal, cx, cy, distance } } = view;
    const { sum, list: { count, x: listX, y: listY, near: listNear, triangle } } = target;
    const [m0, m1, m2, m3, m4, m5, m6, m7, m8] = rotation(camera, view.camera);
    const tight = distance * distance / AGREE, loose = tight / 3, right = width - 1.001, bottom = height - 1.001;
    for (let n = 0, o = 0; n < count; n++, o += 4) {
      const rx = listX[n], ry = listY[n], w = listNear[n], back = distance * w - 1;
      const q = 1 / (distance * w - m6 * rx - m7 * ry - m8 * back);
      const u = cx - 0.5 + focal * q * (m0 * rx + m1 * ry + m2 * back), v = cy - 0.5 - focal * q * (m3 * rx + m4 * ry + m5 * back);
      if (!(u >= 0 && v >= 0 && u < right && v < bottom)) continue;
      const x = u | 0, y = v | 0, fx = u - x, fy = v - y, p = y * width + x, goal = w * q;
      const c0 = colour[p], c1 = colour[p + 1], c2 = colour[p + width], c3 = colour[p + width + 1];
      const n0 = near[p], n1 = near[p + 1], n2 = near[p + width], n3 = near[p + width + 1];
      let b3 = fx * fy, b2 = fy - b3, b1 = fx - b3, b0 = 1 - fx - b2, trust = c0 >>> 24, factor;
      if (trust > 0) {
        const gap = (b0 * n0 + b1 * n1 + b2 * n2 + b3 * n3 - goal) * tight;
        factor = 1 - gap * gap;
        if (factor <= 0) continue;
        factor *= weight * trust;
      } else {
        // Several surfaces meet here: each of the four pixels is asked by itself.
        const own = partOf[triangle[n]];
        let gap = (n0 - goal) * loose; b0 = part[p] === own && gap * gap < 1 ? b0 * (1 - gap * gap) : 0;
        gap = (n1 - goal) * loose; b1 = part[p + 1] === own && gap * gap < 1 ? b1 * (1 - gap * gap) : 0;
        gap = (n2 - goal) * loose; b2 = part[p + width] === own && gap * gap < 1 ? b2 * (1 - gap * gap) : 0;
        gap = (n3 - goal) * loose; b3 = part[p + width + 1] === own && gap * gap < 1 ? b3 * (1 - gap * gap) : 0;
        factor = weight * EDGE_TRUST;
      }
      b0 *= factor; b1 *= factor; b2 *= factor; b3 *= factor;
      sum[o] += b0 * (c0 & 255) + b1 * (c1 & 255) + b2 * (c2 & 255) + b3 * (c3 & 255);
      sum[o + 1] += b0 * (c0 >> 8 & 255) + b1 * (c1 >> 8 & 255) + b2 * (c2 >> 8 & 255) + b3 * (c3 >> 8 & 255);
      sum[o + 2] += b0 * (c0 >> 16 & 255) + b1 * (c1 >> 16 & 255) + b2 * (c2 >> 16 & 255) + b3 * (c3 >> 16 & 255);
      sum[o + 3] += b0 + b1 + b2 + b3;
    }
  }

  // Places that the chosen views hardly know are looked up in other views at hand. Their share grows as the others' knowledge falls.
  function askOthers(mesh, target, camera, others) {
    const { list, sum } = target, lost = [];
    for (let n = 0; n < list.count; n++) if (sum[4 * n + 3] < 1) lost.push(n);
    if (!lost.length || !others.length) return;
    const [x, y, near] = [list.x, list.y, list.near].map(all => Float32Array.from(lost, n => all[n]));
    const few = { sum: new Float32Array(4 * lost.length), list: { count: lost.length, x, y, near, triangle: Int32Array.from(lost, n => list.triangle[n]) } };
    for (const { view, weight } of others) readView(view, weight, few, camera, mesh.partOf);
    lost.forEach((n, i) => {
      const share = 1 - sum[4 * n + 3];
      for (let c = 0; c < 4; c++) sum[4 * n + c] += share * few.sum[4 * i + c];
    });
  }

  // Mean colour of a part, from the vertices seen so far.
  function partColour(mesh, part) {
    const { corners, seen } = mesh, { first, count } = mesh.parts[part], total = [0, 0, 0, 0];
    for (let k = 3 * first; k < 3 * (first + count); k++) for (let c = 0; c < 4; c++) total[c] += seen[4 * corners[k] + c];
    return total[3] > 0 ? total.slice(0, 3).map(x => x / total[3]) : [128, 128, 128];
  }

  // Colour for a place that no chosen view sees: what other views have seen of its corners, else the part's mean, darker where it turns away.
  function guessColour(mesh, camera, triangle, means) {
    const { corners, seen, place } = mesh, total = [0, 0, 0, 0];
    for (let k = 3 * triangle; k < 3 * triangle + 3; k++) for (let c = 0; c < 4; c++) total[c] += seen[4 * corners[k] + c];
    if (total[3] > 0) return total.map(x => x / total[3]);
    const [a, b, c] = [0, 1, 2].map(k => place.subarray(3 * corners[3 * triangle + k], 3 * corners[3 * triangle + k] + 3));
    const e = [0, 1, 2].map(k => b[k] - a[k]), f = [0, 1, 2].map(k => c[k] - a[k]);
    const normal = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    const facing = Math.abs(normal.reduce((s, x, k) => s + x * camera.axes[2][k], 0)) / (Math.hypot(...normal) || 1);
    const part = mesh.partOf[triangle], mean = means[part] || (means[part] = partColour(mesh, part));
    return mean.map(x => x * (0.6 + 0.4 * facing));
  }

  // Turns sums into pixels. Samples of a pixel follow each other in the list. Returns the number of samples that no view saw.
  function resolve(target, mesh, camera, exact) {
    const { list, sum, rgba, samples } = target, { count, pixel, share } = list, full = samples * samples, means = [];
    let unseen = 0;
    rgba.fill(0);
    for (let n = 0; n < count;) {
      const at = pixel[n], o = 4 * at;
      if (share[n] === full && sum[4 * n + 3] >= 1) {
        const k = 1 / sum[4 * n + 3];
        rgba[o] = k * sum[4 * n]; rgba[o + 1] = k * sum[4 * n + 1]; rgba[o + 2] = k * sum[4 * n + 2]; rgba[o + 3] = 255;
        n++;
        continue;
      }
      let red = 0, green = 0, blue = 0, number = 0, cover = 0;
      for (; n < count && pixel[n] === at; n++, number++) {
        const weight = sum[4 * n + 3], known = Math.min(1, weight), k = weight > 0 ? known / weight : 0;
        red += k * sum[4 * n]; green += k * sum[4 * n + 1]; blue += k * sum[4 * n + 2]; cover += share[n];
        if (known === 1) continue;
        const guess = guessColour(mesh, camera, list.triangle[n], means);
        red += (1 - known) * guess[0]; green += (1 - known) * guess[1]; blue += (1 - known) * guess[2]; unseen++;
      }
      rgba[o] = red / number; rgba[o + 1] = green / number; rgba[o + 2] = blue / number; rgba[o + 3] = 255 * cover / full;
    }
    if (exact) for (let n = 0; n < count; n++) {
      const o = 4 * pixel[n], c = exact[pixel[n]];
      rgba[o] = c & 255; rgba[o + 1] = c >> 8 & 255; rgba[o + 2] = c >> 16 & 255;
    }
    return unseen;
  }

  // Draws the garment as `camera` sees it into target.rgba (straight alpha). `sources` are prepared views with weights.
  // When the camera stands where a view was rendered, `exact` gives that view's own pixels. `others` fill in what `sources` do not see.
  function drawPicture(mesh, target, camera, sources, exact = null, others = []) {
    rasterise(mesh, camera, target.buffer, target.samples);
    collectSamples(target, camera);
    target.sum.fill(0, 0, 4 * target.list.count);
    for (const { view, weight } of sources) readView(view, weight, target, camera, mesh.partOf);
    askOthers(mesh, target, camera, others);
    return resolve(target, mesh, camera, exact);
  }

  // What lies under a place of the canvas: part, triangle within the part, and its weights of the triangle's corners.
  function pickAt(mesh, target, camera, x, y) {
    const { buffer, samples } = target, column = Math.floor(x * samples), row = Math.floor(y * samples), p = row * buffer.width + column;
    if (column < 0 || row < 0 || column >= buffer.width || row >= buffer.height || buffer.near[p] === 0) return null;
    const triangle = buffer.triangle[p], part = mesh.partOf[triangle], corner = [0, 1, 2].map(k => mesh.corners[3 * triangle + k]);
    // From the middle of the sample, which lies in the triangle; the place itself may lie just outside.
    x = (column + 0.5) / samples; y = (row + 0.5) / samples;
    project(mesh, camera);
    const [a, b, c] = corner.map(i => [mesh.x[i], mesh.y[i], mesh.near[i]]);
    const area = (p, q) => (p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y);
    // Weights on the picture times 1 / distance are, up to scale, weights in space.
    const raw = [area(b, c) * a[2], area(c, a) * b[2], area(a, b) * c[2]], sum = raw[0] + raw[1] + raw[2];
    return { part: mesh.parts[part].name, partIndex: part, triangle: triangle - mesh.parts[part].first, barycentric: raw.map(v => limit(v / sum, 0, 1)) };
  }

  // ---- The page ----

  const KEEP = 12, MAX_ZOOM = 6;    // views kept ready; greatest zoom
  const BUDGET = 28, REST = 120;    // milliseconds a frame may take while moving; milliseconds without input before the fine picture
  const BUTTONS = [['Front', 0], ['Three-quarter', 45], ['Left', 90], ['Back', 180], ['Right', 270]]; // the wearer's left and right

  function make(parent, tag, name, attributes = {}, text = '') {
    const element = document.createElement(tag);
    if (name) element.className = name;
    for (const key of Object.keys(attributes)) element.setAttribute(key, attributes[key]);
    element.textContent = text;
    return parent.appendChild(element);
  }

  // Decodes a picture to red, green, blue and alpha in one number a pixel.
  async function readPicture(uri) {
    const image = new Image();
    image.src = uri;
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.naturalWidth; canvas.height = image.naturalHeight;
    const pen = canvas.getContext('2d', { willReadFrequently: true });
    pen.drawImage(image, 0, 0);
    return { width: canvas.width, height: canvas.height, pixels: new Uint32Array(pen.getImageData(0, 0, canvas.width, canvas.height).data.buffer) };
  }

  // How the picture between views comes about: here through the mesh; flow.js has the other way.
  function throughMesh(data, mesh) {
    return {
      makeTarget, // (width, height, fine)
      readSheet: async sheet => (await readPicture(data.sheets[sheet])).pixels,
      prepare: (index, pixels) => prepareView(data, mesh, index, pixels),
      // Fills target.rgba. `picks` are views and weights.
      draw(target, camera, at, picks, store, fine) {
        const sources = picks.map(p => ({ view: store.view(p.index), weight: p.weight })), [first] = picks;
        const standing = fine && first.weight > 0.9999 && at.zoom === 1 && Math.abs(tierOf(data, first.index) - at.elevation) < 0.01;
        drawPicture(mesh, target, camera, sources, standing ? sources[0].view.pixels : null, store.others(picks, at));
      },
      pick: (target, camera, x, y) => pickAt(mesh, target, camera, x, y), // px of the target
    };
  }

  // Sheets are decoded one after the other, and views made ready when they are needed; the least recently used one goes.
  function makeStore(data, way) {
    const spans = readSpans(data), sheets = new Array(data.sheets.length).fill(null), ready = new Map(), count = data.views * data.tiers.length;
    const nearestOf = (at, fits) => {
      let best = -1;
      for (let i = 0; i < count; i++) if (fits(Math.floor(i / data.perSheet)) && (best < 0 || apart(data, i, at) < apart(data, best, at))) best = i;
      return best;
    };
    const store = {
      loaded: index => sheets[Math.floor(index / data.perSheet)] !== null,
      isReady: index => ready.has(index),
      others: (picks, at) => [...ready].filter(([index]) => !picks.some(p => p.index === index))
        .map(([index, view]) => ({ view, weight: otherWeight(data, index, at) })).filter(o => o.weight > 0.001),
      nearest: at => nearestOf(at, sheet => sheets[sheet] !== null),
      view(index) {
        const view = ready.get(index) || way.prepare(index, unpackView(data, spans, sheets[Math.floor(index / data.perSheet)], index));
        ready.delete(index);
        ready.set(index, view);
        if (ready.size > KEEP) ready.delete(ready.keys().next().value);
        return view;
      },
      async load(at, afterEach) {
        for (let left = sheets.length; left > 0; left--) {
          const sheet = Math.floor(nearestOf(at, k => sheets[k] === null) / data.perSheet);
          sheets[sheet] = await way.readSheet(sheet);
          afterEach();
          await new Promise(done => setTimeout(done)); // lets a frame through
        }
      },
    };
    return store;
  }

  // Draws what is asked on a canvas: coarse and fast while moving, fine at rest.
  function makePainter(data, way, store, canvas) {
    const pen = canvas.getContext('2d'), targets = new Map();
    let cost = 15, scale = 1, frames = 0, last = null;
    const scaleCost = (from, to) => 0.4 + 0.6 * (to / from) ** 2; // part of the work does not depend on the size
    const resize = to => { cost *= scaleCost(scale, to); scale = to; };
    const targetFor = fine => {
      const key = fine ? 'fine' : scale, size = fine ? 1 : scale;
      if (!targets.has(key)) targets.set(key, way.makeTarget(Math.round(data.width * size), Math.round(data.height * size), fine));
      return targets.get(key);
    };
    return {
      // Returns false when no view is there yet.
      draw(at, fine) {
        let picks = pickViews(data, at.azimuth, at.elevation).filter(p => store.loaded(p.index));
        if (!picks.length) { const index = store.nearest(at); if (index < 0) return false; picks = [{ index, weight: 1 }]; }
        // In a fast turn making views ready would take longer than the turn: one view a frame has to do.
        const fast = !fine && last && Math.abs(at.azimuth - last.at.azimuth) > 180 / data.views;
        if (fast && !picks.every(p => store.isReady(p.index))) picks = [{ index: picks[0].index, weight: 1 }];
        for (const { index } of picks) store.view(index);
        const begun = performance.now(), target = targetFor(fine), camera = makeCamera(data, target.width, target.height, at);
        way.draw(target, camera, at, picks, store, fine);
        if (canvas.width !== target.width) { canvas.width = target.width; canvas.height = target.height; }
        pen.putImageData(new ImageData(target.rgba, target.width, target.height), 0, 0);
        last = { target, camera, at: { ...at } };
        if (!fine) {
          // Slow machines get a smaller picture while moving. The first frames do not count: the code is still being compiled.
          frames++;
          if (frames > 10) cost += (performance.now() - begun - cost) * 0.1;
          if (cost > BUDGET && scale > 0.5) resize(scale - 0.25);
          else if (scale < 1 && cost * scaleCost(scale, scale + 0.25) < 0.8 * BUDGET) resize(scale + 0.25);
        }
        return true;
      },
      // x and y run from 0 to 1 across and down the canvas.
      pick: (x, y) => last && way.pick(last.target, last.camera, x * last.target.width, y * last.target.height),
    };
  }

  // Draws the surroundings small, to be stretched: they are out of focus anyway.
  function drawPanorama(data, canvas, { width, height, pixels }, at) {
    const w = canvas.width, h = canvas.height, pen = canvas.getContext('2d'), picture = pen.createImageData(w, h), to = new Uint32Array(picture.data.buffer);
    const [r, u, b] = makeCamera(data, w, h, at).axes, k = 2 * Math.tan((data.panoramaFov || 45) * Math.PI / 360) / h;
    for (let y = 0, n = 0; y < h; y++) for (let x = 0; x < w; x++, n++) {
      const dx = (x + 0.5 - w / 2) * k, dy = (h / 2 - y - 0.5) * k;
      const px = r[0] * dx + u[0] * dy - b[0], py = u[1] * dy - b[1], pz = r[2] * dx + u[2] * dy - b[2];
      const across = Math.floor((0.5 + Math.atan2(px, -pz) / (2 * Math.PI)) * width) % width;
      const down = Math.min(height - 1, Math.floor((0.5 - Math.atan2(py, Math.hypot(px, pz)) / Math.PI) * height));
      to[n] = pixels[down * width + across];
    }
    pen.putImageData(picture, 0, 0);
  }

  // Pointers: one turns, with shift it moves the picture; two pinch and move. A press without movement is a click.
  function listenToPointers(stage, data, { turn, move, zoomAt, click, release }) {
    const held = new Map(), scale = () => data.width / stage.clientWidth;
    let travel = 0;
    stage.addEventListener('pointerdown', e => {
      if (e.button > 0) return;
      stage.setPointerCapture(e.pointerId);
      travel = held.size ? 99 : 0;
      held.set(e.pointerId, [e.clientX, e.clientY]);
      stage.classList.add('tt-held');
    });
    stage.addEventListener('pointermove', e => {
      const was = held.get(e.pointerId);
      if (!was) return;
      const dx = e.clientX - was[0], dy = e.clientY - was[1], other = [...held].find(([id]) => id !== e.pointerId);
      held.set(e.pointerId, [e.clientX, e.clientY]);
      travel += Math.abs(dx) + Math.abs(dy);
      if (other) {
        const [ox, oy] = other[1], before = Math.hypot(was[0] - ox, was[1] - oy), after = Math.hypot(e.clientX - ox, e.clientY - oy);
        move(dx / 2 * scale(), dy / 2 * scale());
        if (before > 10) zoomAt(after / before, (e.clientX + ox) / 2, (e.clientY + oy) / 2);
      } else if (e.shiftKey) move(dx * scale(), dy * scale());
      else turn(dx / stage.clientWidth, dy / stage.clientWidth);
    });
    const lift = e => {
      if (!held.delete(e.pointerId) || held.size) return;
      stage.classList.remove('tt-held');
      if (e.type === 'pointerup' && travel < 4) click(e); else release();
    };
    stage.addEventListener('pointerup', lift);
    stage.addEventListener('pointercancel', lift);
    stage.addEventListener('wheel', e => {
      e.preventDefault();
      zoomAt(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0015)), e.clientX, e.clientY);
    }, { passive: false });
    return { isHeld: () => held.size > 0 };
  }

  function buildPage(root, data) {
    const label = data.label || 'Garment';
    root.classList.add('tt-root');
    root.style.setProperty('--tt-ratio', data.width / data.height);
    if (data.title) make(root, 'h2', 'tt-title', {}, data.title);
    const range = { 'aria-orientation': 'horizontal', 'aria-valuemin': 0, 'aria-valuemax': 359, 'aria-valuenow': 0 };
    const stage = make(root, 'div', 'tt-stage', { tabindex: 0, role: 'slider', 'aria-label': label, ...range });
    if (data.background) stage.style.background = data.background;
    const behind = make(stage, 'canvas', 'tt-canvas tt-behind', { 'aria-hidden': 'true' }), front = make(stage, 'canvas', 'tt-canvas', { 'aria-hidden': 'true' });
    front.width = data.width; front.height = data.height;
    const tools = make(root, 'div', 'tt-tools', { role: 'group', 'aria-label': 'View' });
    const state = make(root, 'p', 'tt-state', { role: 'status', 'aria-live': 'polite' }, 'Loading');
    make(root, 'p', 'tt-help', {}, 'Drag or use the arrow keys to turn. Wheel, pinch, + and \u2212 zoom. '
      + 'Shift and drag, or two fingers, move the picture. Home or a double click goes back to the front.');
    return { stage, behind, front, tools, state };
  }

  function turntable(root, data) {
    const { stage, behind, front, tools, state } = buildPage(root, data);
    const mesh = readMesh(data), way = data.flow ? turntable.alongFlow(data, mesh) : throughMesh(data, mesh);
    const store = makeStore(data, way), painter = makePainter(data, way, store, front);
    const low = Math.min(...data.tiers), high = Math.max(...data.tiers), home = { azimuth: 0, elevation: limit(5, low, high), zoom: 1, panX: 0, panY: 0 };
    const calm = matchMedia('(prefers-reduced-motion: reduce)');
    // `goal` is what the person asked for; `now` is what is shown, and follows it. `spin` goes on after a drag, in degrees a millisecond.
    const goal = { ...home }, now = { ...home }, spin = { azimuth: 0, at: 0 };
    let asked = false, shown = null, fine = false, timer = 0, panorama = null, before = 0;
    const wrap = angle => (angle % 360 + 360) % 360;

    function tidy() {
      goal.elevation = limit(goal.elevation, low - 3, high + 3);
      goal.zoom = limit(goal.zoom, 1, MAX_ZOOM);
      goal.panX = limit(goal.panX, -data.width / 2 * (goal.zoom - 1), data.width / 2 * (goal.zoom - 1));
      goal.panY = limit(goal.panY, -data.height / 2 * (goal.zoom - 1), data.height / 2 * (goal.zoom - 1));
    }
    function say() {
      const around = Math.round(wrap(goal.azimuth)) % 360, up = Math.round(goal.elevation);
      const text = `${around} degrees round, ${Math.abs(up)} degrees ${up < 0 ? 'from below' : 'from above'}, zoom ${goal.zoom.toFixed(1)}`;
      if (state.textContent === text) return;
      stage.setAttribute('aria-valuenow', around);
      stage.setAttribute('aria-valuetext', text);
      state.textContent = text;
    }
    function paint(isFine) {
      tidy();
      const turned = !shown || shown.azimuth !== now.azimuth || shown.elevation !== now.elevation;
      if (!painter.draw(now, isFine)) return;
      if (panorama && turned) drawPanorama(data, behind, panorama, now);
      shown = { ...now }; fine = isFine;
    }
    function ask() {
      clearTimeout(timer);
      timer = setTimeout(rest, REST);
      if (!asked) { asked = true; requestAnimationFrame(frame); }
    }
    // Nothing has moved for a while: the fine picture, the words, and the neighbouring views for the next turn.
    function rest() {
      if (asked) return;
      if (!fine) paint(true);
      say();
      makeReady();
    }
    function makeReady() {
      const step = 360 / data.views;
      for (const side of [step, -step]) for (const { index } of pickViews(data, goal.azimuth + side, goal.elevation))
        if (store.loaded(index) && !store.isReady(index)) { store.view(index); timer = setTimeout(rest, 20); return; }
    }
    // Moves `now` towards `goal`. Returns whether it is still on its way.
    function follow(passed) {
      if (!pointers.isHeld() && Math.abs(spin.azimuth) > 0.005) { goal.azimuth += spin.azimuth * passed; spin.azimuth *= Math.exp(-passed / 250); }
      const share = calm.matches ? 1 : 1 - Math.exp(-passed / 40);
      let onWay = false;
      for (const key of Object.keys(goal)) {
        const gap = goal[key] - now[key], small = key === 'zoom' ? 0.002 : key.startsWith('pan') ? 0.3 : 0.03;
        now[key] = Math.abs(gap) < small ? goal[key] : now[key] + gap * share;
        if (now[key] !== goal[key]) onWay = true;
      }
      return onWay || (!pointers.isHeld() && Math.abs(spin.azimuth) > 0.005);
    }
    function frame(time) {
      asked = false;
      tidy();
      const onWay = follow(limit(time - before, 1, 50));
      before = time;
      if (!shown || Object.keys(now).some(key => now[key] !== shown[key])) paint(false);
      if (onWay) ask();
      // While a hand or its swing turns the garment, the words wait for the rest.
      if (!pointers.isHeld() && Math.abs(spin.azimuth) <= 0.005) say();
    }

    function change(changes) {
      Object.assign(goal, changes);
      spin.azimuth = 0;
      ask();
    }
    // The shorter way round.
    const turnTo = azimuth => { now.azimuth = goal.azimuth = wrap(now.azimuth - azimuth + 180) - 180 + azimuth; change({ azimuth }); };
    const goHome = () => { turnTo(0); change(home); };
    const zoomBy = k => { const zoom = limit(goal.zoom * k, 1, MAX_ZOOM); change({ zoom, panX: goal.panX * zoom / goal.zoom, panY: goal.panY * zoom / goal.zoom }); };
    const onStage = e => { const box = front.getBoundingClientRect(); return [(e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height]; };
    const pointers = listenToPointers(stage, data, {
      turn(dx, dy) {
        // Half a turn across the stage; finer when zoomed in. The garment follows the hand.
        const k = 180 / Math.sqrt(goal.zoom), time = performance.now(), passed = Math.max(8, time - spin.at), speed = -dx * k / passed;
        change({ azimuth: goal.azimuth - dx * k, elevation: goal.elevation + dy * k });
        Object.assign(spin, { azimuth: passed < 80 && !calm.matches ? limit(speed, -0.3, 0.3) : 0, at: time });
      },
      move: (dx, dy) => change({ panX: goal.panX + dx, panY: goal.panY + dy }),
      // The point under the pointer stays where it is.
      zoomAt(factor, clientX, clientY) {
        const [fx, fy] = onStage({ clientX, clientY }), x = (fx - 0.5) * data.width, y = (fy - 0.5) * data.height;
        const zoom = limit(goal.zoom * factor, 1, MAX_ZOOM), k = zoom / goal.zoom;
        change({ zoom, panX: x - (x - goal.panX) * k, panY: y - (y - goal.panY) * k });
      },
      click(e) {
        const detail = painter.pick(...onStage(e));
        if (detail) stage.dispatchEvent(new CustomEvent('toile:pick', { bubbles: true, detail }));
      },
      release() { if (performance.now() - spin.at > 60) spin.azimuth = 0; ask(); },
    });
    stage.addEventListener('dblclick', goHome);
    const keys = {
      ArrowLeft: () => change({ azimuth: goal.azimuth - 10 }), ArrowRight: () => change({ azimuth: goal.azimuth + 10 }),
      ArrowUp: () => change({ elevation: goal.elevation + 5 }), ArrowDown: () => change({ elevation: goal.elevation - 5 }),
      '+': () => zoomBy(1.25), '=': () => zoomBy(1.25), '-': () => zoomBy(0.8), Home: goHome,
    };
    stage.addEventListener('keydown', e => {
      if (!keys[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
      e.preventDefault();
      keys[e.key]();
    });
    for (const [text, azimuth] of BUTTONS) make(tools, 'button', 'tt-button', { type: 'button' }, text).addEventListener('click', () => turnTo(azimuth));
    for (const [text, name, k] of [['\u2212', 'Zoom out', 0.8], ['+', 'Zoom in', 1.25]])
      make(tools, 'button', 'tt-button', { type: 'button', 'aria-label': name }, text).addEventListener('click', () => zoomBy(k));

    // Paper gets the front.
    addEventListener('beforeprint', () => { painter.draw(home, true); if (panorama) drawPanorama(data, behind, panorama, home); });
    addEventListener('afterprint', () => { shown = null; ask(); });

    const failed = () => { state.textContent = 'The pictures in this page cannot be read.'; };
    const loading = store.load(goal, () => { shown = null; ask(); }).then(() => { root.dataset.ttLoaded = 'yes'; }, failed);
    if (data.panorama) readPicture(data.panorama).then(picture => {
      panorama = picture;
      behind.width = Math.ceil(data.width / 3); behind.height = Math.ceil(data.height / 3);
      shown = null;
      ask();
    }, () => {});
    return {
      stage, loading,
      // Shows a view at once: any of azimuth, elevation, zoom, panX, panY.
      show(view) { Object.assign(goal, view); tidy(); Object.assign(now, goal); spin.azimuth = 0; shown = null; ask(); },
      pick: (x, y) => painter.pick(x / front.clientWidth, y / front.clientHeight), // CSS pixels from the stage's top left corner
    };
  }

  // The parts without a page, for measuring and testing.
  turntable.core = {
    bytesOf, readPicture, azimuthOf, tierOf, limit, otherWeight, readMesh, readSpans, unpackView, prepareView, makeCamera, pickViews, makeTarget, drawPicture, pickAt, rasterise, makeBuffer,
  };
  if (typeof module === 'object') module.exports = turntable;
  return turntable;
})();
