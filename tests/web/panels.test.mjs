// The panels beside the picture.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { closeBrowser, headCt, missing, open, psnr, quick, sample, samples } from "./page.mjs";

after(closeBrowser);

const json = JSON.stringify;

/** Presses keys on a slider (an input of type range) with that label. */
async function slide(viewer, label, key, times = 1) {
  const slider = viewer.page.getByRole("slider", { name: label, exact: true });
  await slider.focus();
  for (let i = 0; i < times; ++i) await slider.press(key);
}

test("labels of a file are hidden, made of a material, and undone", { skip: missing("mri-brain.nii.gz", "aal.nii.gz") }, async (t) => {
  const viewer = await open(t, [sample("mri-brain.nii.gz"), ...quick], { folder: samples });
  await viewer.done();
  await viewer.panel("Labels");
  await viewer.button("Label volume from a file").click();
  await viewer.page.getByRole("dialog", { name: "Add a label volume" }).getByRole("button", { name: /aal\.nii\.gz/ }).click();
  const added = await viewer.sceneWith((s) => s.proxies?.length === 1, "a label volume");
  assert.equal(added.proxies[0].lookup, "nearest");
  // What is found is changed at once: of one side where that is meant.
  await viewer.page.getByLabel("Search labels of aal").fill("frontal mid l");
  await viewer.page.getByText(/^2 found/).waitFor();
  await viewer.button("Color").click();
  const left = await viewer.sceneWith((s) => s.transfer.rules?.length > 0, "colors");
  assert.deepEqual(left.transfer.rules[0].points.map(({ value }) => value).sort((a, b) => a - b), [7, 9]);
  await viewer.undo();
  await viewer.page.getByLabel("Search labels of aal").fill("frontal mid");
  await viewer.page.getByText(/^4 found/).waitFor();
  await viewer.done();
  const before = await viewer.shown("before.png");
  await viewer.button("Hide Frontal Mid L").click();
  const hidden = await viewer.sceneWith((s) => s.transfer.rules?.length > 0, "a rule");
  await viewer.page.getByText("3 of 4 visible").waitFor();
  await viewer.done();
  const without = await viewer.shown("hidden.png");
  assert.ok(psnr(before, without) < 40, "hiding changes nothing");

  await viewer.page.getByRole("button", { name: /^Frontal Mid R/ }).click();
  const material = viewer.page.getByRole("combobox", { name: "Material" });
  const names = await material.locator("option").evaluateAll((options) => options.map((option) => option.value));
  assert.ok(names.includes("gold") || names.length > 3, `materials: ${names}`);
  const name = names.includes("gold") ? "gold" : names.at(-1);
  await material.selectOption(name);
  await viewer.sceneWith((s) => json(s.transfer.rules).includes(`"material":"${name}"`), `the material ${name}`);
  await viewer.done();
  assert.ok(psnr(without, await viewer.shown("material.png")) < 40, "the material changes nothing");
  await viewer.undo();
  await viewer.sceneWith((s) => json(s.transfer.rules) === json(hidden.transfer.rules), "the rules without material");
  await viewer.undo();
  await viewer.sceneWith((s) => !s.transfer.rules?.length, "no rules");
  await viewer.done();
  assert.ok(psnr(before, await viewer.shown("undone.png")) > 45, "not as before");
});

