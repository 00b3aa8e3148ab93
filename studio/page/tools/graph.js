// Which stage reads from which: a stage stands right of all that it reads from.

import { svg } from "../dom/element.js";

const [WIDTH, HEIGHT, ACROSS, DOWN] = [128, 30, 160, 44];

/** Columns by the longest way from a stage that reads from none. */
function columns(stages) {
    const column = new Map();
    for (const { id, made_by: from } of stages) {
        column.set(id, Math.max(-1, ...from.map((other) => column.get(other) ?? -1)) + 1);
    }
    return column;
}

export function graphOf(stages, chosen, choose) {
    const column = columns(stages);
    const filled = [];
    const at = new Map(
        stages.map(({ id }) => {
            const x = column.get(id);
            filled[x] = (filled[x] ?? 0) + 1;
            return [id, [10 + ACROSS * x, 10 + DOWN * (filled[x] - 1)]];
        }),
    );
    const size = [20 + ACROSS * filled.length, 20 + DOWN * Math.max(1, ...Array.from(filled, (n) => n ?? 0))];
    const lines = stages.flatMap(({ id, made_by: from }) =>
        from
            .filter((other) => at.has(other))
            .map((other) => {
                const [[x0, y0], [x1, y1]] = [at.get(other), at.get(id)];
                const [a, b, mid] = [x0 + WIDTH, y0 + HEIGHT / 2, (x0 + WIDTH + x1) / 2];
                const lit = id === chosen || other === chosen ? "lit" : "";
                return svg("path", {
                    class: `wire ${lit}`,
                    d: `M${a} ${b}C${mid} ${b} ${mid} ${y1 + HEIGHT / 2} ${x1} ${y1 + HEIGHT / 2}`,
                });
            }),
    );
    const boxes = stages.map(({ id, state }) => {
        const [x, y] = at.get(id);
        const box = svg(
            "g",
            {
                class: `node ${state} ${id === chosen ? "lit" : ""}`,
                tabindex: 0,
                role: "button",
                "aria-label": id,
                "data-key": `node-${id}`,
                onclick: () => choose(id),
                onkeydown: (event) =>
                    ["Enter", " "].includes(event.key) && (event.preventDefault(), choose(id)),
            },
            svg("rect", { x, y, width: WIDTH, height: HEIGHT, rx: 6 }),
            svg("text", { x: x + WIDTH / 2, y: y + HEIGHT / 2 + 4 }, id),
        );
        return box;
    });
    return svg(
        "svg",
        {
            width: size[0],
            height: size[1],
            viewBox: `0 0 ${size.join(" ")}`,
            role: "group",
            label: "stages.graph",
        },
        lines,
        boxes,
    );
}
