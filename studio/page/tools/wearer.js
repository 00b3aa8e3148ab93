// Who wears it and what it is made of: measures of the body as sliders in centimetres, sizes, fabrics.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { edit } from "../server/edits.js";
import { stagesOf, store, watch, whenChanged } from "../server/store.js";
import { quote, tryRead } from "../ron/ron.js";
import { inCm } from "../ron/lengths.js";
import { namesIn } from "./card_types.js";
import { parameter, slider } from "./fields.js";

/** The stage of the body that has the measures. */
const body = () =>
    stagesOf("body").find((stage) => stage.name === store.measures?.stage) ?? stagesOf("body")[0];
const fabric = () => stagesOf("fabric")[0];

/** The changes that give a measure. A body that has none of its own is swapped for a mannequin of these measures. */
function measure(name, path, value) {
    const stage = body();
    if (path && stage?.name === "Mannequin") return [{ set: { path, value: inCm(value) } }];
    const all = store.measures.measures
        .filter((one) => ["height", "bust", "waist", "hip", name].includes(one.name))
        .filter((one) => one.name === name || one.value_m !== null)
        .map((one) => `${one.name}: ${inCm(one.name === name ? value : one.value_m)}`);
    return [{ swap: { stage: stage.id, with: `Mannequin(${all.join(", ")})` } }];
}

/** A size is taken as it is: the measures that are given would have the last word. */
function size(value) {
    const stage = body();
    if (stage?.name !== "Mannequin")
        return [{ swap: { stage: stage.id, with: `Mannequin(size: ${quote(value)})` } }];
    const given = store.measures.measures.filter(({ name }) => stage.params[name] !== undefined);
    return [
        { set: { path: `${stage.path}.size`, value: quote(value) } },
        ...given.map(({ name }) => ({ remove: `${stage.path}.${name}` })),
    ];
}

/** The size that the body has, as the file gives it; "" where it goes by measures. */
const chosenSize = () => tryRead(body()?.params.size)?.value ?? "";

function sizes(all, now) {
    const choice = h(
        "select",
        { id: "size", "data-key": "size" },
        h("option", { value: "" }, t("wearer.bySize")),
        all.map((value) => h("option", { value }, value)),
    );
    choice.value = all.includes(now) ? now : "";
    choice.addEventListener(
        "change",
        () => choice.value && edit(t("edit.size", { size: choice.value }), () => size(choice.value)),
    );
    return h("p", { class: "line" }, h("label", { for: "size", word: "wearer.size" }), choice);
}

function measures(list) {
    return h(
        "div",
        { class: "measures" },
        list.map(({ name, path, value_m: value, min_m: min, max_m: max, iso }) => {
            const id = `measure-${name}`;
            // A body without measures of its own becomes a mannequin, within a mannequin's limits.
            const limits = store.cards.get("Mannequin")?.params.find((param) => param.name === name);
            const label =
                t(`measure.${name}`) === `measure.${name}` ? name.replaceAll("_", " ") : t(`measure.${name}`);
            return h(
                "div",
                { class: "measure" },
                h("label", { for: id, title: iso }, label),
                slider({
                    id,
                    label,
                    // A measure that is not known yet has an empty field.
                    value: value === null ? "" : Number((100 * value).toFixed(1)),
                    min: Math.round(100 * (min ?? limits?.min)),
                    max: Math.round(100 * (max ?? limits?.max)),
                    step: 0.5,
                    unit: "cm",
                    take: (next) =>
                        edit(t("edit.measure", { name: label, value: `${next} cm` }), () =>
                            measure(name, path, next / 100),
                        ),
                }),
            );
        }),
    );
}

