// What can be done with the piece, edge or seam that is chosen; the list of seams where nothing is.

import { h, replace } from "../dom/element.js";
import { numberField } from "../dom/number_field.js";
import { cm, mm, t, term } from "../words/words.js";
import { edit } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";
import { choose, selection } from "../server/selection.js";
import { takeBack } from "../garment/hand_places.js";
import { alter, dart, lengthen, mirror, reverseSeam, takenOut, unsew } from "./alterations.js";
import { sewOnPart } from "./sew_on.js";
import { proposalLine, proposalList, proposals } from "./proposals.js";

/** A longer list of seams is opened by who wants to see it. */
const MOST_OPEN = 12;

const pattern = () => store.view?.pattern;

const names = (side) => side.map(({ piece, edge }) => `${piece}.${edge}`);
const seamWords = (seam) => seam.sides.map((side) => names(side).join(" + ")).join(" – ");

/** A dart: place along the edge, width, length. */
function dartForm(edge) {
    const [at, width, length] = [
        ["50", "%", 5, 95],
        ["20", "mm", 4, 120],
        ["90", "mm", 10, 500],
    ].map(([value, unit, min, max]) =>
        h("input", { type: "number", value, min, max, required: true, "data-unit": unit }),
    );
    const line = (word, input) =>
        h("label", { class: "line" }, h("span", { word }), input, ` ${input.dataset.unit}`);
    const form = h(
        "form",
        { class: "in-line" },
        line("dart.at", at),
        line("dart.width", width),
        line("dart.length", length),
        h("button", { word: "dart.add" }),
    );
    form.addEventListener("submit", (event) => {
        event.preventDefault();
        edit(t("edit.dart", { edge }), () =>
            alter(dart(edge, at.value / 100, width.value / 1000, length.value / 1000)),
        );
    });
    return h("details", {}, h("summary", { word: "dart" }), form);
}

function edgePart(name, edge) {
    const length = 100 * edge.length;
    return [
        h("h3", {}, name),
        numberField(
            "edge.length",
            length.toFixed(1),
            "cm",
            { step: "0.1", min: "0.5", "data-key": "length" },
            (next) =>
                edit(t("edit.length", { edge: name, length: `${next} cm` }), () =>
                    alter(lengthen(name, (next - length) / 100)),
                ),
        ),
        h("p", { class: "hint", word: "edge.moveHow" }),
        dartForm(name),
    ];
}

function seamPart(seam) {
    const [[a], [b] = []] = seam.sides.map(names);
    const simple = seam.sides.length === 2 && seam.sides.every((side) => side.length === 1);
    return h(
        "div",
        { class: "seam-part" },
        h(
            "p",
            {},
            t("seam.what", { seam: seamWords(seam), kind: term("seamKind", seam.kind) }),
            seam.gap_m !== null && seam.gap_m !== undefined && ` ${t("seam.gap", { mm: mm(seam.gap_m, 1) })}`,
        ),
        h(
            "p",
            { class: "choices" },
            h("button", {
                id: "unpick",
                word: "seam.unpick",
                onclick: () => edit(t("edit.unpick", { seam: seamWords(seam) }), () => alter(unsew(a))),
            }),
            h("button", {
                id: "reverse",
                word: "seam.reverse",
                disabled: !simple,
                onclick: () => edit(t("edit.reverse", { seam: seamWords(seam) }), () => reverseSeam(a, b)),
            }),
        ),
    );
}

/** The mirrored name of a piece: left becomes right. */
const mirrored = (name) => {
    const swapped = name.replace(/left|right/, (side) => (side === "left" ? "right" : "left"));
    return swapped === name ? `${name}_mirrored` : swapped;
};

function piecePart(piece) {
    const name = h("input", {
        type: "text",
        value: mirrored(piece.name),
        pattern: "[A-Za-z0-9_]+",
        required: true,
    });
    const form = h(
        "form",
        { class: "in-line" },
        h("label", { class: "line" }, h("span", { word: "mirror.name" }), name),
        h("button", { word: "mirror.do" }),
    );
    form.addEventListener("submit", (event) => {
        event.preventDefault();
        edit(t("edit.mirror", { piece: piece.name }), () => alter(mirror(piece.name, name.value)));
    });
    const isLast = pattern().pieces.length === 1;
    const out = h("button", {
        word: "piece.remove",
        disabled: isLast,
        onclick: () =>
            edit(t("edit.removePiece", { piece: piece.name }), () => [
                ...takenOut(piece.name),
                ...takeBack(piece.name),
            ]),
    });
    return [h("h3", {}, piece.name), h("p", { class: "hint", word: "piece.how" }), form, sewOnPart(piece), out];
}

function seamList(seams) {
    return h(
        "details",
        { class: "seams", open: seams.length <= MOST_OPEN },
        h("summary", {}, t("seams.count", { n: seams.length })),
        h(
            "ul",
            {},
            seams.map((seam, i) =>
                h(
                    "li",
                    {},
                    h(
                        "button",
                        {
                            class: "plain",
                            "data-key": `seam-${seam.name}`,
                            onclick: () =>
                                choose({
                                    seam: seam.name,
                                    edge: names(seam.sides[0])[0],
                                    piece: seam.sides[0][0].piece,
                                }),
                        },
                        h("span", { class: `chip seam-${i % 10}` }, String(i + 1)),
                        ` ${seamWords(seam)}`,
                    ),
                ),
            ),
        ),
    );
}

export function mountInspector(root) {
    const draw = whenChanged((found, chosen, proposed) => {
        if (!found) return replace(root);
        const piece = found.pieces.find((p) => p.name === chosen.piece);
        const edge = chosen.edge && piece?.edges.find((e) => `${piece.name}.${e.name}` === chosen.edge);
        // A seam that is sewn anew while its edge is chosen has another name.
        const seam =
            found.seams.find((s) => s.name === chosen.seam) ??
            found.seams.find((s) => chosen.edge && s.sides.flatMap(names).includes(chosen.edge));
        if (!piece) {
            return replace(
                root,
                proposed.length > 0 && proposalList(proposed, found.seams.length),
                (proposed.length === 0 || found.seams.length > 0) && seamList(found.seams),
            );
        }
        const offered = proposed.findIndex((one) => one.name === chosen.seam);
        const corner = chosen.corner !== undefined && piece.edges[chosen.corner];
        return replace(
            root,
            edge && edgePart(chosen.edge, edge),
            seam && seamPart(seam),
            offered >= 0 && [
                h("p", { class: "hint", word: "proposals.one" }),
                proposalLine(proposed[offered], found.seams.length + offered + 1),
            ],
            corner && cornerPart(piece, chosen.corner, piece.points[corner.start]),
            !edge && !corner && piecePart(piece),
        );
    });
    watch(["view", "chosen", "state", "pending"], () => {
        if (store.pending > 0) return;
        const { piece, edge, corner, seam } = selection.chosen;
        draw(pattern(), { piece, edge, corner, seam }, proposals());
    });
}

const cornerPart = (piece, k, [x, y]) => [
    h("h3", {}, t("corner.label", { k: k + 1, piece: piece.name, x: cm(x), y: cm(y) })),
    h("p", { class: "hint", word: "corner.how" }),
];
