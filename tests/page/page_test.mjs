// The live page in a real browser, of a real run: a fault is begun and stopped by hand, and the fix goes and comes back.
// Ends with 77 where node, Chromium or playwright-core is missing. Pictures are kept in $SKYLOOP_PICTURES.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { LiveRun } from "./live_run.mjs";
import { fixIs, keep, laptop, noOverflow, phone, pictures } from "./looks.mjs";
import { correctionsAreShown, nothingOfCorrections } from "./rtk_steps.mjs";

const skipped = 77;
const whole = 385_000; // ms, all of it
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const chromium = process.env.SKYLOOP_CHROMIUM;

function skip(why) {
    console.log(`page/live is skipped: ${why}`);
    process.exit(skipped);
}

/** playwright-core, from the build folder; fetched there when it is not. */
function browserControl() {
    const folder = process.env.SKYLOOP_NODE_FOLDER;
    fs.mkdirSync(folder, { recursive: true });
    fs.copyFileSync(path.join(here, "package.json"), path.join(folder, "package.json"));
    const load = () => createRequire(path.join(folder, "package.json"))("playwright-core");
    const wanted = JSON.parse(fs.readFileSync(path.join(here, "package.json"), "utf8")).dependencies["playwright-core"];
    const manifest = path.join(folder, "node_modules/playwright-core/package.json");
    if (fs.existsSync(manifest) && JSON.parse(fs.readFileSync(manifest, "utf8")).version === wanted) return load();
    const quiet = ["--no-audit", "--no-fund", "--no-package-lock", "--ignore-scripts"];
    const npm = spawnSync("npm", ["install", ...quiet], { cwd: folder, timeout: 90_000, encoding: "utf8" });
    if (npm.status !== 0) skip(`npm cannot install playwright-core ${wanted}: ${npm.stderr ?? npm.error}`);
    return load();
}

// What the run shows before anything is done to it.
async function everythingIsThere(page) {
    assert.match(await fixIs(page, "fix"), /3D|DGNSS|RTK/);
    const told = (id) => page.locator(id).innerText();
    assert.match(await told("#error-more"), /^claims [\d.]+ m, HDOP\s[\d.]+$/);
    assert.match(await told("#height-more"), /^claims [\d.]+ m, VDOP\s[\d.]+$/);
    assert.match(await told("#sky-dop"), /^PDOP [\d.]+$/);
    // The run begins at 09:00:00 UTC on a Sunday, and GPS counts 18 leap seconds more.
    const [, week, timeOfWeek] = /^GPS week (\d+), TOW (\d+) s$/.exec(await told("#gps-now"));
    assert.equal(week, "2408");
    assert.ok(timeOfWeek >= 32418 && timeOfWeek < 32418 + 900, `a time of week of ${timeOfWeek} s`);
    assert.ok((await page.locator("#sky .sat").count()) >= 6, "satellites in the sky");
    assert.ok((await page.locator("#bars rect").count()) >= 6, "bars of C/N0");
    assert.ok((await page.locator("#sky .sat-blocked, #sky .sat-reflected").count()) >= 1, "a city hides something");
    await page.locator("#timeline .row", { hasText: "lossy cable" }).waitFor();
    await page.locator("#wires", { hasText: "client connected" }).waitFor();
    const inked = (id) => page.evaluate((name) => {
        const canvas = document.getElementById(name);
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return new Set(new Uint32Array(data.buffer)).size;
    }, id);
    assert.ok((await inked("track")) > 3, "the map is drawn");
    assert.ok((await inked("errors")) > 3, "the errors are drawn");
    await page.waitForFunction(() => Number(document.getElementById("deviation-count").textContent) >= 10);
    assert.ok((await inked("deviation")) > 3, "the deviation is drawn");
    assert.ok((await inked("states")) > 3, "the states are drawn");
    assert.match(await page.locator("#states").getAttribute("aria-label"), /^States of \d+ satellites over time$/);
    await noOverflow(page, laptop.width);
}

