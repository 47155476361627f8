// What the user brings: several files that are one volume, folders, and scenes of them.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, readdirSync, truncateSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { execFileSync } from "node:child_process";
import { after, test } from "node:test";
import { closeBrowser, open, program, psnr, quick, writeBall, writeQuarters } from "./page.mjs";

after(closeBrowser);

const opened = (viewer, name) => viewer.page.waitForFunction((n) => document.title.startsWith(n), name, { timeout: 60000 });

/** Chooses files, or a folder, as the first screen and the dialog offer. */
async function choose(viewer, button, paths) {
  const [chooser] = await Promise.all([viewer.page.waitForEvent("filechooser"), viewer.button(button).click()]);
  await chooser.setFiles(paths);
}

/** Drops files and folders of the disk, as a hand would. */
async function drop(viewer, files) {
  const session = await viewer.page.context().newCDPSession(viewer.page);
  const data = { items: [], files, dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"]) await session.send("Input.dispatchDragEvent", { type, x: 200, y: 200, data });
  await session.detach();
}

/** A folder in the test's own with a detached NRRD of 24 x 24 x 24 voxels. */
function writePair(folder) {
  mkdirSync(folder);
  writeFileSync(join(folder, "cube.nhdr"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\nspace: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\ndata file: cube.raw\n\n");
  writeFileSync(join(folder, "cube.raw"), Buffer.alloc(24 ** 3, 200).fill(0, 0, 4000));
  return ["cube.nhdr", "cube.raw"].map((name) => join(folder, name));
}

/** A DICOM series of the ball. */
function writeSeries(folder) {
  execFileSync(program, ["convert", writeBall(`${folder}.nrrd`), `${folder}/`], { stdio: "pipe" });
  writeFileSync(join(folder, ".hidden"), "as some systems put into folders");
  return folder;
}

test("a header and its voxels are chosen together", async (t) => {
  const viewer = await open(t, [...quick]);
  const [header, voxels] = writePair(join(viewer.scratch, "pair"));
  await choose(viewer, "files", [voxels, header]);
  await opened(viewer, "cube.nhdr");
  await viewer.done();
  // Alone the header says what it needs, and what is open stays.
  await viewer.page.keyboard.press("Control+o");
  await choose(viewer, "files", [header]);
  await viewer.page.getByText(/cube\.raw/).waitFor();
  assert.match(await viewer.page.title(), /cube\.nhdr/);
  await viewer.page.keyboard.press("Control+o");
  await choose(viewer, "files", [header, writeBall(join(viewer.scratch, "ball.nrrd"))]);
  await viewer.page.getByText(/found ball\.nrrd, cube\.nhdr/).waitFor();
});

test("a DICOM folder is dropped, or chosen", async (t) => {
  const viewer = await open(t, [...quick]);
  const series = writeSeries(join(viewer.scratch, "scan"));
  const slices = readdirSync(series).filter((name) => !name.startsWith("."));
  assert.ok(slices.length >= 48, `${slices.length} slices`);
  await viewer.page.getByText("Open a volume").waitFor();
  await drop(viewer, [series]);
  await opened(viewer, "scan");
  await viewer.done();
  const facts = await viewer.page.evaluate(async () => (await fetch("/api/volume")).json());
  assert.deepEqual(facts.size, [48, 48, 48]);
  await drop(viewer, [writeBall(join(viewer.scratch, "ball.nrrd"))]);
  await opened(viewer, "ball.nrrd");
  await drop(viewer, slices.map((name) => join(series, name)));
  await opened(viewer, "series");
  await viewer.page.keyboard.press("Control+o");
  await choose(viewer, "a folder", series);
  await opened(viewer, "scan");
  // And where the viewer runs, from the dialog.
  await viewer.page.keyboard.press("Control+o");
  await viewer.page.getByRole("dialog").getByRole("button", { name: "scan", exact: true }).click();
  await viewer.page.getByRole("dialog").getByRole("button", { name: `Open ${slices.length} slices` }).click();
  await viewer.page.waitForFunction(async (name) => (await (await fetch("/api/scene.json")).json()).volume.path.startsWith(name), viewer.scratch);
});

test("uploads of many files show how far they are, and can be given up", async (t) => {
  const viewer = await open(t, [...quick]);
  const series = writeSeries(join(viewer.scratch, "scan"));
  let sent = 0;
  const answers = [];
  await viewer.page.route("**/api/upload?*", async (route) => {
    if (++sent > 10) await new Promise((resolve) => answers.push(resolve));
    await route.continue().catch(() => undefined);  // given up meanwhile
  });
  await viewer.page.getByText("Open a volume").waitFor();
  await drop(viewer, [series]);
  await viewer.page.getByText("Uploading scan").waitFor();
  await viewer.page.getByText(/10 of \d+ files/).waitFor();
  await viewer.button("Cancel the upload").click();
  await viewer.page.getByText("Open a volume").waitFor();
  for (const answer of answers) answer();
  assert.equal(sent, 11, "files are sent after it was given up");
});

test("what takes long to open is given up, and what nobody sees is told", async (t) => {
  const viewer = await open(t, [...quick]);
  const { page, scratch } = viewer;
  writeFileSync(join(scratch, "large.nhdr"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4096 4096 1024\nencoding: raw\nspacings: 1 1 1\ndata file: large.raw\n\n");
  writeFileSync(join(scratch, "large.raw"), "");
  truncateSync(join(scratch, "large.raw"), 2 ** 34);
  writeBall(join(scratch, "ball.nrrd"));
  const far = readFileSync(writeQuarters(join(scratch, "far.nrrd"))).toString("latin1");
  writeFileSync(join(scratch, "far.nrrd"), far.replace("space origin: (0,0,0)", "space origin: (900,0,0)"), "latin1");
  const choose = async (name) => page.getByRole("button", { name: new RegExp(`^${name.replace(".", "\\.")}`) }).first().click();
  await page.reload();
  await choose("large.nhdr");
  await page.getByRole("progressbar", { name: "Opening" }).waitFor();
  await viewer.button("Cancel opening").click();
  await page.getByText("Open a volume").waitFor();
  await choose("ball.nrrd");
  await opened(viewer, "ball.nrrd");
  await viewer.done();
  // Over a scene that was edited: nothing has taken its place, and no way back is offered later.
  await page.locator(".view").focus();
  await page.keyboard.press("ArrowRight");
  const turned = await viewer.sceneWith((s) => s.camera.azimuth_deg !== 0, "another view");
  await page.keyboard.press("Control+o");
  await choose("large.nhdr");
  await page.getByRole("progressbar", { name: "Opening" }).waitFor();
  await viewer.button("Cancel opening").click();
  await page.getByRole("progressbar", { name: "Opening" }).waitFor({ state: "detached" });
  assert.deepEqual((await viewer.scene()).camera, turned.camera);
  await viewer.undo();
  await viewer.sceneWith((s) => s.camera.azimuth_deg === 0, "the view before");
  await viewer.done();
  assert.equal(await page.getByText(/^Opened/).count(), 0);
  await viewer.panel("Labels");
  await viewer.button("Label volume from a file").click();
  await page.getByRole("dialog", { name: "Add a label volume" }).getByRole("button", { name: /far\.nrrd/ }).click();
  await page.getByText(/"far" lies nowhere in the volume/).first().waitFor();
  await page.locator(".open-warning").getByLabel(/lies nowhere/).or(page.getByLabel(/lies nowhere/)).first().waitFor();
});

test("a scene of a dropped file names it by its name, finds it again, and is rendered beside it", async (t) => {
  const viewer = await open(t, [...quick]);
  const ball = writeBall(join(viewer.scratch, "mine.nrrd"));
  await viewer.page.getByText("Open a volume").waitFor();
  await drop(viewer, [ball]);
  await opened(viewer, "mine.nrrd");
  await viewer.done();
  await viewer.page.keyboard.press("3");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  const save = async (name) => {
    await viewer.button("Scene file").click();
    const [download] = await Promise.all([viewer.page.waitForEvent("download"), viewer.page.getByRole("menuitem", { name: /Save scene/ }).click()]);
    await download.saveAs(join(viewer.scratch, name));
    return readFileSync(join(viewer.scratch, name), "utf8");
  };
  const text = await save("saved.json");
  assert.equal(JSON.parse(text).volume.path, "mine.nrrd");
  assert.doesNotMatch(text, /voxlume-view/);
  const told = viewer.page.getByText(/does not contain mine\.nrrd.*beside the scene file/);
  await told.waitFor();
  await viewer.button("Dismiss").click();
  await save("again.json");
  assert.equal(await told.count(), 0, "told twice");
  // The link says no more.
  await viewer.button("Copy a link to this scene").click();
  await viewer.page.getByText("Link to this scene copied").waitFor();
  const link = await viewer.page.evaluate(() => navigator.clipboard.readText());
  const linked = await viewer.page.evaluate(async (hash) => {
    const bytes = Uint8Array.from(atob(hash.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).text();
  }, link.split("#scene=")[1]);
  assert.equal(JSON.parse(linked).volume.path, "mine.nrrd");

  // Another volume, then the scene: it finds the upload.
  await viewer.page.keyboard.press("Control+o");
  await viewer.page.getByRole("dialog").getByRole("button", { name: /^Phantom/ }).click();
  await opened(viewer, "phantom");
  await viewer.load(JSON.parse(text));
  await opened(viewer, "mine.nrrd");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the saved view");
  // And from its own folder, without the viewer.
  execFileSync(program, ["render", join(viewer.scratch, "saved.json"), "-o", join(viewer.scratch, "picture.png")], { stdio: "pipe" });
  // Elsewhere it says what is missing.
  await viewer.load({ ...JSON.parse(text), volume: { path: "gone.nrrd" } });
  await viewer.page.getByText(/gone\.nrrd.*drop it on the page/).waitFor();
});

test("a scene and its volume are dropped together", async (t) => {
  const viewer = await open(t, [...quick]);
  const ball = writeBall(join(viewer.scratch, "mine.nrrd"));
  const scene = join(viewer.scratch, "view.json");
  writeFileSync(scene, JSON.stringify({ version: 1, volume: { path: "mine.nrrd" }, camera: { azimuth_deg: 12 }, image: { spp: 4 } }));
  await viewer.page.getByText("Open a volume").waitFor();
  await drop(viewer, [ball, scene]);
  await opened(viewer, "mine.nrrd");
  assert.equal((await viewer.scene()).camera.azimuth_deg, 12);
});

/** A Radiance picture, red above and green below. */
function writeSky(file, width, height) {
  const pixels = Buffer.alloc(4 * width * height);
  for (let i = 0; i < width * height; ++i) pixels.set(i < (width * height) / 2 ? [200, 20, 20, 132] : [20, 200, 20, 129], 4 * i);
  writeFileSync(file, Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`), pixels]));
  return file;
}

test("an environment map of this computer lights the volume, and what is none changes nothing", async (t) => {
  const viewer = await open(t, (scratch) => {
    writeSky(join(scratch, "sky.hdr"), 16, 8);
    return [writeBall(join(scratch, "ball.nrrd")), ...quick];
  });
  const { page, scratch } = viewer;
  // As a picture is called that the viewer has itself.
  mkdirSync(join(scratch, "own"));
  const sky = writeSky(join(scratch, "own/sky.hdr"), 16, 8);
  await viewer.done();
  await viewer.panel("Lights and background");
  await viewer.done();
  const before = await viewer.shown("before.png");
  let go;
  await page.route("**/api/upload?*", async (route) => {
    await new Promise((resolve) => (go = resolve));
    await route.continue();
  });
  const pick = "Picture from this computer";
  await choose(viewer, pick, sky);
  await page.getByText("Uploading sky.hdr").waitFor();
  assert.ok(await viewer.button(pick).isDisabled(), "two at a time");
  go();
  await page.getByText("sky.hdr lights the volume").waitFor();
  await page.unroute("**/api/upload?*");
  const lit = await viewer.sceneWith((s) => s.environment?.image === "sky.hdr", "the sky");
  assert.equal(await page.getByRole("combobox", { name: "Picture" }).evaluate((select) => select.selectedOptions[0].textContent), "sky.hdr");
  await viewer.done();
  assert.ok(psnr(before, await viewer.shown("lit.png")) < 35, "it is as light as before");

  writeFileSync(join(scratch, "text.hdr"), "no picture");
  await choose(viewer, pick, join(scratch, "text.hdr"));
  await page.getByText("text.hdr is damaged").waitFor();
  await choose(viewer, pick, join(scratch, "ball.nrrd"));
  await page.getByText("ball.nrrd cannot light the volume: expected a .hdr or .exr picture").waitFor();
  await choose(viewer, pick, writeSky(join(scratch, "square.hdr"), 16, 16));
  await page.getByText(/square\.hdr.*16 x 16; an environment is twice as wide as high/).waitFor();
  await viewer.sceneWith((s) => s.environment.image === "sky.hdr", "the sky again");
  assert.deepEqual(await viewer.scene(), lit);

  await drop(viewer, [writeSky(join(scratch, "dropped.hdr"), 32, 16)]);
  await viewer.sceneWith((s) => s.environment.image === "dropped.hdr", "what was dropped");
  await viewer.undo();
  await viewer.sceneWith((s) => s.environment.image === "sky.hdr", "the sky, one step back");
  await viewer.undo();
  await viewer.sceneWith((s) => !s.environment?.image, "no picture, one step back");
});

test("environment maps that cannot be taken are refused in a line", async (t) => {
  const viewer = await open(t, [...quick, "--max-upload", "0.000002"]);
  const sky = writeSky(join(viewer.scratch, "sky.hdr"), 64, 32);
  await viewer.page.getByText("Open a volume").waitFor();
  await drop(viewer, [sky]);
  await viewer.page.getByText("sky.hdr is light for a volume: open one first").waitFor();
  await viewer.page.getByRole("button", { name: /^Phantom/ }).click();
  await viewer.done();
  const before = await viewer.scene();
  await drop(viewer, [sky]);
  await viewer.page.getByText(/^sky\.hdr: /).waitFor();
  assert.deepEqual(await viewer.scene(), before);
});

test("labels of this computer are added to the volume", async (t) => {
  const viewer = await open(t, (scratch) => [writeBall(join(scratch, "ball.nrrd")), ...quick]);
  await viewer.done();
  const labels = writeBall(join(viewer.scratch, "parts.nrrd")), names = join(viewer.scratch, "parts.txt");
  writeFileSync(names, "200 core 255 0 0\n");
  await viewer.panel("Labels");
  await viewer.button("Label volume from a file").click();
  await choose(viewer, "Upload from this computer", [labels, names]);
  await viewer.page.getByRole("button", { name: /core/ }).first().waitFor();
  const { proxies } = await viewer.scene();
  assert.deepEqual(proxies.map(({ name, path, lookup }) => [name, path, lookup]), [["parts", "parts.nrrd", "nearest"]]);
});

test("a file that is no label volume is not added, and one that is can follow", async (t) => {
  const viewer = await open(t, ["phantom", ...quick]);
  await viewer.done();
  const fractions = join(viewer.scratch, "fractions.nrrd");
  writeFileSync(fractions, Buffer.concat([
    Buffer.from("NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nencoding: raw\nendian: little\n\n"),
    Buffer.from(Float32Array.from({ length: 64 }, (_, i) => i / 8).buffer),
  ]));
  await viewer.panel("Labels");
  const add = async (file) => {
    await viewer.button("Label volume from a file").click();
    await choose(viewer, "Upload from this computer", [file]);
  };
  await add(fractions);
  await viewer.page.getByText(/fractions\.nrrd: expected a label volume of whole numbers/).first().waitFor();
  assert.equal(await viewer.page.getByText("/uploads/").count(), 0, "a path that the user does not know is shown");
  await viewer.sceneWith((s) => !s.proxies?.length, "no label volume");
  await add(writeBall(join(viewer.scratch, "ball.nrrd")));
  await viewer.page.getByText("ball: 1 label", { exact: true }).first().waitFor();
  assert.equal((await viewer.scene()).proxies.length, 1);
});
