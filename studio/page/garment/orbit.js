// The camera goes around a point: drag turns, wheel or two fingers zoom, drag with the right button or Shift moves.
// Keys: arrows turn, + and - zoom, Home fits.

import { Vector3 } from "../vendor/three.module.min.js";

const TURN = 0.008;
const KEY_TURN = 0.12;
const ZOOM = 1.15;
const STEEPEST = 1.5;

export function orbit(canvas, camera, draw) {
    const centre = new Vector3(0, 1, 0);
    let [around, up, away] = [0, 0.08, 3];
    let size = 1.5;
    const fingers = new Map();

    const show = () => {
        const level = away * Math.cos(up);
        camera.position.set(
            centre.x + level * Math.sin(around),
            centre.y + away * Math.sin(up),
            centre.z + level * Math.cos(around),
        );
        camera.lookAt(centre);
        draw();
    };
    const turn = (dx, dy) => {
        around -= dx;
        up = Math.min(STEEPEST, Math.max(-STEEPEST, up + dy));
        show();
    };
    const zoom = (factor) => {
        away = Math.min(20 * size, Math.max(0.1 * size, away / factor));
        show();
    };
    const move = (dx, dy) => {
        const perPixel = (2 * away * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight;
        const right = new Vector3().setFromMatrixColumn(camera.matrix, 0);
        const above = new Vector3().setFromMatrixColumn(camera.matrix, 1);
        centre.addScaledVector(right, -dx * perPixel).addScaledVector(above, dy * perPixel);
        show();
    };

    let walked = 0;
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        fingers.set(event.pointerId, [event.clientX, event.clientY]);
        walked = 0;
    });
    canvas.addEventListener("click", (event) => walked > 4 && event.stopImmediatePropagation(), {
        capture: true,
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointermove", (event) => {
        const before = fingers.get(event.pointerId);
        if (!before) return;
        const now = [event.clientX, event.clientY];
        const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
        walked += Math.hypot(dx, dy);
        const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
        if (other) {
            const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
            zoom(apart(now) / apart(before));
        } else if (event.buttons === 2 || event.shiftKey) move(dx, dy);
        else turn(TURN * dx, TURN * dy);
        fingers.set(event.pointerId, now);
    });
    for (const end of ["pointerup", "pointercancel"])
        canvas.addEventListener(end, (e) => fingers.delete(e.pointerId));
    canvas.addEventListener(
        "wheel",
        (event) => {
            event.preventDefault();
            zoom(event.deltaY < 0 ? ZOOM : 1 / ZOOM);
        },
        { passive: false },
    );
    canvas.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const many = event.shiftKey ? 4 : 1;
        const act = {
            ArrowLeft: () => turn(-KEY_TURN * many, 0),
            ArrowRight: () => turn(KEY_TURN * many, 0),
            ArrowUp: () => turn(0, KEY_TURN * many),
            ArrowDown: () => turn(0, -KEY_TURN * many),
            "+": () => zoom(ZOOM),
            "=": () => zoom(ZOOM),
            "-": () => zoom(1 / ZOOM),
            Home: () => view.fit(),
        }[event.key];
        if (!act) return;
        event.preventDefault();
        act();
    });

    let whole = { middle: [0, 1, 0], size: 1.5 };
    const view = {
        turning: () => fingers.size > 0,
        /** Looks at the whole, from where the camera stands. */
        fit(next = whole) {
            whole = next;
            size = whole.size;
            centre.set(...whole.middle);
            const narrow = Math.min(1, camera.aspect);
            away = (0.62 * size) / Math.tan((camera.fov * Math.PI) / 360) / narrow;
            show();
        },
        /** Looks from an angle around the vertical, in radians. */
        from(angle) {
            [around, up] = [angle, 0.08];
            show();
        },
        zoom,
    };
    return view;
}
