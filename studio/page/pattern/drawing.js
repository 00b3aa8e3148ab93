// The drawing of the pattern: pieces with their edges, corners, lines, notches and grain. Edges that are sewn together
// have the same colour and number.

import { svg } from "../dom/element.js";
import { cm, t } from "../words/words.js";
import { edgePoints } from "../garment/edge_line.js";
import { pocketOf } from "./sew_on.js";

/** Colours of seams, one after the other; the style sheet has as many. */
const COLOURS = 10;

/** Seams and proposals by edge: {name, number, others, proposed}. */
export function seamsByEdge(seams, proposals = []) {
    const found = new Map();
    [...seams, ...proposals].forEach((seam, i) => {
        const all = seam.sides.flat().map(({ piece, edge }) => `${piece}.${edge}`);
        for (const edge of all) {
            const others = all.filter((other) => other !== edge);
            found.set(edge, { name: seam.name, number: i + 1, others, proposed: i >= seams.length });
        }
    });
    return found;
}

const path = (points, close = false) =>
    `M${points.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join("L")}${close ? "Z" : ""}`;

const middle = (line) => {
    const i = Math.floor((line.length - 1) / 2);
    const [a, b] = [line[i], line[i + 1] ?? line[i]];
    return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
};

/** An edge: a thin line that is seen and a wide one that is easily met. */
function edgeElement(piece, edge, at, seam, reach) {
    const name = `${piece.name}.${edge.name}`;
    const line = edgePoints(piece, edge).map(at.to);
    const word = seam?.proposed ? "edge.proposed" : "edge.sewn";
    const sewn = seam ? t(word, { to: seam.others.join(", ") }) : t("edge.open");
    const label = `${name}, ${cm(edge.length)}, ${sewn}`;
    const colour = seam ? `seam-${(seam.number - 1) % COLOURS}` : "free";
    const [x, y] = middle(line);
    return svg(
        "g",
        {
            class: `edge ${colour}${seam?.proposed ? " proposed" : ""}`,
            "data-edge": name,
            "data-seam": seam?.name,
            "data-length": 1000 * edge.length,
        },
        svg("path", { class: "line", d: path(line) }),
        svg(
            "path",
            {
                class: "reach",
                d: path(line),
                role: "button",
                "aria-label": label,
                "data-edge": name,
                "data-key": `edge-${name}`,
                tabindex: reach ? 0 : -1,
            },
            svg("title", {}, label),
        ),
        seam && svg("text", { class: "number", x, y, "aria-hidden": "true" }, String(seam.number)),
    );
}

/** A corner: k is where edge k starts. */
function cornerElement(piece, k, at, reach) {
    const edge = piece.edges[k];
    const point = piece.points[edge ? edge.start : piece.corners[k]];
    const [cx, cy] = at.to(point);
    const label = t("corner.label", { k: k + 1, piece: piece.name, x: cm(point[0]), y: cm(point[1]) });
    return svg(
        "circle",
        {
            class: "corner",
            cx,
            cy,
            r: 3,
            role: "button",
            "aria-label": label,
            "data-corner": k,
            "data-piece": piece.name,
            "data-key": `corner-${piece.name}-${k}`,
            tabindex: reach ? 0 : -1,
        },
        svg("title", {}, label),
    );
}

/** A line that is drawn on a piece. That of a pocket can be moved. */
function markElement(line, at) {
    const pocket = pocketOf(line);
    const label = pocket ? t("sewOn.drag", { piece: pocket }) : line.name;
    const handle = pocket && {
        role: "button",
        tabindex: 0,
        "aria-label": label,
        "data-piece": pocket,
        "data-pocket": pocket,
        "data-key": `pocket-${pocket}`,
    };
    return svg(
        "path",
        {
            class: `mark ${line.purpose}${pocket ? " can-move" : ""}`,
            d: path(line.points.map(at.to)),
            ...handle,
        },
        svg("title", {}, label),
    );
}

/** A piece with all that is drawn on it. `reach` says whether the Tab key goes into it. */
export function pieceElement(piece, at, seams, reach) {
    const outline = path(piece.points.map(at.to), true);
    const label = t("piece.label", { piece: piece.name, edges: piece.edges.length });
    return svg(
        "g",
        { class: "piece", role: "group", "aria-label": piece.name, "data-piece": piece.name },
        svg("path", {
            class: "cloth",
            d: outline,
            role: "button",
            tabindex: 0,
            "aria-label": label,
            "data-key": `piece-${piece.name}`,
            "data-piece": piece.name,
        }),
        (piece.lines ?? []).map((line) => markElement(line, at)),
        piece.grain && svg("path", { class: "grain", d: path(piece.grain.map(at.to)) }),
        svg("text", { class: "name", x: at.middle[0], y: at.middle[1], "aria-hidden": "true" }, piece.name),
        piece.edges.map((edge) =>
            edgeElement(piece, edge, at, seams.get(`${piece.name}.${edge.name}`), reach),
        ),
        (piece.notches ?? []).map((notch) => {
            const [x, y] = at.to(notch);
            return svg("circle", { class: "notch", cx: x, cy: y, r: 2 });
        }),
        piece.edges.map((_, k) => cornerElement(piece, k, at, reach)),
    );
}
