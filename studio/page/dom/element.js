// Elements from code. Words stand in the markup as keys, so that they change with the language:
//
//     h("button", { word: "save", tip: "save.tip", onclick: save })

import { t } from "../words/words.js";

const SVG = "http://www.w3.org/2000/svg";

function set(el, name, value) {
    if (value === undefined || value === null) return;
    if (name.startsWith("aria-")) el.setAttribute(name, String(value));
    else if (value === false) return;
    else if (name.startsWith("on")) el.addEventListener(name.slice(2), value);
    else if (name === "word") [el.dataset.word, el.textContent] = [value, t(value)];
    else if (name === "label") {
        el.dataset.label = value;
        el.setAttribute("aria-label", t(value));
    } else if (name === "tip") [el.dataset.tip, el.title] = [value, t(value)];
    else if (name === "value" || name === "checked" || name === "selected") el[name] = value;
    else el.setAttribute(name, value === true ? "" : value);
}

function make(el, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) if (name !== "value") set(el, name, value);
    el.append(
        ...children
            .flat(Infinity)
            .filter((child) => child !== null && child !== undefined && child !== false),
    );
    if ("value" in attributes) set(el, "value", attributes.value);
    return el;
}

/** An element of the page. `value` is set last, when the options of a choice are there. */
export const h = (tag, attributes = {}, ...children) =>
    make(document.createElement(tag), attributes, children);

/** An element of a drawing. */
export const svg = (tag, attributes = {}, ...children) =>
    make(document.createElementNS(SVG, tag), attributes, children);

/**
 * Puts children in the place of those that are there. The focus goes to the child with the same `data-key` as the one
 * that had it, so that someone who works by keyboard keeps their place.
 */
export function replace(parent, ...children) {
    const active = document.activeElement;
    const key = parent.contains(active) ? active.dataset?.key : undefined;
    parent.replaceChildren(...children.flat(Infinity).filter(Boolean));
    if (key) parent.querySelector(`[data-key="${CSS.escape(key)}"]`)?.focus({ preventScroll: true });
}

/** Runs `run` at the next picture, once however often it was asked for. */
export function oncePerFrame(run) {
    let due = false;
    return () => {
        if (due) return;
        due = true;
        requestAnimationFrame(() => {
            due = false;
            run();
        });
    };
}

/** Runs `run` with the last arguments when none came for `ms`. `now()` runs it at once if it is due. */
export function afterPause(ms, run) {
    let timer = 0;
    let last = [];
    const later = (...args) => {
        last = args;
        clearTimeout(timer);
        timer = setTimeout(() => {
            timer = 0;
            run(...last);
        }, ms);
    };
    later.due = () => timer !== 0;
    later.now = () => {
        if (!timer) return;
        clearTimeout(timer);
        timer = 0;
        run(...last);
    };
    return later;
}
