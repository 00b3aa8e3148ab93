// The legend of a map, and the figure at the pointer.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { drawStripe, figureOf, isMap } from "./maps.js";

export function mountLegend(root) {
    const stripe = h("canvas", { width: 160, height: 10, "aria-hidden": "true" });
    const name = h("span");
    const end = h("span", { class: "end" });
    const at = h("output", { label: "legend.here" });
    replace(root, h("div", { class: "map" }, name, h("span", {}, "0"), stripe, end), at);
    drawStripe(stripe);
    root.hidden = true;
    return {
        /** Shows the scale of a map; nothing where the looks are none. */
        scale(looks, scale) {
            root.hidden = scale === null || scale === undefined;
            if (root.hidden) return;
            name.textContent = t(`looks.${looks}`);
            end.textContent = figureOf(looks, scale);
        },
        at(looks, spot) {
            const value = spot?.[looks];
            at.textContent =
                isMap(looks) && Number.isFinite(value)
                    ? t("legend.at", { figure: figureOf(looks, value) })
                    : "";
        },
    };
}
