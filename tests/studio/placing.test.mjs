// Pieces placed around the body before they are sewn, and pieces that are taken out.

import assert from "node:assert/strict";
import { test } from "node:test";
import { ask, change, drag, quiet, serve, settled, stateOf, until } from "./studio.mjs";

const vest = await serve("vest.ron");
const page = await vest.open();
const garment = page.getByRole("region", { name: "Garment" });
const canvas = garment.getByRole("application");
const place = garment.getByRole("button", { name: "Place pieces" });

const handPlaces = (text) => /hand_places: (\[.*?\)\])/.exec(text)?.[1] ?? null;
const depth = () => garment.getByLabel(/^Forwards/).inputValue().then(Number);

test("pieces are shown as they start", async () => {
    await place.click();
    await page.waitForFunction(() => document.querySelector("#garment .facts.placing"));
    assert.equal(await place.getAttribute("aria-pressed"), "true");
    assert.match(await canvas.getAttribute("aria-label"), /2 panels/);
    await garment.getByText("Drag a piece to where it starts").waitFor();
});

test("a piece is dragged, and the file says where it starts", async () => {
    const box = await canvas.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const after = await change(page, async () => {
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x + 30, y, { steps: 4 });
        await page.mouse.up();
    });
    const found = /\[\(piece: "front", middle: \("(.*?) mm", "(.*?) mm", "(.*?) mm"\), turn: \(0, 0, 0\)\)\]/.exec(
        handPlaces(after.text),
    );
    assert.ok(found, after.text);
    const [left, up, forwards] = found.slice(1).map(Number);
    // To the right on the screen is to the wearer's left, for whom looks at them.
    assert.ok(left > 20 && left < 2000, `${left}`);
    assert.ok(up > 500 && up < 1500 && forwards > 50, `${up} ${forwards}`);
    await settled(page);
});

test("a piece that is let go beside the view goes back", async () => {
    const before = (await stateOf(page)).project.edit;
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x - 300, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(500);
    assert.equal((await stateOf(page)).project.edit, before);
});

test("a place in figures, and a turn", async () => {
    const field = garment.getByLabel(/^Forwards/);
    const before = await depth();
    await change(page, async () => {
        await field.fill(String(before + 5));
        await field.press("Tab");
    });
    assert.ok(Math.abs((await depth()) - before - 5) < 0.06);
    for (const wrong of ["1e9", ""]) {
        const now = await depth();
        await field.fill(wrong);
        await field.press("Tab");
        assert.equal(await depth(), now, `"${wrong}" gives the figure before back`);
    }
    const turned = await change(page, () => garment.getByRole("button", { name: "Turn left" }).press("Enter"));
    assert.match(handPlaces(turned.text), /turn: \(0, 15, 0\)/);
    const tilted = await change(page, () => garment.getByRole("button", { name: "Tilt forwards" }).press("Enter"));
    // Around the body's own axis, after the turn: z takes a part.
    assert.match(handPlaces(tilted.text), /turn: \(15\.5, 14\.5, 4\)/);
});

test("a piece is given its own place back, and the garment comes back", async () => {
    const after = await change(page, () => garment.getByRole("button", { name: "Back to its own place" }).click());
    assert.equal(handPlaces(after.text), null);
    await place.click();
    await garment.getByLabel("Cut open").waitFor();
    await settled(page);
    await quiet(page);
});

/** A top of front and back with a collar, which no rule places. */
function collared() {
    const body = "24,0 24,40 18,42 16,60 10,62 8,55 -8,55 -10,62 -16,60 -18,42 -24,40 -24,0";
    const path = (points, id, dx, dy) => {
        const at = points.split(" ").map((p) => p.split(",").map(Number));
        return `<path id="${id}" d="M ${at.map(([x, y]) => `${x + dx} ${dy - y}`).join(" L ")} Z"/>`;
    };
    return `<svg xmlns="http://www.w3.org/2000/svg" width="130cm" height="80cm" viewBox="0 0 130 80">
        ${path(body, "front", 30, 65)}${path(body, "back", 85, 65)}${path("0,0 0,6 16,6 16,0", "collar", 30, 75)}</svg>`;
}

