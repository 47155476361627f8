// Keyframes, and films of them.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { chmodSync, mkdirSync, writeFileSync } from "node:fs";
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

test("movies are offered where ffmpeg is, and said to need it elsewhere", async (t) => {
  const without = await open(t, [headCt, ...quick, "--turntable"], { environment: { PATH: "/nowhere" } });
  await without.done();
  await without.panel("Animation");
  const format = (viewer) => viewer.page.getByLabel("Format");
  assert.equal(await format(without).inputValue(), "zip");
  const options = await format(without).locator("option").evaluateAll((all) => all.map((one) => `${one.disabled} ${one.textContent}`));
  assert.deepEqual(options, ["true mp4: install ffmpeg", "true webm: install ffmpeg", "false PNG (zip)"]);
  assert.match(await format(without).getAttribute("title"), /install ffmpeg/);

  // An ffmpeg that makes a file of the words it was given.
  const bin = join(without.scratch, "bin");
  mkdirSync(bin);
  writeFileSync(join(bin, "ffmpeg"), '#!/bin/sh\nfor last; do :; done\nfor word; do echo "$word"; done > "$last"\n');
  chmodSync(join(bin, "ffmpeg"), 0o755);
  const viewer = await open(t, [headCt, ...quick, "--turntable", "0.2"], { environment: { PATH: `${bin}:/usr/bin:/bin` }, resolution: 0.25 });
  await viewer.done();
  await viewer.panel("Animation");
  assert.equal(await format(viewer).inputValue(), "mp4");
  for (const [kind, coder] of [["mp4", "libx264"], ["webm", "libvpx-vp9"]]) {
    await format(viewer).selectOption(kind);
    await viewer.button("Export").click();
    const save = viewer.page.getByRole("link", { name: new RegExp(`^Save .*\\.${kind}$`) });
    await save.waitFor({ timeout: 60000 });
    const [download] = await Promise.all([viewer.page.waitForEvent("download"), save.click()]);
    await download.saveAs(join(viewer.scratch, kind));
    assert.match(readFileSync(join(viewer.scratch, kind), "utf8"), new RegExp(coder));
  }
});

const noFfmpeg = spawnSync("ffprobe", ["-version"]).status === 0 ? false : "without ffmpeg";

test("movies have all frames, and the browser plays them", { skip: noFfmpeg }, async (t) => {
  // Sides that are odd: colors at half the resolution need even ones.
  const viewer = await open(t, [headCt, ...quick, "--turntable", "1", "--fps", "12"], { resolution: 0.25, size: [1283, 721] });
  await viewer.done();
  await viewer.panel("Animation");
  await viewer.done();
  const { image } = await viewer.scene();
  for (const [kind, codec] of [["mp4", "h264"], ["webm", "vp9"]]) {
    await viewer.page.getByLabel("Format").selectOption(kind);
    await viewer.button("Export").click();
    const save = viewer.page.getByRole("link", { name: new RegExp(`^Save .*\\.${kind}$`) });
    await save.waitFor({ timeout: 60000 });
    const [download] = await Promise.all([viewer.page.waitForEvent("download"), save.click()]);
    const file = join(viewer.scratch, `film.${kind}`);
    await download.saveAs(file);
    const { streams, format } = JSON.parse(execFileSync("ffprobe", ["-v", "error", "-count_frames", "-show_streams", "-show_format", "-of", "json", file], { encoding: "utf8" }));
    const [video] = streams;
    assert.equal(streams.length, 1);
    assert.equal(video.codec_name, codec);
    assert.equal(Number(video.nb_read_frames), 12);
    assert.deepEqual([video.width, video.height], [image.width, image.height].map((side) => 2 * Math.floor(side / 2)));
    assert.equal(video.pix_fmt, "yuv420p");
    assert.deepEqual([video.color_space, video.color_primaries, video.color_transfer, video.color_range], ["bt709", "bt709", "bt709", "tv"]);
    assert.equal(video.avg_frame_rate, "12/1");
    assert.ok(Math.abs(Number(format.duration) - 1) < 0.01, `${format.duration} s`);
    const frames = join(viewer.scratch, `${kind}-%d.png`);
    execFileSync("ffmpeg", ["-v", "error", "-i", file, frames]);
    assert.ok(psnr(frames.replace("%d", "1"), frames.replace("%d", "7")) < 30, "the camera stands still");
    const player = await viewer.page.context().newPage();
    const played = await player.evaluate(async (source) => {
      const video = document.createElement("video");
      const ended = new Promise((resolve) => {
        video.onended = () => resolve("played");
        video.onerror = () => resolve(video.error.message);
      });
      video.muted = true;
      video.src = source;
      await video.play().catch(() => undefined);
      return [await ended, video.videoWidth, video.videoHeight];
    }, `data:video/${kind};base64,${readFileSync(file).toString("base64")}`);
    await player.close();
    assert.deepEqual(played, ["played", video.width, video.height]);
  }
});

test("a turntable beside keyframes of the camera says so and offers a way out", async (t) => {
  const viewer = await open(t, [headCt, ...quick], { resolution: 0.25 });
  await viewer.done();
  await viewer.panel("Animation");
  await viewer.button("Keyframe").click();
  await viewer.page.keyboard.press("3");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  await viewer.button("Keyframe").click();
  await viewer.sceneWith((s) => s.animation?.tracks?.[0]?.keys.length === 2, "two keyframes");
  const note = viewer.page.getByText(/turns the camera in addition/);
  assert.equal(await note.count(), 0);
  await viewer.button("Turntable: once around in 6 s").click();
  await note.waitFor();
  await viewer.button("Remove the turntable").first().click();
  const keyframes = await viewer.sceneWith((s) => !s.animation.turntable, "no turntable");
  assert.equal(keyframes.animation.tracks[0].keys.length, 2);
  await viewer.undo();
  await note.waitFor();
  await viewer.button("Replace the keyframes").click();
  await viewer.sceneWith((s) => s.animation.turntable && !s.animation.tracks?.length, "the turntable alone");
  await note.waitFor({ state: "detached" });
});