// Five errors of which quantiles and means are known, and what the run shows.
async function deviationIsTold(page) {
    const figures = await page.evaluate(async () => {
        const { deviationFigures } = await import("/deviation.js");
        return deviationFigures([[3, 4], [0, 1], [-2, 0], [0, -3], [4, 0]].map(([east, north]) => ({ east, north })));
    });
    const rounded = Object.fromEntries(Object.entries(figures).map(([name, value]) => [name, Number(value.toFixed(9))]));
    assert.deepEqual(rounded, { count: 5, cep50: 3, cep95: 4.8, largest: 5, east: 1, north: 0.4 });
    const label = await page.locator("#deviation").getAttribute("aria-label");
    assert.match(label, /^Deviation: \d+ fixes, CEP 50 % [\d.]+ k?m, 95 % [\d.]+ k?m$/);
    for (const id of ["cep50", "cep95", "largest", "east", "north"])
        assert.match(await page.locator(`#deviation-${id}`).innerText(), /^−?\d.* k?m$/);
    assert.match(await page.locator("#deviation-ring").innerText(), /^a ring each [\d.]+ k?m$/);
}

// Snapshots of one epoch are one position; those without a position are none.
async function historyTakesEpochsOnce(page) {
    const times = await page.evaluate(async () => {
        const { History } = await import("/history.js");
        const history = new History();
        const add = (time, epoch, error) => history.add(time, { truth: {}, fix: { ok: true }, satellites: [], epoch_s: epoch, error });
        const error = { east_m: 1, north_m: 2, up_m: 3 };
        add(0.2, 0, error);
        add(0.4, 0, error);
        add(1.0, 1, null);
        add(2.0, 2, error);
        add(2.2, 2, error);
        return [history.positions(0), history.positions(1)].map((list) => list.map((sample) => sample.time));
    });
    assert.deepEqual(times, [[0.2, 2], [2]]);
}

// A state goes on until another begins, or until nothing is seen of the satellite.
async function historyJoinsStates(page) {
    const stretches = await page.evaluate(async () => {
        const { History } = await import("/history.js");
        const history = new History();
        const seen = [[0, "line_of_sight", true], [1, "line_of_sight", true], [2, "shadowed", true], [3, "shadowed", false],
            [9, "shadowed", false]];
        for (const [time, state, used] of seen)
            history.add(time, { truth: {}, fix: { ok: true }, satellites: [{ id: "G01", state, used }] });
        return history.states.get("G01").map(({ from, to, state, used }) => [from, to, state, used]);
    });
    assert.deepEqual(stretches, [[0, 2, "line_of_sight", true], [2, 3, "shadowed", true], [3, 3, "shadowed", false],
        [9, 9, "shadowed", false]]);
}

function messageRow(page, name, from) {
    return page.locator(`#message-rows .from-${from}`, { has: page.locator("th", { hasText: new RegExp(`^${name}$`) }) });
}

// What a receiver at 5 Hz says of itself, as far as its wire carries it, and the poll that its client sends once a second.
async function messagesAreCounted(page) {
    const number = async (row, index) => Number(await row.locator(".number").nth(index).innerText());
    const between = (name, from, least, most) => page.waitForFunction((wanted) =>
        [...document.querySelectorAll(`#message-rows .from-${wanted.from}`)].some((row) => {
            const rate = Number(row.lastElementChild.textContent);
            return row.querySelector("th").textContent === wanted.name && rate >= wanted.least && rate <= wanted.most;
        }), { name, from, least, most });
    await between("GGA", "receiver", 1, 5.5);
    await between("MON-VER", "client", 0.5, 1.5);
    const sentences = messageRow(page, "GGA", "receiver");
    const before = await number(sentences, 0);
    await page.waitForTimeout(1500);
    assert.ok((await number(sentences, 0)) > before, "it goes on counting");
    assert.ok(await messageRow(page, "MON-VER", "receiver").isVisible(), "the answers have a row of their own");
}

