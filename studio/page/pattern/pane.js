// The pattern in the plane. A click chooses a piece, an edge or a corner; what is chosen is dragged, or moved by arrow
// keys in steps of 5 mm. Two edges are sewn by clicking one after the other.

import { h, replace, svg } from "../dom/element.js";
import { zoomable } from "../dom/zoom.js";
import { draggable, isHeld } from "../dom/drag.js";
import { oldNotice } from "../head/old.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";
import { choose, hover, isLit, selection } from "../server/selection.js";
import { spotOf, triangleAt } from "../server/mesh_file.js";
import { litEdges } from "../garment/edge_line.js";
import { alter, moveCorner, moveEdge } from "./alterations.js";
import { pieceElement, seamsByEdge } from "./drawing.js";
import { arrange } from "./plane.js";
import { mountInspector } from "./inspector.js";
import { mountPrinting } from "./printing.js";
import { proposals } from "./proposals.js";
import { dragsPocket } from "./sew_on.js";
import { sewing } from "./sewing.js";

/** What an arrow key moves, in millimetres. */
const STEP = 5;
/** The width of a letter of a piece's name, in pixels: a piece that is narrower than its name is not named. */
const LETTER = 7;
/** Edges that are shorter on the screen show no number, in pixels. */
const NUMBERED = 30;
/** Corners at shorter edges are shown on the piece that is chosen. */
const CORNERED = 24;

let plane = { box: [0, 0, 100, 100], at: new Map() };
let seams = new Map();

/** What an element of the drawing stands for. */
function meant(target) {
    const { edge, corner, piece } = target.dataset ?? {};
    if (edge) return { piece: edge.slice(0, edge.indexOf(".")), edge, seam: seams.get(edge)?.name };
    if (corner !== undefined) return { piece, corner: Number(corner) };
    return piece ? { piece } : {};
}

/** The place of the garment at a point of a piece. */
function spotAt(name, at) {
    const garment = store.garment;
    const panel = garment?.panels.find((p) => p.name === name);
    const found = panel && triangleAt(garment, panel, "flat", plane.at.get(name).from(at));
    return found ? { spot: spotOf(garment, found.triangle, found.shares) } : {};
}