test("a rule of two values: its columns are added, moved and removed", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.panel("Transfer function");
  await viewer.done();
  const curve = await viewer.shown("curve.png");
  await viewer.button("Further volumes").click();
  await viewer.button("Gradient").click();
  await viewer.sceneWith((s) => s.proxies?.[0]?.kind === "gradient", "a gradient");
  await viewer.button("Rules").click();
  await viewer.button("Add a rule").click();
  const one = await viewer.sceneWith((s) => s.transfer.rules?.length === 1, "a rule");
  const [first, second] = one.transfer.rules[0].volume === "data" ? ["data", "edges"] : ["edges", "data"];
  await viewer.page.getByLabel("Of", { exact: true }).selectOption(first);
  await viewer.page.getByLabel("Along", { exact: true }).selectOption(second);
  const two = await viewer.sceneWith((s) => s.transfer.rules[0].along === second, "a second value");
  const columns = viewer.page.getByRole("button", { name: /^Column at/ });
  const count = two.transfer.rules[0].columns.length;
  assert.equal(await columns.count(), count);
  // Behind them is how often the two values occur together: somewhere, but not everywhere.
  const counts = viewer.page.getByRole("img", { name: "Joint histogram of the two volumes" });
  await counts.waitFor();
  const filled = await counts.evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((value, i) => i % 4 === 3 && value > 0).length / (canvas.width * canvas.height);
  });
  assert.ok(filled > 0.05 && filled < 0.95, `${filled} of the plane`);
  const plane = await viewer.page.getByRole("group", { name: /^Columns of the rule/ }).boundingBox();
  const places = (s) => s.transfer.rules[0].columns.map((column) => column.at);
  const addColumn = async () => {
    await viewer.page.mouse.dblclick(plane.x + plane.width / 2, plane.y + plane.height * 0.4);
    return viewer.sceneWith((s) => s.transfer.rules[0].columns.length === count + 1, "a further column");
  };
  // The new one has the focus, not what has the number of the one that had it.
  await columns.nth(count - 1).focus();
  await addColumn();
  await viewer.page.getByRole("button", { name: /^Column at/, pressed: true }).and(viewer.page.locator(":focus")).waitFor({ state: "attached" });
  await viewer.page.keyboard.press("Delete");
  await viewer.sceneWith((s) => json(places(s)) === json(places(two)), "the columns without the new one");
  const added = await addColumn();
  const index = places(added).findIndex((at) => !places(two).includes(at));
  const line = await columns.nth(index).boundingBox();
  await viewer.drag([0, -12], { from: [line.x + line.width / 2, line.y + line.height / 2] });
  const moved = await viewer.sceneWith((s) => places(s)[index] > places(added)[index], "a column further up");
  await viewer.undo();
  await viewer.sceneWith((s) => json(places(s)) === json(places(added)), "the column where it was, in one step");
  await columns.nth(index).focus();
  await viewer.page.keyboard.press("Delete");
  await viewer.sceneWith((s) => s.transfer.rules[0].columns.length === count, "a column less");
  assert.notDeepEqual(places(moved), places(added));
  // What the rule decides is seen, and gone with it.
  await viewer.page.getByLabel("Merge", { exact: true }).selectOption("product");
  await viewer.sceneWith((s) => s.transfer.merge === "product", "another merge");
  await viewer.done();
  assert.ok(psnr(curve, await viewer.shown("rule.png")) < 40, "the rule changes nothing");
  await viewer.button("Remove the rule").click();
  await viewer.sceneWith((s) => !s.transfer.rules?.length, "no rule");
});

test("lights: added, dragged, moving by themselves, kept as tracks", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  await viewer.done();
  await viewer.panel("Lights and background");
  await viewer.done();
  const dark = await viewer.shown("dark.png");
  const { lights: before = [] } = await viewer.scene();
  await viewer.button("Area").click();
  const added = await viewer.sceneWith((s) => s.lights?.length === before.length + 1, "a light");
  const index = before.length;
  await viewer.done();
  assert.ok(psnr(dark, await viewer.shown("lit.png")) < 35, "the light changes nothing");

  const handle = viewer.page.getByRole("button", { name: `Area light ${index + 1}` });
  const box = await handle.locator(".bulb").boundingBox();
  await viewer.drag([70, 50], { from: [box.x + box.width / 2, box.y + box.height / 2] });
  const moved = await viewer.sceneWith((s) => json(s.lights[index].position_mm) !== json(added.lights[index].position_mm), "the light elsewhere");
  assert.ok(moved.lights[index].position_mm[2] < added.lights[index].position_mm[2], "down is not toward the feet");
  assert.deepEqual(moved.camera, added.camera, "the light's handle turns the view");
  await viewer.undo();
  await viewer.sceneWith((s) => json(s.lights) === json(added.lights), "the light where it was, in one step");

  const rotate = viewer.page.getByRole("switch", { name: "Rotate" });
  const place = (s) => json(s.lights[index].position_mm), from = place(added);
  await rotate.click();
  const once = place(await viewer.sceneWith((s) => place(s) !== from, "the light at another place"));
  await viewer.sceneWith((s) => ![from, once].includes(place(s)), "the light at still another place");
  await rotate.click();
  await viewer.done();
  await viewer.undo();
  await viewer.sceneWith((s) => json(s.lights) === json(added.lights), "the light as it was, in one step");

  await viewer.button("Keep the turn").click();
  const turn = await viewer.sceneWith((s) => s.animation?.tracks?.length === 1, "a track");
  assert.match(turn.animation.tracks[0].field, new RegExp(`^/lights/${index}/`));
  await viewer.button("Keep the flash").click();
  const both = await viewer.sceneWith((s) => s.animation?.tracks?.length === 2, "two tracks");
  assert.ok(both.animation.tracks.some(({ field }) => field === `/lights/${index}/intensity`));
  await viewer.button("Remove the light").click();
  await viewer.sceneWith((s) => (s.lights ?? []).length === before.length, "one light less");
});

