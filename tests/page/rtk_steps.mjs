// What the page shows of a base and its rover: numbers, the kinds of solution over time, the base on the map.
import assert from "node:assert/strict";
import { fixIs, keep, laptop, noOverflow, phone } from "./looks.mjs";

const shown = (page, id) => page.locator(id).isVisible();
const told = (page, id) => page.locator(id).innerText();
const label = (page, id) => page.locator(id).getAttribute("aria-label");

/** No card, no legend and no word of them where none have come in. */
export async function nothingOfCorrections(page) {
    assert.equal(await page.locator(".of-corrections:visible").count(), 0);
    assert.equal(await label(page, "#errors"), "Error over time");
    assert.doesNotMatch(await label(page, "#track"), /base/);
}

function says(page, id, pattern) {
    return page.waitForFunction(([where, source]) => new RegExp(source).test(document.querySelector(where).textContent),
        [id, pattern], { timeout: 60_000 });
}

function labelSays(page, id, pattern) {
    return page.waitForFunction(([where, source]) =>
        new RegExp(source).test(document.querySelector(where).getAttribute("aria-label")), [id, pattern], { timeout: 20_000 });
}

async function fixWordFits(page) {
    const tooWide = await page.evaluate(() => {
        const tile = document.getElementById("fix");
        return tile.scrollWidth - tile.clientWidth;
    });
    assert.ok(tooWide <= 0, `the kind of fix is ${tooWide} px too wide`);
}

async function isFixed(page) {
    await says(page, "#fix-word", "^RTK FIXED$");
    await fixWordFits(page);
    await says(page, "#corrections-solution", "^RTK fixed$");
    assert.match(await told(page, "#corrections-age"), /^\d\.\d s$/);
    assert.match(await told(page, "#corrections-base"), /^\d+$/);
    assert.match(await told(page, "#corrections-length"), /^1[2-8]\d m$/);
    assert.match(await told(page, "#corrections-vector"), /^−?\d+\.\d{3}, −1[2-8]\d\.\d{3}, −?0\.0\d\d m$/);
    assert.match(await told(page, "#corrections-ratio"), /^>?[\d.]+$/);
    await labelSays(page, "#errors", "^Error over time; solution (.*, )?fixed from \\d:\\d\\d$");
    await noOverflow(page, laptop.width);
}

// At first beyond the edge; seen from farther away it is there.
async function baseIsOnTheMap(page) {
    const where = /^Track, truth against fix\. The base \d+ stands 1[2-8]\d m to the (north-|south-)?east(, beyond the edge)?\. /;
    const beyond = where.exec(await label(page, "#track"));
    assert.ok(beyond?.[2], await label(page, "#track"));
    await keep(page, "rtk_base_beyond", { clip: await page.locator("#track-panel").boundingBox() });
    for (let i = 0; i < 3; ++i) await page.locator("#track-out").click();
    await labelSays(page, "#track", "east\\. ");
    assert.match(await label(page, "#track"), where);
    await keep(page, "rtk_base", { clip: await page.locator("#track-panel").boundingBox() });
}

async function otherReceiverHasNone(page) {
    await page.locator("#receiver").selectOption({ label: "base" });
    await page.locator("#corrections").waitFor({ state: "hidden" });
    await page.waitForTimeout(400); // until it is drawn anew
    await nothingOfCorrections(page);
    await page.locator("#receiver").selectOption({ label: "rover" });
    await page.locator("#corrections").waitFor();
}

// Without the base the solution falls back step by step (corrections_test.py knows when), and comes back with it.
async function silenceIsSeen(page) {
    await says(page, "#corrections-solution", "^RTK float$");
    assert.equal(await told(page, "#corrections-ratio"), "–");
    await says(page, "#corrections-solution", "^DGNSS$");
    assert.match(await told(page, "#corrections-length"), /^1[2-8]\d m$/);
    await says(page, "#corrections-solution", "^not used$");
    for (const id of ["length", "vector", "ratio"]) assert.equal(await told(page, `#corrections-${id}`), "–");
    assert.equal(await page.locator("#corrections").getAttribute("data-state"), "warn");
    assert.match(await told(page, "#corrections-age"), /^[67]\d\.\d s$/);
    await keep(page, "rtk_not_used");
    await says(page, "#fix-word", "^RTK FIXED$");
    const fall = "fixed from ([\\d:]+), float from ([\\d:]+), DGNSS from ([\\d:]+), single from ([\\d:]+), .*fixed from ([\\d:]+)$";
    await labelSays(page, "#errors", fall);
    const seconds = (text) => text.split(":").reduce((sum, part) => 60 * sum + Number(part), 0);
    const [, float, differential, single, again] = new RegExp(fall).exec(await label(page, "#errors")).slice(1).map(seconds);
    assert.ok(Math.abs(differential - float - 15) <= 3, `DGNSS ${differential - float} s after float`);
    assert.ok(Math.abs(single - differential - 30) <= 3, `single ${single - differential} s after DGNSS`);
    assert.ok(again >= 225, `fixed again at ${again} s`);
}

async function looksOnOtherScreens(browser, url) {
    for (const [name, options] of [
        ["rtk_dark", { viewport: laptop, colorScheme: "dark" }],
        ["rtk_narrow", { viewport: { width: 1200, height: 900 }, colorScheme: "light" }],
        ["rtk_tablet", { viewport: { width: 820, height: 1100 }, colorScheme: "light" }],
        ["rtk_phone", { viewport: phone, deviceScaleFactor: 2, hasTouch: true, isMobile: true }],
    ]) {
        const page = await browser.newPage(options);
        await page.goto(url);
        await fixIs(page, "fix");
        assert.ok(await shown(page, "#corrections"));
        await page.waitForTimeout(4000);
        await noOverflow(page, options.viewport.width);
        await fixWordFits(page);
        await keep(page, name, { fullPage: name === "rtk_phone" });
        await page.close();
    }
}

/** @param url of a run of rtk_page.toml */
export async function correctionsAreShown(browser, url) {
    const mistakes = [];
    const page = await browser.newPage({ viewport: laptop, colorScheme: "light" });
    page.on("pageerror", (error) => mistakes.push(String(error)));
    await page.goto(url);
    await isFixed(page);
    await baseIsOnTheMap(page);
    await otherReceiverHasNone(page);
    await silenceIsSeen(page);
    await page.evaluate(() => scrollTo(0, 0));
    await keep(page, "rtk");
    await keep(page, "rtk_whole", { fullPage: true });
    await keep(page, "rtk_error", { clip: await page.locator("#error-panel").boundingBox(), fullPage: true });
    await page.close();
    await looksOnOtherScreens(browser, url);
    assert.deepEqual(mistakes, []);
}