async function dialogueIsFiltered(page) {
    await page.locator("#dialogue-from").selectOption("client");
    await page.locator("#dialogue .from-client", { hasText: "MON-VER" }).first().waitFor();
    // The list is drawn with the next frame.
    await page.waitForFunction(() => !document.querySelector("#dialogue .from-receiver"));
    await page.locator("#dialogue-from").selectOption("");
    await page.locator("#dialogue-text").fill("mon-ver");
    const answer = page.locator("#dialogue .from-receiver", { hasText: "MON-VER" }).first();
    await answer.waitFor();
    const bytes = answer.locator("code", { hasText: "b5620a04" });
    // A newer answer may take the place of the first one while it is opened.
    for (let tries = 0; tries < 20 && !(await bytes.isVisible()); ++tries) {
        await answer.locator("summary").click();
        await page.waitForTimeout(200);
    }
    await bytes.waitFor();
    await page.locator("#dialogue-text").fill("");
}

async function clickedFaultTakesTheFix(page) {
    await page.locator('#fault-kinds [data-kind="outage"]').click();
    await keep(page, "form");
    await page.locator("#fault-begin").click();
    await page.locator("#ask-yes").waitFor();
    await keep(page, "question");
    // A no is a no.
    await page.keyboard.press("Escape");
    await page.locator("#ask").waitFor({ state: "hidden" });
    assert.equal(await page.locator("#active li").count(), 0);
    await page.locator("#fault-begin").click();
    await page.locator("#ask-yes").click();
    await page.locator("#active li", { hasText: "outage" }).waitFor();
    assert.equal(await fixIs(page, "nofix"), "NO FIX");
    await page.locator("#timeline .row[data-state=active]", { hasText: "outage" }).waitFor();
    await page.locator("#events", { hasText: "fault begins" }).waitFor();
    await page.evaluate(() => scrollTo(0, 0));
    await keep(page, "no_fix");
    await page.locator("#active button", { hasText: "Stop" }).click();
    await fixIs(page, "fix");
    await page.locator("#active li").first().waitFor({ state: "detached" });
    await keep(page, "back");
    await page.evaluate(() => scrollTo(0, 0));
    await keep(page, "laptop", { fullPage: true });
}

function verdict(page, name) {
    return page.locator("#verdicts li", { hasText: name });
}

// Before anything has been done to the fix.
async function verdictsStand(page) {
    await page.locator("#verdict-panel").waitFor();
    await verdict(page, "a fix at the start").locator(".badge", { hasText: "passed" }).waitFor();
    await verdict(page, "no gap").locator(".badge", { hasText: "pending" }).waitFor();
    assert.match(await verdict(page, "a fix at the start").locator(".evidence").innerText(), /came true/);
    assert.equal(await page.locator("#verdict-count").innerText(), "2 pending, 1 passed");
}

// An outage after the first half minute has broken one of them for good; the evidence is told.
async function verdictsFall(page) {
    await page.waitForFunction(() => document.getElementById("verdict-count").textContent.includes("failed"), null,
        { timeout: 60_000 });
    await verdict(page, "no gap").locator(".badge", { hasText: "failed" }).waitFor();
    assert.match(await verdict(page, "no gap").locator(".evidence").innerText(), /did not hold/);
    await page.evaluate(() => document.activeElement?.blur());
    await page.keyboard.press("v");
    assert.equal(await page.evaluate(() => document.activeElement.id), "verdicts");
    await page.evaluate(() => document.getElementById("verdict-panel").scrollIntoView({ behavior: "instant", block: "center" }));
    await keep(page, "verdicts");
}

function percents(text) {
    return Number(/(\d+) %/.exec(text)?.[1] ?? NaN);
}

