// What outlives a page, or a viewer: links, pictures with all their light, and connections that end.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { deflateSync } from "node:zlib";
import { after, test } from "node:test";
import { violations } from "./checks.mjs";
import { closeBrowser, headCt, open, program, psnr, quick, readFileSync, startViewer, writeBall, writeRamp } from "./page.mjs";

after(closeBrowser);

test("a copied link opens the same scene", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  await viewer.drag([90, -30]);
  const linked = await viewer.sceneWith((s) => s.camera.azimuth_deg !== 0, "another azimuth");
  await viewer.done();
  const picture = await viewer.shown("linked.png");
  await viewer.button("Copy a link to this scene").click();
  await viewer.page.getByText("Link to this scene copied").waitFor();
  const link = await viewer.page.evaluate(() => navigator.clipboard.readText());
  assert.ok(link.startsWith(new URL("/", viewer.viewer.url).href), link.slice(0, 60));
  await viewer.page.keyboard.press("3");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  await viewer.done();
  // In the open page, and from the beginning.
  await viewer.page.goto(link);
  assert.deepEqual((await viewer.sceneWith((s) => s.camera.azimuth_deg === linked.camera.azimuth_deg, "the linked view")), linked);
  await viewer.done();
  assert.ok(psnr(picture, await viewer.shown("again.png")) > 45, "not the linked picture");
  await viewer.page.keyboard.press("3");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left again");
  await viewer.page.goto("about:blank");
  await viewer.page.goto(link);
  assert.deepEqual((await viewer.sceneWith((s) => s.camera.azimuth_deg === linked.camera.azimuth_deg, "the linked view again")), linked);
  assert.equal(await viewer.page.evaluate(() => location.hash), "", "reloading would undo what is changed from now on");
  await viewer.done();
  // A damaged link changes nothing and says so.
  await viewer.page.goto(`${link.slice(0, link.length - 40)}`);
  await viewer.page.getByText("copy the whole link again").waitFor();
  assert.deepEqual(await viewer.scene(), linked);
});

/** What is behind the viewer's address in a link to a scene. */
const hashOf = (scene) => `#scene=${deflateSync(JSON.stringify(scene)).toString("base64url")}`;

test("what a link has replaced is told and comes back in one step; a link to what is shown does nothing", async (t) => {
  const viewer = await open(t, (scratch) => [writeBall(join(scratch, "ball.nrrd")), ...quick]);
  const { page } = viewer;
  await viewer.done();
  await page.keyboard.press("3");
  const before = await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  await viewer.done();
  const notice = page.locator(".toast", { hasText: "The scene of the link has replaced" });
  const address = new URL("/", viewer.viewer.url).href;
  const follow = (scene) => page.goto(address + hashOf(scene));
  const revision = () => page.evaluate(() => window.seenBySocket.revision);

  const told = await revision();
  const { camera, ...rest } = await page.evaluate(async () => (await fetch("/api/scene.json")).json());
  await follow({ camera, ...rest, image: { ...rest.image, width: 99, height: 77 } });
  await page.waitForFunction(() => location.hash === "");
  // Whatever it had changed would be there before what is asked for now.
  await page.keyboard.press("m");
  await page.getByText("Click two points").waitFor();
  await page.keyboard.press("m");
  await viewer.done();
  assert.equal(await revision(), told);
  // Also where it says what need not be said.
  await follow(before);
  await page.waitForFunction((number) => window.seenBySocket.revision > number, told);
  await viewer.done();
  assert.equal(await notice.count(), 0);
  assert.deepEqual(await viewer.scene(), before);

  // Of several fields, and others look on.
  const onlooker = await page.context().newPage();
  await onlooker.goto(address);
  await onlooker.waitForFunction(() => document.title.includes("-"));
  await onlooker.getByRole("img", { name: "The rendered volume" }).waitFor();
  await page.bringToFront();
  const link = { ...before, camera: { azimuth_deg: 12, zoom: 2 }, environment: { ...before.environment, intensity: 2 } };
  await follow(link);
  await notice.waitFor();
  assert.match(await notice.innerText(), /for all 2 pages/);
  assert.deepEqual(await violations(page), []);
  assert.equal(await onlooker.locator(".toast").count(), 0, "those who did not follow it are told");
  await onlooker.close();
  assert.equal((await viewer.scene()).camera.azimuth_deg, 12);
  await notice.getByRole("button", { name: "Undo" }).click();
  await viewer.sceneWith((s) => s.camera.azimuth_deg === before.camera.azimuth_deg, "the view before the link");
  const withoutSize = ({ image, ...others }) => ({ ...others, image: { ...image, width: 0, height: 0 } });
  assert.deepEqual(withoutSize(await viewer.scene()), withoutSize(before));
  await notice.waitFor({ state: "detached" });
  await viewer.button("Redo").click();
  await viewer.sceneWith((s) => s.camera.azimuth_deg === 12, "the link again");
  await page.keyboard.press("Control+z");
  await viewer.sceneWith((s) => s.camera.azimuth_deg === before.camera.azimuth_deg, "one step back");

  // What is changed after the link is not taken for it.
  await follow(link);
  await notice.waitFor();
  await page.keyboard.press("4");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg + 90) < 1e-6, "the view from the right");
  await notice.getByRole("button", { name: "Undo" }).click();
  await viewer.sceneWith((s) => s.camera.azimuth_deg === before.camera.azimuth_deg, "the view before the link");
  assert.deepEqual(withoutSize(await viewer.scene()), withoutSize(before));

  // Another volume.
  await follow({ version: 1, volume: { path: writeRamp(join(viewer.scratch, "ramp.nrrd")) }, image: { spp: 4 } });
  await notice.waitFor();
  await page.waitForFunction(() => document.title.startsWith("ramp.nrrd"));
  await notice.getByRole("button", { name: "Undo" }).click();
  await page.waitForFunction(() => document.title.startsWith("ball.nrrd"));
  await viewer.done();
  assert.deepEqual(withoutSize(await viewer.scene()), withoutSize(before));

  // No scene behind it.
  for (const [scene, line] of [[{ ...before, camera: { zoom: -1 } }, "/camera/zoom"], [[1, 2], "expected an object"]]) {
    await follow(scene);
    await page.getByText(line).first().waitFor();
    assert.deepEqual(withoutSize(await viewer.scene()), withoutSize(before));
    assert.equal(await notice.count(), 0);
  }
});

