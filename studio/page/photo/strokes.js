// Strokes that say what is garment and what is ground. They are places that `GraphCut` keeps; another stage that finds
// the garment is swapped for it with the first stroke.

import { h, replace, svg } from "../dom/element.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { stagesOf, store, watch, whenChanged } from "../server/store.js";
import { list, map, pair, tryRead } from "../ron/ron.js";
import { photo } from "./shown.js";

/** Distance of the places of a stroke, as a share of the photo's longer side. */
const APART = 0.02;
const KINDS = ["garment", "ground"];

const binariser = () => stagesOf("binariser")[0];

/** Places of a kind by photo, as shares, as the file gives them. */
function places(stage, kind) {
    const entries = (stage?.name === "GraphCut" && tryRead(stage.params[kind])?.entries) || [];
    return new Map(
        entries.map(([name, { items }]) => [name, items.map((item) => item.items.map((x) => x.value))]),
    );
}

const written = (all) =>
    map([...all].map(([name, points]) => [name, list(points.map(([x, y]) => pair(x, y)))]));

function changes(kind, name, points) {
    const stage = binariser();
    if (!stage) return [];
    const all = places(stage, kind);
    all.set(name, [...(all.get(name) ?? []), ...points]);
    if (stage.name === "GraphCut") return [{ set: { path: `${stage.path}.${kind}`, value: written(all) } }];
    return [{ swap: { stage: stage.id, with: `GraphCut(${kind}: ${written(all)})` } }];
}

const clear = () => {
    const stage = binariser();
    const paths = KINDS.filter((kind) => stage?.params[kind]).map((kind) => ({
        remove: `${stage.path}.${kind}`,
    }));
    return paths;
};

/** `painted` is where strokes are drawn. Returns the buttons and whether someone paints. */
export function strokes({ drawing, painted, place, scale }) {
    let kind = null;
    let points = null;
    let line = null;

    const press = (next) => {
        kind = kind === next ? null : next;
        for (const el of buttons) el.setAttribute("aria-pressed", el.dataset.kind === kind);
        drawing.classList.toggle("painting", kind !== null);
    };
    const buttons = KINDS.map((name) =>
        h("button", {
            word: `stroke.${name}`,
            tip: `stroke.${name}.tip`,
            "data-kind": name,
            "aria-pressed": "false",
            onclick: () => press(name),
        }),
    );
    const away = h("button", { word: "stroke.clear", onclick: () => edit(t("edit.strokesClear"), clear) });
    watch(["escape"], () => kind && press(kind));

    // Before the handles and the zoom, which would take the pointer.
    drawing.addEventListener(
        "pointerdown",
        (event) => {
            if (!kind || event.button !== 0) return;
            event.stopImmediatePropagation();
            drawing.setPointerCapture(event.pointerId);
            points = [place(event)];
            line = svg("polyline", { class: kind, "stroke-width": 6 * scale() });
            painted.append(line);
        },
        { capture: true },
    );
    drawing.addEventListener("pointermove", (event) => {
        if (!points) return;
        points.push(place(event));
        line.setAttribute("points", points.map((p) => p.join(",")).join(" "));
    });
    drawing.addEventListener("pointerup", async () => {
        if (!points) return;
        const now = photo();
        const shares = thinned(points, APART * Math.max(now.width, now.height))
            .map(([x, y]) => [x / now.width, y / now.height])
            .filter(([x, y]) => x >= 0 && y >= 0 && x <= 1 && y <= 1);
        points = null;
        await edit(t(`edit.stroke.${kind}`), () => changes(kind, now.name, shares));
        line.remove();
    });

    const show = whenChanged((name, size, all) =>
        replace(
            painted,
            KINDS.flatMap((of) =>
                (all[of][name] ?? []).map(([x, y]) =>
                    svg("circle", { class: of, cx: x * size[0], cy: y * size[1], r: 0.006 * size[0] }),
                ),
            ),
        ),
    );
    watch(["state", "view", "photo"], () => {
        const stage = binariser();
        const now = photo();
        for (const el of [...buttons, away]) el.hidden = !stage || !now;
        if (!stage || !now) return;
        const all = Object.fromEntries(KINDS.map((of) => [of, Object.fromEntries(places(stage, of))]));
        away.hidden = KINDS.every((of) => Object.keys(all[of]).length === 0);
        show(now.name, [now.width, now.height], all);
    });
    return { buttons: [...buttons, away], isOn: () => kind !== null };
}

/** Points of a line that lie at least so far from each other, the first one always. */
function thinned(points, apart) {
    const kept = [points[0]];
    for (const p of points) {
        const last = kept.at(-1);
        if (Math.hypot(p[0] - last[0], p[1] - last[1]) >= apart) kept.push(p);
    }
    return kept;
}