// A fault that grows slowly and fades: a number, a bar in the row, a level beside its name.
async function rampsShowTheirStrength(page) {
    const told = await page.evaluate(async () => (await fetch("/api/faults", {
        method: "POST", headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ kind: "cn0_drop", name: "icing", attenuation_db: 6, ramp_in_s: 30, ramp_out_s: 8 }),
    })).status);
    assert.equal(told, 202);
    const row = page.locator("#timeline .row", { hasText: "icing" });
    const state = row.locator(".row-state", { hasText: /^active, \d+ %$/ });
    await state.waitFor();
    const first = percents(await state.innerText());
    await page.locator("#active li", { hasText: "icing" }).locator("meter").waitFor();
    await page.waitForFunction((least) => {
        const text = document.querySelector('#active li[data-fault="icing"] .active-told')?.textContent ?? "";
        return Number(/(\d+) %/.exec(text)?.[1]) >= least;
    }, first + 10);
    assert.equal(await row.locator("rect.level").count(), 1);
    await page.evaluate(() => scrollTo(0, 0));
    await keep(page, "ramp");
    await page.locator("#active li", { hasText: "icing" }).locator("button").click();
    await row.locator(".row-state", { hasText: /^fading, \d+ %$/ }).waitFor();
    await row.locator(".row-state", { hasText: /^over$/ }).waitFor();
    await page.locator("#active li").first().waitFor({ state: "detached" });
}

// No mouse: a fault is found, filled in, begun and stopped; time is stopped and goes on.
async function keyboardIsEnough(page) {
    const keys = page.keyboard;
    await page.locator("body").focus();
    await page.evaluate(() => document.activeElement?.blur());
    await keys.press("/");
    await keys.type("no version");
    await keys.press("Enter");
    await keys.type("twelve");
    await keys.press("Enter");
    await page.locator("#fault-fields .mistake", { hasText: "no number" }).waitFor();
    await keys.press("ControlOrMeta+a");
    await keys.type("60");
    await keys.press("Enter");
    assert.match(await page.locator("#ask-text").innerText(), /for_s = 60/);
    await keys.press("Enter");
    await page.locator("#active li", { hasText: "no version" }).waitFor();
    await page.evaluate(() => document.activeElement?.blur());
    await keys.press("x");
    await page.locator("#active li").first().waitFor({ state: "detached" });
    await keys.press("Space");
    await page.locator('#pace[data-paused="true"]').waitFor();
    const before = await page.locator("#now").innerText();
    await keys.press("s");
    // While it steps it is not paused; afterwards it is again.
    const another = (text) => document.getElementById("now").textContent !== text;
    await page.waitForFunction(another, before);
    await page.waitForTimeout(2000);
    await page.locator('#pace[data-paused="true"]').waitFor();
    const stepped = await page.locator("#now").innerText();
    await page.waitForTimeout(1500);
    assert.equal(await page.locator("#now").innerText(), stepped, "one step, and no more");
    await keys.press("Space");
    await page.waitForTimeout(2500);
    assert.equal(await page.locator("#pace").getAttribute("data-paused"), "false");
    assert.notEqual(await page.locator("#now").innerText(), stepped);
}

async function darkIsDark(browser, url) {
    const page = await browser.newPage({ viewport: laptop, colorScheme: "dark" });
    await page.goto(url);
    await fixIs(page, "fix");
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
    assert.ok(Math.max(...(await ground())) < 60, "a dark ground");
    await page.waitForTimeout(3000);
    await keep(page, "dark");
    await page.evaluate(() => document.getElementById("verdict-panel").scrollIntoView({ behavior: "instant", block: "center" }));
    await keep(page, "dark_verdicts");
    await page.locator("#scheme").click(); // chosen by hand: light
    assert.ok(Math.min(...(await ground())) > 200, "a light ground");
    await page.close();
}

