// The garment in space.

import assert from "node:assert/strict";
import { test } from "node:test";
import { change, idle, quiet, serve, settled } from "./studio.mjs";

const studio = await serve("vest.ron");
const page = await studio.open();
const garment = page.getByRole("region", { name: "Garment" });
const canvas = garment.getByRole("application");
const pictures = () => canvas.evaluate((el) => Number(el.dataset.pictures));

/** Colours of the canvas's middle, to see that something is drawn there. */
const seen = async () => (await canvas.screenshot({ caret: "initial" })).toString("base64");

test("the canvas shows a garment and says how large it is", async () => {
    assert.match(await canvas.getAttribute("aria-label"), /2 panels, \d+ triangles/);
    assert.ok((await pictures()) > 0);
});

test("arrow keys turn it, plus and minus zoom, Home shows all", async () => {
    await canvas.focus();
    const views = [await seen()];
    for (const key of ["ArrowRight", "+", "Home"]) {
        await page.keyboard.press(key);
        await page.waitForTimeout(800);
        views.push(await seen());
    }
    assert.equal(new Set(views).size, 3);
    assert.equal(views[3], views[1], "Home keeps the side from which it is looked at");
});

test("at rest nothing is drawn", async () => {
    await idle(page);
    await page.mouse.move(5, 5);
    await page.waitForTimeout(1500);
    const before = await pictures();
    await page.waitForTimeout(700);
    assert.equal(await pictures(), before);
});

test("a click on the garment lights its panel in the pattern and its pixel in the photo", async () => {
    await garment.getByRole("button", { name: "Front", exact: true }).click();
    await garment.getByRole("button", { name: "Show all" }).click();
    await canvas.focus();
    await page.keyboard.press("Enter");

    await page.locator('#pattern .piece.lit[data-piece="front"]').waitFor();
    await page.locator("#pattern .spot:not(.gone)").waitFor({ state: "attached" });
    await page.locator("#photo .spot:not(.gone)").waitFor({ state: "attached" });
});

test("a click on the photo lights the same place on the garment", async () => {
    await page.keyboard.press("Escape");
    const before = await seen();
    const box = await page.locator("#photo svg > image").boundingBox();
    await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.6 * box.height);
    await page.locator('#pattern .piece.lit[data-piece="front"]').waitFor();
    assert.notEqual(await seen(), before);
    await page.keyboard.press("Escape");
});

test("the strain map has a legend, and a figure at the pointer", async () => {
    await garment.getByLabel("What the garment shows").selectOption("strain");
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await garment.getByText(/here [\d.]+ %/).waitFor();
    await garment.getByLabel("What the garment shows").selectOption("texture");
});

test("the body, a cut and the garment before an edit change the picture", async () => {
    await change(page, () => page.locator("#wearer").getByRole("button", { name: "denim" }).click());
    await settled(page);
    const views = [await seen()];
    for (const act of [
        () => garment.getByLabel("Body").uncheck(),
        () => garment.getByLabel("Cut open").selectOption("front"),
        () => garment.getByLabel("Before").check(),
    ]) {
        await act();
        await page.waitForTimeout(800);
        views.push(await seen());
    }
    assert.equal(new Set(views).size, 4);
});

test("a garment of the vest's size turns smoothly without a graphics card", async () => {
    const rate = await canvas.evaluate(async (el) => {
        const turn = () =>
            el.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
        const [from, began] = [Number(el.dataset.pictures), performance.now()];
        while (performance.now() - began < 2000) {
            turn();
            await new Promise(requestAnimationFrame);
        }
        return (Number(el.dataset.pictures) - from) / 2;
    });
    assert.ok(rate > 5, `${rate} pictures a second`);
    quiet(page);
});