test("opening something else over a scene that was edited leaves a way back", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  const { page } = viewer;
  await viewer.done();
  const openFile = async (path) => {
    await page.keyboard.press("Control+o");
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), viewer.button("files").click()]);
    await chooser.setFiles(path);
  };
  const shows = (name) => page.waitForFunction((n) => document.title.startsWith(n), name, { timeout: 60000 });
  const notices = page.locator(".toast", { hasText: /^Opened/ });
  const ball = writeBall(join(viewer.scratch, "ball.nrrd"));
  // Nothing is lost yet.
  await openFile(ball);
  await shows("ball.nrrd");
  assert.equal(await notices.count(), 0);

  await page.keyboard.press("3");
  const edited = await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left");
  await openFile(writeRamp(join(viewer.scratch, "ramp.nrrd")));
  await shows("ramp.nrrd");
  await notices.filter({ hasText: "Opened ramp.nrrd" }).waitFor();
  assert.deepEqual(await violations(page), []);
  assert.ok(await viewer.button("Undo").isDisabled(), "there is a step to undo, and a notice for nothing");
  await viewer.button("Back to ball.nrrd").click();
  await shows("ball.nrrd");
  const plain = ({ image, ...others }) => others;
  assert.deepEqual(plain(await viewer.scene()), plain(edited));
  assert.equal(await notices.count(), 0, "the way back has a way back, though nothing was edited there");

  // What one has come back to has been edited, with and without further steps; another scene of the same volume.
  const scene = join(viewer.scratch, "other.json");
  writeFileSync(scene, JSON.stringify({ ...edited, camera: { azimuth_deg: 12 } }));
  await openFile(scene);
  await viewer.sceneWith((s) => s.camera.azimuth_deg === 12, "the other scene");
  await viewer.button("Back to ball.nrrd as it was").click();
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "the view from the left again");
  // One that cannot be opened changes nothing and says no such thing; afterwards all is as before.
  const broken = join(viewer.scratch, "broken.nrrd");
  writeFileSync(broken, "NRRD0004\n");
  await openFile(broken);
  await page.getByText("broken.nrrd could not be opened").first().waitFor();
  await page.keyboard.press("4");
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg + 90) < 1e-6, "the view from the right");
  await viewer.button("Undo").click();
  await viewer.sceneWith((s) => Math.abs(s.camera.azimuth_deg - 90) < 1e-6, "one step back");
  assert.equal(await notices.filter({ hasText: "broken.nrrd" }).count(), 0);
});

