// Landmarks of the garment on its photo. One that is dragged is given to the stage that cuts the pattern, as shares of
// the photo's width and height, and to the one that measures its wearer; a double click or Delete gives it back.

import { replace, svg } from "../dom/element.js";
import { draggable } from "../dom/drag.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { stagesOf, store } from "../server/store.js";
import { map, pair, tryRead } from "../ron/ron.js";
import { entryOf } from "./shown.js";

const takesLandmarks = (stage) =>
    store.cards.get(stage.name)?.params.some((param) => param.name === "landmarks");

/** The stage that cuts the pattern by landmarks, where the pipeline has one. */
export const cutter = () => stagesOf("style").find(takesLandmarks);

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
    const value = map([...all].map(([key, [x, y]]) => [key, pair(x, y)]));
    return [stage, ...stagesOf("body").filter(takesLandmarks)]
        .filter((of) => all.size > 0 || given(of).size > 0)
        .map((of) => `${of.path}.landmarks`)
        .map((path) => (all.size === 0 ? { remove: path } : { set: { path, value } }));
}

/** A photo that is another one's mirror image has no landmarks of its own. */
const isMirror = (name) => name !== "front" && !entryOf(name)?.file;

/** Corners of edges that are no landmark are called by their two edges. */
const hasName = (mark) => !mark.name.includes("/");

let drawn = "";

/** Draws the photo's landmarks; nothing is redrawn while one of them is being moved. */
export function landmarks({ root, photo, zoom, sizes }) {
    const canMove = Boolean(cutter()) && !isMirror(photo.name);
    const now = JSON.stringify([photo, canMove, document.documentElement.lang]);
    if (now === drawn || store.pending > 0 || root.querySelector(".moving")) return;
    drawn = now;
    replace(
        root,
        photo.landmarks.map((mark) => handle(mark, { photo, zoom, canMove: canMove && hasName(mark) })),
    );
    sizes();
}

/** The name in the file: landmarks of a photo of the back say so. */
const keyOf = (photo, name) => (photo.name === "front" ? name : `${photo.name}.${name}`);

function handle(mark, { photo, zoom, canMove }) {
    const { name, x, y } = mark;
    const key = keyOf(photo, name);
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
        // Places are those of pixels' centres.
        const share = [(x + dx + 0.5) / photo.width, (y + dy + 0.5) / photo.height].map((s) =>
            Math.min(1, Math.max(0, s)),
        );
        await edit(t("edit.landmark", { name: nice(name) }), () => changes(key, share));
        el.classList.remove("moving");
    };
    const move = (dx, dy) => {
        el.classList.toggle("moving", dx !== 0 || dy !== 0);
        el.setAttribute("cx", x + dx);
        el.setAttribute("cy", y + dy);
    };
    draggable(el, { place: zoom.place, move, end, step: 1 });
    const giveBack = () =>
        mark.given && edit(t("edit.landmarkBack", { name: nice(name) }), () => changes(key, null));
    el.addEventListener("dblclick", giveBack);
    el.addEventListener("keydown", (event) => event.key === "Delete" && giveBack());
    return el;
}
