// Keyframes, and films of them.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, headCt, open, psnr, quick, readFileSync } from "./page.mjs";

after(closeBrowser);

/** Names and bytes of a zip file's entries, which are stored as they are. */
function storedFiles(zip) {
  const out = [];
  let at = zip.readUInt32LE(zip.lastIndexOf(Buffer.from("PK\x05\x06", "latin1")) + 16);
  for (; zip.readUInt32LE(at) === 0x02014b50; at += 46 + zip.readUInt16LE(at + 28) + zip.readUInt16LE(at + 30) + zip.readUInt16LE(at + 32)) {
    const local = zip.readUInt32LE(at + 42), bytes = zip.readUInt32LE(at + 24);
    assert.equal(zip.readUInt16LE(at + 10), 0, "an entry is compressed");
    const begin = local + 30 + zip.readUInt16LE(local + 26) + zip.readUInt16LE(local + 28);
    out.push({ name: zip.toString("utf8", at + 46, at + 46 + zip.readUInt16LE(at + 28)), data: zip.subarray(begin, begin + bytes) });
  }
  return out;
}

test("keyframes of two views are shown between, and exported as pictures", async (t) => {
  const viewer = await open(t, [headCt, ...quick], { size: [1280, 560], resolution: 0.25 });
  await viewer.done();
  await viewer.panel("Animation");
  await viewer.done();
  assert.ok(await viewer.button("Export").isDisabled(), "a film of what stands still");
  const front = await viewer.shown("front.png");
  await viewer.button("Keyframe").click();
  await viewer.sceneWith((s) => s.animation?.tracks?.length > 0, "a keyframe");
  await viewer.page.keyboard.press("3");
  const side = await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  await viewer.done();
  const left = await viewer.shown("left.png");
  await viewer.button("Keyframe").click();
  const keys = (s) => s.animation.tracks.find((track) => track.field === "/camera/azimuth_deg").keys;
  const two = await viewer.sceneWith((s) => keys(s).length === 2, "two keyframes");
  assert.deepEqual(keys(two).map(([, azimuth]) => Math.round(azimuth)), [0, 90]);

  // Nearer by keys and by the mouse; a drag is one step.
  const second = viewer.page.getByRole("button", { name: /^Keyframe at/ }).nth(1);
  const box = await second.boundingBox();
  await viewer.drag([-60, 0], { from: [box.x + box.width / 2, box.y + box.height / 2] });
  await viewer.sceneWith((s) => keys(s)[1][0] < keys(two)[1][0], "the second keyframe earlier");
  await viewer.undo();
  await viewer.sceneWith((s) => keys(s)[1][0] === keys(two)[1][0], "the second keyframe where it was, in one step");
  const fps = viewer.page.getByRole("textbox", { name: "Frames a second [fps]" });
  await fps.fill("2");
  await fps.press("Enter");
  const slow = await viewer.sceneWith((s) => s.animation.fps === 2, "2 frames a second");
  await viewer.done();

  const time = viewer.page.getByRole("slider", { name: "Time" });
  await viewer.newPicture(() => time.press("ArrowLeft"));
  const between = await viewer.shown("between.png");
  for (const end of [front, left]) assert.ok(psnr(between, end) < 35, "between is as at an end");
  for (let step = 0; step < 3; ++step) await viewer.newPicture(() => time.press("ArrowLeft"));
  assert.ok(psnr(await viewer.shown("start.png"), front) > 25, "does not begin with the first view");
  assert.deepEqual((await viewer.scene()).camera, side.camera, "the preview changes the scene");
  await viewer.newPicture(() => viewer.button("Show the scene as it is").click());
  assert.ok(psnr(await viewer.shown("after.png"), left) > 45, "not the scene again");

  await viewer.page.getByLabel("Format").selectOption("zip");
  await viewer.button("Export").click();
  const save = viewer.page.getByRole("link", { name: /^Save .*\.zip/ });
  await save.waitFor({ timeout: 60000 });
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), save.click()]);
  const file = join(viewer.scratch, "frames.zip");
  await download.saveAs(file);
  const frames = storedFiles(readFileSync(file));
  const expected = Math.round(keys(slow)[1][0] * 2);
  assert.ok([expected, expected + 1].includes(frames.length), `${frames.length} pictures of ${expected}`);
  const { image } = await viewer.scene();
  for (const { name, data } of frames) {
    assert.match(name, /-\d{4}\.png$/);
    assert.equal(data.toString("latin1", 1, 4), "PNG");
    assert.deepEqual([data.readUInt32BE(16), data.readUInt32BE(20)], [image.width, image.height]);
  }
  const [first, last] = [frames[0], frames.at(-1)].map(({ name, data }) => {
    writeFileSync(join(viewer.scratch, name), data);
    return join(viewer.scratch, name);
  });
  assert.ok(psnr(first, last) < 30, "the camera stands still");
});

test("a film that takes long can be given up", async (t) => {
  const viewer = await open(t, [headCt, "--spp", "2000", "--denoise", "none", "--turntable"], { resolution: 0.5 });
  await viewer.panel("Animation");
  await viewer.page.getByLabel("Format").selectOption("zip");
  await viewer.button("Export").click();
  await viewer.page.getByRole("progressbar", { name: "Writing the animation" }).waitFor();
  await viewer.button("Cancel").click();
  await viewer.button("Export").waitFor();
  assert.equal(await viewer.page.getByRole("link", { name: /^Save / }).count(), 0);
});
