// Which photo is shown, and which photo shows a panel.

import { store, tell } from "../server/store.js";

let chosen = null;

/** The photo that is shown: the one that was chosen, else the first. */
export const photo = () => store.view?.photos.find((p) => p.name === chosen) ?? store.view?.photos[0];

/** The photo's entry in the file. */
export const entryOf = (name) => store.state?.stages.find((stage) => stage.path === `photos.${name}`);

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