function cloth(stage, card) {
    const param = card?.params.find((one) => namesIn(one, card).length > 0);
    const others = card?.params.filter((one) => one !== param) ?? [];
    const names = param ? namesIn(param, card) : [];
    const now = stage.params[param?.name]?.replaceAll('"', "") ?? param?.default.replaceAll('"', "");
    return [
        param &&
            h(
                "div",
                { class: "choices fabrics", role: "group", label: "wearer.fabric" },
                names.map((name) =>
                    h(
                        "button",
                        {
                            "aria-pressed": name === now,
                            "data-key": `fabric-${name}`,
                            onclick: () =>
                                edit(t("edit.fabric", { name: fabricName(name) }), [
                                    { set: { path: `${stage.path}.${param.name}`, value: quote(name) } },
                                ]),
                        },
                        fabricName(name),
                    ),
                ),
            ),
        h(
            "div",
            { class: "params" },
            others.map((one) => parameter(stage, card, one)),
        ),
    ];
}

const fabricName = (name) => {
    const key = `fabric.${name}`;
    return t(key) === key ? name : t(key);
};

/** A body of a photo is fitted to the garment: a mannequin in its place has measures. */
function noMeasures() {
    const stage = body();
    return [
        h("p", { class: "hint", word: "wearer.noMeasures" }),
        stage?.path &&
            stage.name !== "Mannequin" &&
            store.cards.has("Mannequin") &&
            h(
                "p",
                { class: "choices" },
                h("button", {
                    id: "mannequin",
                    word: "wearer.mannequin",
                    onclick: () =>
                        edit(t("edit.swap", { from: stage.name, to: "Mannequin" }), [
                            { swap: { stage: stage.id, with: "Mannequin()" } },
                        ]),
                }),
            ),
    ];
}

/** The parameters of stages that are chosen here as well as on the stages' cards. */
const rows = (list, wanted) =>
    list
        .filter(({ path }) => path)
        .flatMap((stage) => {
            const card = store.cards.get(stage.name);
            const params = (card?.params ?? []).filter(wanted);
            return params.length === 0
                ? []
                : [h("h3", {}, stage.name), ...params.map((param) => parameter(stage, card, param))];
        });

const shownOf = (list) => list.map(({ id, name, path, params }) => ({ id, name, path, params }));

/** How the arms are held: as the garment is sewn, and as it hangs in the end. */
const pose = (list) => rows(list, ({ name }) => name === "arm_angle");

/** What the cloth looks like. */
const looks = (list) => rows(list, ({ name }) => LOOKS.includes(name));
const LOOKS = ["texture", "colour", "repeat", "unseen", "shading"];

export function mountWearer(root) {
    const bodyPart = h("div");
    const posePart = h("div", { class: "params" });
    const fabricPart = h("div");
    const looksPart = h("div", { class: "params" });
    replace(
        root,
        h("div", { class: "half" }, h("div", { class: "bar" }, h("h2", { word: "wearer.body" })), bodyPart, posePart),
        h(
            "div",
            { class: "half" },
            h("div", { class: "bar" }, h("h2", { word: "wearer.fabric" })),
            fabricPart,
            looksPart,
        ),
    );
    const drawPose = whenChanged((list) => replace(posePart, pose(list)));
    const drawLooks = whenChanged((list) => replace(looksPart, looks(list)));
    const drawBody = whenChanged((found, size) =>
        replace(
            bodyPart,
            found && found.measures.length > 0
                ? [
                      found.sizes.length > 0 && sizes(found.sizes, size),
                      found.measures.every(({ path }) => !path) &&
                          h("p", { class: "hint", word: "wearer.fitted" }),
                      measures(found.measures),
                  ]
                : noMeasures(),
        ),
    );
    const drawFabric = whenChanged((stage, known) =>
        replace(
            fabricPart,
            stage && known
                ? cloth(stage, store.cards.get(stage.name))
                : h("p", { class: "hint", word: "wearer.noFabric" }),
        ),
    );
    watch(["measures", "state", "cards", "pending"], () => {
        if (!store.state || store.pending > 0) return;
        drawBody(store.measures, chosenSize(), store.cards.size > 0);
        drawPose(shownOf(stagesOf("body")), store.cards.size > 0);
        drawLooks(shownOf(stagesOf("texturer")), store.cards.size > 0);
        const stage = fabric();
        drawFabric(
            stage && { id: stage.id, name: stage.name, path: stage.path, params: stage.params },
            store.cards.size > 0,
        );
    });
}
