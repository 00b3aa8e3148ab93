// What a message offers to be typed at the command line (`--set 'PATH=VALUE'`), as buttons.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";
import { show } from "../layout.js";

const OFFER = /--set '([^=']+)=([^']*)'/g;
/** Offers that stand behind each other are made together. */
const TOGETHER = /(?:--set '[^']*'\s*)+/g;
/** Values of these paths in messages are examples: each is said where the page asks for it. */
const ASKED = [
    [/^(style|body)\.style$/, "remedy.kind", () => document.querySelector("#photo .kinds summary")],
    [/^photos\.\w+\.(width|scale)$/, "remedy.width", () => document.getElementById("photo-width")],
];
const FILE = /\.(file|seams|measurements)$|\(file:/;

/** The remedies of a text: `[{words, act}]`. */
function remedies(text) {
    const found = new Map();
    for (const [together] of text.matchAll(TOGETHER)) {
        const offers = [...together.matchAll(OFFER)].map(([, path, value]) => ({ path, value }));
        const [{ path }] = offers;
        const asked = ASKED.find(([paths]) => paths.test(path));
        if (asked) found.set(asked[1], { words: t(asked[1]), act: () => lead(asked[2]) });
        else if (!offers.some((offer) => FILE.test(offer.path) || FILE.test(offer.value))) {
            const said = offers.map((offer) => `${offer.path} = ${offer.value}`).join(", ");
            const changes = offers.map((offer) => ({ set: offer }));
            found.set(said, { words: t("remedy.set", { said }), act: () => edit(said, changes) });
        }
    }
    return [...found.values()];
}

/** Shows what asks for it. */
function lead(field) {
    show("photo");
    const el = field();
    if (el?.parentNode.matches("details")) el.parentNode.open = true;
    el?.focus();
}

/** The texts that say what keeps the present text from a good garment. */
function told() {
    const { faults, run, project } = store.state ?? {};
    if (!project?.file) return [];
    if (faults.length > 0) return faults.map(({ message, hint }) => `${message} ${hint ?? ""}`);
    if (run.edit !== project.edit) return [];
    if (run.state === "failed" && run.error) return [`${run.error.message} ${run.error.hint ?? ""}`];
    return run.state === "done" ? (run.shortfalls ?? []).map(({ message }) => message) : [];
}

export function mountRemedies(foot) {
    const part = h("p", { class: "choices", role: "group", label: "remedies" });
    foot.append(part);
    const draw = whenChanged((text) => {
        const found = remedies(text);
        part.hidden = found.length === 0;
        replace(
            part,
            found.map(({ words, act }) => h("button", { onclick: act }, words)),
        );
    });
    watch(["state"], () => draw(told().join(" ")));
}
