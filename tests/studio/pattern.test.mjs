// The pattern: corners, edges, seams, darts, mirror images, print.

import assert from "node:assert/strict";
import { test } from "node:test";
import { change, drag, quiet, said, serve, settled, stateOf, until } from "./studio.mjs";

const studio = await serve("vest.ron");
const page = await studio.open();
const pattern = page.getByRole("region", { name: "Pattern" });
const edge = (name) => pattern.locator(`.reach[data-edge="${name}"]`);
const seams = async () => Number(/\d+/.exec(await pattern.getByText(/^Seams: /).textContent())[0]);

/** Clicks on an edge: its middle, since the box of a curve is not the curve; once the drawing stands still. */
async function click(name) {
    let at = "";
    const [x, y] = await until("a drawing that stands still", async () => {
        const place = await edge(name).evaluate((path) => {
            const { x, y } = path
                .getPointAtLength(path.getTotalLength() * 0.4)
                .matrixTransform(path.getScreenCTM());
            return [x, y];
        });
        const stands = place.join() === at && place;
        at = place.join();
        return stands;
    });
    await page.mouse.click(x, y);
}

const nothing = () => page.keyboard.press("Escape");

test("an edge that is pointed at lights both sides of its seam, here, on the garment and in the photo", async () => {
    await edge("front.side_left").hover({ force: true });
    await page.locator('#pattern .edge.lit[data-edge="front.side_left"]').waitFor();
    await page.locator('#pattern .edge.lit[data-edge="back.side_left"]').waitFor();
    await page.locator("#photo .edges polyline").first().waitFor({ state: "attached" });
});

test("a piece that is chosen is chosen in the photo as well", async () => {
    await pattern.locator('.cloth[data-piece="back"]').click();
    await page.locator("#photo").getByRole("button", { name: "back", pressed: true }).waitFor();
    await page.locator('#photo .outlines .lit[data-panel="back"]').waitFor({ state: "attached" });
    await nothing();
});

test("a corner that is dragged is an alteration in the file", async () => {
    const state = await change(page, () =>
        drag(page, pattern.locator('.corner[data-piece="front"][data-corner="2"]'), 0, 12),
    );

    assert.match(
        state.text,
        /Alter\(alterations: \[MoveCorner\(piece: "front", corner: 2, x: "[\d.-]+ mm", y: "-[\d.]+ mm"\)\]\)/,
    );
    const stages = state.stages.map(({ name }) => name);
    assert.ok(stages.indexOf("Alter") < stages.findIndex((name) => name.endsWith("Mesher")), stages.join());
    await nothing();
});

test("undo takes the corner back, redo moves it again", async () => {
    const undone = await change(page, () => page.keyboard.press("Control+z"));
    assert.doesNotMatch(undone.text, /MoveCorner/);
    const redone = await change(page, () => page.keyboard.press("Control+Shift+Z"));
    assert.match(redone.text, /MoveCorner/);
    await change(page, () => page.getByRole("button", { name: "Undo" }).click());
    await settled(page);
});

test("a seam is unpicked, and its edges are sewn by two clicks", async () => {
    await nothing();
    const all = await seams();
    await click("front.side_left");
    const unpicked = await change(page, () =>
        pattern.getByRole("button", { name: "Unpick the seam" }).click(),
    );
    assert.match(unpicked.text, /Unsew\(edge: "front\.side_left"\)/);
    await nothing();
    await until("one seam less", async () => (await seams()) === all - 1);

    await pattern.getByRole("button", { name: "Sew", exact: true }).click();
    await click("front.side_left");
    await said(page, /front\.side_left: now click/);
    const sewn = await change(page, () => click("back.side_left"));
    assert.match(sewn.text, /Sew\(a: "front\.side_left", b: "back\.side_left"\)/);
    await settled(page);
    await until("the seam again", async () => (await seams()) === all);
});

