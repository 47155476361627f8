// Tools over the picture: reading values, measuring, turning, touching.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { violations } from "./checks.mjs";
import { closeBrowser, headCt, open, psnr, quick, writeBall } from "./page.mjs";

after(closeBrowser);

/** A ball of 40 mm, opaque and seen from the front by parallel rays: what is where is known. */
async function openBall(t, options) {
  const scene = (folder) => {
    const volume = { path: writeBall(join(folder, "ball.nrrd")) };
    const transfer = { points: [{ value: 90, opacity: 0, color: "#ffffff" }, { value: 110, opacity: 0.999, color: "#ffffff" }] };
    const file = join(folder, "ball.json");
    writeFileSync(file, JSON.stringify({ version: 1, volume, transfer, camera: { projection: "orthographic" } }));
    return [file, ...quick];
  };
  const viewer = await open(t, scene, options);
  await viewer.done();
  return viewer;
}

const center_mm = 23.5, radius_mm = 20;

/** CSS px of 1 mm of a picture by parallel rays. */
async function pxPerMm(viewer) {
  const { camera } = await viewer.header();
  assert.ok(camera.orthographic);
  const { height } = await viewer.canvas.boundingBox();
  return height / (2 * camera.half_height);
}

/** The place on the page [CSS px] of a point by parallel rays from the front: x toward the patient's left, z up. */
async function placeOf(viewer, x_mm, z_mm) {
  const [box, scale, { camera }] = [await viewer.canvas.boundingBox(), await pxPerMm(viewer), await viewer.header()];
  return [box.x + box.width / 2 + (x_mm - camera.eye_mm[0]) * scale, box.y + box.height / 2 - (z_mm - camera.eye_mm[2]) * scale];
}

test("reads value and position under the pointer", async (t) => {
  const viewer = await openBall(t);
  await viewer.page.mouse.move(...(await placeOf(viewer, center_mm + 10, center_mm - 5)));
  const position = viewer.page.locator(".status-bar .position");
  await position.waitFor();
  const [x, y, z] = (await position.innerText()).match(/-?[\d.]+/g).map(Number);
  // One pixel of the page is 0.1 mm or so, the ball's border half a voxel.
  const front = center_mm - Math.sqrt(radius_mm ** 2 - 10 ** 2 - 5 ** 2);
  assert.ok(Math.abs(x - (center_mm + 10)) < 0.5 && Math.abs(z - (center_mm - 5)) < 0.5, `${x} ${z}`);
  assert.ok(Math.abs(y - front) < 1, `${y}, not ${front}`);
  assert.match(await position.innerText(), /^L [\d.]+\s+P [\d.]+\s+S [\d.]+ mm$/);
  const value = Number((await viewer.page.locator(".status-bar .value").innerText()).match(/[\d.]+/)[0]);
  assert.ok(value > 80 && value <= 200, `the surface's value is ${value}`);
  // Beside the ball there is nothing to read.
  await viewer.page.mouse.move(...(await placeOf(viewer, center_mm + 23, center_mm)));
  await position.waitFor({ state: "detached" });
});

test("what is read is under the pointer, also when it rests and the picture moves", async (t) => {
  const viewer = await openBall(t);
  const { page } = viewer;
  const position = page.locator(".status-bar .position");
  await page.mouse.move(...(await placeOf(viewer, center_mm + 10, center_mm)));
  await position.waitFor();
  const read = async () => (await position.innerText()).match(/-?[\d.]+/g).map(Number);
  const until = async (pred, what) => {
    for (let tries = 0; ; ++tries) {
      const at = await read();
      if (pred(at)) return at;
      assert.ok(tries < 200, `${what}: ${at}`);
      await page.waitForTimeout(30);
    }
  };
  const depth = Math.sqrt(radius_mm ** 2 - 10 ** 2);
  await until(([x, y]) => Math.abs(x - center_mm - 10) < 0.5 && Math.abs(y - center_mm + depth) < 1, "not on the front");
  await page.keyboard.press("2");
  await until(([x, y]) => Math.abs(x - center_mm + 10) < 0.5 && Math.abs(y - center_mm - depth) < 1, "not on the back");
  await page.mouse.wheel(0, -400);
  await until(([x]) => x > center_mm - 9 && x < center_mm - 2, "not nearer to the middle");
  // A drag ends where the pointer then rests.
  const [x, y] = await placeOf(viewer, center_mm, center_mm);
  await viewer.drag([60, 0], { from: [x, y] });
  await position.waitFor();
});

