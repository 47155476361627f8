// What a page keeps of each volume: distances, and where its slices are.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, test } from "node:test";
import { violations } from "./checks.mjs";
import { closeBrowser, open, quick, writeRamp, writeWaves } from "./page.mjs";

after(closeBrowser);

/** The page with slices of the ramp, and what they show. */
async function openRamp(t) {
  const viewer = await open(t, (folder) => [writeRamp(join(folder, "ramp.nrrd")), ...quick]);
  const { page } = viewer;
  await viewer.done();
  await page.keyboard.press("s");
  const axial = page.getByRole("application", { name: /^Axial slice/ });
  await axial.waitFor();
  await viewer.done();
  const level = page.getByRole("textbox", { name: "Level", exact: true });
  const lengths = axial.locator(".measurement .tag-text");
  return {
    viewer,
    page,
    level,
    lengths,
    voice: page.getByRole("status", { name: "Measuring" }),
    place: () => page.locator(".slice-position").innerText(),
    shows: (name) => page.waitForFunction((n) => document.title.startsWith(n), name),
    async measure(dx) {
      const box = await axial.boundingBox();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
      const before = await lengths.count();
      await page.mouse.click(x - dx / 2, y + dx);
      await this.voice.filter({ hasText: /^First end at/ }).waitFor();
      await page.mouse.click(x + dx / 2, y + dx);
      await lengths.nth(before).waitFor();
    },
    async clickAxial(dx, dy) {
      const box = await axial.boundingBox();
      await page.mouse.click(box.x + box.width / 2 + dx, box.y + box.height / 2 + dy);
    },
    /** Until that many distances are in the axial slice; then their lengths. */
    async measured(count) {
      for (let tries = 0; (await lengths.count()) !== count; ++tries) {
        assert.ok(tries < 100, `${await lengths.count()} distances, not ${count}`);
        await page.waitForTimeout(30);
      }
      return lengths.allTextContents();
    },
  };
}

test("a page that is reloaded has its distances, crosshair and window; another volume has its own", async (t) => {
  const slices = await openRamp(t);
  const { page, viewer, level } = slices;
  const middle = await slices.place();
  await slices.clickAxial(24, 10);
  await page.waitForFunction((text) => document.querySelector(".slice-position").innerText !== text, middle);
  await level.fill("1234");
  await level.press("Enter");
  await page.getByRole("application", { name: /^Axial slice/ }).focus();
  await page.keyboard.press("m");
  await slices.measure(40);
  await slices.measure(60);
  const [place, lengths] = [await slices.place(), await slices.measured(2)];

  await page.reload();
  await viewer.done();
  assert.deepEqual(await slices.measured(2), lengths);
  assert.equal(await slices.place(), place);
  assert.equal(await level.inputValue(), "1234");
  // The new ones are further ones.
  await page.keyboard.press("m");
  await slices.measure(20);
  await slices.measured(3);
  await page.keyboard.press("m");

  await page.keyboard.press("Control+o");
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), viewer.button("files").click()]);
  await chooser.setFiles(writeWaves(join(viewer.scratch, "waves.nrrd")));
  await slices.shows("waves.nrrd");
  await slices.measured(0);
  assert.notEqual(await slices.place(), place);
  assert.notEqual(await level.inputValue(), "1234");
  await page.keyboard.press("Control+o");
  await page.getByRole("button", { name: /^ramp\.nrrd/ }).click();
  await slices.shows("ramp.nrrd");
  assert.deepEqual((await slices.measured(3)).slice(0, 2), lengths);
  assert.equal(await slices.place(), place);
  assert.equal(await level.inputValue(), "1234");
});

test("distances that were deleted come back", async (t) => {
  const slices = await openRamp(t);
  const { page, viewer, voice } = slices;
  await page.keyboard.press("m");
  await slices.measure(40);
  await slices.measure(60);
  const lengths = await slices.measured(2);
  await viewer.button("Delete all").click();
  await slices.measured(0);
  const all = page.locator(".toast", { hasText: "2 distances deleted" });
  assert.deepEqual(await violations(page), []);
  await slices.measure(20);
  await all.getByRole("button", { name: "Undo" }).click();
  assert.deepEqual((await slices.measured(3)).slice(0, 2), lengths);
  // One by one, with the keys.
  await page.keyboard.press("Delete");
  await page.keyboard.press("Delete");
  assert.deepEqual(await slices.measured(1), lengths.slice(0, 1));
  await page.locator(".toast", { hasText: `Distance of ${lengths[1]} deleted` }).getByRole("button", { name: "Undo" }).click();
  assert.deepEqual(await slices.measured(2), lengths);
  assert.equal(await voice.innerText(), "", "a deleted distance is told twice");
});
