// The begin of a project in an empty folder.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { quiet, said, serve, settled, stateOf, until } from "./studio.mjs";

const sample = (name) => path.resolve(import.meta.dirname, "../../pipelines/samples", name);

/** Drops a file onto the page, as from a folder's window. */
async function drop(page, file) {
    const bytes = fs.readFileSync(file).toString("base64");
    await page.evaluate(
        ([name, base64]) => {
            const data = new DataTransfer();
            data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
            document
                .getElementById("drop")
                .dispatchEvent(
                    new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }),
                );
        },
        [path.basename(file), bytes],
    );
}

test("a photo that is dropped is asked for its width and becomes a garment", async () => {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await drop(page, sample("vest/front.jpg"));
    await page.getByRole("heading", { name: "How wide is it?" }).waitFor();
    await page.getByLabel("Width").fill("52");
    await page.getByRole("button", { name: "Make the garment" }).click();

    await settled(page);
    assert.match(studio.file(), /"52 cm"/);
    assert.ok(fs.existsSync(path.join(studio.folder, "front.jpg")));
    assert.equal(await page.getByRole("button", { name: "Make the garment" }).count(), 0);
    quiet(page);
});

test("a photo is taken by the camera", async () => {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page.getByRole("button", { name: "Take a photo" }).click();
    await page.getByRole("button", { name: "Back" }).click();
    await page.getByRole("button", { name: "Take a photo" }).click();
    await page.getByRole("button", { name: "Take it" }).click();
    await page.getByRole("heading", { name: "How wide is it?" }).waitFor();
    const picture = page.getByAltText("Your photo photo.jpg");
    await until("the picture", () => picture.evaluate((el) => el.naturalWidth > 100));
    await page.getByLabel("Width").fill("52");
    await page.getByRole("button", { name: "Make the garment" }).click();
    await until("a pipeline", async () => (await stateOf(page)).project.file);
    assert.equal(fs.readFileSync(path.join(studio.folder, "photo.jpg")).readUInt16BE(0), 0xffd8);
    quiet(page);
});

test("a bank card beside the garment gives the width", async () => {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page.getByLabel("Choose a file").setInputFiles(sample("vest/front.jpg"));
    await page.getByLabel("A bank card lies beside it").check();
    await page.getByRole("button", { name: "Make the garment" }).click();

    await until("a pipeline", async () => (await stateOf(page)).project.file);
    assert.match(studio.file(), /scale: BankCard/);
});

test("a pattern file is sewn without a question", async () => {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page.getByLabel("Choose a file").setInputFiles(sample("pattern/shirt_specification.json"));

    await until("a pipeline", async () => (await stateOf(page)).project.file);
    assert.match(studio.file(), /shirt_specification\.json/);
    // The pattern has the room of a photo that there is not.
    await page.locator("#photo").waitFor({ state: "hidden" });
});

test("a file that is neither is refused in words", async () => {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page
        .getByLabel("Choose a file")
        .setInputFiles({ name: "song.mp3", mimeType: "audio/mpeg", buffer: Buffer.from("x") });

    await said(page, /song\.mp3 is neither a photo nor a pattern/);
    assert.equal((await stateOf(page)).project.file, null);
});

test("a sample is one click away", async () => {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page.getByRole("button", { name: "Vest" }).click();

    await until("a pipeline", async () => (await stateOf(page)).project.file);
    await page.getByRole("region", { name: "Pattern" }).waitFor();
    await page.locator("#pattern .piece").first().waitFor({ timeout: 120_000 });
    quiet(page);
});

/** A page of a project whose photo is a text by another name. */
async function begunWithNotes() {
    const studio = await serve();
    const page = await studio.open({ wait: false });
    await page.locator("#begin").waitFor();
    const text = { name: "notes.jpg", mimeType: "image/jpeg", buffer: Buffer.from("these are notes") };
    await page.getByLabel("Choose a file").setInputFiles(text);
    await page.getByLabel("Width").fill("52");
    await page.getByRole("button", { name: "Make the garment" }).click();
    await said(page, /notes\.jpg/);
    return page;
}

test("a photo that cannot be read does not hold the folder: one begins anew, and undo goes back", async () => {
    const page = await begunWithNotes();
    await page.getByText("The photo is not read yet.").waitFor();

    await page.getByRole("button", { name: "New…" }).click();
    await page.getByRole("button", { name: "Keep this garment" }).click();
    await page.getByText("The photo is not read yet.").waitFor();
    await page.getByRole("button", { name: "New…" }).click();
    await page.getByRole("button", { name: "Vest" }).click();
    await settled(page);
    assert.match((await stateOf(page)).text, /"vest"/);

    await page.getByRole("button", { name: "Undo" }).click();
    await until("the photo before", async () => /notes\.jpg/.test((await stateOf(page)).text));
});

test("another photo takes the place of one, under the same width", async () => {
    const page = await begunWithNotes();
    await page.getByLabel("Choose a file for front").setInputFiles(sample("vest/front.jpg"));
    await settled(page);
    assert.match((await stateOf(page)).text, /"front": \(file: "front\.jpg", width: "52 cm"\)/);
    quiet(page);
});