test("measures a distance that is known, and its end can be moved", async (t) => {
  const viewer = await openBall(t);
  await viewer.page.keyboard.press("m");
  await viewer.page.getByText("Click two points").waitFor();
  const click = async (x, z) => viewer.page.mouse.click(...(await placeOf(viewer, x, z)));
  const lengths = viewer.page.locator(".measurement .tag-text");
  // 39 of the ball's 40 mm: at its very rim a click would miss. A click is off by half a pixel at most (0.1 mm), and
  // the voxels of both ends are off alike in depth, where a millimetre lengthens by less than 0.02 mm.
  await click(center_mm - 19.5, center_mm);
  await viewer.page.locator(".measurements > .dot").first().waitFor();
  await click(center_mm + 19.5, center_mm);
  await lengths.waitFor();
  const first = parseFloat(await lengths.textContent());
  assert.ok(Math.abs(first - 39) <= 0.3, `${first} mm`);
  // Its second end to the middle of the front.
  const from = await placeOf(viewer, center_mm + 19.5, center_mm);
  const scale = await pxPerMm(viewer);
  await viewer.drag([-19.5 * scale, 0], { from });
  const along = Math.hypot(19.5, Math.sqrt(radius_mm ** 2 - 0) - Math.sqrt(radius_mm ** 2 - 19.5 ** 2));
  await viewer.page.waitForFunction((mm) => Math.abs(parseFloat(document.querySelector(".measurement .tag-text").textContent) - mm) <= 1, along);
  const scene = await viewer.scene();
  await viewer.page.getByRole("button", { name: /^Delete the distance/ }).click();
  await lengths.waitFor({ state: "detached" });
  await viewer.page.mouse.click(...(await placeOf(viewer, center_mm + 23, center_mm)));
  await viewer.page.getByText("Nothing there to measure").waitFor();
  await viewer.button("Done").click();
  await viewer.page.getByText("Click two points").waitFor({ state: "detached" });
  assert.deepEqual((await viewer.scene()).camera, scene.camera, "measuring has moved the camera");
});

test("a click at the end of a distance leaves it, and begins another where distances are measured", async (t) => {
  const viewer = await openBall(t);
  const { page } = viewer;
  const voice = page.getByRole("status", { name: "Measuring" });
  const first = voice.filter({ hasText: /^First end at/ });
  await page.keyboard.press("m");
  await page.mouse.click(...(await placeOf(viewer, center_mm - 10, center_mm)));
  await first.waitFor();
  await page.mouse.click(...(await placeOf(viewer, center_mm + 10, center_mm)));
  const length = page.locator(".measurement .tag-text");
  await length.waitFor();
  const [second, beside] = [page.getByRole("button", { name: /^Second end of the distance/ }), 9];
  const place = () => second.evaluate((handle) => handle.getAttribute("transform").match(/[-\d.]+/g).map(Number));
  const [text, before] = [await length.textContent(), await place()];
  const box = await viewer.canvas.boundingBox();
  const [x, y] = [box.x + before[0] - beside, box.y + before[1]];
  await page.mouse.click(x, y);
  await first.waitFor();
  assert.deepEqual([await length.textContent(), await place()], [text, before], "the click has moved the end");
  await page.keyboard.press("Escape");
  await voice.filter({ hasText: "First end dropped" }).waitFor();
  await page.keyboard.press("Escape");
  await page.getByText("Click two points").waitFor({ state: "detached" });
  await page.mouse.click(x, y);
  await page.mouse.move(x + 1, y + 1);
  await page.waitForTimeout(300);
  assert.deepEqual([await length.textContent(), await place()], [text, before], "the click has moved the end");
  assert.equal(await page.locator(".measurements > .dot").count(), 0, "a distance is begun");
  // Taken beside its middle, it still goes as far as the pointer.
  await viewer.drag([-50, 20], { from: [x, y] });
  await page.waitForFunction(([left, top]) => {
    const at = document.querySelectorAll(".measurement .end")[1].getAttribute("transform").match(/[-\d.]+/g);
    return Math.hypot(at[0] - left, at[1] - top) < 0.5;
  }, [before[0] - 50, before[1] + 20]);
});

