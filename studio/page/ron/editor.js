// The pipeline's text beside the rest: line numbers, faults at their place. What is typed goes to the program after a
// pause, first as a draft, whose faults are told; without faults, for real.

import { afterPause, h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";
import { indexOfByte, lineOf } from "./places.js";

const PAUSE = 400;

/** The text with the places of faults marked, behind the field in which it is typed. */
function underlined(text, faults) {
    const spans = faults
        .map(({ start, end }) => [
            indexOfByte(text, start),
            Math.max(indexOfByte(text, end), indexOfByte(text, start) + 1),
        ])
        .sort((a, b) => a[0] - b[0]);
    const parts = [];
    let at = 0;
    for (const [start, end] of spans) {
        if (start < at) continue;
        parts.push(text.slice(at, start), h("mark", {}, text.slice(start, end)));
        at = end;
    }
    return [...parts, `${text.slice(at)}\n`];
}

export function mountText(root) {
    const numbers = h("pre", { class: "numbers", "aria-hidden": "true" });
    const behind = h("pre", { class: "behind", "aria-hidden": "true" });
    const field = h("textarea", {
        id: "ron",
        label: "text.label",
        spellcheck: "false",
        autocomplete: "off",
        autocapitalize: "off",
        wrap: "off",
        lang: "en",
    });
    const faultList = h("ul", { class: "faults", "aria-live": "polite" });
    replace(
        root,
        h("div", { class: "editor" }, numbers, h("div", { class: "paper" }, behind, field)),
        h(
            "div",
            { class: "beside" },
            h("div", { class: "bar" }, h("h2", { word: "text.faults" })),
            faultList,
            h("p", { class: "hint", word: "text.how" }),
        ),
    );

    /** The text that the program has, as far as this field knows. */
    let known = "";
    let sending = false;

    const scroll = () => {
        numbers.scrollTop = field.scrollTop;
        behind.scrollTop = field.scrollTop;
        behind.scrollLeft = field.scrollLeft;
    };
    const drawNumbers = whenChanged((count) => {
        numbers.textContent = Array.from({ length: count }, (_, i) => i + 1).join("\n");
    });
    const drawBehind = (faults) => {
        drawNumbers(field.value.split("\n").length);
        replace(behind, underlined(field.value, faults));
        scroll();
    };
    const isTyped = () => field.value !== known;

    const send = afterPause(PAUSE, async () => {
        if (!isTyped() || sending) return;
        sending = true;
        const text = field.value;
        const words = t("edit.text");
        const taken = await edit(words, [{ text }], { draft: true });
        const faults = taken ? await faultsOf(text) : null;
        if (faults?.length === 0 && field.value === text) await edit(words, [{ text }]);
        if (taken) known = text;
        sending = false;
        field.dataset.typed = String(isTyped());
        if (isTyped()) send();
    });
    field.addEventListener("input", () => {
        field.dataset.typed = "true";
        drawBehind([]);
        send();
    });
    field.addEventListener("commit", () => send.now());
    field.addEventListener("blur", () => send.now());
    field.addEventListener("scroll", scroll);
    // Tab leaves the field, as everywhere; lines keep their indentation.
    field.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" || event.isComposing) return;
        const line = field.value.slice(0, field.selectionStart).split("\n").at(-1);
        const indent = /^\s*/.exec(line)[0];
        if (!indent) return;
        event.preventDefault();
        field.setRangeText(`\n${indent}`, field.selectionStart, field.selectionEnd, "end");
        field.dispatchEvent(new Event("input"));
    });

    const jump = (fault) => {
        const index = indexOfByte(field.value, fault.start);
        field.focus();
        field.setSelectionRange(index, Math.max(index + 1, indexOfByte(field.value, fault.end)));
        const height = parseFloat(getComputedStyle(field).lineHeight);
        field.scrollTop = Math.max(0, (lineOf(field.value, index).line - 4) * height);
    };
    const drawFaults = whenChanged((faults) => {
        replace(
            faultList,
            faults.length === 0
                ? h("li", { class: "none" }, t("text.noFaults"))
                : faults.map((fault) =>
                      h(
                          "li",
                          {},
                          h(
                              "button",
                              { class: "plain", onclick: () => jump(fault) },
                              t("text.line", { line: fault.line, column: fault.column }),
                          ),
                          h("span", { lang: "en" }, ` ${fault.message}`),
                          fault.hint && h("span", { class: "hint", lang: "en" }, ` ${fault.hint}`),
                      ),
                  ),
        );
        const tab = document.getElementById("tab-text");
        if (tab) tab.dataset.faults = faults.length > 0 ? String(faults.length) : "";
    });

    watch(["state"], () => {
        const state = store.state;
        if (!state) return;
        if (!isTyped() && !sending && store.text !== field.value) {
            const { scrollTop, selectionStart } = field;
            field.value = known = store.text;
            field.setSelectionRange(selectionStart, selectionStart);
            field.scrollTop = scrollTop;
        }
        drawFaults(state.faults);
        if (!isTyped()) drawBehind(state.faults);
        field.setAttribute("aria-invalid", state.faults.length > 0);
    });
}

/** The faults of a draft: of the state that has this text. */
async function faultsOf(text) {
    const { getJson } = await import("../server/requests.js");
    const state = await getJson("/api/state");
    return state.text === text ? state.faults : null;
}
