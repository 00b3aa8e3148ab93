// Several tabs, reloads, a lost connection: every page shows what the program has.

import assert from "node:assert/strict";
import { test } from "node:test";
import { change, cuttable, quiet, serve, settled, stateOf, until } from "./studio.mjs";

const studio = await serve("vest.ron");
const page = await studio.open();
const fabric = (where, name, rest = {}) => where.getByRole("button", { name, exact: true, ...rest });

test("what is done in one tab is seen in the other", async () => {
    const other = await studio.open({ context: page.context() });
    await change(page, () => fabric(page, "denim").click());
    await fabric(other, "denim", { pressed: true }).waitFor();
    await change(other, () => other.keyboard.press("Control+z"));
    await fabric(page, "cotton poplin", { pressed: true }).waitFor();
    quiet(other);
    await other.close();
});

test("an edit that comes second is tried again on what the first one left", async () => {
    const { edit } = (await stateOf(page)).project;
    // Both in one moment: the page has heard nothing of the other edit when the fabric is clicked.
    await page.evaluate(async (number) => {
        const changes = [{ set: { path: "stages.Canny.smooth", value: "2" } }];
        const taken = await fetch("/api/edit", {
            method: "POST",
            headers: { "Content-Type": "application/json" },
            body: JSON.stringify({ edit: number, words: "by another", changes }),
        });
        if (!taken.ok) throw new Error(await taken.text());
        document.querySelector('[data-key="fabric-linen"]').click();
    }, edit);
    const state = await until("both edits", async () => {
        const now = await stateOf(page);
        return now.project.edit >= edit + 2 && now;
    });
    assert.match(state.text, /Canny\(smooth: 2/);
    assert.match(state.text, /Preset\(name: "linen"/);
});

test("a reload in the middle of a run shows the run", async () => {
    await change(page, () => fabric(page, "wool coating").click());
    await page.reload();
    await fabric(page, "wool coating", { pressed: true }).waitFor();
    await settled(page);
});

test("a lost connection is told, and comes back with what happened meanwhile", async () => {
    const line = await cuttable(studio.address);
    const far = await studio.open({ context: page.context(), wait: false, address: line.address });
    await fabric(far, "wool coating", { pressed: true }).waitFor();
    line.cut();
    await far.getByText("The connection to the program is lost.").waitFor();
    await change(page, () => fabric(page, "silk charmeuse").click());
    line.mend();
    await far.getByText("The connection to the program is lost.").waitFor({ state: "hidden" });
    await fabric(far, "silk charmeuse", { pressed: true }).waitFor();
    assert.deepEqual(far.told.outside, []);
    await far.close();
});

test("the program's end loses nothing that was answered", async () => {
    await studio.end("SIGKILL");
    const again = await serve(null, { folder: studio.folder });
    const next = await again.open({ wait: false });
    await until("the unsaved edit", async () => /silk charmeuse/.test((await stateOf(next)).text));
    assert.equal((await stateOf(next)).project.saved, false);
});