test("the ends of a distance are moved by keys, and it is deleted from them", async (t) => {
  const viewer = await openBall(t);
  const { page } = viewer;
  const { camera } = await viewer.scene();
  const voice = page.getByRole("status", { name: "Measuring" });
  await page.keyboard.press("m");
  await page.mouse.click(...(await placeOf(viewer, center_mm - 10, center_mm)));
  await voice.filter({ hasText: /^First end at/ }).waitFor();
  await page.mouse.click(...(await placeOf(viewer, center_mm + 10, center_mm)));
  const [first, second] = ["First", "Second"].map((name) => page.getByRole("button", { name: new RegExp(`^${name} end of the distance of [\\d.]+ mm$`) }));
  await second.waitFor();
  await page.keyboard.press("Escape");
  const length = async () => parseFloat(await page.locator(".measurement .tag-text").textContent());
  const place = (end) => end.evaluate((handle) => handle.getAttribute("transform").match(/[-\d.]+/g).map(Number));
  const until = async (end, wanted) => {
    for (let tries = 0; ; ++tries) {
      const at = await place(end);
      if (Math.hypot(at[0] - wanted[0], at[1] - wanted[1]) < 0.2) return;
      assert.ok(tries < 100, `the end is at ${at}, not ${wanted}`);
      await page.waitForTimeout(30);
    }
  };
  assert.deepEqual(await violations(page), []);
  // Reached by the Tab key like everything.
  await page.getByRole("application", { name: /^View of the volume/ }).focus();
  for (let stops = 0; !(await second.evaluate((end) => end === document.activeElement)); ++stops) {
    assert.ok(stops < 12, "the Tab key does not come to the end");
    await page.keyboard.press("Tab");
  }
  const ring = await second.locator(".reach").evaluate((reach) => getComputedStyle(reach).stroke);
  assert.notEqual(ring, "none", "no ring of focus");
  const [[x, y], before] = [await place(second), await length()];
  const still = await place(first);
  for (let i = 0; i < 12; ++i) await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Shift+ArrowDown");
  await until(second, [x - 12, y + 10]);
  for (let i = 0; i < 12; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowUp");
  await until(second, [x, y]);
  assert.ok(Math.abs((await length()) - before) < 0.15, `${await length()} mm, was ${before}`);
  for (let i = 0; i < 3; ++i) await page.keyboard.press("Shift+ArrowLeft");
  await until(second, [x - 30, y]);
  assert.deepEqual(await place(first), still);
  await voice.filter({ hasText: (await page.locator(".measurement .tag-text").textContent()) }).waitFor();
  assert.ok((await length()) < before - 1);
  // Beside the ball it stays where it was.
  for (let i = 0; i < 60; ++i) await page.keyboard.press("Shift+ArrowRight");
  await voice.filter({ hasText: "Nothing there" }).waitFor();
  assert.ok((await length()) > before);
  assert.deepEqual((await viewer.scene()).camera, camera, "the keys have moved the camera");
  await page.keyboard.press("Delete");
  await page.locator(".measurement").waitFor({ state: "detached" });
  await page.getByRole("status").filter({ hasText: /Distance of [\d.]+ mm deleted/ }).waitFor();
  assert.match(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), /^View of the volume/, "the focus is lost");
});

