// Which photo is shown, and which photo shows a panel.

import { tryRead } from "../ron/ron.js";
import { store, tell } from "../server/store.js";

let chosen = null;

/** Photos, the front's first. */
export const photos = () =>
    [...(store.view?.photos ?? [])].sort((a, b) => (b.name === "front") - (a.name === "front"));

/** Names of the photos that the file gives, read or not. */
export const named = () => (tryRead(photosText())?.entries ?? []).map(([key]) => key);

/** Whether the garment has photos at all; taken to be so before anything is known. */
export const hasPhotos = () => !store.view || photos().length > 0 || named().length > 0;

const photosText = () => store.state?.stages.find((stage) => stage.path === "photos")?.params.photos;

/** The photo that is shown: the one that was chosen, else the first. */
export const photo = () => photos().find((p) => p.name === chosen) ?? photos()[0];

/** What the file says of a photo, as it is written there: {file, width, scale}; nothing of a mirror image. */
export function entryOf(name) {
    const text = photosText();
    const entry = tryRead(text)?.entries?.find(([key]) => key === name)?.[1];
    return entry?.fields && valuesOf(text, entry.fields);
}

const valuesOf = (text, fields) =>
    Object.fromEntries(
        Object.entries(fields).map(([key, value]) => [key, text.slice(value.start, value.end)]),
    );

/** Which photo a panel is seen in. */
export function photoOf(panel) {
    const piece = store.view?.pattern?.pieces.find((p) => p.name === panel);
    if (piece) return piece.photo;
    return store.view?.photos.some((p) => p.name === panel) ? panel : store.view?.photos[0]?.name;
}

export function showPhoto(name) {
    chosen = name;
    tell("photo");
}
