// Lengths and places of volumes of all sizes: microscopy, and whole landscapes.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, open, quick, writeBallOf } from "./page.mjs";

after(closeBrowser);

for (const { name, voxel_mm, unit, unit_mm } of [
  { name: "0.1 µm", voxel_mm: 1e-4, unit: "µm", unit_mm: 1e-3 },
  { name: "100 m", voxel_mm: 1e5, unit: "m", unit_mm: 1e3 },
]) {
  test(`a volume of voxels of ${name} is read, measured and clipped to parts of a voxel`, async (t) => {
    const viewer = await open(t, (folder) => {
      const file = join(folder, "ball.json");
      const points = [{ value: 90, opacity: 0, color: "#ffffff" }, { value: 110, opacity: 0.999, color: "#ffffff" }];
      writeFileSync(file, JSON.stringify({ version: 1, volume: { path: writeBallOf(join(folder, "ball.nrrd"), voxel_mm) }, transfer: { points }, camera: { projection: "orthographic" } }));
      return [file, ...quick];
    });
    const { page } = viewer;
    await viewer.done();
    await page.keyboard.press("s");
    const axial = page.getByRole("application", { name: /^Axial slice/ });
    await axial.waitFor();
    await viewer.done();
    const box = await axial.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const voxel = voxel_mm / unit_mm;
    const number = (text) => Number(text.match(/[\d.]+/)[0]);
    const readout = axial.locator(".slice-readout");
    assert.match(await readout.innerText(), new RegExp(`^S [\\d.]+ ${unit}$`));
    assert.ok(Math.abs(number(await readout.innerText()) - 23.5 * voxel) < voxel / 3);

    // What the pane shows is 48 voxels high or wide.
    const [px] = [Math.min(box.width, box.height) / 48];
    await page.keyboard.press("m");
    await page.mouse.move(x - 10 * px, y);
    const position = page.locator(".status-bar .position");
    await position.filter({ hasText: new RegExp(`${unit}$`) }).waitFor();
    assert.ok(Math.abs(number(await position.innerText()) - 13.5 * voxel) < voxel / 3, await position.innerText());
    await page.mouse.click(x - 10 * px, y);
    await page.getByRole("status", { name: "Measuring" }).filter({ hasText: /^First end at/ }).waitFor();
    await page.mouse.click(x + 10 * px, y);
    const length = axial.locator(".measurement .tag-text");
    await length.waitFor();
    assert.match(await length.textContent(), new RegExp(` ${unit}$`));
    assert.ok(Math.abs(number(await length.textContent()) - 20 * voxel) < voxel / 3, await length.textContent());
    await page.keyboard.press("m");
    assert.equal(await page.locator(".toast").count(), 0, await page.locator(".toast").allInnerTexts());

    // Fields have mm, as the scene.
    await viewer.panel("Clip box");
    await page.getByRole("switch", { name: "Cut the volume" }).check();
    await viewer.sceneWith((s) => s.clip, "a clip box");
    const left = page.getByRole("textbox", { name: "Left [mm]" });
    const text = (mm) => mm.toLocaleString("en", { useGrouping: false, maximumFractionDigits: 6 });
    await left.fill(text(30.25 * voxel_mm));
    await left.press("Enter");
    const is = (mm, wanted) => Math.abs(mm - wanted) < 1e-6 * wanted;
    await viewer.sceneWith((s) => is(s.clip.x_mm[1], 30.25 * voxel_mm), "the side that was typed");
    assert.ok(Math.abs(number(await left.inputValue()) - 30.25 * voxel_mm) < voxel_mm / 4, await left.inputValue());
    for (const name of ["Left", "Right", "Superior"]) {
      const field = page.getByRole("textbox", { name: `${name} [mm]` });
      const [whole, seen] = await field.evaluate((input) => [input.scrollWidth, input.clientWidth]);
      assert.ok(whole <= seen, `${name}: ${seen} of ${whole} px are seen`);
    }
    await left.press("ArrowDown");
    await viewer.sceneWith((s) => is(s.clip.x_mm[1], 29.25 * voxel_mm), "a side that is a voxel less");
    // Up to its other side, and no farther.
    await left.fill("0");
    await left.press("Enter");
    const closed = await viewer.sceneWith((s) => s.clip.x_mm[1] < 29 * voxel_mm, "a side nearer to the other");
    assert.ok(closed.clip.x_mm[1] < 0.1 * voxel_mm, `${closed.clip.x_mm}`);
  });
}
