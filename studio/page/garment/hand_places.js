// Where pieces start that were dragged, as the stage `Arrange` takes them: the middle of a piece in metres from the
// floor below the wearer (to the wearer's left, up, forwards), and degrees by which it is turned.

import { stageNamed, store } from "../server/store.js";
import { list, number, quote, tryRead } from "../ron/ron.js";
import { inMm, metres } from "../ron/lengths.js";
import { extent } from "./extent.js";

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

/** Pieces that something else places: key points, or the piece that they are sewn onto. */
function placedOtherwise() {
    const keys = tryRead(stageNamed("Arrange")?.params.key_points)?.items ?? [];
    const keyed = keys.map(({ fields }) => fields.edge.value.split(".", 1)[0]);
    const patches = (store.view?.pattern?.seams ?? []).filter(({ kind }) => kind === "patch");
    return new Set([...keyed, ...patches.flatMap(({ sides }) => sides[0].map((use) => use.piece))]);
}

/** Pieces of which neither the file nor a rule says where they stand. */
export function unplaced() {
    if (!canPlace()) return [];
    const given = new Set([...placedOtherwise(), ...handPlaces().map(({ piece }) => piece)]);
    return (store.view?.unplaced ?? []).filter((piece) => !given.has(piece));
}

/** Whether a piece has a place by itself. */
export const hasOwnPlace = (piece) => !(store.view?.unplaced ?? []).includes(piece);

/** Where a piece starts now, by hand or by itself; nothing where it has no place, or none that can be changed by hand. */
export function placeOf(piece) {
    const isThere = store.view?.pattern?.pieces.some(({ name }) => name === piece);
    if (!isThere || placedOtherwise().has(piece)) return null;
    const given = handPlaces().find((place) => place.piece === piece);
    if (given) return given;
    const panel = store.garment?.panels.find(({ name }) => name === piece);
    if (!panel) return null;
    const [first, end] = [panel.first_vertex, panel.first_vertex + panel.vertices];
    const { middle } = extent(store.garment.positions.subarray(3 * first, 3 * end));
    return { piece, middle, turn: NO_TURN };
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
    const [, top, front] = store.body ? extent(store.body.positions).high : [0, 1.7, 0.15];
    return { piece, middle: [0, 0.65 * top, front + 0.08], turn: NO_TURN };
}
