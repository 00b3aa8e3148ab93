// The head: the project's name and state, undo and redo, save, quality and run, progress, language, light or dark.

import { h, replace } from "../dom/element.js";
import { t, words } from "../words/words.js";
import { redo, run, save, stop, undo } from "../server/edits.js";
import { store, watch, whenChanged } from "../server/store.js";
import { beginAnew } from "../begin/begin.js";
import { isDark, switchTheme } from "./theme.js";

const isRunning = () => store.state?.run.state === "running";

/** The share of the run that is done, and words for what is being done. */
function progress() {
    const stages = store.state.stages;
    const done = stages.filter((stage) => ["done", "skipped", "failed"].includes(stage.state)).length;
    const running = stages.find((stage) => stage.state === "running");
    const told = store.progress?.stage === running?.id ? store.progress : null;
    const share = told?.share ?? running?.share ?? 0;
    return {
        share: (done + share) / Math.max(1, stages.length),
        words: [running?.name, told?.words].filter(Boolean).join(": "),
    };
}

function tools() {
    const undoButton = h("button", { id: "undo", word: "undo", tip: "undo.tip", onclick: undo });
    const redoButton = h("button", { id: "redo", word: "redo", tip: "redo.tip", onclick: redo });
    const saveButton = h("button", { id: "save", word: "save", tip: "save.tip", onclick: save });
    const anewButton = h("button", { id: "anew", word: "anew", tip: "anew.tip", onclick: () => beginAnew() });
    watch(["state"], () => {
        const project = store.state?.project;
        undoButton.disabled = !project?.can_undo;
        redoButton.disabled = !project?.can_redo;
        saveButton.disabled = !project || project.saved;
        undoButton.title = project?.can_undo ? t("undo.what", { words: project.can_undo }) : t("undo.tip");
        redoButton.title = project?.can_redo ? t("redo.what", { words: project.can_redo }) : t("redo.tip");
    });
    return h(
        "div",
        { class: "group", role: "group", label: "head.edit" },
        undoButton,
        redoButton,
        saveButton,
        anewButton,
    );
}

function runner() {
    const quality = h("select", { id: "quality", label: "quality" });
    const button = h("button", {
        id: "run",
        class: "primary",
        onclick: () => (isRunning() ? stop() : run(quality.value || null)),
    });
    const bar = h("progress", { max: "1", label: "progress" });
    const what = h("span", { class: "what" });

    const fill = whenChanged((names) => {
        const kept = quality.value;
        replace(
            quality,
            h("option", { value: "" }, t("quality.asFile")),
            names.map((name) => h("option", { value: name }, name)),
        );
        quality.value = names.includes(kept) ? kept : "";
    });
    watch(["trade"], () => fill((store.trade?.qualities ?? []).map((point) => point.name)));
    watch(["state", "progress"], () => {
        const running = isRunning();
        button.textContent = t(running ? "stop" : "run");
        button.disabled = !store.state?.project.file || (!running && store.state.faults.length > 0);
        bar.hidden = what.hidden = !running;
        if (!running) return;
        const { share, words: now } = progress();
        bar.value = share;
        what.textContent = now;
    });
    return h("div", { class: "group", role: "group", label: "head.run" }, quality, button, bar, what);
}

function looks() {
    const language = h(
        "select",
        { id: "language", label: "language", onchange: () => words.choose(language.value) },
        Object.entries(words.languages).map(([tag, name]) => h("option", { value: tag, lang: tag }, name)),
    );
    const theme = h("button", { id: "theme", class: "icon", onclick: switchTheme });
    const show = () => {
        language.value = words.language;
        theme.textContent = isDark() ? "☀" : "☾";
        theme.title = t(isDark() ? "theme.light" : "theme.dark");
        theme.setAttribute("aria-label", theme.title);
    };
    words.watch(show);
    watch(["theme"], show);
    return h("div", { class: "group looks", role: "group", label: "head.looks" }, language, theme);
}

export function mountHead(head) {
    const name = h("h1", {}, "Toile");
    const state = h("span", { class: "saved" });
    const atWork = [tools(), runner()];
    replace(head, h("div", { class: "title" }, name, state), atWork, looks());

    watch(["state"], () => {
        const project = store.state?.project;
        const folder = project?.folder.split(/[\\/]/).filter(Boolean).at(-1);
        name.textContent = project?.file ? `${folder} / ${project.file}` : "Toile";
        name.title = project?.folder ?? "";
        document.title = project?.file ? `${project.saved ? "" : "• "}${folder} – Toile` : "Toile studio";
        state.textContent = project?.file ? t(project.saved ? "saved" : "unsaved") : "";
        state.dataset.saved = project?.saved ?? true;
        for (const group of atWork) group.hidden = !project?.file || store.beginsAnew;
    });
}
