// Where pieces start that were dragged, as the stage `Arrange` takes them: the middle of a piece in metres from the
// floor below the wearer (to the wearer's left, up, forwards), and degrees by which it is turned.

import { stageNamed, store } from "../server/store.js";
import { list, number, quote, tryRead } from "../ron/ron.js";
import { inMm, metres } from "../ron/lengths.js";

const NO_TURN = [0, 0, 0];

export const canPlace = () => Boolean(stageNamed("Arrange")?.path);

/** The places that the file gives: `[{piece, middle, turn}]`. */
export function handPlaces() {
    const items = tryRead(stageNamed("Arrange")?.params.hand_places)?.items ?? [];
    return items.map(({ fields }) => ({
        piece: fields.piece.value,
        middle: fields.middle.items.map(({ value }) => metres(value)),
        turn: fields.turn?.items.map(({ value }) => value) ?? NO_TURN,
    }));
}

/** The middle of the box around a panel. */
function middleOf(mesh, { first_vertex: first, vertices }) {
    const places = mesh.positions.subarray(3 * first, 3 * (first + vertices));
    const [low, high] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    places.forEach((x, i) => {
        low[i % 3] = Math.min(low[i % 3], x);
        high[i % 3] = Math.max(high[i % 3], x);
    });
    return low.map((x, k) => (x + high[k]) / 2);
}

/** Where a piece starts now, by hand or by itself; nothing where it has no place. */
export function placeOf(piece) {
    const given = handPlaces().find((place) => place.piece === piece);
    if (given) return given;
    const panel = store.garment?.panels.find(({ name }) => name === piece);
    return panel ? { piece, middle: middleOf(store.garment, panel), turn: NO_TURN } : null;
}

const text = ({ piece, middle, turn }) =>
    `(piece: ${quote(piece)}, middle: (${middle.map(inMm).join(", ")}), turn: (${turn.map((a) => number(a, 1)).join(", ")}))`;

/** The changes that let a piece start there. */
export function put(place) {
    const places = handPlaces();
    const at = places.findIndex(({ piece }) => piece === place.piece);
    places.splice(at < 0 ? places.length : at, at < 0 ? 0 : 1, place);
    return [{ set: { path: `${stageNamed("Arrange").path}.hand_places`, value: list(places.map(text)) } }];
}

/** The changes that let a piece start where it does by itself; none where it does. */
export function takeBack(piece) {
    const before = handPlaces();
    const places = before.filter((place) => place.piece !== piece);
    if (places.length === before.length) return [];
    const path = `${stageNamed("Arrange").path}.hand_places`;
    return places.length > 0 ? [{ set: { path, value: list(places.map(text)) } }] : [{ remove: path }];
}

/** The rotation around an axis as rows of a matrix. */
function around(axis, degrees) {
    const [cos, sin] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
    const [one, two] = [(axis + 1) % 3, (axis + 2) % 3];
    const rows = [0, 1, 2].map((i) => [0, 1, 2].map((k) => (i === k ? 1 : 0)));
    [rows[one][one], rows[one][two], rows[two][one], rows[two][two]] = [cos, -sin, sin, cos];
    return rows;
}

const times = (a, b) =>
    a.map((row) => [0, 1, 2].map((k) => row.reduce((sum, x, i) => sum + x * b[i][k], 0)));

/** A place turned by some degrees around an axis of space: 0 to the wearer's left, 1 up, 2 forwards. */
export function turned(place, axis, degrees) {
    // `Arrange` turns around x first, then y, then z.
    const before = place.turn.reduce((all, angle, k) => times(around(k, angle), all), around(0, 0));
    const now = times(around(axis, degrees), before);
    const upright = Math.hypot(now[0][0], now[1][0]);
    const y = Math.atan2(-now[2][0], upright);
    // Where y is a right angle, x and z turn around the same axis.
    const [x, z] =
        upright > 1e-6
            ? [Math.atan2(now[2][1], now[2][2]), Math.atan2(now[1][0], now[0][0])]
            : [Math.atan2(-now[1][2], now[1][1]), 0];
    return { ...place, turn: [x, y, z].map((angle) => (angle * 180) / Math.PI) };
}

/** A place in front of the body, for a piece that has none. */
export function beforeTheBody(piece) {
    const places = store.body?.positions ?? [];
    let [top, front] = [1.7, 0.15];
    if (places.length > 0) {
        top = front = -Infinity;
        for (let i = 0; i < places.length; i += 3) {
            top = Math.max(top, places[i + 1]);
            front = Math.max(front, places[i + 2]);
        }
    }
    return { piece, middle: [0, 0.65 * top, front + 0.08], turn: NO_TURN };
}
