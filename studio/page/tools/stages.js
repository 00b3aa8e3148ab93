// The pipeline's stages, as a list and as a graph; the card of the one that is chosen.

import { h, replace } from "../dom/element.js";
import { summary } from "../words/card_texts.js";
import { t, term } from "../words/words.js";
import { edit } from "../server/edits.js";
import { sameRole, store, watch, whenChanged } from "../server/store.js";
import { graphOf } from "./graph.js";
import { cardOf } from "./card.js";

const MARKS = { waiting: "·", running: "▸", done: "✓", skipped: "–", failed: "✗" };

let chosen = null;
let asGraph = false;

const stage = () => store.state?.stages.find((one) => one.id === chosen) ?? store.state?.stages[0];

function row(one, now, choose) {
    const time = one.cached
        ? t("stage.kept")
        : one.seconds === null
          ? ""
          : t("seconds", { s: one.seconds.toFixed(2) });
    const counts = [
        one.warnings.length > 0 &&
            h("span", { class: "count warning" }, t("stage.warnings", { n: one.warnings.length })),
        one.notes.length > 0 && h("span", { class: "count" }, t("stage.notes", { n: one.notes.length })),
    ];
    return h(
        "li",
        {},
        h(
            "button",
            {
                class: `stage-row ${one.state}`,
                "aria-pressed": one.id === now,
                "data-key": `stage-${one.id}`,
                onclick: () => choose(one.id),
            },
            h("span", { class: "state", "aria-hidden": "true" }, MARKS[one.state]),
            h("span", { class: "id" }, one.id),
            h("span", { class: "unseen" }, ` ${term("state", one.state)}`),
            counts,
            h("span", { class: "time" }, time),
        ),
    );
}

function adder() {
    const writers = [...store.cards.values()].filter((card) => sameRole(card.role, "writer"));
    const choice = h(
        "select",
        { id: "writer", label: "stages.writer", "data-key": "writer" },
        writers.map((card) => h("option", { value: card.name, title: summary(card) }, card.name)),
    );
    return h(
        "p",
        { class: "line" },
        choice,
        h("button", {
            id: "add-writer",
            word: "stages.add",
            "data-key": "add-writer",
            onclick: () =>
                edit(t("edit.add", { stage: choice.value }), [
                    { add: { stage: `${choice.value}()`, after: null } },
                ]),
        }),
    );
}

export function mountStages(root) {
    const rows = h("ol", { class: "rows" });
    const graph = h("div", {
        class: "graph",
        tabindex: 0,
        role: "region",
        label: "stages.graph",
        hidden: true,
    });
    const add = h("div");
    const card = h("div", { class: "card-of" });
    const turn = h("button", {
        word: "stages.asGraph",
        "aria-pressed": "false",
        onclick: () => {
            asGraph = !asGraph;
            turn.setAttribute("aria-pressed", asGraph);
            rows.hidden = asGraph;
            graph.hidden = !asGraph;
            root.classList.toggle("wide-list", asGraph);
        },
    });
    replace(
        root,
        h(
            "div",
            { class: "list" },
            h("div", { class: "bar" }, h("h2", { word: "tab.stages" }), turn),
            rows,
            graph,
            add,
        ),
        card,
    );

    const choose = (id) => {
        chosen = id;
        redraw();
    };
    const drawRows = whenChanged((stages, now) => {
        replace(
            rows,
            stages.map((one) => row(one, now, choose)),
        );
        replace(graph, graphOf(stages, now, choose));
    });
    const drawCard = whenChanged((one) => replace(card, one && cardOf(one)));
    const drawAdder = whenChanged(() => replace(add, adder()));

    function redraw() {
        if (!store.state) return;
        const now = stage();
        drawRows(store.state.stages, now?.id);
        drawAdder(store.cards.size);
        // Someone who moves a slider is not disturbed by what an earlier move came to.
        if (store.pending === 0)
            drawCard(now && { ...now, seconds: 0, share: 0, state: "", cached: false }, store.cards.size);
    }
    watch(["state", "cards", "pending"], redraw);
}
