// The pattern on paper, for a cutter or a program: files are written beside the other results.

import { h, replace } from "../dom/element.js";
import { postJson } from "../server/requests.js";
import { loadFiles } from "../server/live.js";
import { store, watch } from "../server/store.js";
import { sayError, sayWord } from "../head/status.js";

/** Formats with the stages that write them; the first that the program has is taken. */
const FORMATS = {
    PDF: ["PatternPdf"],
    SVG: ["PatternSvg"],
    DXF: ["PatternDxf"],
    HPGL: ["PatternHpgl", "PatternPlt"],
};

/** What is added around the pieces unless another figure is given, and the most, in millimetres. */
const ALLOWANCES = { seam: 10, hem: 20 };
const MOST_ALLOWANCE = 100;

const link = (path) =>
    h("a", { href: `/api/out/${path.split("/").map(encodeURIComponent).join("/")}`, target: "_blank" }, path);

/** A button that opens a list of formats; below them the files that were written. */
export function mountPrinting() {
    const done = h("p", { class: "printed" });
    const allowances = ["seam", "hem"].map((of) =>
        h("input", {
            type: "number",
            id: `print-${of}`,
            min: 0,
            max: MOST_ALLOWANCE,
            step: "any",
            value: String(ALLOWANCES[of]),
            "data-of": of,
        }),
    );
    const fields = h(
        "p",
        { class: "line" },
        allowances.map((field) =>
            h("label", { class: "line" }, h("span", { word: `print.${field.dataset.of}` }), field, " mm"),
        ),
    );
    const buttons = Object.entries(FORMATS).map(([format, writers]) =>
        h("button", { "data-format": format, onclick: () => print(format, writers) }, format),
    );
    const all = h(
        "details",
        { id: "print", class: "menu" },
        h("summary", { word: "print" }),
        h(
            "div",
            { class: "menu-body" },
            h("p", { class: "hint", word: "print.how" }),
            fields,
            h("p", { class: "choices" }, buttons),
            done,
        ),
    );

    async function print(format, writers) {
        const wrong = allowances.find((field) => field.value === "" || !field.checkValidity());
        if (wrong) {
            wrong.reportValidity();
            return;
        }
        const given = allowances.map((field) => `${field.dataset.of}_allowance: "${Number(field.value)} mm"`);
        const writer = writers.find((name) => store.cards.has(name)) ?? writers[0];
        for (const el of buttons) el.disabled = true;
        sayWord("print.busy", { format });
        try {
            const { files } = await postJson("/api/print", { writer: `${writer}(${given.join(", ")})` });
            replace(
                done,
                files.map((file) => link(file.path ?? file)),
            );
            sayWord("print.done", { format, n: files.length }, "done");
            loadFiles();
        } catch (error) {
            sayError(error);
        } finally {
            for (const el of buttons) el.disabled = false;
        }
    }
    all.addEventListener("keydown", (event) => {
        if (event.key !== "Escape" || !all.open) return;
        event.stopPropagation();
        all.open = false;
        all.querySelector("summary").focus();
    });
    watch(["escape"], () => {
        all.open = false;
    });
    document.addEventListener("pointerdown", (event) => {
        if (!all.contains(event.target)) all.open = false;
    });
    return all;
}
