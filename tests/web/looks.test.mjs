// What could be taken for something else: rings that are covered, handles in one place, numbers that are cut off.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, headCt, open, quick, writeRamp } from "./page.mjs";

after(closeBrowser);

test("a slice that has the focus has a whole ring, and long numbers are seen whole", async (t) => {
  const viewer = await open(t, (folder) => [writeRamp(join(folder, "ramp.nrrd")), ...quick]);
  const { page } = viewer;
  await viewer.done();
  assert.equal(await page.getByRole("heading", { level: 1 }).count(), 1);
  await page.keyboard.press("s");
  const axial = page.getByRole("application", { name: /^Axial slice/ });
  await axial.waitFor();
  await viewer.done();
  for (const label of ["Window", "Level"]) {
    const field = page.getByRole("textbox", { name: label, exact: true });
    for (const [typed, shown] of [["4.99961234e31", "4.9996e+31"], ["0.00012", "0.00012"], ["12", "12"]]) {
      await page.getByRole("textbox", { name: "Window", exact: true }).fill("0.00012");
      await page.keyboard.press("Enter");
      await field.fill(typed);
      await field.press("Enter");
      assert.equal(await field.inputValue(), shown);
      const [whole, seen] = await field.evaluate((input) => [input.scrollWidth, input.clientWidth]);
      assert.ok(whole <= seen, `${label} ${typed}: ${seen} of ${whole} px are seen`);
    }
  }
  const box = await axial.boundingBox();
  const edge = (y) => page.screenshot({ clip: { x: box.x + box.width / 2 + 20, y, width: 40, height: 2 } });
  const edges = async () => [await edge(box.y), await edge(box.y + box.height - 2)];
  const plain = await edges();
  await axial.focus();
  await page.keyboard.press("Shift");
  const ringed = await edges();
  for (const [i, side] of ["top", "bottom"].entries()) assert.ok(!plain[i].equals(ringed[i]), `no ring at the ${side}`);
});

test("no preset is chosen of a curve that was changed", async (t) => {
  const viewer = await open(t, [headCt, "--preset", "ct-bone", ...quick]);
  const { page } = viewer;
  await viewer.done();
  await viewer.panel("Transfer function");
  const preset = page.getByRole("radio", { name: "ct-bone" });
  await preset.and(page.locator("[aria-checked=true]")).waitFor();
  const before = await viewer.scene();
  await viewer.button("Add a point").click();
  await preset.and(page.locator("[aria-checked=false]")).waitFor();
  await viewer.sceneWith((s) => !s.transfer.preset && s.transfer.points.length === before.transfer.points.length + 1, "a curve of its own");
  await viewer.undo();
  await preset.and(page.locator("[aria-checked=true]")).waitFor();
  assert.deepEqual((await viewer.scene()).transfer, before.transfer);
});

test("faces of the clip box that lie behind one another have their own handles", async (t) => {
  const viewer = await open(t, (folder) => [writeRamp(join(folder, "ramp.nrrd")), ...quick]);
  const { page } = viewer;
  await viewer.done();
  await page.keyboard.press("1");
  await page.keyboard.press("c");
  const handle = (name) => page.getByRole("slider", { name: `Clip from the ${name}` }).locator(".knob");
  await handle("front").waitFor();
  await viewer.done();
  const place = async (name) => {
    const box = await handle(name).boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  const [front, back] = [await place("front"), await place("back")];
  assert.ok(Math.hypot(front[0] - back[0], front[1] - back[1]) > 30, `${front} and ${back}`);
  // Upward is away from the eye: into the box for the front, out of it for the back.
  await viewer.drag([0, -60], { from: front });
  const cut = await viewer.sceneWith((s) => (s.clip?.y_mm?.[0] ?? null) !== null, "a front that is cut off");
  assert.ok(cut.clip.y_mm[0] > 1 && (cut.clip.y_mm[1] ?? null) === null, `${cut.clip.y_mm}`);
  await viewer.drag([0, 60], { from: await place("back") });
  await viewer.sceneWith((s) => (s.clip?.y_mm?.[1] ?? null) !== null, "a back that is cut off");
});
