// A piece that is sewn onto another, as a pocket, and how far its middle lies from the middle of that one.

import { draggable } from "../dom/drag.js";
import { h } from "../dom/element.js";
import { numberField } from "../dom/number_field.js";
import { t } from "../words/words.js";
import { takeBack } from "../garment/hand_places.js";
import { edit } from "../server/edits.js";
import { tryRead } from "../ron/ron.js";
import { metres } from "../ron/lengths.js";
import { store } from "../server/store.js";
import { alter, present, sewOn, sewsOn, withItems } from "./alterations.js";

/** How a piece is sewn on: the place in the list of alterations and what it says; nothing where it is not. */
function sewnOn(piece) {
    const items = present();
    const at = items.findLastIndex((item) => sewsOn(item, piece));
    if (at < 0) return null;
    const { fields } = tryRead(items[at]);
    return { items, at, onto: fields.onto.value, way: [metres(fields.x.value), metres(fields.y.value)] };
}

/** The changes after which a piece lies so far from the middle of the other; none where it is sewn on no longer. */
function moved(piece, to) {
    const now = sewnOn(piece);
    return now && withItems(now.items.with(now.at, sewOn(piece, now.onto, ...to(now.way))));
}

/** The changes after which a piece is sewn onto no other. */
function takenOff(piece) {
    const now = sewnOn(piece);
    return now && withItems(now.items.toSpliced(now.at, 1));
}

/** How far to a side the middle of a pocket may lie from that of its piece, in metres: no farther than its edges. */
function farthest(onto, k) {
    const points = store.view.pattern.pieces.find(({ name }) => name === onto)?.points;
    if (!points) return Infinity;
    const all = points.map((point) => point[k]);
    return (Math.max(...all) - Math.min(...all)) / 2;
}

/** The piece that is sewn on along a line of another piece; nothing for other lines. */
export function pocketOf(line) {
    const piece = /^(.+)_place$/.exec(line.name)?.[1];
    return piece && sewnOn(piece) ? piece : null;
}

/** Lets a piece be dragged on the one that it is sewn onto, by the line that is drawn there. */
export function dragsPocket(line, { place, step }) {
    const piece = line.dataset.pocket;
    draggable(line, {
        place,
        step,
        move: (dx, dy) => line.setAttribute("transform", `translate(${dx} ${dy})`),
        end: (dx, dy) => {
            const { onto } = sewnOn(piece);
            const within = (x, k) => Math.max(-farthest(onto, k), Math.min(farthest(onto, k), x));
            const by = [dx / 1000, -dy / 1000];
            edit(t("edit.sewOn", { piece, onto }), () => moved(piece, (way) => way.map((x, k) => within(x + by[k], k))));
        },
    });
}

/** What can be done with a piece that is sewn on, or that may be. */
export function sewOnPart({ name: piece }) {
    const now = sewnOn(piece);
    if (now) {
        const most = (k) => 100 * farthest(now.onto, k);
        const field = (word, k) =>
            numberField(
                word,
                Number((100 * now.way[k]).toFixed(1)),
                "cm",
                { step: "any", min: -most(k), max: most(k), "data-key": word },
                (next) =>
                    edit(t("edit.sewOn", { piece, onto: now.onto }), () =>
                        moved(piece, (way) => way.with(k, next / 100)),
                    ),
            );
        return h(
            "p",
            { class: "line" },
            t("sewOn.now", { onto: now.onto }),
            " ",
            field("sewOn.right", 0),
            field("sewOn.above", 1),
            h("button", {
                word: "sewOn.off",
                onclick: () => edit(t("edit.sewOnOff", { piece, onto: now.onto }), () => takenOff(piece)),
            }),
        );
    }
    const others = store.view.pattern.pieces.map(({ name }) => name).filter((name) => name !== piece);
    const sewn = store.view.pattern.seams.some(({ sides }) => sides.flat().some((use) => use.piece === piece));
    if (sewn || others.length === 0) return null;
    const onto = h(
        "select",
        {},
        others.map((name) => h("option", { value: name }, name)),
    );
    const form = h(
        "form",
        { class: "in-line" },
        h("label", { class: "line" }, h("span", { word: "sewOn.onto" }), onto),
        h("button", { word: "sewOn.do" }),
    );
    form.addEventListener("submit", (event) => {
        event.preventDefault();
        edit(t("edit.sewOn", { piece, onto: onto.value }), () => [
            ...alter(sewOn(piece, onto.value, 0, 0)),
            ...takeBack(piece),
        ]);
    });
    return form;
}
