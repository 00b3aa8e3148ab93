// Stages, body, fabric, text, accuracy and time, files: the pipeline from the tools below the panes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { change, quiet, said, serve, settled, stateOf, until } from "./studio.mjs";

const studio = await serve("vest.ron");
const page = await studio.open();
const tab = (name) => page.getByRole("tab", { name }).click();
const begun = (await stateOf(page)).text;

test("a fabric is chosen by its name", async () => {
    await tab("Body and fabric");
    const state = await change(page, () => page.getByRole("button", { name: "linen" }).click());
    assert.match(state.text, /Preset\(name: "linen", hysteresis: true\)/);
    await page.getByRole("button", { name: "linen", pressed: true }).waitFor();
});

test("the line below says what the change did and cost", async () => {
    await said(page, /fabric linen: .*(moved by at most [\d.]+ mm, in|Done in) [\d.]+ s/);
});

test("the arms and the looks of the cloth are set beside body and fabric", async () => {
    const other = await serve("pattern.ron");
    const shirt = await other.open();
    const wearer = shirt.locator("#wearer");
    await wearer.getByLabel("FabricTexturer texture").selectOption("Check");
    await until("the texture", async () => /texture: Check/.test((await stateOf(shirt)).text));
    const coloured = await change(shirt, () => wearer.getByLabel("FabricTexturer colour").fill("#803030"));
    assert.match(coloured.text, /colour: "#803030"/);
    const posed = await change(shirt, () => wearer.getByRole("slider", { name: "Mannequin arm_angle" }).press("ArrowLeft"));
    assert.match(posed.text, /Mannequin\(arm_angle: 59\.\d/);
    quiet(shirt);
    await shirt.close();
});

test("a slider of the body is moved by keys", async () => {
    await page.getByRole("slider", { name: "Bust" }).focus();
    const state = await change(page, () => page.keyboard.press("ArrowRight"));
    assert.match(state.text, /bust: "88\.5 cm"/);
});

test("a size takes the place of the measures", async () => {
    const size = page.getByLabel("Size");
    const wanted = await size.locator("option").nth(1).getAttribute("value");
    const state = await change(page, () => size.selectOption(wanted));
    assert.match(state.text, new RegExp(`Mannequin\\(.*size: "${wanted}"`));
    assert.doesNotMatch(state.text, /bust: /);
    await change(page, () => page.keyboard.press("Control+z"));
});

test("a parameter is set on its card, and given back", async () => {
    await tab("Stages");
    await page
        .locator("#stages")
        .getByRole("button", { name: /^GridMesher/ })
        .click();
    const edge = page.locator("#stages").getByRole("slider", { name: "GridMesher edge" });
    await edge.focus();
    const state = await change(page, () => page.keyboard.press("ArrowRight"));
    assert.match(state.text, /GridMesher\(edge: "\d+(\.\d+)? mm"\)/);
    assert.notEqual(state.text, begun);
    const back = await change(page, () =>
        page
            .locator("#stages .param", { hasText: "edge" })
            .getByRole("button", { name: "Back to the default" })
            .click(),
    );
    assert.doesNotMatch(back.text, /GridMesher\(edge/);
    await change(page, () => page.keyboard.press("Control+z"));
});

test("the mesher is swapped for another one", async () => {
    const state = await change(page, () =>
        page.getByLabel("Swap for another stage of its role").selectOption("DelaunayMesher"),
    );
    assert.match(state.text, /DelaunayMesher\(\)/);
    assert.doesNotMatch(state.text, /^ *GridMesher/m);
    await page
        .locator("#stages")
        .getByRole("button", { name: /^DelaunayMesher/ })
        .waitFor();
    await change(page, () => page.keyboard.press("Control+z"));
});

test("a writer is added and removed", async () => {
    await page.getByLabel("What is written besides").selectOption("Ply");
    const added = await change(page, () => page.getByRole("button", { name: "Add", exact: true }).click());
    assert.match(added.text, /Report\(\), +Ply\(\)|Ply\(\)/);
    await page.locator("#stages").getByRole("button", { name: /^Ply/ }).click();
    const removed = await change(page, () => page.getByRole("button", { name: "Remove" }).click());
    assert.doesNotMatch(removed.text, /Ply\(\)/);
});

test("the graph shows every stage, and chooses one", async () => {
    await page.getByRole("button", { name: "As a graph" }).click();
    await until("a node a stage", async () => {
        const { stages } = await stateOf(page);
        return (await page.locator("#stages .node").count()) === stages.length;
    });
    await page.locator("#stages .node", { hasText: "Canny" }).click();
    await page.locator("#stages h3", { hasText: "Canny" }).waitFor();
    await page.getByRole("button", { name: "As a graph" }).click();
});

test("a fault in the text is told with its line, and nothing is run", async () => {
    await tab("Text");
    const field = page.getByRole("textbox", { name: "The pipeline's text" });
    const text = await field.inputValue();
    await field.fill(text.replace("Otsu()", "Otsuu()"));
    const line = text.split("\n").findIndex((one) => one.includes("Otsu()")) + 1;
    const place = page.getByRole("button", { name: new RegExp(`^Line ${line}, column`) });
    await place.waitFor();
    await place.click();
    assert.match(await field.evaluate((el) => el.value.slice(el.selectionStart, el.selectionEnd)), /Otsuu/);
    assert.equal(
        (await stateOf(page)).run.state === "running" && (await stateOf(page)).faults.length > 0,
        false,
    );

    await field.fill(text.replace('name: "vest"', 'name: "my vest"'));
    await page.getByText("None.").waitFor();
    await until("the text", async () => /name: "my vest"/.test((await stateOf(page)).text));
});

test("Save writes the file with its comments", async () => {
    assert.equal((await stateOf(page)).project.saved, false);
    await page.keyboard.press("Control+s");
    await until("the file", async () => (await stateOf(page)).project.saved);
    assert.match(studio.file(), /\/\/ Who wears it, and what it is made of\./);
    assert.match(studio.file(), /Preset\(name: "linen"/);
    await page.locator("#head .saved", { hasText: /^saved$/ }).waitFor();
});

test("a point of accuracy and time is taken, and its files are listed", async () => {
    await settled(page);
    await tab("Accuracy and time");
    await page.getByRole("button", { name: /^Draft: error 2 mm/ }).waitFor();
    await page.getByRole("button", { name: "Take Draft" }).click();
    await until(
        "a full run",
        async () => {
            const { run } = await stateOf(page);
            return run.kind === "full" && run.state === "done";
        },
        300_000,
    );
    await tab("Files");
    await page.getByRole("link", { name: "garment.glb" }).waitFor();
});

test("a run is stopped", async () => {
    await page.getByRole("button", { name: "Run", exact: true }).click();
    const stop = page.getByRole("button", { name: "Stop" });
    if (await stop.isVisible().catch(() => false)) await stop.click();
    await page.getByRole("button", { name: "Run", exact: true }).waitFor({ timeout: 120_000 });
    quiet(page);
});