test("a light that flashes is seen dim, and is in the scene as it is", async (t) => {
  const viewer = await open(t, [headCt, ...quick]);
  const { page } = viewer;
  await viewer.panel("Lights and background");
  await viewer.button("Area").click();
  const { lights } = await viewer.sceneWith((s) => s.lights?.length, "a light");
  const index = lights.length - 1, own = lights[index].intensity;
  await viewer.done();
  const still = await viewer.shown("still.png");
  const flash = page.getByRole("switch", { name: "Flash" });
  const flashes = (on) => page.getByRole("switch", { name: "Flash", checked: on }).waitFor();
  const brightness = (canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let sum = 0;
    for (let i = 0; i < data.length; i += 4) sum += data[i] + data[i + 1] + data[i + 2];
    return sum / data.length;
  };
  const bright = await viewer.canvas.evaluate(brightness);
  const seenDim = async () => {
    let now = bright;
    for (let tries = 0; now > 0.95 * bright; ++tries) {
      assert.ok(tries < 100, `the picture does not follow the flash: ${now} of ${bright}`);
      await page.waitForTimeout(100);
      now = await viewer.canvas.evaluate(brightness);
    }
    assert.equal((await viewer.scene()).lights[index].intensity, own);
  };
  const stillAgain = async (what) => {
    await viewer.done();
    const again = await viewer.shown("again.png");
    assert.ok(psnr(still, again) > 45, `${what}: ${psnr(still, again)} dB`);
  };

  await flash.click();
  await seenDim();
  await flash.click();
  await stillAgain("after the flash");
  // It is no step: what is undone is the light.
  await viewer.button("Undo").click();
  await viewer.sceneWith((s) => (s.lights?.length ?? 0) === lights.length - 1, "one light less");
  await viewer.button("Redo").click();
  await viewer.sceneWith((s) => s.lights?.length === lights.length, "the light again");

  await flash.click();
  await seenDim();
  await page.getByRole("switch", { name: "Rotate" }).click();
  await flashes(false);
  await page.getByRole("switch", { name: "Rotate" }).click();
  await viewer.button("Undo").click();  // the turn
  await stillAgain("after it rotated instead");

  await flash.click();
  await seenDim();
  await viewer.button("Keep the flash").click();
  const { animation } = await viewer.sceneWith((s) => s.animation, "a track");
  assert.equal(animation.tracks[0].keys[0][1], own, "the track begins bright");
  await flashes(false);
  await stillAgain("after the flash was kept");

  // The intensity may be changed meanwhile, and is the light's.
  await flash.click();
  await seenDim();
  const intensity = page.getByRole("textbox", { name: "Intensity", exact: true }).first();
  await intensity.fill(String(2 * own));
  await intensity.press("Enter");
  await viewer.sceneWith((s) => s.lights[index].intensity === 2 * own, "the intensity that was typed");
  await viewer.button("Undo").click();
  await viewer.sceneWith((s) => s.lights[index].intensity === own, "its own intensity");

  // Another page takes a light away, so that this one may have another number: its flash ends.
  const other = await page.context().newPage();
  await other.goto(viewer.viewer.url);
  await other.getByRole("radio").nth(index).waitFor();
  await page.bringToFront();
  await flashes(true);
  await other.getByRole("radio").nth(index).click();
  await other.getByRole("button", { name: "Duplicate the light" }).click();
  await flashes(false);
  await other.getByRole("button", { name: "Remove the light" }).click();
  await viewer.sceneWith((s) => s.lights.length === lights.length, "as many lights as before");
  await other.close();
  await stillAgain("after another page had changed the lights");

  // The page goes.
  await page.getByRole("radio").nth(index).click();
  await flash.click();
  await seenDim();
  await page.reload();
  await stillAgain("after the page was loaded again");
});