async function phoneFits(browser, url) {
    const page = await browser.newPage({ viewport: phone, deviceScaleFactor: 2, hasTouch: true, isMobile: true });
    await page.goto(url);
    await fixIs(page, "fix");
    await noOverflow(page, phone.width);
    for (const panel of ["deviation-panel", "message-panel"]) {
        const box = await page.locator(`#${panel}`).boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= phone.width, `${panel} fits`);
    }
    await keep(page, "phone");
    await page.locator("#nav-verdicts").tap();
    await page.waitForTimeout(800); // it scrolls smoothly
    assert.ok((await page.locator("#verdict-panel").boundingBox()).y < phone.height, "the verdicts are in sight");
    await keep(page, "phone_verdicts");
    await page.locator("#nav-faults").tap();
    await page.locator("#fault-kinds summary", { hasText: "Signals" }).tap();
    for (const target of await page.locator("#fault-kinds button:visible, nav button").all()) {
        const box = await target.boundingBox();
        assert.ok(box.height >= 40, `a touch target of ${box.height} px`);
    }
    await page.locator('#fault-kinds [data-kind="jamming"]').tap();
    await noOverflow(page, phone.width);
    assert.ok(await page.locator("#fix").isVisible(), "the state stays in sight");
    await keep(page, "phone_form");
    await page.close();
}

// The program ends: the page says so, instead of showing the past as if it were now.
async function endIsTold(page, run) {
    await page.locator("#stop-run").click();
    await page.locator("#ask-yes").click();
    await run.ended;
    await page.locator("#lost", { hasText: "ended or cannot be reached" }).waitFor();
}

async function test(browser, run) {
    const mistakes = [];
    const page = await browser.newPage({ viewport: laptop, colorScheme: "light" });
    page.setDefaultTimeout(20_000);
    page.on("pageerror", (error) => mistakes.push(String(error)));
    page.on("console", (message) => message.type() === "error" && mistakes.push(message.text()));
    page.on("request", (request) =>
        request.url().startsWith(run.url) || request.url().startsWith("blob:") || mistakes.push(`foreign: ${request.url()}`));
    await page.goto(run.url);
    await everythingIsThere(page);
    await nothingOfCorrections(page);
    await deviationIsTold(page);
    await historyTakesEpochsOnce(page);
    await historyJoinsStates(page);
    await messagesAreCounted(page);
    await dialogueIsFiltered(page);
    await verdictsStand(page);
    await page.waitForFunction(() => /:3[1-9]|:[45]/.test(document.getElementById("timeline-now").textContent), null,
        { timeout: 60_000 });
    await clickedFaultTakesTheFix(page);
    await verdictsFall(page);
    await rampsShowTheirStrength(page);
    await keyboardIsEnough(page);
    await darkIsDark(browser, run.url);
    await phoneFits(browser, run.url);
    assert.deepEqual(mistakes, []);
    await endIsTold(page, run);
    await page.close();
}

// Another run, of a base and its rover, at five times the speed.
async function testCorrections(browser) {
    const run = new LiveRun(process.env.SKYLOOP, path.join(here, "rtk_page.toml"), 5);
    try {
        await run.begin();
        await correctionsAreShown(browser, run.url);
    } catch (error) {
        console.error(`the program said: ${run.log}`);
        throw error;
    } finally {
        await run.end();
    }
}

if (!chromium || !fs.existsSync(chromium)) skip("there is no Chromium; apt-get install chromium");
const { chromium: driver } = browserControl();
fs.mkdirSync(pictures, { recursive: true });
const run = new LiveRun(process.env.SKYLOOP, path.join(here, "live_page.toml"));
let browser = null;
const bound = setTimeout(async () => {
    console.error("page/live takes too long");
    await browser?.close();
    await LiveRun.endAll();
    process.exit(1);
}, whole);
try {
    await run.begin();
    browser = await driver.launch({
        executablePath: chromium,
        args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
            "--disable-component-update", "--disable-sync"],
    });
    await test(browser, run);
    await testCorrections(browser);
    console.log(`page/live: passed; pictures in ${pictures}`);
} catch (error) {
    console.error(error);
    console.error(`the program said: ${run.log}`);
    for (const context of browser?.contexts() ?? [])
        for (const page of context.pages()) await keep(page, "failed").catch(() => {});
    process.exitCode = 1;
} finally {
    clearTimeout(bound);
    await browser?.close();
    await run.end();
}