test("a seam is turned round", async () => {
    await click("front.side_left");
    const state = await change(page, () =>
        pattern.getByRole("button", { name: "Turn the seam round" }).click(),
    );
    assert.match(state.text, /Sew\(a: "front\.side_left", b: "back\.side_left", reversed: true\)/);
    await change(page, () => page.keyboard.press("Control+z"));
    await nothing();
});

test("an edge is given a length", async () => {
    await settled(page);
    await click("front.shoulder_left");
    const length = pattern.getByLabel("Length").first();
    const wanted = (Number(await length.inputValue()) + 1).toFixed(1);
    const state = await change(page, async () => {
        await length.fill(wanted);
        await length.press("Enter");
    });
    assert.match(state.text, /Lengthen\(edge: "front\.shoulder_left", by: "[\d.]+ mm"\)/);
    await change(page, () => page.keyboard.press("Control+z"));
    await nothing();
});

test("an edge that is chosen is moved by arrow keys in steps of 5 mm", async () => {
    await settled(page);
    await click("front.hem");
    await edge("front.hem").focus();
    const state = await change(page, async () => {
        await page.keyboard.press("ArrowDown");
        await page.keyboard.press("ArrowDown");
    });
    assert.match(state.text, /MoveEdge\(edge: "front\.hem", x: "0 mm", y: "-10 mm"\)/);
    await change(page, () => page.keyboard.press("Control+z"));
    await nothing();
});

test("a dart is cut into the hem", async () => {
    await settled(page);
    await click("front.hem");
    await pattern.getByText("Add a dart").click();
    const state = await change(page, () => pattern.getByRole("button", { name: "Add the dart" }).click());
    assert.match(state.text, /Dart\(edge: "front\.hem", at: 0\.5, width: "20 mm", length: "90 mm"\)/);
    await change(page, () => page.keyboard.press("Control+z"));
    await nothing();
});

test("a piece is mirrored", async () => {
    await settled(page);
    await pattern.locator('.cloth[data-piece="front"]').click();
    await pattern.getByLabel("Name of the mirror image").fill("back");
    const state = await change(page, () => pattern.getByRole("button", { name: "Mirror" }).click());
    assert.match(state.text, /Mirror\(piece: "front", name: "back"\)/);
    await change(page, () => page.keyboard.press("Control+z"));
    await nothing();
});

test("the pattern is printed as PDF, and the file is as it was", async () => {
    await settled(page);
    const { text } = await stateOf(page);
    await pattern.getByText("Print", { exact: true }).click();
    await pattern.getByRole("button", { name: "PDF" }).click();
    await said(page, /PDF: \d+ file\(s\) written/);
    const link = pattern.getByRole("link", { name: /\.pdf$/ });
    const answer = await page.request.get(new URL(await link.getAttribute("href"), page.url()).href);
    assert.equal((await answer.body()).subarray(0, 5).toString(), "%PDF-");
    assert.equal((await stateOf(page)).text, text);
});

test("allowances are given where it is printed", async () => {
    const pieces = async () => {
        const link = pattern.getByRole("link", { name: /\.svg$/ });
        const answer = await page.request.get(new URL(await link.getAttribute("href"), page.url()).href);
        return Number(/width="([\d.]+)mm"/.exec(await answer.text())[1]);
    };
    const print = async (seam) => {
        await pattern.getByLabel("Seam allowance").fill(seam);
        await pattern.getByRole("button", { name: "SVG" }).click();
    };
    await print("10");
    await said(page, /SVG: \d+ file\(s\) written/);
    const narrow = await pieces();
    await print("25");
    await until("wider pieces", async () => (await pieces()) > narrow + 25);
    await print("-1");
    assert.equal(await pattern.getByLabel("Seam allowance").evaluate((el) => el.checkValidity()), false);
    await pattern.getByLabel("Seam allowance").fill("10");
});

test("the pattern is written for a cutter", async () => {
    await pattern.getByRole("button", { name: "HPGL" }).click();
    await said(page, /HPGL: \d+ file\(s\) written/);
    await nothing();
    quiet(page);
});
