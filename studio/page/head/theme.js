// Light or dark: as the system says, until someone says otherwise. What was said is remembered.

import { tell } from "../server/store.js";

const KEPT = "toile-theme";
const system = matchMedia("(prefers-color-scheme: dark)");

export const isDark = () =>
    (document.documentElement.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";

export function restoreTheme() {
    const kept = localStorage.getItem(KEPT);
    if (kept) document.documentElement.dataset.theme = kept;
    system.addEventListener("change", () => tell("theme"));
}

export function switchTheme() {
    const next = isDark() ? "light" : "dark";
    document.documentElement.dataset.theme = next;
    localStorage.setItem(KEPT, next);
    tell("theme");
}

/** The value of a colour of the style sheets, for what is drawn on a canvas. */
export function colour(name) {
    // A property holds light-dark(...) as it is written; a colour of an element is what it comes to.
    const probe = document.createElement("i");
    probe.style.color = `var(--${name})`;
    document.body.append(probe);
    const value = getComputedStyle(probe).color;
    probe.remove();
    return value;
}
