// Fields for the parameters of a stage, made from its card: a slider with its figure, a choice, a switch, a text. Each
// has the default beside it and can be given back to it.

import { h } from "../dom/element.js";
import { cardText } from "../words/card_texts.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { upload } from "../server/requests.js";
import { sayError } from "../head/status.js";
import { quote, tryRead } from "../ron/ron.js";
import { inCm, inMm, lengthLike, metres } from "../ron/lengths.js";
import { carries, choicesOf, kindOf, mayBeNone, namesIn, written } from "./card_types.js";

const finite = (x) => x !== null && x !== undefined && Number.isFinite(x);

/** A slider and a field of the same value; `take(value)` when either was moved. */
export function slider({ id, label, value, min, max, step, unit, take, ...rest }) {
    const field = h("input", {
        id,
        type: "number",
        step: "any",
        value: String(value),
        "data-key": id,
        ...rest,
    });
    const parts = [field, h("span", { class: "unit" }, unit)];
    if (finite(min) && finite(max)) {
        Object.assign(field, { min, max });
        const range = h("input", {
            type: "range",
            min,
            max,
            step,
            value: String(value),
            "aria-label": label,
            "data-key": `${id}-slider`,
        });
        range.addEventListener("input", () => {
            field.value = range.value;
        });
        range.addEventListener("change", () => take(Number(range.value)));
        parts.unshift(range);
    }
    field.addEventListener(
        "change",
        () => field.value !== "" && field.checkValidity() && take(Number(field.value)),
    );
    return h("span", { class: "slider" }, parts);
}

/** A step that a slider of that range is moved by: a hundredth of it, in round figures. */
export function roundStep(min, max) {
    const share = (max - min) / 100;
    const unit = 10 ** Math.floor(Math.log10(share));
    return Number(((share / unit >= 5 ? 5 : share / unit >= 2 ? 2 : 1) * unit).toPrecision(2));
}

function lengthField(param, value, props, take) {
    const given = value ?? written(param.default);
    const cm = finite(param.max) && param.max > 0.5;
    const per = cm ? 100 : 1000;
    const at = metres(given);
    return slider({
        ...props,
        value: at === null ? "" : Number((per * at).toFixed(2)),
        unit: cm ? "cm" : "mm",
        min: finite(param.min) ? per * param.min : undefined,
        max: finite(param.max) ? per * param.max : undefined,
        step: finite(param.max) ? roundStep(per * (param.min ?? 0), per * param.max) : 1,
        take: (next) =>
            take(value ? lengthLike(next / per, value) : cm ? inCm(next / per) : inMm(next / per)),
    });
}

function numberField(param, value, props, take) {
    const given = Number(value ?? written(param.default));
    const whole = kindOf(param) === "whole";
    const { min, max } = param;
    return slider({
        ...props,
        value: Number.isNaN(given) ? "" : given,
        unit: cardText(param.unit).text,
        min,
        max,
        step: whole
            ? Math.max(1, Math.round((max - min) / 100))
            : finite(min) && finite(max)
              ? roundStep(min, max)
              : "any",
        take: (next) =>
            take(whole ? String(Math.round(next)) : Number.isInteger(next) ? `${next}.0` : String(next)),
    });
}

