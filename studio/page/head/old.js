// What a pane shows is of an earlier text where the last run did not come so far: the pane says so, and why.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { run, undo } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";

/** The stage at which the run failed. */
const failed = () => store.state?.stages.find(({ id }) => id === store.state.run.error?.stage);

const makes = (stage, kind) =>
    (store.cards.get(stage?.name)?.outputs ?? []).some((output) => output.kind === kind);

/** The number of the text that the pane's part comes from; nothing where there is no such part. */
function comesFrom(part) {
    if (part === "pattern") return store.view?.pattern_edit;
    return store.placing ? store.view?.start_edit : store.view?.garment_edit;
}

/** Why a part is not that of the present text: "faults", "failed", "stopped"; null where it is, or is on its way. */
function why(part) {
    const from = comesFrom(part) ?? null;
    if (from === null || !store.state) return null;
    const { project, faults, run: last } = store.state;
    if (faults.length > 0) return from === project.edit ? null : "faults";
    if (last.edit !== project.edit || (last.state !== "failed" && last.state !== "stopped")) return null;
    // A pattern is changed by several stages: what the one that failed was given is not what it should be.
    const isHalf = part === "pattern" && last.state === "failed" && makes(failed(), "pattern");
    return from !== project.edit || isHalf ? last.state : null;
}

/** The line above a pane's part ("pattern", "garment") that says that it is old, with a way out. */
export function oldNotice(part) {
    const line = h("p", { class: "old-notice", role: "status" });
    const draw = whenChanged((reason, stage, words) => {
        line.hidden = !reason;
        if (!reason) return replace(line);
        const again = reason === "stopped";
        return replace(
            line,
            h("span", {}, t(`old.${reason}`, { stage })),
            again && h("button", { word: "run", onclick: () => run(null) }),
            !again && words && h("button", { onclick: undo }, t("old.undo", { words })),
        );
    });
    watch(["state", "view", "cards"], () => {
        const reason = why(part);
        draw(reason, failed()?.name ?? t("old.writing"), store.state?.project.can_undo ?? null);
    });
    return line;
}
