// A program that serves a copy of a sample, and a browser that looks at it.
//
//     const studio = await serve("vest.ron");
//     const page = await studio.open();
//     const after = await change(page, () => page.getByRole("button", { name: "linen" }).click());
//
// What a page complained of, and where it asked for anything, is kept and judged by `quiet`.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { after } from "node:test";

const root = path.resolve(import.meta.dirname, "../..");
const tools = createRequire(path.join(process.env.STUDIO_TOOLS, "node_modules/"));
const { chromium, firefox } = tools("playwright-core");
const AXE = fs.readFileSync(tools.resolve("axe-core/axe.min.js"), "utf8");

/** How long a run of the vest may take on a machine that others use too, in milliseconds. */
export const RUN = 120_000;

/** What a sample needs beside its pipeline. */
const INPUTS = {
    "vest.ron": ["samples/vest"],
    "photo_vest.ron": ["samples/vest"],
    "pattern.ron": ["samples/pattern/shirt_specification.json"],
};

const ended = [];
after(async () => {
    for (const end of ended.reverse()) await end();
});

/** A folder with a copy of a pipeline as `pipeline.ron` and its inputs; an empty one without. Meshes are coarse. */
export function folderOf(pipeline) {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), "toile-studio-"));
    ended.push(() => fs.rmSync(folder, { recursive: true, force: true }));
    if (!pipeline) return folder;
    const text = fs.readFileSync(path.join(root, "pipelines", pipeline), "utf8");
    fs.writeFileSync(
        path.join(folder, "pipeline.ron"),
        text.replace(/Mesher\(edge: "1\d mm"\)/, 'Mesher(edge: "24 mm")'),
    );
    for (const input of INPUTS[pipeline]) {
        fs.cpSync(path.join(root, "pipelines", input), path.join(folder, input), { recursive: true });
    }
    return folder;
}

/** Starts `toile studio` on a folder. */
export async function serve(pipeline, { folder = folderOf(pipeline) } = {}) {
    const program = spawn(process.env.TOILE_BIN, ["studio", "--no-open", folder], {
        stdio: ["ignore", "pipe", "pipe"],
    });
    const gone = new Promise((resolve) => program.once("exit", resolve));
    ended.push(async () => {
        program.kill();
        await gone;
    });
    const address = await new Promise((resolve, reject) => {
        let said = "";
        const hear = (bytes) => {
            said += bytes;
            const found = /http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]+/.exec(said);
            if (found) resolve(found[0]);
        };
        program.stdout.on("data", hear);
        program.stderr.on("data", hear);
        program.once("exit", (code) => reject(new Error(`toile studio ended with ${code}: ${said}`)));
    });
    return {
        folder,
        address,
        pid: program.pid,
        open: (options) => open(options?.address ?? address, options),
        file: () => fs.readFileSync(path.join(folder, "pipeline.ron"), "utf8"),
        async end(signal) {
            program.kill(signal);
            await gone;
        },
    };
}

let browser = null;

const launchChromium = () =>
    chromium.launch({
        executablePath: process.env.CHROMIUM,
        args: [
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            // A camera that shows a test picture.
            "--use-fake-ui-for-media-stream",
            "--use-fake-device-for-media-stream",
        ],
    });

/** Firefox has 3D on a screen alone, which may be a virtual one. */
const launchFirefox = () =>
    firefox.launch({
        executablePath: process.env.FIREFOX,
        channel: "moz-firefox",
        headless: false,
        firefoxUserPrefs: {
            "webgl.force-enabled": true,
            // A camera that shows a test picture.
            "media.navigator.streams.fake": true,
            "media.navigator.permission.disabled": true,
        },
    });

/** Has the page's files come from a folder, not from the program. */
const fromDisk = (page, folder) =>
    page.route(
        (url) => /\.(js|css|json)$/.test(url.pathname) && fs.existsSync(path.join(folder, url.pathname)),
        (route) => route.fulfill({ path: path.join(folder, new URL(route.request().url()).pathname) }),
    );

/** Opens a page; `options` are those of Playwright's contexts. A garment is waited for, unless `wait` is false. */
async function open(address, { wait = true, context = null, address: _, ...options } = {}) {
    if (!browser) {
        browser = await (process.env.FIREFOX ? launchFirefox() : launchChromium());
        ended.push(() => browser.close());
    }
    const own =
        context ??
        (await browser.newContext({
            viewport: { width: 1280, height: 800 },
            locale: "en-GB",
            colorScheme: "light",
            reducedMotion: "reduce",
            ...options,
        }));
    const page = await own.newPage();
    page.setDefaultTimeout(20_000);
    const origin = new URL(address).origin;
    if (process.env.PAGE) await fromDisk(page, process.env.PAGE);
    page.told = { errors: [], outside: [] };
    page.on(
        "console",
        (message) =>
            message.type() === "error" &&
            page.told.errors.push(`${message.text()} ${message.location().url}`),
    );
    page.on("pageerror", (error) => page.told.errors.push(String(error)));
    page.on("request", (request) => {
        const url = request.url();
        if (!url.startsWith(origin) && !/^(blob|data):/.test(url)) page.told.outside.push(url);
    });
    await page.goto(address);
    if (wait) await settled(page);
    return page;
}

