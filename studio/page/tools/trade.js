// Accuracy against time: the qualities of this pipeline as they were measured. A click takes one.

import { h, replace, svg } from "../dom/element.js";
import { t } from "../words/words.js";
import { run } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";
import { metres } from "../ron/lengths.js";

const [WIDTH, HEIGHT, LEFT, DOWN] = [360, 200, 46, 34];

/** Millimetres of an error, which the program writes as "1 mm" or in metres. */
const millimetres = (error) => 1000 * (typeof error === "number" ? error : (metres(error) ?? NaN));

const take = (name) => {
    const choice = document.getElementById("quality");
    choice.value = name;
    return run(name);
};

function plot(points) {
    const known = points.filter((p) => p.seconds !== null && Number.isFinite(millimetres(p.max_error)));
    if (known.length < 2) return null;
    const range = (values) => [Math.min(...values) / 1.4, Math.max(...values) * 1.4].map(Math.log);
    const xs = range(known.map((p) => p.seconds));
    const ys = range(known.map((p) => millimetres(p.max_error)));
    const x = (s) => LEFT + ((Math.log(s) - xs[0]) / (xs[1] - xs[0])) * (WIDTH - LEFT - 12);
    const y = (e) => 12 + ((ys[1] - Math.log(e)) / (ys[1] - ys[0])) * (HEIGHT - DOWN - 12);
    const label = (p) => t("trade.point", { name: p.name, error: millimetres(p.max_error), s: p.seconds });
    return svg(
        "svg",
        { class: "plot", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "group", label: "trade.plot" },
        svg("path", { class: "axis", d: `M${LEFT} 8V${HEIGHT - DOWN}H${WIDTH - 6}` }),
        svg(
            "text",
            { class: "axis-name", x: WIDTH - 8, y: HEIGHT - 6, "text-anchor": "end" },
            t("trade.seconds"),
        ),
        svg("text", { class: "axis-name", x: 4, y: 12 }, "mm"),
        known.map((p) => [
            svg(
                "text",
                { class: "tick", x: x(p.seconds), y: HEIGHT - DOWN + 14, "text-anchor": "middle" },
                p.seconds.toFixed(1),
            ),
            svg(
                "text",
                { class: "tick", x: LEFT - 5, y: y(millimetres(p.max_error)) + 4, "text-anchor": "end" },
                String(millimetres(p.max_error)),
            ),
            svg(
                "circle",
                {
                    class: p.chosen ? "point chosen" : "point",
                    cx: x(p.seconds),
                    cy: y(millimetres(p.max_error)),
                    r: 8,
                    tabindex: 0,
                    role: "button",
                    "aria-label": label(p),
                    "data-key": `point-${p.name}`,
                    onclick: () => take(p.name),
                    onkeydown: (event) => event.key === "Enter" && take(p.name),
                },
                svg("title", {}, label(p)),
            ),
            svg(
                "text",
                { class: "point-name", x: x(p.seconds) + 11, y: y(millimetres(p.max_error)) - 6 },
                p.name,
            ),
        ]),
    );
}

function table(points) {
    const head = ["name", "error", "time", "measured", ""].map((name) =>
        h("th", { scope: "col" }, name && t(`trade.${name}`)),
    );
    return h(
        "table",
        {},
        h("thead", {}, h("tr", {}, head)),
        h(
            "tbody",
            {},
            points.map((p) =>
                h(
                    "tr",
                    { class: p.chosen ? "chosen" : "" },
                    h("th", { scope: "row" }, p.name),
                    h("td", {}, `${millimetres(p.max_error)} mm`),
                    h("td", {}, p.seconds === null ? "–" : t("seconds", { s: p.seconds.toFixed(1) })),
                    h(
                        "td",
                        { class: "long", lang: "en", title: p.measured ?? "" },
                        t(p.stands ? "trade.stands" : "trade.stale"),
                        p.measured ? `: ${p.measured.split(":")[0]}` : "",
                    ),
                    h(
                        "td",
                        {},
                        h(
                            "button",
                            {
                                "data-key": `take-${p.name}`,
                                "aria-label": t("trade.takeNamed", { name: p.name }),
                                onclick: () => take(p.name),
                            },
                            t("trade.take"),
                        ),
                    ),
                ),
            ),
        ),
    );
}

export function mountTrade(root) {
    const part = h("div", { class: "trade" });
    replace(root, h("div", { class: "bar" }, h("h2", { word: "tab.trade" })), part);
    const draw = whenChanged((points) =>
        replace(
            part,
            points.length > 0 ? [plot(points), table(points)] : h("p", { class: "hint", word: "trade.none" }),
        ),
    );
    watch(["trade"], () => draw(store.trade?.qualities ?? []));
}
