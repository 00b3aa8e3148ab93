// Three tasks as a new user does them, each from an empty folder: what is pressed, and how long it takes, is printed.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { ask, change, idle, quiet, serve, settled, stateOf, until } from "./studio.mjs";

const sample = (name) => path.resolve(import.meta.dirname, "../../pipelines/samples", name);

/** A task on a page of an empty folder: `step` does what a person does, `reached` waits for what they look for. */
async function begun(name) {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page.locator("#begin").waitFor();
    const [steps, start] = [[], performance.now()];
    return {
        studio,
        page,
        async step(words, act) {
            steps.push(words);
            await act();
        },
        ended() {
            quiet(page);
            const took = ((performance.now() - start) / 1e3).toFixed(1);
            console.log(`${name}: ${steps.length} steps, ${took} s (${steps.join("; ")})`);
        },
    };
}

/** What a link gives. */
async function fetched(page, link) {
    const answer = await page.request.get(new URL(await link.getAttribute("href"), page.url()).href);
    assert.equal(answer.status(), 200);
    return answer.body();
}

test("from a photo of one's own to a GLB", async () => {
    const { page, step, ended } = await begun("photo to GLB");
    const buffer = fs.readFileSync(sample("tshirt/front.jpg"));
    await step("choose the photo", () =>
        page.getByLabel("Choose a file").setInputFiles({ name: "IMG_2031.jpg", mimeType: "image/jpeg", buffer }),
    );
    await step("say how wide it is", () => page.getByLabel("Width").fill("76"));
    await step("make the garment", () => page.getByRole("button", { name: "Make the garment" }).click());
    await settled(page);
    await idle(page);
    await step("open the files", () => page.getByRole("tab", { name: "Files" }).click());
    const link = page.getByRole("link", { name: "garment.glb" });
    await step("take garment.glb", () => link.waitFor());
    assert.equal((await fetched(page, link)).subarray(0, 4).toString(), "glTF");
    assert.equal((await stateOf(page)).run.state, "done");
    ended();
});

/** The sample vest as a DXF, which has no seams. */
async function vestAsDxf() {
    const studio = await serve("vest.ron");
    const page = await studio.open();
    await page.getByText("Print", { exact: true }).click();
    await page.getByRole("button", { name: "DXF" }).click();
    const link = page.getByRole("link", { name: /\.dxf$/ });
    await link.waitFor();
    return fetched(page, link);
}

test("from a DXF over its confirmed seams to a garment", async () => {
    const buffer = await vestAsDxf();
    const { page, studio, step, ended } = await begun("DXF to garment");
    await step("choose the DXF", () =>
        page.getByLabel("Choose a file").setInputFiles({ name: "vest.dxf", mimeType: "application/dxf", buffer }),
    );
    const sew = page.getByRole("button", { name: /^Sew these \d+$/ });
    await step("look at the proposed seams", () => sew.waitFor({ timeout: 60_000 }));
    await step("sew them", () => sew.click());
    await until("the garment", async () => {
        const { project, run } = await stateOf(page);
        return project.edit === run.edit && run.kind === "full" && run.state !== "running" && run;
    });
    const { figures } = await ask(page, "view");
    assert.ok(figures.seam_gap_max_m < 1e-3, `${figures.seam_gap_max_m}`);
    assert.match(studio.file(), /DxfPattern\(/);
    ended();
});

test("from another size to a printed pattern", async () => {
    const { page, step, ended } = await begun("another size to a printed pattern");
    const measured = fs.readFileSync(sample("pattern/body.smis"), "utf8");
    await step("choose the pattern and its measurements", () =>
        page.getByLabel("Choose a file").setInputFiles([sample("pattern/skirt.sm2d"), sample("pattern/body.smis")]),
    );
    await page.getByText(/^Proposed seams: \d+$/).waitFor({ timeout: 60_000 });
    const width = async () => {
        const { points } = (await ask(page, "view")).pattern.pieces.find(({ name }) => name === "front");
        const across = points.map(([x]) => x);
        return Math.max(...across) - Math.min(...across);
    };
    const before = await width();
    await step("open the stages", () => page.getByRole("tab", { name: "Stages" }).click());
    await step("open the pattern's reader", () => page.getByRole("button", { name: /^SeamlyPattern/ }).click());
    const buffer = Buffer.from(measured.replaceAll('name="hip_circ" value="96"', 'name="hip_circ" value="108"'));
    assert.notEqual(buffer.toString(), measured);
    await step("choose other measurements", () =>
        change(page, () =>
            page
                .getByLabel("Choose a file for SeamlyPattern measurements")
                .setInputFiles({ name: "larger.smis", mimeType: "application/xml", buffer }),
        ),
    );
    await until("wider pieces", async () => (await width()) > before + 0.05);
    await step("open what prints", () => page.getByText("Print", { exact: true }).click());
    await step("print a PDF", () => page.getByRole("button", { name: "PDF" }).click());
    const link = page.getByRole("link", { name: /\.pdf$/ });
    await link.waitFor();
    assert.equal((await fetched(page, link)).subarray(0, 5).toString(), "%PDF-");
    ended();
});
