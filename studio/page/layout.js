// Photo, pattern and garment beside each other, the tools below them. On a narrow screen one of them at a time: the
// same row of tabs then holds the panes as well.

import { h, replace } from "./dom/element.js";
import { store, watch } from "./server/store.js";
import { mountPhoto } from "./photo/pane.js";
import { hasPhotos } from "./photo/shown.js";
import { mountPattern } from "./pattern/pane.js";
import { mountGarment } from "./garment/pane.js";
import { mountStages } from "./tools/stages.js";
import { mountWearer } from "./tools/wearer.js";
import { mountText } from "./ron/editor.js";
import { mountTrade } from "./tools/trade.js";
import { mountFiles } from "./tools/files.js";

const PANES = { photo: mountPhoto, pattern: mountPattern, garment: mountGarment };
const TOOLS = {
    wearer: mountWearer,
    stages: mountStages,
    text: mountText,
    trade: mountTrade,
    files: mountFiles,
};
const KEPT = "toile-shown";
const narrow = matchMedia("(max-width: 900px)");

let shown = { pane: "photo", tool: "wearer", narrow: "photo" };

function tab(name, isPane) {
    return h("button", {
        id: `tab-${name}`,
        role: "tab",
        word: `tab.${name}`,
        "aria-controls": name,
        class: isPane ? "of-pane" : "of-tool",
        onclick: () => show(name),
    });
}

/** Arrow keys go along the tabs, as tabs everywhere. */
function alongTabs(event) {
    const tabs = [...event.currentTarget.querySelectorAll("[role=tab]")].filter(
        (el) => el.offsetParent !== null,
    );
    const at = tabs.indexOf(document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined || at < 0) return;
    event.preventDefault();
    const next = tabs[(to + tabs.length) % tabs.length];
    next.focus();
    next.click();
}

function apply() {
    const open = narrow.matches ? shown.narrow : shown.tool;
    // Without photos the other panes have the room of theirs, on a wide screen.
    const isThere = (name) => (narrow.matches ? open === name : name !== "photo" || hasPhotos());
    for (const name of Object.keys(PANES)) document.getElementById(name).hidden = !isThere(name);
    for (const name of Object.keys(TOOLS)) document.getElementById(name).hidden = open !== name;
    document.getElementById("panes").hidden = narrow.matches && !PANES[open];
    document.getElementById("tools").hidden = narrow.matches && Boolean(PANES[open]);
    for (const el of document.querySelectorAll("#tabs [role=tab]")) {
        const chosen = el.id === `tab-${open}`;
        el.setAttribute("aria-selected", chosen);
        el.tabIndex = chosen ? 0 : -1;
    }
}

/** Shows a pane or a tool. */
export function show(name) {
    if (PANES[name]) shown.pane = name;
    else shown.tool = name;
    shown.narrow = name;
    sessionStorage.setItem(KEPT, JSON.stringify(shown));
    applyAndSee();
}

/** The tab that is open is seen in a row that is longer than the screen. */
function applyAndSee() {
    apply();
    const open = narrow.matches ? shown.narrow : shown.tool;
    document.getElementById(`tab-${open}`).scrollIntoView({ block: "nearest", inline: "nearest" });
}

export function mountWork(work) {
    const kept = JSON.parse(sessionStorage.getItem(KEPT) ?? "null");
    if (kept && PANES[kept.pane] && TOOLS[kept.tool]) shown = kept;

    const section = (name, mount, kind) => {
        const part = h("section", { id: name, class: kind, label: `tab.${name}` });
        mount(part);
        return part;
    };
    replace(
        work,
        h(
            "div",
            { id: "panes" },
            Object.entries(PANES).map(([name, mount]) => section(name, mount, "pane")),
        ),
        h(
            "div",
            { id: "tabs", role: "tablist", label: "tabs", onkeydown: alongTabs },
            Object.keys(PANES).map((name) => tab(name, true)),
            Object.keys(TOOLS).map((name) => tab(name, false)),
        ),
        h(
            "div",
            { id: "tools" },
            Object.entries(TOOLS).map(([name, mount]) => section(name, mount, "tool")),
        ),
    );
    narrow.addEventListener("change", applyAndSee);
    watch(["state", "view"], () => {
        work.hidden = !store.state?.project.file || store.beginsAnew;
        apply();
    });
    applyAndSee();
}