function choiceField(param, value, { id, label }, take) {
    const given = written(value ?? param.default);
    const name = given.replace(/\(.*$/s, "");
    const choice = h(
        "select",
        { id, "aria-label": label, "data-key": id },
        choicesOf(param).map((one) => h("option", { value: one }, one)),
    );
    choice.value = name;
    const none = (one) => (one === "None" && !mayBeNone(param) ? "r#None" : one);
    const more =
        carries(param, name) &&
        h("input", { type: "text", value: given, label: "field.inFull", "data-key": `${id}-full` });
    if (more) more.addEventListener("change", () => take(more.value));
    choice.addEventListener("change", () => take(none(choice.value)));
    return h("span", {}, choice, more);
}

function namesField(names, value, { id, label }, take) {
    const choice = h(
        "select",
        { id, "aria-label": label, "data-key": id },
        names.map((one) => h("option", { value: one }, one)),
    );
    choice.value = value;
    choice.addEventListener("change", () => take(quote(choice.value)));
    return choice;
}

function textField(param, value, { id, label }, take) {
    const given = value ?? written(param.default);
    const text = tryRead(given);
    const isText = /^text/.test(param.type) && (!text || text.kind === "text" || text.value === "None");
    const shown = isText ? (text?.kind === "text" ? text.value : "") : given;
    const field = h("input", {
        id,
        type: "text",
        value: shown,
        "aria-label": label,
        "data-key": id,
        spellcheck: "false",
    });
    field.addEventListener("input", () => {
        field.dataset.typed = "true";
    });
    field.addEventListener("change", () => {
        field.dataset.typed = "false";
        take(isText ? quote(field.value) : field.value);
    });
    return field;
}

/** A text that names a file of the project's folder, and a button that brings one there. */
function fileField(param, value, { id, label }, take) {
    const input = h("input", {
        id: `${id}-file`,
        type: "file",
        class: "unseen",
        "aria-label": t("field.fileOf", { name: label }),
    });
    input.addEventListener("change", async () => {
        if (!input.files[0]) return;
        try {
            take(quote(await upload(input.files[0])));
        } catch (error) {
            sayError(error);
        }
    });
    return h(
        "span",
        { class: "file" },
        textField(param, value, { id, label }, take),
        h("label", { class: "button", for: `${id}-file`, word: "field.file" }),
        input,
    );
}

/** A colour as "#5f7fa8"; one that is not given is shown as a middle grey. */
function colourField(param, value, { id, label }, take) {
    const given = tryRead(value ?? param.default);
    const field = h("input", {
        id,
        type: "color",
        value: given?.kind === "text" ? given.value.toLowerCase() : "#808080",
        "aria-label": label,
        "data-key": id,
    });
    field.addEventListener("change", () => take(quote(field.value)));
    return field;
}

function switchField(param, value, { id, label }, take) {
    const box = h("input", {
        id,
        type: "checkbox",
        checked: (value ?? param.default) === "true",
        "aria-label": label,
        "data-key": id,
    });
    box.addEventListener("change", () => take(String(box.checked)));
    return box;
}

/** A line of a stage's card: name, field, default, and what gives it back. */
export function parameter(stage, card, param) {
    const value = stage.params[param.name];
    const id = `${stage.id}-${param.name}`;
    const label = `${stage.name} ${param.name}`;
    const path = `${stage.path}.${param.name}`;
    const take = (next) =>
        edit(t("edit.set", { path: `${stage.name}.${param.name}`, value: next }), [
            { set: { path, value: next } },
        ]);
    const names = namesIn(param, card);
    const kind = names.length > 0 ? "names" : param.file ? "file" : param.name === "colour" ? "colour" : kindOf(param);
    const field = {
        switch: () => switchField(param, value, { id, label }, take),
        choice: () => choiceField(param, value, { id, label }, take),
        names: () => namesField(names, tryRead(value ?? param.default)?.value, { id, label }, take),
        length: () => lengthField(param, value, { id, label }, take),
        number: () => numberField(param, value, { id, label }, take),
        whole: () => numberField(param, value, { id, label }, take),
        colour: () => colourField(param, value, { id, label }, take),
        file: () => fileField(param, value, { id, label }, take),
        text: () => textField(param, value, { id, label }, take),
    }[kind]();
    const reset =
        value !== undefined &&
        h(
            "button",
            {
                class: "icon",
                label: "field.reset",
                tip: "field.reset",
                "data-key": `${id}-reset`,
                onclick: () =>
                    edit(t("edit.reset", { path: `${stage.name}.${param.name}` }), [{ remove: path }]),
            },
            "↺",
        );
    const { text: doc, lang } = cardText(param.doc);
    return h(
        "div",
        { class: `param ${value === undefined ? "" : "given"}` },
        h("label", { for: id }, param.name),
        field,
        reset,
        h(
            "p",
            { class: "hint", lang },
            doc,
            " ",
            h(
                "span",
                { class: "default" },
                t("field.default", { value: written(param.default) || "–" }),
                param.trades ? ` ${t("field.trades")}` : "",
            ),
        ),
    );
}
