// What is said of a photo: how wide the garment is, or what lies beside it, and what kind of garment it is.

import { h, replace } from "../dom/element.js";
import { t, term } from "../words/words.js";
import { edit } from "../server/edits.js";
import { upload } from "../server/requests.js";
import { sayError } from "../head/status.js";
import { quote } from "../ron/ron.js";
import { stagesOf, store, watch, whenChanged } from "../server/store.js";
import { inCm, metres } from "../ron/lengths.js";
import { choicesOf } from "../tools/card_types.js";
import { entryOf, named, photo } from "./shown.js";

const OBJECTS = ["BankCard", "A4", "Letter", "Ruler"];

/** The photo is given its scale by one of the two; the other one goes. */
function scaleBy(name, field, value) {
    const other = field === "width" ? "scale" : "width";
    const path = `photos.${name}`;
    const set = { set: { path: `${path}.${field}`, value } };
    return entryOf(name)?.[other] ? [set, { remove: `${path}.${other}` }] : [set];
}

function scale(name, width, object) {
    const field = h("input", {
        id: "photo-width",
        type: "number",
        min: "5",
        max: "300",
        step: "0.5",
        "data-key": "width",
        value: width === null ? "" : String(Number((100 * width).toFixed(1))),
    });
    field.addEventListener(
        "change",
        () =>
            field.checkValidity() &&
            field.value &&
            edit(t("edit.width", { width: `${field.value} cm` }), () =>
                scaleBy(name, "width", inCm(Number(field.value) / 100)),
            ),
    );
    const choice = h(
        "select",
        {
            label: "photo.scale",
            "data-key": "scale",
            onchange: () =>
                choice.value &&
                edit(t("edit.scale", { object: term("scale", choice.value) }), () =>
                    scaleBy(name, "scale", choice.value),
                ),
        },
        h("option", { value: "", word: "photo.byWidth" }),
        OBJECTS.map((value) => h("option", { value, word: `scale.${value}` })),
    );
    choice.value = OBJECTS.includes(object) ? object : "";
    return h(
        "p",
        { class: "line" },
        h("label", { for: "photo-width", word: "photo.width" }),
        field,
        " cm",
        choice,
        another(name),
    );
}

/** A button that takes another picture in the photo's place. */
function another(name) {
    const input = h("input", {
        id: "photo-file",
        type: "file",
        class: "unseen",
        accept: ".jpg,.jpeg,.png,.webp,.tif,.tiff",
        "aria-label": t("field.fileOf", { name }),
    });
    input.addEventListener("change", async () => {
        if (!input.files[0]) return;
        try {
            const file = await upload(input.files[0]);
            edit(t("edit.photo", { name, file }), [
                { set: { path: `photos.${name}.file`, value: quote(file) } },
            ]);
        } catch (error) {
            sayError(error);
        }
    });
    return [h("label", { class: "button", for: "photo-file", word: "photo.file" }), input];
}

/** What the garment is: the guesses of the network as buttons, and all kinds there are. */
function kinds(kindStages, chosen, choices, guesses) {
    const take = (kind) =>
        edit(
            t("edit.kind", { kind: term("kind", kind) }),
            kindStages.map(({ path }) => ({ set: { path: `${path}.style`, value: kind } })),
        );
    const seen = guesses.filter(({ kind }) => choices.includes(kind));
    const likeliest =
        seen.length > 0 &&
        h(
            "p",
            { class: "choices", role: "group", label: "photo.guesses" },
            h("span", { class: "hint", word: "photo.guesses" }),
            seen.map(({ kind, share }) =>
                h(
                    "button",
                    {
                        "aria-pressed": kind === chosen,
                        "data-key": `guess-${kind}`,
                        onclick: () => take(kind),
                    },
                    t("photo.guess", { kind: term("kind", kind), share: Math.round(100 * share) }),
                ),
            ),
        );
    const all = h(
        "details",
        { class: "kinds" },
        h("summary", {}, t("photo.kind", { kind: term("kind", chosen) })),
        h(
            "p",
            { class: "choices" },
            choices.map((kind) =>
                h(
                    "button",
                    {
                        "aria-pressed": kind === chosen,
                        "data-key": `kind-${kind}`,
                        onclick: () => take(kind),
                    },
                    term("kind", kind),
                ),
            ),
        ),
    );
    return [likeliest, all];
}

export function mountFacts(root) {
    const draw = whenChanged((name, entry, kindStages, chosen, choices, guesses) => {
        const open = root.querySelector("details")?.open;
        replace(
            root,
            entry?.file
                ? scale(name, metres(entry.width), entry.scale)
                : h("p", { class: "hint" }, t("photo.noFile", { name })),
            kindStages.length > 0 && kinds(kindStages, chosen, choices, guesses),
        );
        const details = root.querySelector("details");
        if (details) details.open = open ?? false;
    });
    watch(["state", "cards", "view", "photo"], () => {
        const name = photo()?.name ?? named()[0];
        if (!name) return;
        // The wearer is measured by the kind as well.
        const kindStages = [...stagesOf("style"), ...stagesOf("body")]
            .filter((stage) => paramOf(stage, "style"))
            .map(({ name, path, params }) => ({ name, path, style: params.style }));
        const param = kindStages[0] && paramOf(kindStages[0], "style");
        draw(
            name,
            entryOf(name),
            kindStages,
            kindStages[0]?.style ?? param?.default ?? "Auto",
            param ? choicesOf(param) : [],
            name === "front" ? (store.view?.guesses ?? []) : [],
        );
    });
}

const paramOf = (stage, name) => store.cards.get(stage.name)?.params.find((param) => param.name === name);
