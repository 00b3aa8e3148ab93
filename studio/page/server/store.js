// What the page knows of the project, and who wants to hear of it. The program has the truth: nothing here is kept
// over a reload.

import { words } from "../words/words.js";

const watchers = new Map();

export const store = {
    /** STATE of the program; its `text` is that of `textEdit`. */
    state: null,
    text: "",
    /** VIEW: photos, outlines, pattern, figures. */
    view: null,
    /** The garment now and before the last edit, and the body: parsed files, see mesh_file.js. */
    garment: null,
    before: null,
    body: null,
    /** Whether the garment is shown as its pieces start, so that they can be placed. */
    placing: false,
    /** Cards of all stages by name. */
    cards: new Map(),
    measures: null,
    trade: null,
    files: [],
    progress: null,
    connected: true,
    /** Whether the program does not know this page any more. */
    refused: false,
    /** Whether the begin is shown over the project. */
    beginsAnew: false,
    /** Edits of this page that are not answered yet. */
    pending: 0,
};

/** Calls `run` now and whenever one of the topics is told. */
export function watch(topics, run) {
    for (const topic of topics) {
        if (!watchers.has(topic)) watchers.set(topic, new Set());
        watchers.get(topic).add(run);
    }
    run();
}

export function tell(...topics) {
    const runs = new Set(topics.flatMap((topic) => [...(watchers.get(topic) ?? [])]));
    for (const run of runs) run();
}

/** Stages of a role, in the order in which they run. */
export const stagesOf = (role) => (store.state?.stages ?? []).filter((stage) => sameRole(stage.role, role));

export const stageNamed = (name) => store.state?.stages.find((stage) => stage.name === name);

/** Roles are written "edge detector" on cards and "EdgeDetector" in files. */
export const sameRole = (a, b) => plain(a) === plain(b);
const plain = (role) => role.toLowerCase().replace(/[^a-z]/g, "");

words.watch(() => tell(...watchers.keys()));

/** Parts of the page that redraw only when what they show, or its language, has changed. */
export function whenChanged(run) {
    let last = null;
    return (...shown) => {
        const now = JSON.stringify([words.edition, ...shown]);
        if (now === last) return;
        last = now;
        run(...shown);
    };
}
