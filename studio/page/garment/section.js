// A plane that cuts the garment open.

import { h } from "../dom/element.js";

const PLANES = { none: null, front: [0, 0, -1], side: [-1, 0, 0], level: [0, -1, 0] };

export function mountSection(root, scene) {
    let box = { low: [-0.4, 0, -0.4], high: [0.4, 2, 0.4] };
    const slider = h("input", {
        type: "range",
        min: "0",
        max: "1",
        step: "0.005",
        value: "0.5",
        label: "section.at",
        hidden: true,
    });
    const choice = h(
        "select",
        { id: "section", label: "section" },
        Object.keys(PLANES).map((name) => h("option", { value: name, word: `section.${name}` })),
    );
    root.prepend(h("p", { class: "line" }, h("label", { for: "section", word: "section" }), choice, slider));

    const cut = () => {
        const normal = PLANES[choice.value];
        slider.hidden = !normal;
        if (!normal) return scene.cut(null);
        const axis = normal.findIndex((x) => x !== 0);
        return scene.cut(normal, box.low[axis] + Number(slider.value) * (box.high[axis] - box.low[axis]));
    };
    choice.addEventListener("change", cut);
    slider.addEventListener("input", cut);
    return {
        range(next) {
            box = next;
            cut();
        },
    };
}