test("keys alone measure a distance, whose length is told", async (t) => {
  const viewer = await openBall(t);
  const { page } = viewer;
  const view = page.getByRole("application", { name: /^View of the volume/ });
  const voice = page.getByRole("status", { name: "Measuring" });
  const { camera } = await viewer.scene();
  await view.focus();
  await page.keyboard.press("m");
  assert.match(await view.getAttribute("aria-label"), /Arrow keys move the cursor/);
  const far = async (key, times) => {
    for (let i = 0; i < times; ++i) await page.keyboard.press(`Shift+${key}`);
  };
  // From the ball's middle 100 px to the left.
  await far("ArrowLeft", 10);
  await page.locator(".view .key-cursor").waitFor();
  await voice.filter({ hasText: /^[LR] [\d.]+\s+[AP] [\d.]+\s+[SI] [\d.]+ mm$/ }).waitFor();
  await page.keyboard.press("Enter");
  await voice.filter({ hasText: /^First end at [LR] [\d.]+/ }).waitFor();
  await far("ArrowRight", 20);
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
  // What the line that is begun would have is told before its second end is set.
  await voice.filter({ hasText: /^[\d.]+ mm$/ }).waitFor();
  await page.keyboard.press("Enter");
  await voice.filter({ hasText: /^Distance [\d.]+ mm$/ }).waitFor();
  const length = parseFloat((await voice.innerText()).match(/[\d.]+/)[0]);
  assert.equal(await page.locator(".measurement .tag-text").textContent(), `${length.toFixed(1)} mm`);
  // The ends are 205 px apart on the screen, one 5 px deeper in the ball's curve than the other.
  const across = 205 / (await pxPerMm(viewer));
  assert.ok(length >= across - 0.3 && length <= across + 0.5, `${length} mm, not ${across}`);

  await far("ArrowUp", 2);
  await page.keyboard.press("Enter");
  await voice.filter({ hasText: /^First end at/ }).waitFor();
  await page.keyboard.press("Escape");
  await voice.filter({ hasText: "First end dropped" }).waitFor();
  await page.keyboard.press("Delete");
  await page.locator(".measurement").waitFor({ state: "detached" });
  await page.keyboard.press("Escape");
  await page.getByText("Click two points").waitFor({ state: "detached" });
  await page.locator(".key-cursor").waitFor({ state: "detached" });
  assert.deepEqual((await viewer.scene()).camera, camera, "the keys have moved the camera");
  await page.keyboard.press("ArrowLeft");
  await viewer.sceneWith((s) => s.camera.azimuth_deg !== camera.azimuth_deg, "the arrow keys orbiting again");
  // From the button in the toolbar, too, the keys are the picture's.
  await viewer.page.getByRole("button", { name: "Measure distances" }).focus();
  await page.keyboard.press("Enter");
  await page.keyboard.press("ArrowLeft");
  await page.locator(".view .key-cursor").waitFor();
});

test("the scale bar is as long as it says", async (t) => {
  const viewer = await openBall(t, { resolution: 1 });
  const mmOf = (label) => parseFloat(label) * { mm: 1, cm: 10, m: 1000, "µm": 0.001 }[label.split(" ")[1]];
  const bar = async () => {
    const [label, path] = [await viewer.page.locator(".scale-bar text").textContent(), await viewer.page.locator(".scale-bar path").last().getAttribute("d")];
    return Number(path.match(/h([\d.]+)/)[1]) / mmOf(label);
  };
  // The ball itself is the ruler: its 40 mm against the pixels that are not background.
  const seen = await viewer.canvas.evaluate((canvas) => {
    const row = canvas.getContext("2d").getImageData(0, Math.floor(canvas.height / 2), canvas.width, 1).data;
    const background = row.slice(0, 3);
    const differs = (i) => [0, 1, 2].some((c) => Math.abs(row[4 * i + c] - background[c]) > 24);
    const inside = Array.from({ length: canvas.width }, (_, i) => i).filter(differs);
    return ((inside.at(-1) - inside[0] + 1) * canvas.clientWidth) / canvas.width;
  });
  const parallel = await bar();
  assert.ok(Math.abs(seen / parallel - 40) < 1.2, `the ball has ${seen} px, and 1 mm has ${parallel}`);
  await viewer.page.mouse.move(...(await placeOf(viewer, center_mm, center_mm)));
  await viewer.page.mouse.wheel(0, 400);
  await viewer.sceneWith((s) => s.camera.zoom < 1, "a smaller zoom");
  await viewer.done();
  const smaller = await bar();
  assert.ok(Math.abs(smaller / parallel - (await viewer.scene()).camera.zoom) < 0.01, "the bar does not follow the zoom");
  // A change to perspective keeps what is at the target.
  await viewer.page.keyboard.press("o");
  await viewer.sceneWith((s) => s.camera.projection !== "orthographic", "perspective");
  await viewer.done();
  assert.ok(Math.abs((await bar()) / smaller - 1) < 0.01);
});

