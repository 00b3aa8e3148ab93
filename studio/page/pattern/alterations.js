// Alterations of the pattern as the stage `Alter` takes them, one after the other. An alteration is added at the end
// of its list; a pipeline without `Alter` gets one, before the pieces are meshed.

import { stageNamed, store } from "../server/store.js";
import { itemsOf, list, number, quote, tryRead } from "../ron/ron.js";
import { inMm, metres } from "../ron/lengths.js";
import { sameRole } from "../server/store.js";

export const moveCorner = (piece, corner, x, y) =>
    `MoveCorner(piece: ${quote(piece)}, corner: ${corner}, x: ${inMm(x)}, y: ${inMm(y)})`;
export const moveEdge = (edge, x, y) => `MoveEdge(edge: ${quote(edge)}, x: ${inMm(x)}, y: ${inMm(y)})`;
export const lengthen = (edge, by) => `Lengthen(edge: ${quote(edge)}, by: ${inMm(by)})`;
export const dart = (edge, at, width, length) =>
    `Dart(edge: ${quote(edge)}, at: ${number(at, 3)}, width: ${inMm(width)}, length: ${inMm(length)})`;
export const mirror = (piece, name) => `Mirror(piece: ${quote(piece)}, name: ${quote(name)})`;
export const sew = (a, b, reversed = false) =>
    `Sew(a: ${quote(a)}, b: ${quote(b)}${reversed ? ", reversed: true" : ""})`;
const remove = (piece) => `Remove(piece: ${quote(piece)})`;
export const sewOn = (piece, onto, x, y) =>
    `SewOn(piece: ${quote(piece)}, onto: ${quote(onto)}, x: ${inMm(x)}, y: ${inMm(y)})`;
export const unsew = (edge) => `Unsew(edge: ${quote(edge)})`;

/** Where `Alter` is added: before what reads the pattern's seams or meshes its pieces. */
function before() {
    const stages = store.state.stages;
    const stop = stages.findIndex(
        ({ name, role }) => ["Seams", "Unpick"].includes(name) || sameRole(role, "mesher"),
    );
    const ahead = stages.slice(0, stop < 0 ? stages.length : stop);
    const inList = ahead.filter(({ path }) => path?.startsWith("stages."));
    const section =
        ahead.find(({ path }) => path === "style") ??
        ahead.find(({ path }) => path === "pattern") ??
        ahead[0];
    return (inList.at(-1) ?? section)?.id ?? null;
}

/** The changes after which these are the alterations. */
export function withItems(items) {
    const stage = stageNamed("Alter");
    if (!stage) return [{ add: { stage: `Alter(alterations: ${list(items)})`, after: before() } }];
    if (items.length === 0) return [{ remove: stage.path }];
    return [{ set: { path: `${stage.path}.alterations`, value: list(items) } }];
}

export const present = () => itemsOf(stageNamed("Alter")?.params.alterations);

/** The changes that add alterations. Moves of what was moved last are added up. */
export function alter(...added) {
    const items = present();
    for (const item of added) {
        const sum = items.length > 0 && summed(items.at(-1), item);
        if (sum) items[items.length - 1] = sum;
        else items.push(item);
    }
    return withItems(items);
}

/** Whether an alteration sews that piece onto another. */
export function sewsOn(item, piece) {
    const { name, fields } = tryRead(item);
    return name === "SewOn" && fields.piece.value === piece;
}

/** The changes that take a piece out: it is not sewn onto another before. */
export const takenOut = (piece) =>
    withItems([...present().filter((item) => !sewsOn(item, piece)), remove(piece)]);

/** One move in the place of two of the same corner or edge. */
function summed(first, second) {
    const [a, b] = [tryRead(first), tryRead(second)];
    if (a?.name !== b?.name || !["MoveCorner", "MoveEdge"].includes(a.name)) return null;
    if (["piece", "corner", "edge"].some((field) => a.fields[field]?.value !== b.fields[field]?.value))
        return null;
    const [x, y] = ["x", "y"].map((field) => metres(a.fields[field]?.value) + metres(b.fields[field]?.value));
    return a.name === "MoveCorner"
        ? moveCorner(a.fields.piece.value, a.fields.corner.value, x, y)
        : moveEdge(a.fields.edge.value, x, y);
}

/** The changes that turn a seam of two edges round: the alteration that sewed it is turned, or it is sewn anew. */
export function reverseSeam(a, b) {
    const items = present();
    const at = items.findLastIndex((item) => {
        const { name, fields } = tryRead(item);
        return name === "Sew" && [fields.a.value, fields.b.value].sort().join() === [a, b].sort().join();
    });
    if (at < 0) return withItems([...items, unsew(a), sew(a, b, true)]);
    items[at] = sew(a, b, tryRead(items[at]).fields.reversed?.value !== "true");
    return withItems(items);
}
