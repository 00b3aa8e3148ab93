// Landmarks of the garment on its photo. One that is dragged is given to the stage that cuts the pattern, as shares of
// the photo's width and height; a double click or Delete gives it back to the stage.

import { replace, svg } from "../dom/element.js";
import { draggable } from "../dom/drag.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { stagesOf, store } from "../server/store.js";
import { map, pair, tryRead } from "../ron/ron.js";

/** The stage that takes landmarks, where the pipeline has one. */
export const cutter = () =>
    stagesOf("style").find((stage) =>
        store.cards.get(stage.name)?.params.some((param) => param.name === "landmarks"),
    );

const nice = (name) => name.replaceAll("_", " ");

/** Landmarks that the file gives, by name, as shares. */
function given(stage) {
    const entries = tryRead(stage.params.landmarks)?.entries ?? [];
    return new Map(entries.map(([name, { items }]) => [name, items.map((item) => item.value)]));
}

function changes(name, share) {
    const stage = cutter();
    if (!stage) return [];
    const all = given(stage);
    if (share) all.set(name, share);
    else all.delete(name);
    const path = `${stage.path}.landmarks`;
    if (all.size === 0) return [{ remove: path }];
    return [{ set: { path, value: map([...all].map(([key, [x, y]]) => [key, pair(x, y)])) } }];
}

let drawn = "";

/** Draws the photo's landmarks; nothing is redrawn while one of them is being moved. */
export function landmarks({ root, photo, zoom, sizes }) {
    const canMove = Boolean(cutter());
    const now = JSON.stringify([photo, canMove, document.documentElement.lang]);
    if (now === drawn || store.pending > 0 || root.querySelector(".moving")) return;
    drawn = now;
    replace(
        root,
        photo.landmarks.map((mark) => handle(mark, { photo, zoom, canMove })),
    );
    sizes();
}

function handle(mark, { photo, zoom, canMove }) {
    const { name, x, y } = mark;
    const label = t(mark.given ? "landmark.given" : "landmark.found", {
        name: nice(name),
        x: x.toFixed(0),
        y: y.toFixed(0),
    });
    const el = svg(
        "circle",
        {
            cx: x,
            cy: y,
            class: mark.given ? "landmark given" : "landmark",
            "data-key": name,
            ...(canMove ? { tabindex: 0, role: "button" } : { role: "img" }),
            "aria-label": label,
        },
        svg("title", {}, label),
    );
    if (!canMove) return el;
    const end = async (dx, dy) => {
        const share = [(x + dx) / photo.width, (y + dy) / photo.height].map((s) =>
            Math.min(1, Math.max(0, s)),
        );
        await edit(t("edit.landmark", { name: nice(name) }), () => changes(name, share));
        el.classList.remove("moving");
    };
    const move = (dx, dy) => {
        el.classList.toggle("moving", dx !== 0 || dy !== 0);
        el.setAttribute("cx", x + dx);
        el.setAttribute("cy", y + dy);
    };
    draggable(el, { place: zoom.place, move, end, step: 1 });
    const giveBack = () =>
        mark.given && edit(t("edit.landmarkBack", { name: nice(name) }), () => changes(name, null));
    el.addEventListener("dblclick", giveBack);
    el.addEventListener("keydown", (event) => event.key === "Delete" && giveBack());
    return el;
}
