// A figure with its words and its unit.

import { h } from "./element.js";

/** `take(number)` when it was changed. What is no number, or out of `min` and `max`, gives the figure before back. */
export function numberField(word, value, unit, props, take) {
    const input = h("input", { type: "number", value: String(value), "data-unit": unit, ...props });
    let taken = input.value;
    input.addEventListener("change", () => {
        if (input.value === "" || !input.checkValidity()) {
            input.value = taken;
            return;
        }
        taken = input.value;
        take(Number(taken));
    });
    return h("label", { class: "line" }, h("span", { word }), input, ` ${unit}`);
}
