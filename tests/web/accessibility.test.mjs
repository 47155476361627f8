// For everybody: names of controls, contrast, and room at 1280 x 720, with each panel open in both themes.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { overflowing, violations } from "./checks.mjs";
import { axeSource, closeBrowser, headCt, open, quick, sample, samples } from "./page.mjs";

after(closeBrowser);

// With a volume of labels where there is one, so that their panel has something to show.
const labels = sample("aal.nii.gz") ? ["--labels", sample("aal.nii.gz")] : [];
const volume = sample("mri-brain.nii.gz") ?? headCt;

for (const scheme of ["dark", "light"])
  test(`every panel has names, contrast and room (${scheme})`, async (t) => {
    const viewer = await open(t, [volume, ...labels, ...quick, "--turntable"], { scheme, folder: sample("aal.nii.gz") ? samples : undefined });
    const { page } = viewer;
    await viewer.done();
    await page.evaluate(axeSource);
    const brightness = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/[\d.]+/g).slice(0, 3).reduce((sum, c) => sum + Number(c), 0));
    assert.equal(brightness > 382, scheme === "light", `the page's background is ${brightness}`);
    const found = new Set();
    const check = async (where) => {
      for (const what of [...(await overflowing(page)), ...(await violations(page))]) found.add(`${where}: ${what}`);
    };
    await check("no panel");
    const titles = await page.getByLabel("Panels", { exact: true }).getByRole("button").evaluateAll((buttons) => buttons.map((b) => b.getAttribute("aria-label")));
    assert.ok(titles.length >= 9, `panels: ${titles}`);
    for (const title of titles) {
      await viewer.panel(title);
      if (title === "Labels" && labels.length) await viewer.button("Edit single labels").click();
      await page.getByRole("complementary", { name: title }).waitFor();
      const folded = page.locator(".dock :not(.label-row) > [aria-expanded=false]");
      while (await folded.count()) await folded.first().click();
      // Of labels one is open at a time.
      if (await page.locator(".label-row").count()) await page.locator(".label-row .name").first().click();
      await check(title);
      await viewer.panel(title);
    }
    await page.keyboard.press("s");
    await page.getByRole("toolbar", { name: "Slices" }).waitFor();
    await viewer.panel("Transfer function");
    await check("slices");
    await page.keyboard.press("Control+o");
    await page.getByRole("dialog", { name: "Open" }).waitFor();
    await check("the dialog that opens files");
    await page.keyboard.press("Escape");
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Keys and gestures" }).waitFor();
    await check("help");
    assert.deepEqual([...found], []);
  });
