// Pieces dragged around the body to where they start, before they are sewn.
//
// While pieces are placed the page shows them as they start in the place of the garment. A piece is dragged in the
// plane of the screen; beside the pieces a drag turns the view.

import { h, replace } from "../dom/element.js";
import { numberField } from "../dom/number_field.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { loadView } from "../server/live.js";
import { choose, selection } from "../server/selection.js";
import { store, watch, whenChanged } from "../server/store.js";
import {
    beforeTheBody,
    canPlace,
    handPlaces,
    hasOwnPlace,
    placeOf,
    put,
    takeBack,
    turned,
    unplaced,
} from "./hand_places.js";

/** No piece is put farther than this to a side, in centimetres. */
const FARTHEST = 300;
/** A press that moves no farther than this, in pixels, is a click. */
const CLICK = 4;
const TURN = 15;
const TURNS = [
    ["left", "↶", 1, TURN],
    ["right", "↷", 1, -TURN],
    ["forwards", "⤵", 0, TURN],
    ["backwards", "⤴", 0, -TURN],
    ["clockwise", "↻", 2, -TURN],
    ["counter", "↺", 2, TURN],
    ["over", "⇄", 1, 180],
];
const AXES = ["x", "y", "z"];

const panelNamed = (name) => store.garment?.panels.find((panel) => panel.name === name);
const take = (piece, changes) => edit(t("edit.place", { piece }), changes);

/** The button that begins and ends it. */
export function placingButton() {
    const button = h("button", { word: "place", tip: "place.tip", "aria-pressed": "false" });
    const turn = (on) => {
        store.placing = on;
        button.setAttribute("aria-pressed", String(on));
        loadView();
    };
    button.addEventListener("click", () => turn(!store.placing));
    watch(["state", "garment"], () => {
        button.hidden = !canPlace();
        if (button.hidden && store.placing) turn(false);
        button.setAttribute("aria-pressed", String(store.placing));
    });
    return button;
}

/** What stands below the pieces: what has no place, and the place of the chosen piece in figures. */
export function mountPlaces(root) {
    const part = h("div", { class: "places", role: "group", label: "place" });
    root.prepend(part);
    const draw = whenChanged((on, hasStart, without, chosen, place) => {
        part.hidden = !on && without.length === 0;
        root.classList.toggle("placing", on);
        replace(
            part,
            without.map((piece) =>
                h(
                    "p",
                    {},
                    t("place.none", { piece }),
                    " ",
                    h("button", {
                        word: "place.before",
                        "data-key": `place-${piece}`,
                        onclick: () => {
                            store.placing = true;
                            take(piece, () => put(beforeTheBody(piece)));
                            choose({ piece });
                        },
                    }),
                ),
            ),
            place ? form(chosen, place) : on && h("p", { class: "hint", word: hasStart ? "place.how" : "place.noStart" }),
        );
    });
    watch(["state", "view", "garment", "chosen"], () => {
        const on = store.placing;
        const chosen = selection.chosen.piece ?? null;
        const without = unplaced();
        draw(on, Boolean(store.view?.start), without, chosen, on && chosen && !without.includes(chosen) ? placeOf(chosen) : null);
    });
}

function form(piece, place) {
    const canGoBack = handPlaces().some((one) => one.piece === piece) && hasOwnPlace(piece);
    // From the place as it is by then: an edit before this one may be on its way.
    const change = (to) => take(piece, () => put(to(placeOf(piece) ?? place)));
    const coordinate = (axis, k) =>
        numberField(
            `place.${axis}`,
            (100 * place.middle[k]).toFixed(1),
            "cm",
            { step: "any", min: -FARTHEST, max: FARTHEST, "data-key": `place-${axis}` },
            (next) => change((now) => ({ ...now, middle: now.middle.with(k, next / 100) })),
        );
    return [
        h("h3", {}, piece),
        AXES.map(coordinate),
        h(
            "div",
            { role: "group", label: "place.turns", class: "choices" },
            TURNS.map(([name, sign, axis, degrees]) =>
                h(
                    "button",
                    {
                        "data-key": `turn-${name}`,
                        onclick: () => change((now) => turned(now, axis, degrees)),
                    },
                    h("span", { "aria-hidden": "true" }, sign),
                    " ",
                    h("span", { word: `place.${name}` }),
                ),
            ),
        ),
        canGoBack &&
            h("button", {
                word: "place.back",
                "data-key": "place-back",
                onclick: () => edit(t("edit.placeBack", { piece }), () => takeBack(piece)),
            }),
    ];
}

/** Lets pieces be dragged on the canvas. `found(x, y)` tells what lies below a place of the screen. */
export function placing(canvas, camera, cloth, found) {
    let held = null;
    let dragged = false;
    /** The camera's direction to the right (0), up (1) or backwards (2), or its place (3). */
    const column = (k) => camera.matrixWorld.elements.slice(4 * k, 4 * k + 3);
    const way = (event) => {
        const [dx, dy] = [event.clientX - held.from[0], event.clientY - held.from[1]];
        const perPixel = (2 * held.away * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight;
        const [right, up] = [column(0), column(1)];
        return right.map((x, k) => perPixel * (dx * x - dy * up[k]));
    };
    canvas.addEventListener(
        "pointerdown",
        (event) => {
            dragged = false;
            if (!store.placing || event.button !== 0 || event.shiftKey) return;
            const { piece, spot } = found(event.clientX, event.clientY);
            const place = piece && placeOf(piece);
            if (!place) return;
            event.stopImmediatePropagation();
            canvas.focus({ preventScroll: true });
            canvas.setPointerCapture(event.pointerId);
            const [backwards, eye] = [column(2), column(3)];
            const away = spot.position.reduce((sum, x, k) => sum - (x - eye[k]) * backwards[k], 0);
            held = { piece, away, from: [event.clientX, event.clientY], place, by: null };
            choose({ piece });
        },
        { capture: true },
    );
    canvas.addEventListener("pointermove", (event) => {
        if (!held) return;
        held.by = way(event);
        cloth.shift(panelNamed(held.piece), held.by);
    });
    /** A piece that is let go beside the view goes back: nobody sees where it would be. */
    const isTaken = ({ type, clientX: x, clientY: y }) => {
        const { left, right, top, bottom } = canvas.getBoundingClientRect();
        const isSeen = x >= left && x <= right && y >= top && y <= bottom;
        return type === "pointerup" && isSeen && Math.hypot(x - held.from[0], y - held.from[1]) > CLICK;
    };
    // What ends a drag chooses nothing.
    canvas.addEventListener("click", (event) => dragged && event.stopImmediatePropagation(), { capture: true });
    const end = (event) => {
        if (!held) return;
        const { piece, place, by } = held;
        const taken = isTaken(event);
        held = null;
        dragged = Boolean(by);
        if (!by) return;
        const middle = place.middle.map((x, k) => x + by[k]);
        if (taken) take(piece, () => put({ ...place, middle }));
        else cloth.shift(panelNamed(piece), [0, 0, 0]);
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    return { isHeld: () => held !== null };
}