test("the environment's picture lights the volume", { skip: missing("env/forest.exr", "env/night.exr") }, async (t) => {
  const viewer = await open(t, [headCt, ...quick], { folder: samples });
  await viewer.done();
  await viewer.panel("Lights and background");
  await viewer.done();
  const constant = await viewer.shown("constant.png");
  const picture = viewer.page.getByRole("combobox", { name: "Picture" });
  await picture.selectOption({ label: "forest" });
  await viewer.sceneWith((s) => s.environment.image?.endsWith("forest.exr"), "the forest");
  await viewer.done();
  const forest = await viewer.shown("forest.png");
  assert.ok(psnr(constant, forest) < 35, "the forest is as a constant color");
  await picture.selectOption({ label: "night" });
  await viewer.sceneWith((s) => s.environment.image?.endsWith("night.exr"), "the night");
  await viewer.done();
  const night = await viewer.shown("night.png");
  assert.ok(psnr(forest, night) < 35, "the night is as the forest");
  await slide(viewer, "Rotation", "PageUp", 3);
  await viewer.sceneWith((s) => s.environment.rotation_deg > 60, "a rotation");
  await viewer.done();
  assert.ok(psnr(night, await viewer.shown("turned.png")) < 60, "its rotation changes nothing");
});

test("the clip box: its faces are dragged, its numbers say where they are", async (t) => {
  const viewer = await open(t, [headCt, ...quick, "--camera", "30,20"]);
  await viewer.done();
  await viewer.panel("Clip box");
  await viewer.done();
  const whole = await viewer.shown("whole.png");
  const cut = viewer.page.getByRole("switch", { name: "Cut the volume" });
  await cut.click();
  const begun = await viewer.sceneWith((s) => s.clip, "a clip box");
  await viewer.done();
  assert.ok(psnr(whole, await viewer.shown("all.png")) > 30, "the whole box cuts something");
  const handle = viewer.page.getByRole("slider", { name: "Clip from the left" });
  const box = await handle.locator(".knob").boundingBox();
  const from = [box.x + box.width / 2, box.y + box.height / 2];
  await viewer.drag([-80, 0], { from });
  const dragged = await viewer.sceneWith((s) => s.clip.x_mm[1] < begun.clip.x_mm[1], "a nearer side");
  for (const side of ["y_mm", "z_mm"]) assert.deepEqual(dragged.clip[side], begun.clip[side]);
  await viewer.done();
  assert.ok(psnr(whole, await viewer.shown("cut.png")) < 35, "the box cuts nothing");
  // The face stays under the pointer, along its axis.
  const after_ = await handle.locator(".knob").boundingBox();
  assert.ok(Math.abs(after_.x - box.x + 80) < 12, `the handle went ${after_.x - box.x} px of -80`);
  const [letter, distance] = (await viewer.page.getByLabel("Left [mm]").inputValue()).split(" ");
  const shown = letter === "L" ? Number(distance) : -Number(distance);
  assert.ok(Math.abs(shown - dragged.clip.x_mm[1]) < 0.1, `${shown}, not ${dragged.clip.x_mm[1]}`);
  await viewer.undo();
  await viewer.sceneWith((s) => json(s.clip) === json(begun.clip), "the box as it was, in one step");
  await cut.click();
  await viewer.sceneWith((s) => !s.clip, "no clip box");
  await viewer.done();
  assert.ok(psnr(whole, await viewer.shown("again.png")) > 45, "not the whole again");
});

