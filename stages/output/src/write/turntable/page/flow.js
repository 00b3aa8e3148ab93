// The garment between two rendered views by flow alone: pixels of the nearest views move along the flow between these views by the share of
// the way, and are blended (Chen and Williams, "View interpolation for image synthesis", 1993). The mesh has no part in the picture; only
// picking asks it. docs/reference/turntable.md defines `covers` and `flow`. Comes after turntable.js.
turntable.alongFlow = (() => {
  'use strict';

  const { bytesOf, readPicture, readSpans, azimuthOf, tierOf, limit, rasterise, makeBuffer, pickAt } = turntable.core;
  const STEP = 8;        // px between the nodes at which motion is turned round
  const PASSES = 4;      // of the search for the place that moves to a node
  const NOISE = 16;      // coverage below this is what JPEG leaves beside an outline

  // ---- Data ----

  // Neighbours of a view, in the order of its fields: right, left, above, below; -1 where there is none.
  function neighboursOf({ views, tiers }, index) {
    const tier = Math.floor(index / views) * views, v = index - tier;
    return [tier + (v + 1) % views, tier + (v + views - 1) % views, index + views < views * tiers.length ? index + views : -1, index - views >= 0 ? index - views : -1];
  }

  // Which blocks of the flow hold blocks of the sheets, so have vectors.
  function keptBlocks(data, spans, index, columns, rows) {
    const kept = new Uint8Array(columns * rows), per = data.flow.block / 8;
    for (let row = 0; row < spans.rows; row++) {
      const first = spans.bytes[2 * (index * spans.rows + row)], count = spans.bytes[2 * (index * spans.rows + row) + 1];
      for (let c = first; c < first + count; c++) kept[Math.floor(row / per) * columns + Math.floor(c / per)] = 1;
    }
    return kept;
  }

  // Blocks without a vector take the one of their row's nearest end; rows without any, the row nearest to them.
  function carryOn(field, kept, columns, rows) {
    const full = [];
    for (let row = 0; row < rows; row++) {
      const own = [];
      for (let c = 0; c < columns; c++) if (kept[row * columns + c]) own.push(c);
      if (!own.length) continue;
      full.push(row);
      for (let c = 0; c < columns; c++) {
        const near = own.reduce((best, o) => Math.abs(o - c) < Math.abs(best - c) ? o : best), from = 2 * (row * columns + near);
        if (near !== c) field.copyWithin(2 * (row * columns + c), from, from + 2);
      }
    }
    for (let row = 0; row < rows && full.length; row++) {
      const near = full.reduce((best, o) => Math.abs(o - row) < Math.abs(best - row) ? o : best);
      if (near !== row) field.copyWithin(2 * row * columns, 2 * near * columns, 2 * (near + 1) * columns);
    }
  }

  // For each view its fields in the order of its neighbours: x and y in px for each block, row by row.
  function readFlow(data, spans) {
    const bytes = bytesOf(data.flow.vectors), columns = Math.ceil(data.width / data.flow.block), rows = Math.ceil(data.height / data.flow.block);
    let at = 0;
    const next = () => {
      let code = 0, shift = 0, byte;
      do { byte = bytes[at++]; code |= (byte & 127) << shift; shift += 7; } while (byte > 127);
      return (code >>> 1) ^ -(code & 1);
    };
    const readField = kept => {
      const field = new Float32Array(2 * columns * rows);
      for (let k = 0, x = 0, y = 0; k < kept.length; k++) if (kept[k]) {
        field[2 * k] = (x += next()) / data.flow.parts;
        field[2 * k + 1] = (y += next()) / data.flow.parts;
      }
      carryOn(field, kept, columns, rows);
      return field;
    };
    const fields = [];
    for (let index = 0; index < data.views * data.tiers.length; index++) {
      const kept = keptBlocks(data, spans, index, columns, rows);
      fields.push(neighboursOf(data, index).map(n => n < 0 ? null : readField(kept)));
    }
    return { columns, rows, block: data.flow.block, fields };
  }

  // Colours of a sheet with its coverage as alpha.
  async function readSheet(data, sheet) {
    const [pixels, cover] = (await Promise.all([data.sheets[sheet], data.covers[sheet]].map(readPicture))).map(p => p.pixels);
    for (let p = 0; p < pixels.length; p++) {
      const alpha = limit(((cover[p] & 255) - NOISE) * 255 / (255 - 2 * NOISE), 0, 255);
      pixels[p] = (pixels[p] & 0xffffff) | Math.round(alpha) << 24;
    }
    return pixels;
  }

  // ---- Motion ----

  // How far the asked view is from a rendered one, as shares of the way to its neighbours: which field, and how much of it.
  function waysFrom(data, index, at) {
    const across = (((at.azimuth - azimuthOf(data, index)) % 360 + 540) % 360 - 180) * data.views / 360;
    const up = at.elevation - tierOf(data, index), tier = Math.floor(index / data.views), other = data.tiers[tier + Math.sign(up)];
    const ways = [[across > 0 ? 0 : 1, Math.abs(across)]];
    if (up !== 0 && other !== undefined) ways.push([up > 0 ? 2 : 3, limit(up / (other - data.tiers[tier]), 0, 1)]);
    return ways.filter(([, share]) => share > 1e-6);
  }

  // The motion of all blocks of a view towards the asked one.
  function motionOf(flow, index, ways) {
    const motion = new Float32Array(2 * flow.columns * flow.rows);
    for (const [direction, share] of ways) {
      const field = flow.fields[index][direction];
      for (let k = 0; k < motion.length; k++) motion[k] += share * field[k];
    }
    return motion;
  }

  // Writes what a grid of vectors says at a place, between its nodes linearly, to `out`. Nodes are `step` px apart, the first at `first`.
  function readGrid(grid, columns, rows, step, first, x, y, out) {
    const gx = limit((x - first) / step, 0, columns - 1), gy = limit((y - first) / step, 0, rows - 1);
    const cx = Math.min(gx | 0, Math.max(0, columns - 2)), cy = Math.min(gy | 0, Math.max(0, rows - 2)), fx = gx - cx, fy = gy - cy;
    const right = columns > 1 ? 2 : 0, down = rows > 1 ? 2 * columns : 0, p = 2 * (cy * columns + cx);
    for (let c = 0; c < 2; c++) {
      const top = grid[p + c] + fx * (grid[p + right + c] - grid[p + c]);
      const low = grid[p + down + c] + fx * (grid[p + down + right + c] - grid[p + down + c]);
      out[c] = top + fy * (low - top);
    }
  }

  // For nodes STEP px apart in the asked picture, where their pixels lie in the view, as differences: the place whose motion leads
  // to the node, by iteration (Bowles and others, "Iterative image warping", 2012).
  function turnRound(data, flow, motion) {
    const columns = Math.ceil(data.width / STEP) + 1, rows = Math.ceil(data.height / STEP) + 1, grid = new Float32Array(2 * columns * rows), d = [0, 0];
    for (let row = 0, k = 0; row < rows; row++) for (let column = 0; column < columns; column++, k += 2) {
      let x = column * STEP, y = row * STEP;
      for (let pass = 0; pass < PASSES; pass++) {
        readGrid(motion, flow.columns, flow.rows, flow.block, flow.block / 2, x, y, d);
        x = column * STEP - d[0]; y = row * STEP - d[1];
      }
      grid[k] = x - column * STEP; grid[k + 1] = y - row * STEP;
    }
    return { grid, columns, rows };
  }

  // ---- The picture ----

  // Adds a view's pixels, moved, to the sums of red, green, blue and coverage of the target, and its weight to their total.
  function addView(data, pixels, back, weight, target, { focal, cx, cy }) {
    const { width, height, sum, total } = target, scale = target.focal / focal, d = [0, 0], right = data.width - 1, bottom = data.height - 1;
    for (let row = 0, n = 0; row < height; row++) for (let column = 0; column < width; column++, n++) {
      const u = (column + 0.5 - cx) * scale + data.width / 2, v = (row + 0.5 - cy) * scale + data.height / 2;
      readGrid(back.grid, back.columns, back.rows, STEP, 0, u, v, d);
      const x = u + d[0] - 0.5, y = v + d[1] - 0.5;
      if (!(x > -1 && y > -1 && x < right + 1 && y < bottom + 1)) continue;
      const o = 4 * n;
      total[n] += weight;
      const sx = limit(x, 0, right), sy = limit(y, 0, bottom), px = Math.min(sx | 0, right - 1), py = Math.min(sy | 0, bottom - 1), p = py * data.width + px;
      const c0 = pixels[p], c1 = pixels[p + 1], c2 = pixels[p + data.width], c3 = pixels[p + data.width + 1];
      if (((c0 | c1 | c2 | c3) >>> 24) === 0) continue;
      const fx = sx - px, fy = sy - py, b3 = fx * fy, b2 = fy - b3, b1 = fx - b3, b0 = 1 - fx - b2;
      // Colours go on beyond the outline, so they are read without regard to coverage.
      const k = weight * (b0 * (c0 >>> 24) + b1 * (c1 >>> 24) + b2 * (c2 >>> 24) + b3 * (c3 >>> 24));
      sum[o] += k * (b0 * (c0 & 255) + b1 * (c1 & 255) + b2 * (c2 & 255) + b3 * (c3 & 255));
      sum[o + 1] += k * (b0 * (c0 >> 8 & 255) + b1 * (c1 >> 8 & 255) + b2 * (c2 >> 8 & 255) + b3 * (c3 >> 8 & 255));
      sum[o + 2] += k * (b0 * (c0 >> 16 & 255) + b1 * (c1 >> 16 & 255) + b2 * (c2 >> 16 & 255) + b3 * (c3 >> 16 & 255));
      sum[o + 3] += k;
    }
  }

  function resolve({ sum, total, rgba }) {
    for (let n = 0, o = 0; n < total.length; n++, o += 4) {
      const k = sum[o + 3] > 0 ? 1 / sum[o + 3] : 0;
      rgba[o] = k * sum[o]; rgba[o + 1] = k * sum[o + 1]; rgba[o + 2] = k * sum[o + 2]; rgba[o + 3] = total[n] > 0 ? sum[o + 3] / total[n] : 0;
    }
  }

  return (data, mesh) => {
    const flow = readFlow(data, readSpans(data)), focal = data.height / 2 / Math.tan(data.fov * Math.PI / 360);
    return {
      makeTarget: (width, height) => ({
        width, height, samples: 1, buffer: null, focal, // focal length of a view, px
        rgba: new Uint8ClampedArray(4 * width * height), sum: new Float32Array(4 * width * height), total: new Float32Array(width * height),
      }),
      readSheet: sheet => readSheet(data, sheet),
      prepare: (index, pixels) => ({ pixels }),
      draw(target, camera, at, picks, store) {
        target.sum.fill(0);
        target.total.fill(0);
        for (const { index, weight } of picks) {
          const back = turnRound(data, flow, motionOf(flow, index, waysFrom(data, index, at)));
          addView(data, store.view(index).pixels, back, weight, target, camera);
        }
        resolve(target);
      },
      // The mesh is drawn for a click only.
      pick(target, camera, x, y) {
        target.buffer ||= makeBuffer(target.width, target.height);
        rasterise(mesh, camera, target.buffer, 1);
        return pickAt(mesh, target, camera, x, y);
      },
    };
  };
})();
