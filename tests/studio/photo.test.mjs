// The photo: landmarks, width, kind, mask, strokes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { change, drag, quiet, serve, settled, until } from "./studio.mjs";

const studio = await serve("photo_vest.ron");
const page = await studio.open();
const landmark = (name) => page.locator("#photo").getByRole("button", { name: new RegExp(`^${name},`) });

/** The length of the front's neck in centimetres, as the pattern tells it. */
async function neck() {
    const label = await page
        .locator('#pattern .reach[data-edge^="front.neck"]')
        .first()
        .getAttribute("aria-label");
    return Number(/, ([\d.]+) cm/.exec(label)[1]);
}

test("the photo shows the mask, which can be taken away", async () => {
    const mask = page.getByRole("button", { name: "Mask" });
    assert.equal(await mask.getAttribute("aria-pressed"), "true");
    await mask.click();
    assert.equal(await page.locator("#photo .tint").isVisible(), false);
    await mask.click();
    assert.equal(await page.locator("#photo .tint").isVisible(), true);
});

test("a landmark that is dragged changes the neck", async () => {
    const before = await neck();
    const state = await change(page, () => drag(page, landmark("neck left"), 12, -2));

    assert.match(state.text, /landmarks: \{"neck_left": \(0\.\d+, 0\.\d+\)\}/);
    await until("another neck", async () => Math.abs((await neck()) - before) > 0.3);
});

test("a landmark is moved by arrow keys, one edit for several presses", async () => {
    await settled(page);
    const before = await page.locator("#undo").getAttribute("title");
    await landmark("armpit left").focus();
    const state = await change(page, async () => {
        for (const key of ["ArrowDown", "ArrowDown", "Shift+ArrowDown"]) await page.keyboard.press(key);
    });

    assert.match(state.text, /"armpit_left"/);
    assert.equal(state.project.can_undo, "move armpit left");
    assert.notEqual(before, state.project.can_undo);
});

test("Delete gives a landmark back to the stage that found it", async () => {
    await settled(page);
    await page.getByRole("button", { name: /^armpit left, placed/ }).waitFor();
    await landmark("armpit left").focus();
    const state = await change(page, () => page.keyboard.press("Delete"));

    assert.doesNotMatch(state.text, /"armpit_left"/);
    assert.match(state.text, /"neck_left"/);
});

test("the width is said in centimetres", async () => {
    const width = page.getByLabel("Width of the garment");
    const state = await change(page, async () => {
        await width.fill("56");
        await width.press("Enter");
    });
    assert.match(state.text, /width: "56 cm"/);
});

test("the kind is one of the card's choices, for the pattern and the wearer", async () => {
    await page.getByText("Kind: Vest").click();
    const state = await change(page, () =>
        page.getByRole("button", { name: "T-shirt", exact: true }).click(),
    );

    assert.match(state.text, /Block\(.*style: TShirt/);
    assert.match(state.text, /Fitting\(.*style: TShirt/);
    await change(page, () => page.keyboard.press("Control+z"));
});

test("what the network sees is offered as the kind", async () => {
    const guesses = page.locator("#photo").getByRole("group", { name: "The network sees:" });
    const first = guesses.getByRole("button").first();
    assert.match(await first.textContent(), /^Vest \d+ %$/);
    await settled(page);
    const state = await change(page, () => page.locator("#photo").getByRole("button", { name: "T-shirt", exact: true }).click());
    assert.match(state.text, /style: TShirt/);
    const back = await change(page, () => first.click());
    assert.match(back.text, /Block\(style: Vest/);
    assert.match(back.text, /Fitting\(style: Vest/);
});

test("a stroke says what is ground: the stage that takes strokes comes in", async () => {
    await page.getByRole("button", { name: "Mark ground" }).click();
    const box = await page.locator("#photo svg > image").boundingBox();
    const state = await change(page, async () => {
        await page.mouse.move(box.x + 0.05 * box.width, box.y + 0.1 * box.height);
        await page.mouse.down();
        await page.mouse.move(box.x + 0.06 * box.width, box.y + 0.5 * box.height, { steps: 5 });
        await page.mouse.up();
    });

    assert.match(state.text, /GraphCut\(ground: \{"front": \[\(0\.0/);
    await page.keyboard.press("Escape");
    quiet(page);
});
