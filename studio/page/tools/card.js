// A stage's card: what it does, its parameters, what may stand in its place.

import { h } from "../dom/element.js";
import { cardText, summary } from "../words/card_texts.js";
import { t, term } from "../words/words.js";
import { edit } from "../server/edits.js";
import { sameRole, store } from "../server/store.js";
import { parameter } from "./fields.js";

function swap(stage) {
    const others = [...store.cards.values()].filter(
        (card) => sameRole(card.role, stage.role) && card.name !== stage.name,
    );
    if (others.length === 0) return null;
    const choice = h(
        "select",
        { id: "swap", label: "card.swap", "data-key": "swap" },
        h("option", { value: "" }, t("card.swapFor")),
        others.map((card) => h("option", { value: card.name, title: summary(card) }, card.name)),
    );
    choice.addEventListener(
        "change",
        () =>
            choice.value &&
            edit(t("edit.swap", { from: stage.name, to: choice.value }), [
                { swap: { stage: stage.id, with: `${choice.value}()` } },
            ]),
    );
    return choice;
}

function told(stage) {
    const notes = [
        ...stage.warnings.map((text) => ["warning", text]),
        ...stage.notes.map((text) => ["note", text]),
    ];
    return [
        stage.figures.length > 0 &&
            h(
                "dl",
                { class: "figures" },
                stage.figures.map(({ name, value, unit }) => [
                    h("dt", {}, name),
                    h("dd", {}, `${Number(value.toPrecision?.(4) ?? value)} ${unit ?? ""}`),
                ]),
            ),
        notes.length > 0 &&
            h(
                "ul",
                { class: "notes", lang: "en" },
                notes.map(([kind, text]) => h("li", { class: kind }, text)),
            ),
    ];
}

/** All of a stage that the page shows of it. */
export function cardOf(stage) {
    const card = store.cards.get(stage.name);
    const inList = stage.path?.startsWith("stages.");
    const { text: doc, lang } = cardText(card?.doc ?? "");
    const [first, ...rest] = doc.split("\n\n");
    return [
        h(
            "h3",
            {},
            stage.id === stage.name ? stage.name : `${stage.name} “${stage.id}”`,
            h("small", {}, ` ${term("role", stage.role)}`),
        ),
        h("p", { lang }, first),
        rest.length > 0 &&
            h(
                "details",
                {},
                h("summary", { word: "card.more" }),
                rest.map((text) => h("p", { lang }, text)),
                card.source && h("p", { class: "hint" }, cardText(card.source).text),
            ),
        h(
            "p",
            { class: "choices" },
            swap(stage),
            inList &&
                h("button", {
                    id: "remove-stage",
                    word: "card.remove",
                    onclick: () => edit(t("edit.remove", { stage: stage.name }), [{ remove: stage.path }]),
                }),
        ),
        told(stage),
        // A stage that the file does not name has no place where parameters could stand.
        stage.path &&
            stage.path !== "photos" &&
            (card?.params ?? []).length > 0 &&
            h(
                "div",
                { class: "params" },
                card.params.map((param) => parameter(stage, card, param)),
            ),
    ];
}
