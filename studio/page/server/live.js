// Keeps the store in step with the program: its events as they come, and what the events say is new.
//
// An event tells that there is something, not all of it: a view, a mesh, a text is fetched when its number grows, one
// fetch at a time, so that a slow page skips what is old.

import { getBytes, getJson } from "./requests.js";
import { stagesOf, store, tell } from "./store.js";
import { readMesh } from "./mesh_file.js";
import { sayError } from "../head/status.js";

const RETRY = 1000;

/** Fetches again while it was asked for meanwhile; never two at once. */
function latest(fetch) {
    let running = false;
    let again = false;
    return async function next() {
        if (running) {
            again = true;
            return;
        }
        running = true;
        do {
            again = false;
            await fetch().catch((error) => error.status && sayError(error));
        } while (again);
        running = false;
    };
}

const loadText = latest(async () => {
    const state = await getJson("/api/state");
    takeState(state);
});

let seenBody = "";

export const loadView = latest(async () => {
    store.view = await getJson("/api/view");
    tell("view");
    if (store.placing ? store.view.start : store.view.garment) {
        const bytes = await getBytes(store.placing ? "/api/start" : "/api/garment");
        store.garment = bytes && readMesh(bytes);
    } else {
        store.garment = null;
    }
    tell("garment");
    const bodies = stagesOf("body").map(({ id, state, seconds }) => [id, state, seconds]);
    const made = store.view.body ? JSON.stringify([store.state.project.edit, bodies]) : "";
    if (made !== seenBody) {
        seenBody = made;
        const mesh = made && (await getBytes("/api/body"));
        store.body = mesh ? readMesh(mesh) : null;
    }
    tell("body");
});

/** Where the garment has come to while it is draped; nothing of another mesh than the one that is shown. */
const loadMoving = latest(async () => {
    const moving = readMesh(await getBytes("/api/moving"));
    if (store.placing || moving.vertices !== store.garment?.vertices || !store.state.moving) return;
    store.garment.positions = moving.positions;
    tell("moving");
});

const loadMeasures = latest(async () => {
    store.measures = await getJson("/api/measures").catch((error) => {
        if (error.status === 404) return null;
        throw error;
    });
    tell("measures");
});

const loadTrade = latest(async () => {
    store.trade = await getJson("/api/trade");
    tell("trade");
});

export const loadFiles = latest(async () => {
    store.files = (await getJson("/api/out")).files;
    tell("files");
});

/** The garment before the last edit, for laying it over the present one. */
export async function loadBefore() {
    const bytes = await getBytes("/api/before").catch(() => null);
    store.before = bytes && readMesh(bytes);
    tell("before");
}

let textEdit = -1;
let seenView = -1;
let seenMoving = null;
let seenRun = "";
let followed = -1;

/** Takes a state from an event (without its text) or an answer (with it). */
export function takeState(state) {
    const before = store.state;
    // An answer that was on its way when a later one came.
    if (before && state.project.edit < before.project.edit) return;
    store.state = state;
    if (state.text !== undefined) {
        store.text = state.text;
        textEdit = state.project.edit;
    } else if (state.project.edit !== textEdit) {
        loadText();
    }
    tell("state");
    if (!state.project.file) return;
    if (store.cards.size === 0) loadCards();
    if (state.view !== seenView) {
        seenView = state.view;
        loadView();
    }
    if (state.moving && state.moving !== seenMoving) {
        seenMoving = state.moving;
        loadMoving();
    }
    // A text with faults has no measures.
    if (state.project.edit !== followed && state.faults.length === 0) {
        followed = state.project.edit;
        loadMeasures();
        loadTrade();
    }
    const run = `${state.run.number} ${state.run.state}`;
    if (run !== seenRun) {
        seenRun = run;
        loadFiles();
        if (state.run.state === "done" && state.faults.length === 0) loadTrade();
    }
}

const loadCards = latest(async () => {
    if (store.cards.size) return;
    const { stages } = await getJson("/api/cards");
    store.cards = new Map(stages.map((card) => [card.name, card]));
    tell("cards");
});

function connection(up) {
    if (store.connected === up) return;
    store.connected = up;
    tell("connection");
}

/** A program that was started anew has another token: its page must be opened by the address that it printed. */
async function whetherRefused() {
    const refused = await getJson("/api/state").then(
        () => false,
        (error) => error.status === 403,
    );
    if (refused === store.refused) return;
    store.refused = refused;
    tell("connection");
}

/** Opens the stream of events, and opens it again when it breaks. */
export function keepInStep() {
    const events = new EventSource("/api/events");
    events.addEventListener("open", () => connection(true));
    events.addEventListener("state", (event) => {
        connection(true);
        takeState(JSON.parse(event.data));
    });
    events.addEventListener("progress", (event) => {
        store.progress = JSON.parse(event.data);
        tell("progress");
    });
    events.addEventListener("error", () => {
        connection(false);
        if (events.readyState !== EventSource.CLOSED) return;
        whetherRefused();
        setTimeout(keepInStep, RETRY);
    });
    addEventListener("pagehide", () => events.close());
}
