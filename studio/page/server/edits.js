// Edits go out one after the other. Where somebody else edited first, the edit is made anew from the new state, once.

import { Refusal, getJson, postJson } from "./requests.js";
import { store, tell } from "./store.js";
import { takeState } from "./live.js";
import { sayError, sayWord } from "../head/status.js";

let queue = Promise.resolve();
/** The number of the text after the last edit of this page. */
let answered = 0;

/** Runs `send(edit number)` when all before it are answered. Gives whether it was taken. */
function inTurn(send) {
    store.pending += 1;
    const turn = queue.then(async () => {
        try {
            // What the last edit made of the text may still be on its way: the next one is made from it.
            if (store.state.project.edit < answered) takeState(await getJson("/api/state"));
            const { edit } = await send(store.state.project.edit).catch(async (error) => {
                if (!(error instanceof Refusal) || error.code !== "stale") throw error;
                takeState(await getJson("/api/state"));
                return send(store.state.project.edit);
            });
            answered = edit;
            return true;
        } catch (error) {
            sayError(error);
            return false;
        } finally {
            store.pending -= 1;
            tell("pending");
        }
    });
    queue = turn;
    return turn;
}

/** `changes` as the program takes them, or a function that gives them from the state as it is by then. */
export function edit(words, changes, { draft = false } = {}) {
    return inTurn((number) => {
        const list = typeof changes === "function" ? changes() : changes;
        if (!list || list.length === 0) return { edit: number };
        return postJson("/api/edit", { edit: number, words, changes: list, ...(draft ? { draft } : {}) });
    });
}

/** Sews proposed seams of these names. */
export const sewProposals = (words, seams) =>
    inTurn((number) => postJson("/api/sew", { edit: number, words, seams }));

// Whether there is something to undo is known to the program: the last edit may still be on its way here.
export const undo = () => store.state && inTurn((number) => postJson("/api/undo", { edit: number }));
export const redo = () => store.state && inTurn((number) => postJson("/api/redo", { edit: number }));

export async function save() {
    await queue;
    try {
        const { file } = await postJson("/api/save");
        const faulty = store.state.faults.length > 0;
        sayWord(faulty ? "saved.faults" : "saved.as", { file }, faulty ? "error" : "note");
    } catch (error) {
        sayError(error);
    }
}

export async function run(quality = null) {
    await queue;
    await postJson("/api/run", { quality, full: true }).catch(sayError);
}

export const stop = () => postJson("/api/stop").catch(sayError);
