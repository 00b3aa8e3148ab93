// A piece that is sewn onto another, as a pocket, and how far its middle lies from the middle of that one.

import { h } from "../dom/element.js";
import { t } from "../words/words.js";
import { takeBack } from "../garment/hand_places.js";
import { edit } from "../server/edits.js";
import { itemsOf, tryRead } from "../ron/ron.js";
import { metres } from "../ron/lengths.js";
import { stageNamed, store } from "../server/store.js";
import { alter, sewOn, withItems } from "./alterations.js";

/** How a piece is sewn on: the place in the list of alterations and what it says; nothing where it is not. */
function sewnOn(piece) {
    const items = itemsOf(stageNamed("Alter")?.params.alterations);
    const at = items.findLastIndex((item) => {
        const { name, fields } = tryRead(item);
        return name === "SewOn" && fields.piece.value === piece;
    });
    if (at < 0) return null;
    const { fields } = tryRead(items[at]);
    return { items, at, onto: fields.onto.value, way: [metres(fields.x.value), metres(fields.y.value)] };
}

/** What can be done with a piece that is sewn on, or that may be. */
export function sewOnPart({ name: piece }) {
    const now = sewnOn(piece);
    if (now) {
        const field = (word, k) => {
            const input = h("input", {
                type: "number",
                step: "any",
                value: String(Number((100 * now.way[k]).toFixed(1))),
                "data-key": word,
            });
            input.addEventListener("change", () => {
                if (!input.checkValidity() || input.value === "") return;
                const way = now.way.with(k, Number(input.value) / 100);
                const items = now.items.with(now.at, sewOn(piece, now.onto, ...way));
                edit(t("edit.sewOn", { piece, onto: now.onto }), () => withItems(items));
            });
            return h("label", { class: "line" }, h("span", { word }), input, " cm");
        };
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
