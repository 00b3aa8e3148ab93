// Sewing: one edge is clicked, then the other.

import { h } from "../dom/element.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { tell, watch } from "../server/store.js";
import { sayWord } from "../head/status.js";
import { alter, sew } from "./alterations.js";

export function sewing() {
    let on = false;
    let first = null;

    const turn = (next) => {
        [on, first] = [next, null];
        button.setAttribute("aria-pressed", on);
        if (on) sayWord("sew.first");
        tell("sewing");
    };
    const button = h("button", {
        id: "sew",
        word: "sew",
        tip: "sew.tip",
        "aria-pressed": "false",
        onclick: () => turn(!on),
    });
    watch(["escape"], () => on && turn(false));

    return {
        button,
        isOn: () => on,
        first: () => first,
        /** An edge was clicked while sewing. */
        async click(edge) {
            if (!first) {
                first = edge;
                sayWord("sew.second", { edge });
                tell("sewing");
                return;
            }
            const [a, b] = [first, edge];
            turn(false);
            if (a !== b) await edit(t("edit.sew", { a, b }), () => alter(sew(a, b)));
        },
    };
}
