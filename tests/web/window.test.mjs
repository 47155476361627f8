// The window that slices begin with.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { closeBrowser, missing, open, quick, sample } from "./page.mjs";

after(closeBrowser);

for (const name of ["mri-brain.nii.gz", "mri-head.nii.gz"])
  test(`slices of ${name} show white matter brightly, and below white`, { skip: missing(name) }, async (t) => {
    const viewer = await open(t, [sample(name), ...quick]);
    const { page } = viewer;
    await viewer.done();
    await page.keyboard.press("s");
    const axial = page.getByRole("application", { name: /^Axial slice/ });
    await axial.waitFor();
    /** Shares of the painted pixels at least that bright. */
    const shares = () =>
      axial.locator("canvas").evaluate((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const greys = Array.from({ length: data.length / 4 }, (_, i) => (data[4 * i + 3] ? data[4 * i] : 0)).filter((grey) => grey > 10);
        const share = (least) => greys.filter((grey) => grey >= least).length / greys.length;
        return greys.length > 1000 ? { white: share(250), bright: share(140) } : null;
      });
    let seen = null;
    for (let tries = 0; !seen; ++tries) {
      assert.ok(tries < 100, "the slice is never painted");
      await page.waitForTimeout(50);
      seen = await shares();
    }
    assert.ok(seen.white < 0.02, `${100 * seen.white} % are white`);
    assert.ok(seen.bright > 0.25, `${100 * seen.bright} % are bright`);
    assert.equal(await page.getByRole("button", { name: "Automatic" }).getAttribute("aria-pressed"), "true");
  });
