// The garment in space: turned, zoomed, cut by a plane; its looks and what is laid over it. What is pointed at lights
// in the pattern and in the photo.

import { h, oncePerFrame, replace } from "../dom/element.js";
import { oldNotice } from "../head/old.js";
import { mm, t } from "../words/words.js";
import { store, tell, watch, whenChanged } from "../server/store.js";
import { choose, hover, selection } from "../server/selection.js";
import { loadBefore } from "../server/live.js";
import { spotOf } from "../server/mesh_file.js";
import { litEdges } from "./edge_line.js";
import { extent } from "./extent.js";
import { mountLegend } from "./legend.js";
import { mountPlaces, placing, placingButton } from "./placing.js";
import { mountSection } from "./section.js";

const LOOKS = ["texture", "panels", "strain", "pressure", "distance"];
const VIEWS = { front: 0, side: Math.PI / 2, back: Math.PI };

export function mountGarment(root) {
    const canvas = h("canvas", {
        tabindex: 0,
        role: "application",
        "aria-roledescription": t("garment.role"),
    });
    const none = h("p", { class: "nothing", word: "garment.none" });
    const looks = h("select", { id: "looks", label: "garment.looks" });
    const toggle = (id, word, checked) =>
        h("input", { type: "checkbox", id, checked, onchange: () => tell("layers") });
    const layers = {
        body: toggle("show-body", "", true),
        faults: toggle("show-faults", "", true),
        before: toggle("show-before", "", false),
    };
    const views = Object.keys(VIEWS).map((name) =>
        h("button", { word: `garment.${name}`, "data-view": name }),
    );
    const fit = h("button", { class: "icon", label: "zoom.fit", tip: "zoom.fit" }, "⤢");
    const [closer, farther] = ["in", "out"].map((way) =>
        h("button", { class: "icon", label: `zoom.${way}`, tip: `zoom.${way}` }, way === "in" ? "+" : "−"),
    );
    const legend = h("div", { class: "legend" });
    const below = h("div", { class: "facts" });
    replace(
        root,
        h(
            "div",
            { class: "bar", role: "toolbar", label: "garment.tools" },
            h("h2", { word: "tab.garment" }),
            looks,
            placingButton(),
            Object.entries(layers).map(([name, box]) =>
                h("label", { class: "line" }, box, h("span", { word: `garment.${name}` })),
            ),
            h("span", { class: "push" }, views, closer, farther, fit),
        ),
        oldNotice("garment"),
        h("div", { class: "stage" }, canvas, legend, none),
        below,
    );

    // Loaded beside the rest, so that the page stands before it is there; without WebGL the rest goes on.
    start().catch((error) => {
        none.hidden = false;
        none.dataset.word = "garment.noWebGl";
        none.textContent = t("garment.noWebGl");
        none.title = error.message;
        canvas.hidden = true;
    });

    async function start() {
        const [{ makeScene }, { makeCloth }, { makeMarks }, { orbit }, { picker }] = await Promise.all([
            import("./scene.js"),
            import("./cloth.js"),
            import("./marks.js"),
            import("./orbit.js"),
            import("./picking.js"),
        ]);
        const scene = makeScene(canvas);
        const cloth = makeCloth(scene.world, scene.draw);
        const marks = makeMarks(scene.world, scene.draw);
        const camera = orbit(canvas, scene.camera, scene.draw);
        const pick = picker(canvas, scene.camera, cloth.object);
        const figures = mountLegend(legend);
        const section = mountSection(below, scene);
        let fitted = false;
        let placed = false;

        const choices = whenChanged((names) => {
            const kept = sessionStorage.getItem("toile-looks");
            replace(
                looks,
                names.map((name) => h("option", { value: name, word: `looks.${name}` })),
            );
            looks.value = names.includes(kept) ? kept : names[0];
        });
        const shownAs = () => figures.scale(looks.value, cloth.show(looks.value));

        const frame = () => {
            const whole = store.garment ?? store.body;
            if (!whole) return;
            const box = extent(whole.positions);
            camera.fit(box);
            section.range(box);
            fitted = true;
        };
        watch(["garment"], () => {
            const mesh = store.garment;
            none.hidden = Boolean(mesh ?? store.body);
            if (mesh)
                choices(
                    LOOKS.filter(
                        (name) => name === "panels" || (name === "texture" ? mesh?.uv : mesh?.[name]),
                    ),
                );
            figures.scale(looks.value, cloth.take(mesh, store.view?.view));
            if (looks.value) shownAs();
            if ((!fitted || placed !== store.placing) && mesh) frame();
            placed = store.placing;
            if (layers.before.checked) loadBefore();
            canvas.setAttribute(
                "aria-label",
                mesh
                    ? t("garment.label", { panels: mesh.panels.length, triangles: mesh.triangles.length / 3 })
                    : t("garment.none"),
            );
            tell("layers");
        });
        watch(["moving"], () => store.garment && cloth.moveTo(store.garment.positions));
        watch(["body"], () => {
            none.hidden = Boolean(store.garment ?? store.body);
            if (!store.garment && store.body) frame();
            fitted = Boolean(store.garment) && fitted;
        });
        watch(["body", "layers"], () => marks.body(store.body, layers.body.checked));
        watch(["garment", "moving", "layers"], () => marks.faults(store.garment, layers.faults.checked));
        watch(["before", "layers"], () => marks.before(store.before, layers.before.checked));
        layers.before.addEventListener("change", loadBefore);
        looks.addEventListener("change", () => {
            sessionStorage.setItem("toile-looks", looks.value);
            shownAs();
        });
        for (const button of views)
            button.addEventListener("click", () => camera.from(VIEWS[button.dataset.view]));
        fit.addEventListener("click", frame);
        closer.addEventListener("click", () => camera.zoom(1.25));
        farther.addEventListener("click", () => camera.zoom(0.8));

        watch(
            ["hover", "chosen", "garment", "moving"],
            oncePerFrame(() => {
                const at = selection.hover.spot ?? selection.chosen.spot;
                const name = selection.hover.piece ?? selection.chosen.piece;
                const place =
                    at && store.garment && at.triangle < store.garment.triangles.length / 3
                        ? at.position
                        : null;
                const edges = litEdges();
                marks.light(store.garment, edges.length > 0 ? null : name, edges, place);
                figures.at(looks.value, at);
            }),
        );

        /** What lies below a place of the screen. */
        const found = (x, y) => {
            const hit = pick(x, y);
            const panel =
                hit &&
                store.garment?.panels.find(
                    (p) => hit.triangle >= p.first_triangle && hit.triangle < p.first_triangle + p.triangles,
                );
            return panel ? { piece: panel.name, spot: spotOf(store.garment, hit.triangle, hit.shares) } : {};
        };
        const drag = placing(canvas, scene.camera, cloth, found);
        let pointer = null;
        const point = oncePerFrame(
            () => pointer && !camera.turning() && !drag.isHeld() && hover(found(...pointer)),
        );
        canvas.addEventListener("pointermove", (event) => {
            pointer = [event.clientX, event.clientY];
            point();
        });
        canvas.addEventListener("pointerleave", () => {
            pointer = null;
            hover();
        });
        canvas.addEventListener("click", (event) => choose(found(event.clientX, event.clientY)));
        canvas.addEventListener("keydown", (event) => {
            if (event.key !== "Enter") return;
            const box = canvas.getBoundingClientRect();
            choose(found(box.x + box.width / 2, box.y + box.height / 2));
        });
    }
    mountPlaces(below);
    mountGirths(below);
}

/** Girths of cloth and body, and what the garment misses. */
function mountGirths(root) {
    const part = h("details", { class: "girths" });
    root.append(part);
    const draw = whenChanged((girths, missed) => {
        part.hidden = girths.length === 0 && missed.length === 0;
        replace(
            part,
            h("summary", { word: "girths" }),
            h(
                "table",
                {},
                h(
                    "thead",
                    {},
                    h(
                        "tr",
                        {},
                        ["level", "cloth", "body", "ease"].map((name) =>
                            h("th", { scope: "col", word: `girths.${name}` }),
                        ),
                    ),
                ),
                h(
                    "tbody",
                    {},
                    girths.map(({ level, cloth_m: cloth, body_m: body }) =>
                        h(
                            "tr",
                            {},
                            h("th", { scope: "row" }, level),
                            h("td", {}, mm(cloth)),
                            h("td", {}, mm(body)),
                            h("td", {}, mm(cloth - body)),
                        ),
                    ),
                ),
            ),
            missed.length > 0 &&
                h(
                    "ul",
                    {},
                    missed.map((one) => h("li", {}, one.message ?? String(one))),
                ),
        );
    });
    watch(["view"], () => draw(store.view?.girths ?? [], store.view?.qualities_missed ?? []));
}
