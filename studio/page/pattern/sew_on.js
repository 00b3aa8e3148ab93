// A piece that is sewn onto another, as a pocket, and how far its middle lies from the middle of that one.

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

/** The changes that move a piece on the one that it is sewn onto; none where it is sewn on no longer. */
function moved(piece, k, to) {
    const now = sewnOn(piece);
    return now && withItems(now.items.with(now.at, sewOn(piece, now.onto, ...now.way.with(k, to))));
}

/** How far to a side the middle of a pocket may lie from that of its piece, in centimetres: no farther than its edges. */
function limits(onto, k) {
    const points = store.view.pattern.pieces.find(({ name }) => name === onto)?.points;
    if (!points) return {};
    const all = points.map((point) => point[k]);
    const most = 50 * (Math.max(...all) - Math.min(...all));
    return { min: -most, max: most };
}

/** What can be done with a piece that is sewn on, or that may be. */
export function sewOnPart({ name: piece }) {
    const now = sewnOn(piece);
    if (now) {
        const field = (word, k) =>
            numberField(
                word,
                Number((100 * now.way[k]).toFixed(1)),
                "cm",
                { step: "any", ...limits(now.onto, k), "data-key": word },
                (next) => edit(t("edit.sewOn", { piece, onto: now.onto }), () => moved(piece, k, next / 100)),
            );
        return h(
            "p",
            { class: "line" },
            t("sewOn.now", { onto: now.onto }),
            " ",
            field("sewOn.right", 0),
            field("sewOn.above", 1),
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
