// A handle that is dragged by pointer or moved by arrow keys.
//
// What is moved is told in steps of the drawing while it goes, and once when it ends; keys end after a pause, so that
// ten presses are one edit.

import { afterPause } from "./element.js";

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const PAUSE = 500;

let held = null;

/** Whether a handle is held by the pointer: what it belongs to is not drawn anew then. */
export const isHeld = () => held?.isConnected ?? false;

/**
 * `place(event)` gives the point of the drawing below the pointer. `move(dx, dy)` shows the handle moved by so much
 * altogether, `end(dx, dy)` takes it, `step` is what an arrow key moves (ten times with Shift). The handle stays where it
 * is while `when()` is false.
 */
export function draggable(handle, { place, move, end, step, when = () => true }) {
    let from = null;
    let by = [0, 0];
    const finish = () => {
        const [dx, dy] = by;
        by = [0, 0];
        if (dx || dy) end(dx, dy);
    };
    handle.addEventListener("pointerdown", (event) => {
        if (event.button !== 0 || !when()) return;
        // The drawing does not move with its handle.
        event.stopPropagation();
        event.preventDefault();
        handle.focus({ preventScroll: true });
        handle.setPointerCapture(event.pointerId);
        from = place(event);
        held = handle;
    });
    handle.addEventListener("pointermove", (event) => {
        if (!from) return;
        const at = place(event);
        by = [at[0] - from[0], at[1] - from[1]];
        move(...by);
    });
    handle.addEventListener("pointerup", () => {
        if (!from) return;
        from = held = null;
        finish();
    });
    handle.addEventListener("pointercancel", () => {
        from = held = null;
        by = [0, 0];
        move(0, 0);
    });

    const later = afterPause(PAUSE, finish);
    handle.addEventListener("keydown", (event) => {
        const arrow = ARROWS[event.key];
        if (!arrow || !when() || event.ctrlKey || event.altKey || event.metaKey) return;
        event.preventDefault();
        event.stopPropagation();
        const many = event.shiftKey ? 10 : 1;
        by = [by[0] + arrow[0] * step * many, by[1] + arrow[1] * step * many];
        move(...by);
        later();
    });
    handle.addEventListener("blur", () => later.now());
}
