// One selection for the three panes. `hover` is what the pointer is on, `chosen` what was clicked. Each is
// {piece, edge, corner, seam, spot}: edge is "piece.edge", seam a seam's name, corner a number of the piece, and spot
// the same place in all three panes: {triangle, photo: [x, y], flat: [x, y], position: [x, y, z], strain}.

import { tell } from "./store.js";

export const selection = { hover: {}, chosen: {} };

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

export function hover(what = {}) {
    if (same(selection.hover, what)) return;
    selection.hover = what;
    tell("hover");
}

export function choose(what = {}) {
    if (same(selection.chosen, what)) return;
    selection.chosen = what;
    tell("chosen");
}

/** Whether a thing of that kind is lit: under the pointer, or chosen. */
export const isLit = (kind, name) => selection.hover[kind] === name || selection.chosen[kind] === name;
