// Seams that the program proposes for a drawing: those that are ticked are sewn at once.

import { h } from "../dom/element.js";
import { t } from "../words/words.js";
import { sewProposals } from "../server/edits.js";
import { store } from "../server/store.js";
import { choose, hover } from "../server/selection.js";

/** Names of those that are not to be sewn. */
const refused = new Set();

export const proposals = () => store.view?.proposals ?? [];

const percent = (share) => `${Math.round(100 * share)} %`;
const words = ({ sides }) =>
    sides.map((side) => side.map(({ piece, edge }) => `${piece}.${edge}`).join(" + ")).join(" – ");

/** A box to tick, with the seam's number, edges and confidence. */
export function proposalLine(proposal, number, changed = () => {}) {
    const box = h("input", {
        type: "checkbox",
        checked: !refused.has(proposal.name),
        "data-key": `proposal-${proposal.name}`,
    });
    box.addEventListener("change", () => {
        if (box.checked) refused.delete(proposal.name);
        else refused.add(proposal.name);
        changed();
    });
    return h(
        "label",
        { class: "proposal", title: proposal.reason },
        box,
        h("span", { class: `chip seam-${(number - 1) % 10}` }, String(number)),
        h("span", {}, words(proposal)),
        h("span", { class: "hint" }, percent(proposal.confidence)),
    );
}

/** All proposals; `before` is how many seams the pattern has. */
export function proposalList(all, before) {
    const chosen = () => all.map(({ name }) => name).filter((name) => !refused.has(name));
    const button = h("button", {
        id: "sew-proposals",
        class: "primary",
        onclick: () => {
            choose();
            sewProposals(t("edit.proposals", { n: chosen().length }), chosen());
        },
    });
    const count = () => {
        button.textContent = t("proposals.sew", { n: chosen().length });
        button.disabled = chosen().length === 0;
    };
    count();
    const row = (proposal, i) => {
        const light = () => hover({ seam: proposal.name });
        const item = h("li", {}, proposalLine(proposal, before + i + 1, count));
        item.addEventListener("pointerenter", light);
        item.addEventListener("focusin", light);
        item.addEventListener("pointerleave", () => hover());
        item.addEventListener("focusout", () => hover());
        return item;
    };
    return h(
        "div",
        { class: "proposals" },
        h("h3", {}, t("proposals.count", { n: all.length })),
        h("p", { class: "hint", word: "proposals.how" }),
        h("p", { class: "choices" }, button),
        h("ul", { class: "rows" }, all.map(row)),
    );
}
