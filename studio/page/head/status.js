// The line that says what the last change did and cost, and the banner while the connection is lost.

import { h, replace } from "../dom/element.js";
import { mm, t } from "../words/words.js";
import { store, watch, whenChanged } from "../server/store.js";

let line = null;
let aside = null;

function say(text, kind = "note") {
    if (!line) return;
    line.dataset.kind = kind;
    line.textContent = text;
}

/** Says a sentence of the page. */
export const sayWord = (key, values, kind) => say(t(key, values), kind);

/** Says why something was refused, in the program's words. */
export function sayError(error) {
    // A request that did not arrive is told by the banner.
    if (error instanceof TypeError && /fetch|network/i.test(error.message)) return;
    say(error.words ?? error.message, "error");
}

const seconds = (value) => t("seconds", { s: value < 10 ? value.toFixed(1) : value.toFixed(0) });

/** A message with what it offers to be typed at the command line; the page has buttons for that (remedies.js). */
const plain = (text) => text.replace(/--set '([^']*)'/g, "$1");

/** What a run came to, in one sentence. */
function told(run, words) {
    if (run.state === "failed") {
        const { stage, message, hint } = run.error ?? { message: t("run.failed") };
        return say(plain(`${stage ? `${stage}: ` : ""}${message}${hint ? ` (${hint})` : ""}`), "error");
    }
    if (run.state === "stopped") return sayWord("run.stopped", {}, "note");
    if (run.state !== "done") return undefined;
    const took = seconds(run.changed?.seconds ?? run.seconds ?? 0);
    const moved = run.changed?.mm;
    const what = words ? t("run.after", { words }) : "";
    const did =
        moved === null || moved === undefined
            ? t("run.done", { took })
            : t("run.moved", { mm: mm(moved / 1000, moved < 10 ? 1 : 0), took });
    if (run.kind === "draft") return say(what + did + t("run.asDraft"), "done");
    const missed = (run.shortfalls ?? []).map(({ message }) => message);
    return missed.length === 0 ? say(what + did, "done") : say(plain(what + missed.join("; ")), "error");
}

const tellRun = whenChanged((run, words, proposed) => {
    if (run.state === "failed" && proposed > 0) sayWord("proposals.first");
    else told(run, words);
});

/** What was said of another text is no longer said. */
const forget = whenChanged(() => say(""));

/** What keeps a text from being run. What someone types has its faults below it. */
const tellFault = whenChanged((edit, fault) => {
    if (!fault || document.activeElement?.matches("textarea")) return;
    say(plain(fault.hint ? `${fault.message} (${fault.hint})` : fault.message), "error");
});

/** `foot` holds the line, `lost` is the banner. */
export function mountStatus(foot, lost) {
    line = h("p", { id: "status", role: "status", "aria-live": "polite" });
    aside = h("p", { id: "figures" });
    replace(foot, line, aside);

    watch(["state", "view"], () => {
        const state = store.state;
        if (!state?.project.file) return;
        const { run, project } = state;
        forget(project.edit);
        tellFault(project.edit, state.faults[0]);
        // What a text comes to is not told before it has run.
        const isOfThisText = run.edit === project.edit;
        aside.classList.toggle("old", !isOfThisText || run.state === "running");
        if (!isOfThisText) return;
        const { number, state: stands, kind, error, shortfalls, changed, seconds: took } = run;
        const ended = stands === "running" ? {} : { error, shortfalls, changed, seconds: took };
        const proposed = store.view?.proposals?.length ?? 0;
        tellRun({ number, state: stands, kind, ...ended }, project.can_undo, proposed);
    });
    watch(["view"], () => {
        const figures = store.view?.figures;
        const parts = [];
        if (figures?.triangles) parts.push(t("figures.triangles", { n: figures.triangles.toLocaleString() }));
        if (figures?.seam_gap_max_m !== undefined)
            parts.push(t("figures.gap", { mm: mm(figures.seam_gap_max_m, 1) }));
        if (figures?.strain_p99 !== undefined) {
            parts.push(t("figures.strain", { share: (100 * figures.strain_p99).toFixed(1) }));
        }
        aside.textContent = parts.join(" · ");
    });
    watch(["connection"], () => {
        lost.hidden = store.connected;
        lost.textContent = store.connected ? "" : t(store.refused ? "connection.refused" : "connection.lost");
        document.body.classList.toggle("is-lost", !store.connected);
    });
}
