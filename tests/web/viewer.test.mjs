// The viewer from outside: the program, its server and its page in a browser without a screen.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, headCt, open, psnr, quick, readFileSync, writeBall } from "./page.mjs";

after(closeBrowser);

test("shows the picture that the render command makes", async (t) => {
  const viewer = await open(t, [headCt, ...quick], { resolution: 1 });
  await viewer.done();
  const shown = await viewer.shown("shown.png"), rendered = await viewer.rendered("rendered.png");
  const decibel = psnr(shown, rendered);
  assert.ok(decibel > 45, `${decibel} dB`);
});

test("denoises, and shows both sides of a split", async (t) => {
  const viewer = await open(t, [headCt, "--spp", "4"]);
  await viewer.done();
  const scene = await viewer.scene();
  assert.equal(scene.render.denoise, "decoupled");
  const denoised = await viewer.shown("denoised.png");
  await viewer.newPicture(() => viewer.button("Compare with the picture before the denoiser").click());
  const split = await viewer.shown("split.png");
  assert.ok(psnr(denoised, split) < 45, "the split shows nothing else");
  assert.ok(psnr(denoised, split) > 15, "the split shows another picture");
});

test("orbits, zooms, pans and undoes, by mouse and by keys", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  const first = await viewer.scene();
  const before = await viewer.shown("before.png");
  await viewer.drag([120, 40]);
  const orbited = await viewer.sceneWith((s) => s.camera.azimuth_deg !== first.camera.azimuth_deg, "another azimuth");
  assert.notEqual(orbited.camera.elevation_deg, first.camera.elevation_deg);
  await viewer.done();
  assert.ok(psnr(before, await viewer.shown("orbited.png")) < 25, "the picture is the same");
  await viewer.page.mouse.wheel(0, -300);
  const zoomed = await viewer.sceneWith((s) => s.camera.zoom > first.camera.zoom, "a larger zoom");
  await viewer.drag([50, 0], { button: "right" });
  await viewer.sceneWith((s) => JSON.stringify(s.camera.target_mm) !== JSON.stringify(zoomed.camera.target_mm), "another target");
  await viewer.page.keyboard.press("ArrowLeft");
  await viewer.sceneWith((s) => s.camera.azimuth_deg !== zoomed.camera.azimuth_deg, "an azimuth by keys");
  for (let i = 0; i < 20 && !(await viewer.button("Undo").isDisabled()); ++i) {
    await viewer.page.keyboard.press("Control+z");
    await viewer.done();
  }
  const undone = await viewer.sceneWith((s) => s.camera.azimuth_deg === first.camera.azimuth_deg, "the first azimuth again");
  assert.deepEqual(undone.camera, first.camera);
  await viewer.done();
  assert.ok(psnr(before, await viewer.shown("undone.png")) > 45, "not the first picture again");
});

test("views along the patient's axes name the sides", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  await viewer.page.getByRole("button", { name: /^Left: from/ }).click();
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  await viewer.done();
  // From the patient's left the face is on the left of the picture, the back of the head on its right.
  const letters = await viewer.page.locator(".edge-labels text").allTextContents();
  assert.deepEqual(letters.map((letter) => letter.trim()), ["P", "A", "S", "I"]);
});

test("presets and points of the transfer function change the picture", async (t) => {
  const viewer = await open(t, [headCt, "--preset", "ct-bone", ...quick]);
  await viewer.done();
  const bone = await viewer.shown("bone.png");
  const answers = [];
  viewer.page.on("response", (response) => response.url().includes("/api/preset/") && answers.push(response.status()));
  await viewer.panel("Transfer function");
  const first = await viewer.scene();
  // Every preset has its picture, each asked for once, when it is drawn.
  const presets = await viewer.page.getByRole("radiogroup", { name: "Presets" }).getByRole("radio").count();
  await viewer.page.waitForFunction((n) => {
    const pictures = [...document.querySelectorAll(".preset img")];
    return pictures.length === n && pictures.every((picture) => picture.naturalWidth === 128);
  }, presets, { timeout: 60000 });
  assert.deepEqual(answers, Array(presets).fill(200));
  await viewer.page.getByRole("radio", { name: /ct-skin/ }).click();
  const skin = await viewer.sceneWith((s) => s.transfer.preset === "ct-skin", "the preset ct-skin");
  assert.notDeepEqual(skin.transfer.points, first.transfer.points);
  await viewer.done();
  await viewer.shown("skin.png");
  await viewer.button("Undo").click();
  await viewer.sceneWith((s) => JSON.stringify(s.transfer.points) === JSON.stringify(first.transfer.points), "the first points again");
  // A point of the curve, by keys.
  const point = viewer.page.getByLabel(/^Point 2 of/);
  await point.focus();
  await viewer.page.keyboard.press("ArrowRight");
  await viewer.sceneWith((s) => s.transfer.points[1].value > first.transfer.points[1].value, "a moved point");
  // And by the mouse: one step of undo.
  const box = await viewer.page.getByLabel(/^Point 3 of/).boundingBox();
  const opacity = first.transfer.points[2].opacity;
  await viewer.drag([0, 60], { from: [box.x + box.width / 2, box.y + box.height / 2] });
  await viewer.sceneWith((s) => s.transfer.points[2].opacity < opacity, "a lower point");
  await viewer.button("Undo").click();
  await viewer.sceneWith((s) => s.transfer.points[2].opacity === opacity, "the point where it was");
  assert.ok(bone);
});