export function mountPattern(root) {
    const pieces = svg("g");
    const guide = svg("path", { class: "guide" });
    const spot = svg("circle", { class: "spot" });
    const drawing = svg(
        "svg",
        { class: "drawing pattern", role: "group", label: "pattern.drawing" },
        pieces,
        guide,
        spot,
    );
    const zoom = zoomable(drawing, { onchange: () => sizes() });
    const none = h("p", { class: "nothing", word: "pattern.none" });
    const inspector = h("div", { class: "facts" });
    const sewer = sewing();
    replace(
        root,
        h(
            "div",
            { class: "bar", role: "toolbar", label: "pattern.tools" },
            h("h2", { word: "tab.pattern" }),
            sewer.button,
            mountPrinting(),
            h("span", { class: "push" }, zoom.buttons),
        ),
        oldNotice("pattern"),
        h("div", { class: "stage" }, drawing, none),
        inspector,
    );
    mountInspector(inspector);

    function sizes() {
        const scale = zoom.scale();
        drawing.style.setProperty("--px", `${scale}px`);
        for (const el of drawing.querySelectorAll(".corner")) el.setAttribute("r", 5.5 * scale);
        for (const el of drawing.querySelectorAll(".notch")) el.setAttribute("r", 2.5 * scale);
        spot.setAttribute("r", 6 * scale);
        // What is written on a piece would cover it and its neighbours where it is drawn small.
        for (const el of pieces.querySelectorAll(".piece")) {
            const { piece } = el.dataset;
            const width = plane.at.get(piece).size[0] / scale;
            el.classList.toggle("unnamed", width < LETTER * piece.length);
            const lengths = [...el.querySelectorAll(".edge")].map((edge) => edge.dataset.length / scale);
            el.querySelectorAll(".edge").forEach((edge, k) =>
                edge.classList.toggle("short", lengths[k] < NUMBERED),
            );
            el.querySelectorAll(".corner").forEach((corner, k) =>
                corner.classList.toggle(
                    "near",
                    piece !== selection.chosen.piece && Math.min(lengths[k], lengths.at(k - 1)) < CORNERED,
                ),
            );
        }
    }

    /** The form of the drawing's place: its width to its height. */
    const form = () => {
        const { width, height } = drawing.getBoundingClientRect();
        return width > 0 && height > 0 ? width / height : undefined;
    };

    const draw = whenChanged((pattern, reached, proposed) => {
        plane = arrange(pattern.pieces, form());
        seams = seamsByEdge(pattern.seams, proposed);
        replace(
            pieces,
            pattern.pieces.map((piece) =>
                pieceElement(piece, plane.at.get(piece.name), seams, piece.name === reached),
            ),
        );
        for (const piece of pattern.pieces) handles(piece);
        pockets();
        zoom.fit(plane.box);
        sizes();
        light();
    });

    /** Corners are dragged at once, an edge when it was chosen. */
    function handles(piece) {
        const parts = pieces.querySelector(`[data-piece="${CSS.escape(piece.name)}"]`);
        for (const el of parts.querySelectorAll(".corner")) {
            const k = Number(el.dataset.corner);
            const [cx, cy] = [Number(el.getAttribute("cx")), Number(el.getAttribute("cy"))];
            const at = plane.at.get(piece.name).to;
            const before = piece.points[piece.edges.at(k - 1).start];
            const after = piece.points[piece.edges[k].end];
            draggable(el, {
                place: zoom.place,
                step: STEP,
                move: (dx, dy) => {
                    el.setAttribute("cx", cx + dx);
                    el.setAttribute("cy", cy + dy);
                    const line = [at(before), [cx + dx, cy + dy], at(after)];
                    guide.setAttribute("d", dx || dy ? `M${line.map((p) => p.join(" ")).join("L")}` : "");
                },
                end: (dx, dy) =>
                    take(
                        t("edit.corner", { piece: piece.name, k: k + 1 }),
                        moveCorner(piece.name, k, dx / 1000, -dy / 1000),
                    ),
            });
        }
        for (const el of parts.querySelectorAll(".reach")) {
            const name = el.dataset.edge;
            draggable(el, {
                place: zoom.place,
                step: STEP,
                when: () => selection.chosen.edge === name && !sewer.isOn(),
                move: (dx, dy) => el.parentNode.setAttribute("transform", `translate(${dx} ${dy})`),
                end: (dx, dy) => take(t("edit.edge", { edge: name }), moveEdge(name, dx / 1000, -dy / 1000)),
            });
        }
    }

    // The line of a pocket lies on another piece than the one that moves.
    function pockets() {
        for (const line of pieces.querySelectorAll("[data-pocket]"))
            dragsPocket(line, { place: zoom.place, step: STEP });
    }

    async function take(words, alteration) {
        await edit(words, () => alter(alteration));
        guide.setAttribute("d", "");
    }

    const redraw = () => {
        if (isHeld()) return;
        const pattern = store.view?.pattern;
        none.hidden = Boolean(pattern);
        drawing.classList.toggle("gone", !pattern);
        if (pattern) draw(pattern, selection.chosen.piece, proposals());
    };
    watch(["view", "chosen", "state"], redraw);
    // What came while a handle was held.
    for (const end of ["pointerup", "pointercancel"]) drawing.addEventListener(end, redraw);

    function light() {
        const edges = new Set(litEdges().map(({ piece, edge }) => `${piece}.${edge}`));
        for (const el of pieces.querySelectorAll(".piece"))
            el.classList.toggle("lit", isLit("piece", el.dataset.piece));
        for (const el of pieces.querySelectorAll(".edge")) {
            el.classList.toggle("lit", edges.has(el.dataset.edge));
            el.classList.toggle("first", sewer.first() === el.dataset.edge);
            el.querySelector(".reach").classList.toggle(
                "can-move",
                selection.chosen.edge === el.dataset.edge,
            );
        }
        const chosen = selection.chosen;
        for (const el of pieces.querySelectorAll(".corner")) {
            el.classList.toggle(
                "lit",
                chosen.piece === el.dataset.piece && chosen.corner === Number(el.dataset.corner),
            );
        }
        const what = [selection.hover, chosen].find((one) => one.spot?.flat && plane.at.has(one.piece));
        spot.classList.toggle("gone", !what);
        if (!what) return;
        const [x, y] = plane.at.get(what.piece).to(what.spot.flat);
        spot.setAttribute("cx", x);
        spot.setAttribute("cy", y);
    }
    watch(["hover", "chosen", "garment", "sewing"], light);

    const press = (target, spots = {}) => {
        const what = meant(target);
        if (what.edge && sewer.isOn()) sewer.click(what.edge);
        else choose({ ...what, ...spots });
    };
    drawing.addEventListener("pointermove", (event) => {
        if (event.buttons) return;
        const what = meant(event.target);
        hover(what.piece && !what.edge ? { ...what, ...spotAt(what.piece, zoom.place(event)) } : what);
    });
    drawing.addEventListener("pointerleave", () => hover());
    drawing.addEventListener("focusin", (event) => hover(meant(event.target)));
    drawing.addEventListener("focusout", () => hover());
    drawing.addEventListener("click", (event) => {
        const { piece, edge } = meant(event.target);
        press(event.target, piece && !edge ? spotAt(piece, zoom.place(event)) : {});
    });
    drawing.addEventListener("keydown", (event) => {
        if (!["Enter", " "].includes(event.key) || !event.target.dataset?.key) return;
        event.preventDefault();
        press(event.target);
    });
}
