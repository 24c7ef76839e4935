// Looking at the page: its sizes, pictures of it, and what every part of the test asks.
import assert from "node:assert/strict";
import path from "node:path";

export const pictures = process.env.SKYLOOP_PICTURES;
export const laptop = { width: 1440, height: 900 };
export const phone = { width: 390, height: 844 };

export function keep(page, name, options = {}) {
    return page.screenshot({ path: path.join(pictures, `${name}.png`), ...options });
}

export async function fixIs(page, state) {
    await page.locator(`#fix[data-state="${state}"]`).waitFor({ timeout: 60_000 });
    return page.locator("#fix-word").innerText();
}

export async function noOverflow(page, width) {
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `wider than ${width} px`);
}
