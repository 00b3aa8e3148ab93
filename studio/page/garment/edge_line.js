// Where an edge of the pattern lies on the garment and in the photo: the vertices of its panel that lie on it.

import { store } from "../server/store.js";
import { selection } from "../server/selection.js";

/** How far from an edge a vertex may lie in the pattern's plane and still be on it, in metres. */
const ON_EDGE = 0.0008;

const kept = new WeakMap();

/** The points of an edge of a piece, in the pattern's plane. */
export function edgePoints(piece, edge) {
    const { points } = piece;
    const count = (edge.end - edge.start + points.length) % points.length || points.length;
    return Array.from({ length: count + 1 }, (_, i) => points[(edge.start + i) % points.length]);
}

/** Distance of a point from a line of points, and how far along it the nearest place lies. */
function along(line, x, y) {
    let best = { apart: Infinity, at: 0 };
    for (let i = 0, walked = 0; i + 1 < line.length; i++) {
        const [[ax, ay], [bx, by]] = [line[i], line[i + 1]];
        const length = Math.hypot(bx - ax, by - ay) || 1e-12;
        const share = Math.min(1, Math.max(0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length ** 2));
        const apart = Math.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y);
        if (apart < best.apart) best = { apart, at: walked + share * length };
        walked += length;
    }
    return best;
}

/** Vertices of the garment on an edge, from its start to its end. */
function verticesOn(mesh, pieceName, edgeName) {
    if (!kept.has(mesh)) kept.set(mesh, new Map());
    const memory = kept.get(mesh);
    const key = `${pieceName}.${edgeName}`;
    if (!memory.has(key)) memory.set(key, findVertices(mesh, pieceName, edgeName));
    return memory.get(key);
}

function findVertices(mesh, pieceName, edgeName) {
    const panel = mesh.panels.find((p) => p.name === pieceName);
    const piece = store.view?.pattern?.pieces.find((p) => p.name === pieceName);
    const edge = piece?.edges.find((e) => e.name === edgeName);
    if (!panel || !edge || !mesh.flat) return [];
    const line = edgePoints(piece, edge);
    const found = [];
    for (let i = panel.first_vertex; i < panel.first_vertex + panel.vertices; i++) {
        const { apart, at } = along(line, mesh.flat[2 * i], mesh.flat[2 * i + 1]);
        if (apart < ON_EDGE) found.push([at, i]);
    }
    return found.sort((a, b) => a[0] - b[0]).map(([, i]) => i);
}

/** The places of an edge in one of the garment's arrays: "positions" (width 3) or "photo_px" (width 2). */
export function edgeLine(piece, edge, array, width) {
    const mesh = store.garment;
    if (!mesh?.[array]) return [];
    return verticesOn(mesh, piece, edge)
        .map((i) => [...mesh[array].subarray(width * i, width * i + width)])
        .filter((p) => p.every(Number.isFinite));
}

/** The edges that are lit: one that is pointed at or chosen, and all edges of its seam. */
export function litEdges() {
    const seams = [...(store.view?.pattern?.seams ?? []), ...(store.view?.proposals ?? [])];
    const found = new Map();
    for (const what of [selection.hover, selection.chosen]) {
        const sides = seams.find((seam) => seam.name === what.seam)?.sides.flat() ?? [];
        for (const { piece, edge } of sides) found.set(`${piece}.${edge}`, { piece, edge });
        if (what.edge) {
            const cut = what.edge.indexOf(".");
            found.set(what.edge, { piece: what.edge.slice(0, cut), edge: what.edge.slice(cut + 1) });
        }
    }
    return [...found.values()];
}