test("links on another site's page lead into the viewer", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  const scene = { ...(await viewer.scene()), camera: { azimuth_deg: 33 } };
  const hash = hashOf(scene);
  const link = (url, text) => `<p><a href="${url}">${text}</a></p>`;
  const { url } = viewer.viewer;
  // Of another host than the viewer, and so of another site.
  const other = createServer((_, answer) => answer.end(link(url, "the viewer") + link(new URL("/", url).href + hash, "a scene") + link(new URL("/api/scene.json", url).href, "a file")));
  await new Promise((resolve) => other.listen(0, "localhost", resolve));
  t.after(() => other.close());
  const elsewhere = `http://localhost:${other.address().port}/`;
  const context = await viewer.page.context().browser().newContext();
  t.after(() => context.close());
  const page = await context.newPage();
  const follow = async (text) => {
    await page.goto(elsewhere);
    await page.getByRole("link", { name: text }).click();
    await page.waitForURL(`${new URL(url).origin}/**`);
  };
  for (let times = 0; times < 2; ++times) {
    await follow("the viewer");
    await page.waitForFunction(() => document.title.includes("-"));
  }
  await follow("a scene");
  await viewer.sceneWith((s) => s.camera.azimuth_deg === 33, "the linked view");
  await follow("a file");
  await page.getByText("another site's page").waitFor();
});

test("no viewer outlives the script that started it", async () => {
  const tools = new URL("../../tools/viewer/chromium_page.mjs", import.meta.url).pathname;
  const start = `import { startViewer } from ${JSON.stringify(tools)}; const { url } = await startViewer([]); console.log(url);`;
  for (const [what, script, signal] of [
    ["an error", `${start} throw new Error("as measurements may fail")`, null],
    ["a signal", `${start} await new Promise((resolve) => setTimeout(resolve, 60000))`, "SIGTERM"],
  ]) {
    const child = spawn(process.execPath, ["--input-type=module", "-e", script], { stdio: ["ignore", "pipe", "ignore"] });
    const exited = new Promise((resolve) => child.once("exit", resolve));
    const url = await new Promise((resolve) => child.stdout.once("data", (data) => resolve(data.toString().trim())));
    if (signal) child.kill(signal);
    assert.notEqual(await exited, 0);
    const answers = () => fetch(url, { redirect: "manual" }).then(() => true, () => false);
    for (let tries = 0; await answers(); ++tries) {
      assert.ok(tries < 100, `the viewer still answers after ${what}`);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }
});

test("an EXR has the picture in linear light", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  await viewer.button("Save the picture").click();
  const [download] = await Promise.all([viewer.page.waitForEvent("download"), viewer.page.getByRole("menuitem", { name: /^EXR/ }).click()]);
  assert.match(download.suggestedFilename(), /\.exr$/);
  const file = join(viewer.scratch, "picture.exr");
  await download.saveAs(file);
  assert.deepEqual([...readFileSync(file).subarray(0, 4)], [0x76, 0x2f, 0x31, 0x01]);
  const { rmse } = JSON.parse(execFileSync(program, ["compare", file, await viewer.rendered("rendered.exr"), "--json"], { encoding: "utf8" }));
  assert.ok(rmse < 1e-3, `${rmse} of linear light`);
});

test("a viewer that was started again has a new address, and the page says that", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  const { port } = new URL(viewer.viewer.url);
  await viewer.viewer.kill();
  const banner = viewer.page.locator(".banner");
  await banner.getByText(/Not connected to the viewer/).waitFor();
  assert.match(await banner.innerText(), /voxlume view/, "the page does not say what to do");
  viewer.viewer = await startViewer([headCt, ...quick, "--folder", viewer.scratch], {}, port);
  await banner.getByText(/token/).waitFor({ timeout: 15000 });
  assert.doesNotMatch(await banner.innerText(), /Not connected/);
  // With the new address the same browser has the viewer again: here, and in the page that was open all the time.
  const other = await viewer.page.context().newPage();
  await other.goto(viewer.viewer.url);
  await other.waitForFunction(() => document.title.includes("-"));
  await other.close();
  await banner.waitFor({ state: "detached", timeout: 15000 });
  await viewer.done();
  await viewer.drag([60, 0]);
  await viewer.sceneWith((s) => s.camera.azimuth_deg !== 0, "an edit of the page that came back");
});