test("Delete removes the point of the curve that is chosen", async (t) => {
  const viewer = await open(t, [headCt, "--preset", "ct-bone", ...quick]);
  const { page } = viewer;
  await viewer.panel("Transfer function");
  const points = async () => (await viewer.scene()).transfer.points;
  const values = async () => (await points()).map(({ value }) => value);
  const until = async (wanted, what) => {
    const text = JSON.stringify(wanted);
    return viewer.sceneWith((s) => JSON.stringify(s.transfer.points.map(({ value }) => value)) === text, what);
  };
  const middle = async (locator) => {
    const box = await locator.boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  const first = await values();
  const dot = (number) => page.getByLabel(new RegExp(`^Point ${number} of`));
  // Chosen beside its dot, while another one has the focus.
  await dot(2).focus();
  const [x, y] = await middle(dot(3));
  await page.mouse.click(x + 8, y);
  await page.keyboard.press("Delete");
  await until(first.filter((_, i) => i !== 2), "the third point removed");
  await viewer.undo();
  await until(first, "all points");
  // Added before one that has the focus, and with the focus elsewhere.
  for (const [name, focus] of [["a point", () => dot(first.length).focus()], ["a field", () => page.getByLabel("Value of the point").focus()]]) {
    await focus();
    const graph = await page.getByRole("group", { name: /^Opacity over the data's values/ }).boundingBox();
    await page.mouse.dblclick(graph.x + 30, graph.y + 40);
    const added = (await viewer.sceneWith((s) => s.transfer.points.length === first.length + 1, "a further point")).transfer.points;
    const value = added.map((p) => p.value).find((v) => !first.includes(v));
    assert.ok(value < first.at(-1), "the point was to come before the last");
    await page.getByRole("button", { name: /^Point/, pressed: true }).and(page.locator(":focus")).waitFor();
    await page.keyboard.press("Delete");
    await until(first, `the points without the one added while ${name} had the focus`);
  }
  // The last one: the one before is next.
  await dot(first.length).focus();
  await page.keyboard.press("Delete");
  await until(first.slice(0, -1), "the last point removed");
  await page.keyboard.press("Delete");
  await until(first.slice(0, -2), "the one before it removed");
});

test("clips by handles, and saves, loads and keeps the scene", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  const whole = await viewer.shown("whole.png");
  await viewer.button("Clip handles").click();
  await viewer.page.getByLabel("Clip from the right").focus();
  for (let i = 0; i < 50; ++i) await viewer.page.keyboard.press("ArrowRight");
  const right = await viewer.sceneWith((s) => s.clip && (s.clip.x_mm[0] ?? -Infinity) > -20, "a clip box");
  assert.equal(right.clip.x_mm[1], null, "the left side is open");
  const top = await viewer.page.getByLabel("Clip from the head").boundingBox();
  await viewer.drag([0, 60], { from: [top.x + top.width / 2, top.y + top.height / 2] });
  const clipped = await viewer.sceneWith((s) => (s.clip.z_mm?.[1] ?? null) !== null, "its upper side");
  await viewer.done();
  assert.ok(psnr(whole, await viewer.shown("clipped.png")) < 45, "clipping changes nothing");

  await viewer.button("Scene file").click();
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), viewer.page.getByRole("menuitem", { name: /Save scene/ }).click()]);
  const file = join(viewer.scratch, "saved.json");
  await download.saveAs(file);
  const saved = JSON.parse(readFileSync(file, "utf8"));
  assert.deepEqual(saved.clip, clipped.clip);

  // Gone by hand, and there again by the file.
  await viewer.page.keyboard.press("Control+z");
  await viewer.page.reload();
  await viewer.done();
  await viewer.button("Scene file").click();
  const [chooser] = await Promise.all([viewer.page.waitForEvent("filechooser"), viewer.page.getByRole("menuitem", { name: /Load scene/ }).click()]);
  await chooser.setFiles(file);
  await viewer.sceneWith((s) => JSON.stringify(s.clip) === JSON.stringify(saved.clip), "the saved clip box");

  // The state is the server's: another page has it as well.
  await viewer.page.reload();
  await viewer.done();
  assert.deepEqual((await viewer.scene()).clip, saved.clip);
});