test("what is important is seen through what hides it", { skip: missing("head-ct.nrrd") }, async (t) => {
  const viewer = await open(t, [headCt, "--preset", "ct-skin", ...quick]);
  await viewer.done();
  await viewer.panel("Keep in view");
  await viewer.done();
  const skin = await viewer.shown("skin.png");
  await viewer.page.getByRole("switch", { name: "Keep the important in view" }).click();
  const marked = await viewer.sceneWith((s) => s.visibility?.important?.length === 1, "something important");
  assert.equal(marked.visibility.important[0].range[0], 300, "bone");
  await viewer.done();
  const bone = await viewer.shown("bone.png");
  assert.ok(psnr(skin, bone) < 30, "nothing gives way");
  await viewer.button("Values").click();
  await viewer.sceneWith((s) => s.visibility?.important?.length === 2, "the same once more");
  await viewer.page.getByText("The same as number 1 above").waitFor();
  await viewer.page.getByRole("button", { name: "Remove", exact: true }).last().click();
  await viewer.sceneWith((s) => s.visibility?.important?.length === 1, "it alone");
  assert.equal(await viewer.page.getByText("The same as number 1 above").count(), 0);
  await viewer.button("Region").click();
  await viewer.sceneWith((s) => s.visibility?.important?.[1]?.radius_mm > 0, "an important region");
  await viewer.page.getByRole("button", { name: "Remove", exact: true }).last().click();
  await viewer.sceneWith((s) => s.visibility?.important?.length === 1, "one important less");
  await viewer.page.getByRole("switch", { name: "Keep the important in view" }).click();
  await viewer.sceneWith((s) => !s.visibility, "nothing important");
  await viewer.done();
  assert.ok(psnr(skin, await viewer.shown("again.png")) > 45, "not the skin again");
});

test("the denoiser is chosen, and takes noise out", async (t) => {
  const viewer = await open(t, [headCt, "--spp", "2", "--denoise", "none"]);
  await viewer.done();
  await viewer.panel("Picture and rendering");
  await viewer.done();
  const noisy = await viewer.shown("noisy.png");
  const method = viewer.page.getByLabel("Method", { exact: true });
  const names = await method.locator("option").evaluateAll((options) => options.map((option) => option.value));
  for (const name of ["decoupled", "bilateral"]) {
    assert.ok(names.includes(name), `denoisers: ${names}`);
    await method.selectOption(name);
    await viewer.sceneWith((s) => s.render.denoise === name, name);
    await viewer.done();
    assert.ok(psnr(noisy, await viewer.shown(`${name}.png`)) < 40, `${name} changes nothing`);
  }
  await method.selectOption("none");
  await viewer.sceneWith((s) => (s.render?.denoise ?? "none") === "none", "no denoiser");
  await viewer.done();
  assert.ok(psnr(noisy, await viewer.shown("again.png")) > 45);
});

test("exposure keeps the samples, and the picture ends at the noise that is wanted", async (t) => {
  const viewer = await open(t, [headCt, "--spp", "100000", "--denoise", "none"], { resolution: 0.25 });
  await viewer.panel("Picture and rendering");
  const spp = async () => Number((await viewer.progress()).match(/([\d.]+)\s*spp/)?.[1] ?? 0);
  const until = async (least) => {
    await viewer.page.waitForFunction((n) => {
      const bar = document.querySelector("[aria-label='Progress of the picture']").innerText;
      return Number(bar.match(/([\d.]+)\s*spp/)?.[1] ?? 0) >= n && /noise [\d.]+ %/.test(bar);
    }, least, { timeout: 60000 });
    return spp();
  };
  await until(16);
  await viewer.page.waitForFunction(() => window.seenBySocket.shown?.spp >= 16 && !window.seenBySocket.shown.moving);
  const { revision, reached } = await viewer.page.evaluate(() => ({ revision: window.seenBySocket.revision, reached: window.seenBySocket.shown.spp }));
  await slide(viewer, "Exposure", "PageUp");
  await viewer.sceneWith((s) => s.image?.exposure_ev > 0.5, "a longer exposure");
  await viewer.page.waitForFunction((r) => window.seenBySocket.shown.revision > r && !window.seenBySocket.shown.moving, revision);
  const later = await viewer.page.evaluate((r) => window.seenBySocket.frames.filter((frame) => frame.revision > r).map((frame) => frame.spp), revision);
  assert.ok(later.length && later.every((n) => n >= reached), `${reached} spp, then ${later}`);
  assert.ok((await until(reached)) >= reached);

  await viewer.page.getByRole("switch", { name: "Stop at a noise" }).click();
  await viewer.sceneWith((s) => s.image?.noise > 0, "a noise to stop at");
  const field = viewer.page.getByRole("textbox", { name: "Noise" });
  await field.fill("0.2");
  await field.press("Enter");
  await viewer.sceneWith((s) => s.image?.noise === 0.2, "a noise of 0.2");
  await viewer.done();
  const { noise, spp: samples_ } = await viewer.header();
  assert.ok(noise <= 0.2 && samples_ < 100000, `noise ${noise}, ${samples_} spp`);
  assert.ok((await viewer.progress()).includes(`${(noise * 100).toFixed(1)} %`), await viewer.progress());
});
