// The begin of a project: drop or choose a photo or a pattern file, or take a sample. A photo is asked for its width.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { postJson, upload } from "../server/requests.js";
import { store, watch } from "../server/store.js";
import { sayError, sayWord } from "../head/status.js";

const PHOTO = /\.(jpe?g|png|webp|tiff?)$/i;
const PATTERN = /\.(json|dxf|svg|val|vit|sm2d)$/i;
const SAMPLES = ["vest", "tshirt", "skirt", "trousers", "shirt_pattern"];

let file = null;

async function begin(what) {
    sayWord("begin.busy");
    try {
        await postJson("/api/begin", what);
        sayWord("begin.done");
    } catch (error) {
        sayError(error);
    }
}

async function take(chosen, root) {
    if (!chosen) return;
    if (PATTERN.test(chosen.name)) {
        try {
            await begin({ pattern: await upload(chosen) });
        } catch (error) {
            sayError(error);
        }
    } else if (PHOTO.test(chosen.name)) {
        file = chosen;
        askWidth(root);
    } else {
        sayWord("begin.unknown", { name: chosen.name }, "error");
    }
}

/** Asks for what gives the photo its scale. */
function askWidth(root) {
    const picture = h("img", {
        src: URL.createObjectURL(file),
        alt: t("begin.yourPhoto", { name: file.name }),
    });
    picture.addEventListener("load", () => URL.revokeObjectURL(picture.src), { once: true });
    const width = h("input", {
        id: "begin-width",
        type: "number",
        min: "5",
        max: "300",
        step: "0.5",
        inputmode: "decimal",
        "aria-describedby": "begin-how",
        required: true,
    });
    const byWidth = h("input", { type: "radio", name: "scale", checked: true, value: "width" });
    const byCard = h("input", { type: "radio", name: "scale", value: "card" });
    const choose = () => {
        width.disabled = width.required = byWidth.checked;
        width.disabled = !byWidth.checked;
    };
    byWidth.addEventListener("change", choose);
    byCard.addEventListener("change", choose);
    const form = h(
        "form",
        { class: "ask" },
        h("h2", { word: "begin.howWide" }),
        h("label", { class: "line" }, byWidth, h("span", { word: "begin.byWidth" })),
        h("p", { id: "begin-how", class: "hint", word: "begin.widthHow" }),
        h("p", { class: "line" }, h("label", { for: "begin-width", word: "begin.width" }), width, " cm"),
        h("label", { class: "line" }, byCard, h("span", { word: "begin.byCard" })),
        h("p", { class: "hint", word: "begin.cardHow" }),
        h(
            "p",
            { class: "line" },
            h("button", { class: "primary", word: "begin.make" }),
            h("button", { type: "button", word: "begin.back", onclick: () => offer(root) }),
        ),
    );
    form.addEventListener("submit", async (event) => {
        event.preventDefault();
        try {
            const photo = await upload(file);
            const measured = byWidth.checked ? `${Number(width.value)} cm` : null;
            await begin({ photo, width: measured });
        } catch (error) {
            sayError(error);
        }
    });
    replace(root, h("div", { class: "card two" }, picture, form));
    width.focus();
}

/** The first view: a place to drop, a button to choose, the samples. */
function offer(root) {
    const input = h("input", {
        id: "begin-file",
        type: "file",
        class: "unseen",
        onchange: () => take(input.files[0], root),
        accept: ".jpg,.jpeg,.png,.webp,.tif,.tiff,.json,.dxf,.svg,.val,.vit,.sm2d",
    });
    const drop = h(
        "div",
        { id: "drop", class: "card" },
        h("h2", { word: "begin.drop" }),
        h("p", { class: "hint", word: "begin.dropHow" }),
        h("p", {}, h("label", { class: "button primary", for: "begin-file", word: "begin.choose" }), input),
    );
    replace(
        root,
        drop,
        h(
            "div",
            { class: "card" },
            h("h2", { word: "begin.sample" }),
            h("p", { class: "hint", word: "begin.sampleHow" }),
            h(
                "p",
                { class: "choices" },
                SAMPLES.map((sample) =>
                    h("button", { word: `sample.${sample}`, onclick: () => begin({ sample }) }),
                ),
            ),
        ),
    );
}

export function mountBegin(root) {
    offer(root);
    const over = (on) => (event) => {
        if (root.hidden) return;
        event.preventDefault();
        root.classList.toggle("over", on);
    };
    document.addEventListener("dragover", over(true));
    document.addEventListener("dragleave", over(false));
    document.addEventListener("drop", (event) => {
        if (root.hidden) return;
        over(false)(event);
        take(event.dataTransfer.files[0], root);
    });
    watch(["state"], () => {
        if (!store.state) return;
        const hidden = Boolean(store.state.project.file);
        if (hidden !== root.hidden && !hidden) offer(root);
        root.hidden = hidden;
    });
}