test("the picture is saved at full size", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  await viewer.button("Save the picture").click();
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), viewer.page.getByRole("menuitem", { name: /^PNG/ }).click()]);
  const file = join(viewer.scratch, "picture.png");
  await download.saveAs(file);
  assert.ok(psnr(file, await viewer.rendered("rendered.png")) > 45);
});

test("begins with the samples, opens a dropped file, and says what to do with a bad one", async (t) => {
  const viewer = await open(t, []);
  await viewer.page.getByRole("button", { name: /^Phantom/ }).click();
  await viewer.page.waitForFunction(() => document.title.includes("phantom"), undefined, { timeout: 60000 });

  const drop = async (name, bytes) => {
    const data = await viewer.page.evaluateHandle(([n, b]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([new Uint8Array(b)], n));
      return transfer;
    }, [name, [...bytes]]);
    for (const type of ["dragenter", "dragover", "drop"]) await viewer.page.dispatchEvent("body", type, { dataTransfer: data });
  };
  await drop("ball.nrrd", readFileSync(writeBall(join(viewer.scratch, "ball.nrrd"))));
  await viewer.page.waitForFunction(() => document.title.includes("ball.nrrd"), undefined, { timeout: 60000 });
  await viewer.done();

  await drop("bad.nrrd", Buffer.from("NRRD0004\ntype: nothing\n"));
  await viewer.page.getByText(/bad\.nrrd/).first().waitFor();
  assert.match(await viewer.page.title(), /ball\.nrrd/, "what was open is gone");
});

test("a page that lost its server says so, and two pages see the same scene", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  const other = await viewer.page.context().newPage();
  await other.goto(new URL("/", viewer.viewer.url).href);
  await other.waitForFunction(() => document.title.includes("-"));
  await viewer.page.bringToFront();
  await viewer.drag([80, 0]);
  await viewer.sceneWith((s) => s.camera.azimuth_deg !== 0, "another azimuth");
  await viewer.page.getByText("2 viewers").waitFor();
  await other.close();
  await viewer.viewer.kill();
  await viewer.page.getByText(/connect/i).first().waitFor();
});

test("tells how far it is with what the next picture needs", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  // What the server says where it takes long.
  await viewer.page.addInitScript(() => {
    const Plain = window.WebSocket;
    window.WebSocket = class extends Plain {
      constructor(...args) {
        super(...args);
        window.hear = (message) => this.dispatchEvent(new MessageEvent("message", { data: JSON.stringify(message) }));
      }
    };
  });
  await viewer.page.reload();
  await viewer.done();
  const told = viewer.page.getByText("preparing the scene 40 %");
  await viewer.page.evaluate(() => window.hear({ type: "compiling", share: 0.4 }));
  await told.waitFor();
  await viewer.page.evaluate(() => window.hear({ type: "compiling", share: 1 }));
  await told.waitFor({ state: "detached" });
});

test("writes no more than it is asked to", async (t) => {
  // A scene that names files elsewhere is refused, and the page shows why.
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  const file = join(viewer.scratch, "evil.json");
  const scene = await viewer.scene();
  writeFileSync(file, JSON.stringify({ ...scene, environment: { image: "/etc/passwd" } }));
  await viewer.button("Scene file").click();
  const [chooser] = await Promise.all([viewer.page.waitForEvent("filechooser"), viewer.page.getByRole("menuitem", { name: /Load scene/ }).click()]);
  await chooser.setFiles(file);
  await viewer.page.getByText(/passwd|folder/).first().waitFor();
  assert.equal((await viewer.scene()).environment.image ?? "", scene.environment.image ?? "");
});
