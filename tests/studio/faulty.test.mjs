// Runs that fail: what is shown of an earlier text says so, and what a message offers is a button.

import assert from "node:assert/strict";
import { test } from "node:test";
import { change, quiet, send, serve, settled, stateOf, until } from "./studio.mjs";

const studio = await serve("photo_vest.ron");
const page = await studio.open();
const pane = (name) => page.getByRole("region", { name });
const set = (path, value) => change(page, () => send(page, [{ set: { path, value } }]));

test("a garment that the last run did not come to says so, and the edit is undone there", async () => {
    await set("stages.Arrange.hand_places", '[(piece: "sleeve", middle: ("0 mm", "1200 mm", "400 mm"))]');
    const old = pane("Garment").getByText("Arrange failed: what is shown here is from before it.");
    await old.waitFor();
    await page.locator("#pattern .old-notice").waitFor({ state: "hidden" });
    // Nothing is known where the pieces start now, but from before.
    await pane("Garment").getByRole("button", { name: "Place pieces" }).click();
    await old.waitFor();
    await pane("Garment").getByRole("button", { name: "Place pieces" }).click();

    const after = await change(page, () => pane("Garment").getByRole("button", { name: "Undo: by another" }).click());
    assert.doesNotMatch(after.text, /sleeve/);
    await old.waitFor({ state: "detached" });
    await settled(page);
});

test("a pattern whose last change failed says so", async () => {
    await change(page, () =>
        send(page, [{ add: { stage: 'Alter(alterations: [Remove(piece: "sleeve")])', after: "Canny" } }]),
    );
    await pane("Pattern").getByText("Alter failed: what is shown here is from before it.").waitFor();
    await change(page, () => pane("Pattern").getByRole("button", { name: "Undo: by another" }).click());
    await pane("Pattern").getByText("Alter failed").waitFor({ state: "detached" });
    await settled(page);
});

test("a text with faults says whose garment is shown", async () => {
    const text = (await stateOf(page)).text.replace("Canny()", "Cany()");
    await send(page, [{ text }], { draft: true });
    await pane("Garment").getByText("The text has faults: what is shown here is from before them.").waitFor();
    await change(page, () => page.keyboard.press("Control+z"));
    await pane("Garment").getByText("The text has faults").waitFor({ state: "detached" });
    await settled(page);
});

test("what a message offers to type is a button", async () => {
    await set("style.style", "Skirt");
    const group = page.getByRole("group", { name: "What may help" });
    await group.waitFor();
    const status = await page.locator("#status").textContent();
    assert.doesNotMatch(status, /--set/);
    await group.getByRole("button", { name: "Choose the kind" }).click();
    await until("the kinds", () => page.locator("#photo .kinds").evaluate((el) => el.open));
    await change(page, () => page.locator("#photo").getByRole("button", { name: "Vest", exact: true }).click());
    await settled(page);
    await group.waitFor({ state: "hidden" });
    quiet(page);
});
