// Narrow screens, dark, Chinese, keyboard alone, screen readers.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { ask, change, findings, quiet, serve, stateOf } from "./studio.mjs";

const studio = await serve("vest.ron");
const first = await studio.open();
const TABS = ["Body and fabric", "Stages", "Text", "Accuracy and time", "Files"];

const CARDS = JSON.parse(fs.readFileSync(new URL("../../studio/page/words/cards.zh.json", import.meta.url), "utf8"));

/** How far the page is wider than its window. */
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

test("at 1280 px the three panes stand beside each other", async () => {
    const boxes = [];
    for (const name of ["Photo", "Pattern", "Garment"])
        boxes.push(await first.getByRole("region", { name }).boundingBox());
    assert.ok(boxes[0].x < boxes[1].x && boxes[1].x < boxes[2].x);
    assert.equal(boxes[0].y, boxes[2].y);
    assert.equal(await overflow(first), 0);
});

test("at 400 px each pane and tool is a tab", async () => {
    const page = await studio.open({ viewport: { width: 400, height: 800 } });
    for (const name of ["Photo", "Pattern", "Garment", ...TABS]) {
        await page.getByRole("tab", { name }).click();
        await page.getByRole("region", { name }).or(page.getByRole("tabpanel", { name })).first().waitFor();
        assert.equal(await overflow(page), 0, name);
    }
    await page.getByRole("tab", { name: "Garment" }).click();
    const box = await page.getByRole("application").boundingBox();
    assert.ok(box.width > 350 && box.height > 200, JSON.stringify(box));
    quiet(page);
    await page.context().close();
});

/** Firefox is not told by its driver what the system's colours are. */
const noSystemColours = process.env.FIREFOX ? "Firefox has the colours of this system" : false;

test("the page is dark where the system is, and a switch is remembered", { skip: noSystemColours }, async () => {
    const page = await studio.open({ colorScheme: "dark", wait: false });
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const dark = await ground();
    await page.getByRole("button", { name: "Light colours" }).click();
    const light = await ground();
    assert.notEqual(light, dark);
    await page.reload();
    assert.equal(await ground(), light);
    await page.context().close();
});

test("a Chinese browser is spoken to in Chinese, and the choice of a language is remembered", async () => {
    const page = await studio.open({ locale: "zh-CN" });
    await page.getByRole("button", { name: "保存" }).waitFor();
    await page.getByRole("tab", { name: "人体与面料" }).waitFor();
    assert.equal(await page.evaluate(() => document.documentElement.lang), "zh-Hans");
    await page.locator("#tab-stages").click();
    await page.getByRole("button", { name: /^Canny/ }).click();
    const card = page.locator("#stages");
    const { stages } = await ask(page, "cards");
    const canny = stages.find(({ name }) => name === "Canny");
    for (const english of [canny.doc.split("\n")[0], canny.params[0].doc])
        assert.equal(await card.getByText(english).count(), 0, english);
    const doc = Object.entries(CARDS).find(([english]) => english === canny.params[0].doc)[1];
    await card.getByText(doc).first().waitFor();
    await page.getByLabel("语言", { exact: true }).selectOption("en");
    await card.getByText(canny.params[0].doc).first().waitFor();
    await page.getByRole("button", { name: "Save" }).waitFor();
    await page.reload();
    await page.getByRole("tab", { name: "Body and fabric" }).waitFor();
    quiet(page);
    await page.context().close();
});

test("every sentence is there in both languages", async () => {
    const { en, zh } = Object.assign(
        {},
        await import("../../studio/page/words/en.js"),
        await import("../../studio/page/words/zh.js"),
    );
    assert.deepEqual(
        Object.keys(en).filter((key) => !(key in zh)),
        [],
    );
    const gaps = (text) => (text.match(/\{\w+\}/g) ?? []).sort().join();
    assert.deepEqual(
        Object.keys(en).filter((key) => gaps(en[key]) !== gaps(zh[key])),
        [],
    );
});

test("by keyboard alone: to a corner of the pattern, move it, take it back, save", async () => {
    const page = await studio.open();
    const focused = () =>
        page.evaluate(
            () => document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent,
        );
    const tabTo = async (pattern) => {
        for (let i = 0; i < 150; i++) {
            await page.keyboard.press("Tab");
            if (pattern.test(await focused())) return;
        }
        assert.fail(`no way to ${pattern}`);
    };
    await tabTo(/^Piece front/);
    await page.keyboard.press("Enter");
    await tabTo(/^Corner 1 of front/);
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).stroke);
    const moved = await change(page, () => page.keyboard.press("ArrowUp"));
    assert.match(moved.text, /MoveCorner\(piece: "front", corner: 0, x: "0 mm", y: "5 mm"\)/);
    assert.match(await focused(), /^Corner 1 of front/);
    assert.ok(outline);
    const back = await change(page, () => page.keyboard.press("Control+z"));
    assert.doesNotMatch(back.text, /MoveCorner/);
    await page.keyboard.press("Control+s");
    await page.context().close();
});

test("the tabs are walked by arrow keys", async () => {
    await first.getByRole("tab", { name: "Body and fabric" }).focus();
    await first.keyboard.press("ArrowRight");
    await first.getByRole("tab", { name: "Stages", selected: true }).waitFor();
    await first.keyboard.press("End");
    await first.getByRole("tab", { name: "Files", selected: true }).waitFor();
    await first.keyboard.press("Home");
});

test("axe finds nothing serious, light and dark, wide and narrow", async () => {
    for (const options of [{}, { colorScheme: "dark" }, { viewport: { width: 400, height: 800 } }]) {
        const page = await studio.open(options);
        for (const name of TABS) {
            await page.getByRole("tab", { name }).click();
            await page.waitForTimeout(100);
            assert.deepEqual(await findings(page), [], `${name} ${JSON.stringify(options)}`);
        }
        quiet(page);
        await page.context().close();
    }
});

test("axe finds nothing serious where a project begins", async () => {
    const empty = await serve();
    const page = await empty.open({ wait: false });
    await page.getByRole("button", { name: "Vest" }).waitFor();
    assert.deepEqual(await findings(page), []);
    await page.context().close();
});

test("the page stands within a second, and asks only the program", async () => {
    const page = await studio.open({ wait: false });
    const took = await page.evaluate(
        () => performance.getEntriesByType("navigation")[0].domContentLoadedEventEnd,
    );
    assert.ok(took < 1000, `${took} ms`);
    await page.getByRole("tab", { name: "Stages" }).waitFor();
    assert.ok((await stateOf(page)).project.file);
    quiet(page);
    await page.context().close();
});
