// The begin of a project: drop or choose a photo or a pattern file, or take a sample. A photo is asked for its width, a
// pattern that is drafted to measure for its measurements. A project that is there can begin anew.

import { h, replace } from "../dom/element.js";
import { t } from "../words/words.js";
import { postJson, upload } from "../server/requests.js";
import { store, tell, watch } from "../server/store.js";
import { sayError, sayWord } from "../head/status.js";
import { hasCamera, shoot } from "./camera.js";

const PHOTO = /\.(jpe?g|png|webp|tiff?)$/i;
const PATTERN = /\.(json|dxf|svg|val|sm2d)$/i;
const TO_MEASURE = /\.(val|sm2d)$/i;
const MEASUREMENTS = /\.(smis|smms|vit|vst)$/i;
const SAMPLES = ["vest", "tshirt", "skirt", "trousers", "shirt_pattern"];

let file = null;

async function begin(what) {
    sayWord("begin.busy");
    try {
        await postJson("/api/begin", store.beginsAnew ? { ...what, anew: true } : what);
        beginAnew(false);
        if (store.state.faults.length === 0) sayWord("begin.done");
    } catch (error) {
        sayError(error);
    }
}

/** Shows the begin over a project that is there, or goes back to it. */
export function beginAnew(on = true) {
    if (store.beginsAnew === on) return;
    store.beginsAnew = on;
    tell("state");
}

async function beginWithPattern(pattern, measurements) {
    try {
        const name = await upload(pattern);
        const given = measurements ? { measurements: await upload(measurements) } : {};
        await begin({ pattern: name, ...given });
    } catch (error) {
        sayError(error);
    }
}

function take(files, root) {
    const all = [...files];
    const of = (kind) => all.find(({ name }) => kind.test(name));
    const [pattern, measurements, photo] = [of(PATTERN), of(MEASUREMENTS), of(PHOTO)];
    if (pattern && (measurements || !TO_MEASURE.test(pattern.name))) {
        beginWithPattern(pattern, TO_MEASURE.test(pattern.name) ? measurements : null);
    } else if (pattern) {
        askMeasurements(pattern, root);
    } else if (photo) {
        file = photo;
        askWidth(root);
    } else if (all.length > 0) {
        sayWord("begin.unknown", { name: all[0].name }, "error");
    }
}

/** A field for files, as a button. */
function chooser(id, word, props, take) {
    const input = h("input", { id, type: "file", class: "unseen", ...props });
    input.addEventListener("change", () => take(input.files));
    return h("p", {}, h("label", { class: "button primary", for: id, word }), input);
}

/** Asks for the measurements of a pattern that is drafted to measure. */
function askMeasurements(pattern, root) {
    const choose = chooser(
        "begin-measurements",
        "begin.choose",
        { accept: ".smis,.smms,.vit,.vst" },
        (files) => beginWithPattern(pattern, files[0]),
    );
    replace(
        root,
        h(
            "div",
            { class: "card" },
            h("h2", { word: "begin.measurements" }),
            h("p", { class: "hint" }, t("begin.measurementsHow", { name: pattern.name })),
            choose,
            h(
                "p",
                { class: "line" },
                h("button", {
                    word: "begin.withoutMeasurements",
                    onclick: () => beginWithPattern(pattern, null),
                }),
                h("button", { word: "begin.back", onclick: () => offer(root) }),
            ),
        ),
    );
    choose.querySelector("input").focus();
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
    const accept = ".jpg,.jpeg,.png,.webp,.tif,.tiff,.json,.dxf,.svg,.val,.sm2d,.smis,.smms,.vit,.vst";
    const drop = h(
        "div",
        { id: "drop", class: "card" },
        h("h2", { word: "begin.drop" }),
        h("p", { class: "hint", word: "begin.dropHow" }),
        chooser("begin-file", "begin.choose", { accept, multiple: true }, (files) => take(files, root)),
        hasCamera() &&
            h(
                "p",
                {},
                h("button", {
                    word: "begin.camera",
                    onclick: () =>
                        shoot(
                            root,
                            (photo) => take([photo], root),
                            () => offer(root),
                        ),
                }),
            ),
        store.beginsAnew &&
            h("p", {}, h("button", { word: "begin.stay", onclick: () => beginAnew(false) })),
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
        take(event.dataTransfer.files, root);
    });
    watch(["state"], () => {
        if (!store.state) return;
        const hidden = Boolean(store.state.project.file) && !store.beginsAnew;
        if (hidden !== root.hidden && !hidden) offer(root);
        root.hidden = hidden;
    });
}
