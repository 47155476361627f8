// For everybody: names of controls, contrast, and room at 1280 x 720, in every state of the page and in both themes.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { openFull, overflowing, panelTitles, troubles, violations } from "./checks.mjs";
import { closeBrowser } from "./page.mjs";

after(closeBrowser);

for (const scheme of ["dark", "light"])
  test(`everything has names, contrast and room (${scheme})`, async (t) => {
    const viewer = await openFull(t, { scheme });
    const { page } = viewer;
    const brightness = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/[\d.]+/g).slice(0, 3).reduce((sum, c) => sum + Number(c), 0));
    assert.equal(brightness > 382, scheme === "light", `the page's background is ${brightness}`);
    const titles = await panelTitles(page);
    assert.ok(titles.length >= 9, `panels: ${titles}`);
    assert.deepEqual(await troubles(viewer, [overflowing, violations]), []);
  });