test("a piece that nothing places is put before the body, or taken out", async () => {
    const drawn = await serve();
    const other = await drawn.open({ wait: false });
    await other.locator("#begin").waitFor();
    const pane = other.getByRole("region", { name: "Garment" });
    await other
        .getByLabel("Choose a file")
        .setInputFiles({ name: "top.svg", mimeType: "image/svg+xml", buffer: Buffer.from(collared()) });
    await other.getByRole("button", { name: /^Sew these/ }).click();
    await other.getByText(/^Seams: \d+$/).waitFor();
    await other.getByRole("button", { name: "Sew", exact: true }).click();
    // The neck is as long as the collar.
    const edgeOf = async (name) => {
        const { pattern } = await ask(other, "view");
        const piece = pattern.pieces.find((one) => one.name === name);
        return `${name}.${piece.edges.find(({ length }) => Math.abs(length - 0.16) < 1e-3).name}`;
    };
    for (const name of ["collar", "back"]) {
        const edge = await edgeOf(name);
        await other.locator(`#pattern .edge[data-edge="${edge}"]`).dispatchEvent("click");
    }
    await other.keyboard.press("Escape");
    await pane.getByText("Nothing says where collar stands.").waitFor();

    const placed = await change(other, () => pane.getByRole("button", { name: "Put it before the body" }).click());
    assert.match(handPlaces(placed.text), /piece: "collar", middle: \("0 mm"/);
    await pane.getByText("Nothing says where collar stands.").waitFor({ state: "detached" });
    await pane.getByRole("button", { name: "Turn left" }).waitFor();
    assert.equal(await pane.getByRole("button", { name: "Back to its own place" }).count(), 0, "it has none");

    const out = await change(other, () => other.getByRole("button", { name: "Take it out" }).click());
    assert.match(out.text, /Remove\(piece: "collar"\)/);
    assert.equal(handPlaces(out.text), null);
    await other.locator('.cloth[data-piece="front"]').click();
    await change(other, () => other.getByRole("button", { name: "Take it out" }).click());
    await other.locator('.cloth[data-piece="front"]').waitFor({ state: "detached" });
    await other.locator('.cloth[data-piece="back"]').click();
    assert.ok(await other.getByRole("button", { name: "Take it out" }).isDisabled(), "the last piece stays");
    await quiet(other);
});

test("a pocket is sewn onto a piece, and moved on it", async () => {
    const pocket = `<path id="pocket" d="M 118 50 L 118 62 L 128 62 L 128 50 Z"/></svg>`;
    const drawn = await serve();
    const other = await drawn.open({ wait: false });
    await other.locator("#begin").waitFor();
    const pane = other.getByRole("region", { name: "Pattern" });
    await other.getByLabel("Choose a file").setInputFiles({
        name: "pocketed.svg",
        mimeType: "image/svg+xml",
        buffer: Buffer.from(collared().replace("</svg>", pocket)),
    });
    await other.getByRole("button", { name: /^Sew these/ }).click();
    await other.getByText(/^Seams: \d+$/).waitFor();
    await pane.locator('.cloth[data-piece="collar"]').click();
    await change(other, () => pane.getByRole("button", { name: "Take it out" }).click());

    await pane.locator('.cloth[data-piece="pocket"]').click();
    await pane.getByLabel("Sew it onto").selectOption("front");
    const sewn = await change(other, () => pane.getByRole("button", { name: "Sew on", exact: true }).click());
    assert.match(sewn.text, /SewOn\(piece: "pocket", onto: "front", x: "0 mm", y: "0 mm"\)/);
    const field = pane.getByLabel("to the right in the drawing");
    const moved = await change(other, async () => {
        await field.fill("8");
        await field.press("Tab");
    });
    assert.match(moved.text, /SewOn\(piece: "pocket", onto: "front", x: "80 mm", y: "0 mm"\)/);
    const { pattern } = await until("the pattern with its pocket", async () => {
        const view = await ask(other, "view");
        return view.pattern?.seams.some(({ name }) => name === "pocket on front") && view;
    });
    const line = pattern.pieces.find(({ name }) => name === "front").lines.find(({ name }) => name === "pocket_place");
    const [left, right] = [0, -1].map((k) => line.points.at(k)[0]);
    assert.ok(Math.abs(right - left - 0.1) < 1e-6);
    await field.fill("1e9");
    await field.press("Tab");
    assert.equal(await field.inputValue(), "8", "no pocket lies beside its piece");
    const handle = pane.getByRole("button", { name: "pocket: drag it" });
    const dragged = await change(other, async () => {
        await handle.focus();
        for (const key of ["ArrowLeft", "Shift+ArrowUp"]) await other.keyboard.press(key);
    });
    assert.match(dragged.text, /SewOn\(piece: "pocket", onto: "front", x: "75 mm", y: "50 mm"\)/);
    const by = await change(other, () => drag(other, handle, -12, 0));
    const x = Number(/SewOn\(piece: "pocket", onto: "front", x: "(.*?) mm", y: "50 mm"\)/.exec(by.text)[1]);
    assert.ok(x < 70, `${x}`);
    const off = await change(other, () => pane.getByRole("button", { name: "Take it off again" }).click());
    assert.doesNotMatch(off.text, /SewOn/);
    assert.match(off.text, /Remove\(piece: "collar"\)\]/);
    await change(other, () => other.keyboard.press("Control+z"));
    await until("the pocket on its piece", async () => /SewOn/.test((await stateOf(other)).text));

    const out = await change(other, () => pane.getByRole("button", { name: "Take it out" }).click());
    assert.match(out.text, /Remove\(piece: "collar"\), Remove\(piece: "pocket"\)/);
    assert.doesNotMatch(out.text, /SewOn/);
    await quiet(other);
});
