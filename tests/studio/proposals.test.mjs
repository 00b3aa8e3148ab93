// A drawing without seams: those that are proposed, and what a user takes of them.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { ask, quiet, serve, stateOf, until } from "./studio.mjs";

const sample = (name) => path.resolve(import.meta.dirname, "../../pipelines/samples/pattern", name);

const studio = await serve();
const page = await studio.open({ wait: false });
const pattern = page.getByRole("region", { name: "Pattern" });
const boxes = pattern.locator(".proposals input[type=checkbox]");

test("the seams that a drawing lacks are proposed with how sure the program is", async () => {
    await page.getByLabel("Choose a file").setInputFiles(sample("pleats.svg"));
    await pattern.getByText(/^Proposed seams: \d+$/).waitFor();
    const lines = await pattern.locator(".proposal").allTextContents();
    assert.ok(lines.length >= 2, lines.join("; "));
    for (const line of lines) assert.match(line, /^\d+\S+\.\S+.* – .*\d\d %$/);
    assert.equal(await boxes.evaluateAll((all) => all.every((box) => box.checked)), true);
});

test("one that is pointed at lights its edges, dashed until it is sewn", async () => {
    await pattern.locator(".proposal").first().hover();
    await page.locator("#pattern .edge.proposed.lit").nth(1).waitFor();
});

test("those that are ticked are sewn, the others are not, and undo takes them back", async () => {
    const count = await boxes.count();
    const refused = (await pattern.locator(".proposal").nth(count - 1).locator("span").nth(1).textContent()).split(" – ")[0];
    await boxes.nth(count - 1).uncheck();
    await pattern.getByRole("button", { name: `Sew these ${count - 1}` }).click();

    await pattern.getByText(`Seams: ${count - 1}`).waitFor();
    await pattern.getByText(/^Proposed seams/).waitFor({ state: "detached" });
    assert.match((await stateOf(page)).text, /SvgPattern\(seams: "seams\.ron", file: "pleats\.svg"\)/);
    const seams = fs.readFileSync(path.join(studio.folder, "seams.ron"), "utf8");
    assert.equal(seams.match(/\(name: /g).length, count - 1);
    assert.ok(!seams.includes(`["${refused}"]`), `${refused}: ${seams}`);

    await page.getByRole("button", { name: "Undo" }).click();
    await pattern.getByText(`Proposed seams: ${count}`).waitFor();
});

test("a pattern that is drafted to measure is asked for its measurements", async () => {
    const other = await serve();
    const page = await other.open({ wait: false });
    await page.getByLabel("Choose a file").setInputFiles(sample("skirt.sm2d"));
    await page.getByRole("heading", { name: "Which measurements?" }).waitFor();
    await page.getByLabel("Choose a file").setInputFiles(sample("body.smis"));
    await until("a pipeline", async () => (await stateOf(page)).project.file);
    assert.match(other.file(), /SeamlyPattern\(file: "skirt\.sm2d", measurements: "body\.smis"\)/);
    await page.getByText(/^Proposed seams: \d+$/).waitFor();

    await page.getByRole("button", { name: /^Sew these/ }).click();
    await until("a garment", async () => {
        const { project, run } = await stateOf(page);
        return project.edit === run.edit && run.kind === "full" && run.state === "done";
    });
    assert.ok((await ask(page, "view")).figures.seam_gap_max_m < 1e-3);
    quiet(page);
});

test("a pattern and its measurements may be given together", async () => {
    const other = await serve();
    const page = await other.open({ wait: false });
    await page.getByLabel("Choose a file").setInputFiles([sample("skirt.sm2d"), sample("body.smis")]);
    await until("a pipeline", async () => (await stateOf(page)).project.file);
    assert.match(other.file(), /SeamlyPattern\(file: "skirt\.sm2d", measurements: "body\.smis"\)/);
    quiet(page);
});
