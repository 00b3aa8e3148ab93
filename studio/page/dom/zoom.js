// A drawing that is zoomed and moved by its view box: wheel, drag of the ground, two fingers, buttons.

import { h } from "./element.js";

const STEP = 1.25;

/** `drawing` is an SVG element. Returns `{fit(box), scale(), buttons}`; scale is drawing units per pixel of the screen. */
export function zoomable(drawing, { onchange } = {}) {
    let whole = [0, 0, 100, 100];
    let box = [...whole];
    let touched = false;
    let walked = 0;
    const fingers = new Map();

    const show = () => {
        drawing.setAttribute("viewBox", box.map((x) => x.toFixed(3)).join(" "));
        onchange?.();
    };
    const scale = () => {
        const { width, height } = drawing.getBoundingClientRect();
        return width && height ? Math.max(box[2] / width, box[3] / height) : 1;
    };
    const place = (event) => {
        const matrix = drawing.getScreenCTM();
        if (!matrix) return [0, 0];
        const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
        return [point.x, point.y];
    };
    const zoom = (factor, at = [box[0] + box[2] / 2, box[1] + box[3] / 2]) => {
        const size = box[2] / factor;
        if (size > 4 * whole[2] || size < whole[2] / 60) return;
        touched = true;
        box = [at[0] - (at[0] - box[0]) / factor, at[1] - (at[1] - box[1]) / factor, size, box[3] / factor];
        show();
    };
    const move = (dx, dy) => {
        touched = true;
        box = [box[0] - dx * scale(), box[1] - dy * scale(), box[2], box[3]];
        show();
    };

    drawing.addEventListener(
        "wheel",
        (event) => {
            event.preventDefault();
            zoom(event.deltaY < 0 ? STEP : 1 / STEP, place(event));
        },
        { passive: false },
    );
    drawing.addEventListener("pointerdown", (event) => {
        if (event.button > 1) return;
        fingers.set(event.pointerId, [event.clientX, event.clientY]);
        walked = 0;
    });
    // What ends a drag of the ground is no click.
    drawing.addEventListener("click", (event) => walked > 4 && event.stopImmediatePropagation(), {
        capture: true,
    });
    drawing.addEventListener("pointermove", (event) => {
        const before = fingers.get(event.pointerId);
        if (!before) return;
        const others = [...fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
        const now = [event.clientX, event.clientY];
        if (others.length === 1) {
            const apart = (p) => Math.hypot(p[0] - others[0][0], p[1] - others[0][1]) || 1;
            zoom(apart(now) / apart(before), place(event));
        } else if (Math.hypot(now[0] - before[0], now[1] - before[1]) > 0) {
            walked += Math.hypot(now[0] - before[0], now[1] - before[1]);
            move(now[0] - before[0], now[1] - before[1]);
        }
        fingers.set(event.pointerId, now);
    });
    for (const end of ["pointerup", "pointercancel", "pointerleave"]) {
        drawing.addEventListener(end, (event) => fingers.delete(event.pointerId));
    }

    const fit = () => {
        touched = false;
        box = [...whole];
        show();
    };
    new ResizeObserver(() => onchange?.()).observe(drawing);
    return {
        /** Shows a new whole; the place that someone zoomed to is kept while the whole stays much the same. */
        fit(next) {
            const same = next.every((x, i) => Math.abs(x - whole[i]) < 0.25 * whole[2]);
            whole = next;
            if (!touched || !same) fit();
        },
        scale,
        place,
        buttons: [
            h("button", { class: "icon", label: "zoom.in", tip: "zoom.in", onclick: () => zoom(STEP) }, "+"),
            h(
                "button",
                { class: "icon", label: "zoom.out", tip: "zoom.out", onclick: () => zoom(1 / STEP) },
                "−",
            ),
            h("button", { class: "icon", label: "zoom.fit", tip: "zoom.fit", onclick: fit }, "⤢"),
        ],
    };
}