/** What the program has, as the page's own requests see it. */
export async function ask(page, request) {
    const answer = await page.request.get(new URL(`/api/${request}`, page.url()).href, { maxRetries: 3 });
    return answer.json();
}

export const stateOf = (page) => ask(page, "state");

/** Waits until something holds, which may take as long as a run. */
export async function until(what, holds, ms = RUN) {
    const end = Date.now() + ms;
    for (;;) {
        const found = await holds();
        if (found) return found;
        if (Date.now() > end) throw new Error(`${what}: not within ${ms / 1000} s`);
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
}

/** A run of results that are all known is over before one looks; so long after an edit no other comes, ms. */
const AT_ONCE = 2000;

/** Waits until a garment stands: the present file's draft is done, and the page shows it. */
export async function settled(page) {
    const state = await until("a garment", async () => {
        const now = await stateOf(page);
        const { run } = now;
        // The run that answers an edit begins a moment after it.
        const answers = run.number > (page.told.ranBefore ?? -1);
        if (!answers && Date.now() - page.told.editedAt < AT_ONCE) return false;
        if (run.state === "failed") assert.fail(`the run failed: ${run.error?.message}`);
        return (run.state === "done" || (run.kind === "full" && run.state === "running")) && now;
    });
    await page.waitForFunction(
        () => /\d/.test(document.querySelector("#garment canvas")?.getAttribute("aria-label") ?? ""),
        null,
        { timeout: RUN },
    );
    return state;
}

/** Waits until nothing runs any more: the draft and the full run that follows it. */
export const idle = (page) =>
    until(
        "the end of the runs",
        async () => {
            const { run } = await stateOf(page);
            return run.kind === "full" && run.state !== "running";
        },
        2 * RUN,
    );

/** Does what makes one edit, and waits until the program has it; gives the state after it. */
export async function change(page, act) {
    const before = (await stateOf(page)).project.edit;
    await act();
    const state = await until(
        "an edit",
        async () => {
            const now = await stateOf(page);
            return now.project.edit > before && now;
        },
        20_000,
    );
    // An edit stops the run before it: what has a higher number answers it.
    page.told.ranBefore = state.run.number;
    page.told.editedAt = Date.now();
    return state;
}

/** An edit that another page or program makes; a draft may have faults. */
export async function send(page, changes, { words = "by another", draft = false } = {}) {
    const { project } = await stateOf(page);
    const url = new URL("/api/edit", page.url()).href;
    const data = { edit: project.edit, words, changes, draft };
    const answer = await page.request.post(url, { data, headers: { Origin: new URL(url).origin } });
    assert.equal(answer.status(), 200, await answer.text());
}

/** The line that says what happened. */
export const said = (page, pattern, ms = RUN) =>
    page.waitForFunction(
        (source) => new RegExp(source).test(document.getElementById("status").textContent),
        pattern.source,
        { timeout: ms },
    );

/** No complaint of the browser, no request to anywhere else. */
export function quiet(page) {
    // What drives Firefox puts a style of its own into the page, which the page's policy refuses.
    const own = (error) => process.env.FIREFOX && error.includes("(style-src-elem)");
    assert.deepEqual(
        page.told.errors.filter((error) => !own(error)),
        [],
    );
    assert.deepEqual(page.told.outside, []);
}

/** Findings of axe-core that are serious or critical. */
export async function findings(page) {
    await page.evaluate(AXE);
    const { violations } = await page.evaluate(() =>
        globalThis.axe.run(document, { resultTypes: ["violations"] }),
    );
    return violations
        .filter(({ impact }) => ["serious", "critical"].includes(impact))
        .map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target.join(" ")).join(", ")}`);
}

/** Drags the middle of an element by so many pixels of the screen. */
export async function drag(page, locator, dx, dy) {
    const box = await locator.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx / 2, y + dy / 2);
    await page.mouse.move(x + dx, y + dy);
    await page.mouse.up();
}

/**
 * A line to the program that can be cut: what the browser sends goes through it with the program's own address, which
 * the program insists on.
 */
export async function cuttable(address) {
    const to = Number(new URL(address).port);
    const pipes = new Set();
    let open = true;
    const relay = net.createServer((from) => {
        if (!open) return from.destroy();
        const on = net.connect(to, "127.0.0.1");
        const names = [`127.0.0.1:${relay.address().port}`, `127.0.0.1:${to}`];
        from.on("data", (bytes) =>
            on.write(Buffer.from(bytes.toString("latin1").replaceAll(...names), "latin1")),
        );
        on.pipe(from);
        for (const [a, b] of [
            [from, on],
            [on, from],
        ]) {
            pipes.add(a);
            a.on("error", () => {});
            a.on("close", () => {
                pipes.delete(a);
                b.destroy();
            });
        }
        return undefined;
    });
    await new Promise((resolve) => relay.listen(0, "127.0.0.1", resolve));
    ended.push(() => relay.close());
    return {
        address: address.replace(`:${to}/`, `:${relay.address().port}/`),
        cut() {
            open = false;
            for (const pipe of pipes) pipe.destroy();
        },
        mend() {
            open = true;
        },
    };
}