test("a click on the orientation cube looks at that side, a drag orbits", async (t) => {
  const viewer = await open(t, [headCt, ...quick, "--camera", "35,30"]);
  await viewer.done();
  const face = async (letter) => {
    const box = await viewer.page.locator(".cube-face", { hasText: letter }).boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  await viewer.drag([12, 0], { from: await face("A") });
  const dragged = await viewer.sceneWith((s) => s.camera.azimuth_deg !== 35, "another azimuth");
  assert.equal(dragged.camera.elevation_deg, 30);
  await viewer.undo();
  await viewer.sceneWith((s) => s.camera.azimuth_deg === 35, "the first azimuth again");
  await viewer.done();
  await viewer.page.mouse.click(...(await face("L")));
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6 && Math.abs(s.camera.elevation_deg) < 1e-6, "the view from the left");
  await viewer.undo();
  await viewer.sceneWith((s) => s.camera.azimuth_deg === 35 && s.camera.elevation_deg === 30, "the first view again, in one step");
  await viewer.done();
  await viewer.page.mouse.click(...(await face("S")));
  await viewer.sceneWith((s) => Math.abs(s.camera.elevation_deg - 90) < 1e-6, "the view from above");
});

test("one finger orbits, two zoom, move and roll, each one step of undo", async (t) => {
  const viewer = await open(t, [headCt, ...quick], { touch: true });
  await viewer.done();
  const { camera } = await viewer.scene();
  const box = await viewer.canvas.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const devtools = await viewer.page.context().newCDPSession(viewer.page);
  const send = (type, points) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  const touch = async (paths) => {
    const at = (s) => paths.map(([from, to]) => [from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])]);
    await send("touchStart", at(0));
    for (let i = 1; i <= 10; ++i) await send("touchMove", at(i / 10));
    await send("touchEnd", []);
  };
  const undone = async () => {
    await viewer.undo();
    await viewer.sceneWith((s) => JSON.stringify(s.camera) === JSON.stringify(camera), "the first camera again, in one step");
  };
  await touch([[[x, y], [x + 100, y + 30]]]);
  const orbited = await viewer.sceneWith((s) => s.camera.azimuth_deg !== camera.azimuth_deg, "another azimuth");
  assert.equal(orbited.camera.zoom, camera.zoom);
  await undone();
  // 120 px apart, then 240: twice as near.
  await touch([[[x - 60, y], [x - 120, y]], [[x + 60, y], [x + 120, y]]]);
  const zoomed = await viewer.sceneWith((s) => s.camera.zoom > 1.9, "twice the zoom");
  assert.ok(Math.abs(zoomed.camera.zoom / camera.zoom - 2) < 0.1, `zoom ${zoomed.camera.zoom}`);
  assert.equal(zoomed.camera.azimuth_deg, camera.azimuth_deg);
  await undone();
  // Both to the right: the picture moves along.
  await touch([[[x - 60, y], [x + 20, y]], [[x + 60, y], [x + 140, y]]]);
  const moved = await viewer.sceneWith((s) => s.camera.target_mm[0] < camera.target_mm[0] - 5, "a target further right");
  assert.ok(Math.abs(moved.camera.zoom / camera.zoom - 1) < 0.05);
  await undone();
});

test("the split between traced and denoised picture moves", async (t) => {
  const viewer = await open(t, [headCt, "--spp", "2"]);
  await viewer.done();
  await viewer.page.keyboard.press("d");
  const split = viewer.page.getByRole("slider", { name: "Split between traced and denoised picture" });
  await split.waitFor();
  await viewer.newPicture(async () => split.press("ArrowLeft"));
  const half = await viewer.shown("half.png");
  const box = await split.locator(".knob").boundingBox();
  await viewer.newPicture(() => viewer.drag([200, 0], { from: [box.x + box.width / 2, box.y + box.height / 2] }));
  assert.ok(Number(await split.getAttribute("aria-valuenow")) > 60);
  assert.ok(psnr(half, await viewer.shown("moved.png")) < 60, "the picture is the same");
  await viewer.newPicture(() => viewer.page.keyboard.press("Escape"));
  await split.waitFor({ state: "detached" });
});
