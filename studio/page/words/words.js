// The page's words in the chosen language. A key names a sentence; {name} in it is filled in. Elements that were made
// with a key (dom/element.js) change with the language.

import { en } from "./en.js";
import { zh } from "./zh.js";

const TABLES = { en, zh };
const KEPT = "toile-language";
let language = "en";
let edition = 0;
const watchers = new Set();

const fill = (text, values) => text.replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);

/** The sentence of a key. A key without words in the chosen language is shown in English. */
export function t(key, values = {}) {
    return fill(TABLES[language][key] ?? en[key] ?? key, values);
}

/** The sentence of a key that stands for a name of the program (a role, a state); the name itself where there is none. */
export function term(group, name) {
    const key = `${group}.${name}`;
    return TABLES[language][key] ?? en[key] ?? name;
}

function retell(root = document) {
    for (const el of root.querySelectorAll("[data-word]")) el.textContent = t(el.dataset.word);
    for (const el of root.querySelectorAll("[data-label]"))
        el.setAttribute("aria-label", t(el.dataset.label));
    for (const el of root.querySelectorAll("[data-tip]")) el.title = t(el.dataset.tip);
}

export const words = {
    languages: { en: "English", zh: "中文" },
    get language() {
        return language;
    },
    choose(next) {
        language = TABLES[next] ? next : "en";
        localStorage.setItem(KEPT, language);
        document.documentElement.lang = language === "zh" ? "zh-Hans" : language;
        retell();
        this.renew();
    },
    /** Grows with every change of the words. */
    get edition() {
        return edition;
    },
    /** Tells that there are other words than before. */
    renew() {
        edition += 1;
        watchers.forEach((run) => run());
    },
    /** The language chosen last, else the first that the browser asks for and that there is. */
    restore() {
        const asked = [localStorage.getItem(KEPT), ...navigator.languages].filter(Boolean);
        this.choose(asked.map((tag) => tag.slice(0, 2)).find((tag) => TABLES[tag]) ?? "en");
    },
    watch(run) {
        watchers.add(run);
    },
};

/** Lengths as people who sew write them. */
export const cm = (metres, digits = 1) => `${(100 * metres).toFixed(digits)} cm`;
export const mm = (metres, digits = 0) => `${(1000 * metres).toFixed(digits)} mm`;
