// Texts of stages' cards in the page's language. They are written in English; a table that is named by the English text
// gives another language. A text that it lacks stays English.

import { getJson } from "../server/requests.js";
import { words } from "./words.js";

const TABLES = { zh: "/words/cards.zh.json" };
const loaded = new Map();

/** The text of a card, and its language where that is not the page's. */
export function cardText(english) {
    const table = loaded.get(words.language) ?? {};
    return Object.hasOwn(table, english) ? { text: table[english] } : { text: english, lang: "en" };
}

/** The first paragraph of a card. */
export const summary = (card) => cardText(card.doc).text.split("\n")[0];

/** Brings the table of the chosen language. */
async function load() {
    const { language } = words;
    if (!TABLES[language] || loaded.has(language)) return;
    loaded.set(language, {});
    try {
        loaded.set(language, await getJson(TABLES[language]));
        words.renew();
    } catch {
        // Asked for again with the next choice of a language.
        loaded.delete(language);
    }
}

/** Keeps the texts in the language of the page. */
export function followLanguage() {
    words.watch(load);
    load();
}
