// The photo: what was taken for the garment, where its outline lies, the landmarks that it is cut by.

import { h, replace, svg } from "../dom/element.js";
import { zoomable } from "../dom/zoom.js";
import { store, watch, whenChanged } from "../server/store.js";
import { choose, hover, isLit, selection } from "../server/selection.js";
import { spotOf, triangleAt } from "../server/mesh_file.js";
import { edgeLine, litEdges } from "../garment/edge_line.js";
import { landmarks } from "./landmarks.js";
import { strokes } from "./strokes.js";
import { mountFacts } from "./facts.js";
import { t } from "../words/words.js";
import { entryOf, named, photo, photoOf, photos, showPhoto } from "./shown.js";

/** The place of the garment at a point of the photo. */
function spotAt(at) {
    const garment = store.garment;
    for (const panel of garment?.panels ?? []) {
        if (panel.photo !== photo()?.name) continue;
        const found = triangleAt(garment, panel, "photo_px", at);
        if (found) return { piece: panel.name, spot: spotOf(garment, found.triangle, found.shares) };
    }
    return {};
}

/** The address of a picture, another one when what it shows has changed. */
function addressOf(kind, name, shows = "") {
    const mark = [...shows].reduce((sum, char) => (31 * sum + char.charCodeAt(0)) >>> 0, 7);
    return `/api/${kind}/${encodeURIComponent(name)}?v=${mark.toString(36)}`;
}

function choosers(bar, mask) {
    const fill = whenChanged((names, now) =>
        replace(
            bar,
            names.length > 1 &&
                names.map((name) =>
                    h(
                        "button",
                        { "aria-pressed": name === now, "data-key": name, onclick: () => showPhoto(name) },
                        name,
                    ),
                ),
            mask,
        ),
    );
    return () =>
        fill(
            photos().map((p) => p.name),
            photo()?.name,
        );
}

export function mountPhoto(root) {
    const picture = svg("image", { x: 0, y: 0, preserveAspectRatio: "none" });
    const inside = svg("image", { x: 0, y: 0, preserveAspectRatio: "none" });
    const tint = svg("rect", { class: "tint", x: 0, y: 0, mask: "url(#inside)" });
    const outlines = svg("g", { class: "outlines" });
    const marks = svg("g", { class: "landmarks" });
    const painted = svg("g", { class: "strokes" });
    const lines = svg("g", { class: "edges" });
    const spot = svg("circle", { class: "spot" });
    const drawing = svg(
        "svg",
        { class: "drawing", role: "group", label: "photo.drawing", preserveAspectRatio: "xMidYMid meet" },
        svg("defs", {}, svg("mask", { id: "inside", class: "by-alpha" }, inside)),
        picture,
        tint,
        outlines,
        lines,
        painted,
        marks,
        spot,
    );
    const zoom = zoomable(drawing, { onchange: () => sizes() });

    const maskButton = h("button", {
        word: "photo.mask",
        tip: "photo.mask.tip",
        "aria-pressed": "true",
        onclick: () => {
            const on = maskButton.getAttribute("aria-pressed") !== "true";
            maskButton.setAttribute("aria-pressed", on);
            tint.classList.toggle("off", !on);
        },
    });
    const bar = h("div", { class: "bar", role: "toolbar", label: "photo.tools" });
    const facts = h("div", { class: "facts" });
    const none = h("p", { class: "nothing" });
    const which = h("span", { class: "bar-part" });
    const chooser = choosers(which, maskButton);
    const paint = strokes({ drawing, painted, place: zoom.place, scale: zoom.scale });
    replace(
        bar,
        h("h2", { word: "tab.photo" }),
        which,
        paint.buttons,
        h("span", { class: "push" }, zoom.buttons),
    );
    replace(root, bar, h("div", { class: "stage" }, drawing, none), facts);
    mountFacts(facts);

    // Marks keep their size on the screen however near the photo is looked at.
    function sizes() {
        const scale = zoom.scale();
        drawing.style.setProperty("--px", `${scale}px`);
        spot.setAttribute("r", 6 * scale);
        for (const el of marks.querySelectorAll("circle")) el.setAttribute("r", 7 * scale);
    }

    const drawPhoto = whenChanged((name, width, height, file) => {
        for (const el of [picture, inside, tint]) {
            el.setAttribute("width", width);
            el.setAttribute("height", height);
        }
        picture.setAttribute("href", addressOf("photo", name, file));
        zoom.fit([0, 0, width, height]);
    });
    // A mask is there when its outline is, and another one with another outline.
    const drawMask = whenChanged((name, mine) => {
        if (mine.length > 0) inside.setAttribute("href", addressOf("mask", name, JSON.stringify(mine)));
        else inside.removeAttribute("href");
    });

    const drawOutlines = whenChanged((mine) =>
        replace(
            outlines,
            mine.map(({ panel, points }) =>
                svg(
                    "polygon",
                    {
                        "data-panel": panel,
                        points: points.map((p) => p.map((x) => x.toFixed(1)).join(",")).join(" "),
                    },
                    svg("title", {}, panel),
                ),
            ),
        ),
    );

    const redraw = () => {
        const now = photo();
        drawing.classList.toggle("gone", !now);
        none.hidden = Boolean(now);
        none.textContent = t(named().length > 0 ? "photo.unread" : "photo.none");
        facts.hidden = !now && named().length === 0;
        chooser();
        if (!now) return;
        const mine = store.view.outlines.filter(({ panel }) => photoOf(panel) === now.name);
        drawPhoto(now.name, now.width, now.height, entryOf(now.name)?.file);
        drawMask(now.name, mine);
        drawOutlines(mine);
        landmarks({ root: marks, photo: now, zoom, sizes });
        sizes();
        light();
    };
    watch(["view", "cards", "state", "photo", "pending"], redraw);

    function light() {
        // Edges are seen beside an outline that is not lit.
        const byEdge = litEdges().length > 0;
        for (const el of outlines.children) el.classList.toggle("lit", !byEdge && isLit("piece", el.dataset.panel));
        replace(
            lines,
            litEdges()
                .filter(({ piece }) => photoOf(piece) === photo()?.name)
                .map(({ piece, edge }) =>
                    svg("polyline", {
                        points: edgeLine(piece, edge, "photo_px", 2)
                            .map((p) => p.join(","))
                            .join(" "),
                    }),
                ),
        );
        const at = [selection.hover, selection.chosen].find((what) => what.spot?.photo);
        const here = at && photoOf(at.piece) === photo()?.name;
        spot.classList.toggle("gone", !here);
        if (!here) return;
        spot.setAttribute("cx", at.spot.photo[0]);
        spot.setAttribute("cy", at.spot.photo[1]);
    }
    watch(["hover", "chosen"], light);
    watch(["chosen"], () => {
        const where = selection.chosen.piece && photoOf(selection.chosen.piece);
        if (where && where !== photo()?.name) showPhoto(where);
    });

    drawing.addEventListener(
        "pointermove",
        (event) => event.buttons === 0 && !paint.isOn() && hover(spotAt(zoom.place(event))),
    );
    drawing.addEventListener("pointerleave", () => hover());
    drawing.addEventListener("click", (event) => {
        if (!paint.isOn() && !event.target.closest(".landmark")) choose(spotAt(zoom.place(event)));
    });
}
