// The three slices beside the picture.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, headCt, missing, open, quick, writeQuarters, writeRamp, writeWaves } from "./page.mjs";

after(closeBrowser);

/** The slices and what they show: `mm` where each plane is, `level` and `width` of the window. */
class Slices {
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
  }

  plane(title) {
    return this.page.getByRole("application", { name: new RegExp(`^${title} slice`) });
  }

  /** LPS mm: L, P and S are above 0. */
  async mm(title) {
    const [, letter, mm] = (await this.plane(title).getAttribute("aria-label")).match(/at ([RLAPIS]) ([\d.]+) mm/);
    return ("LPS".includes(letter) ? 1 : -1) * Number(mm);
  }

  /** Sagittal, coronal, axial: x, y, z. */
  async at() {
    return [await this.mm("Sagittal"), await this.mm("Coronal"), await this.mm("Axial")];
  }

  /** Until the planes are as `pred` wants. */
  async until(pred, what) {
    for (let tries = 0; tries < 100; ++tries) {
      const at = await this.at();
      if (pred(at)) return at;
      await this.page.waitForTimeout(30);
    }
    throw new Error(`the planes never were ${what}, but ${await this.at()}`);
  }

  async number(label) {
    return Number(await this.page.getByRole("textbox", { name: label, exact: true }).inputValue());
  }

  async window() {
    return [await this.number("Level"), await this.number("Window")];
  }

  /** Mean grey of a plane's canvas once it is drawn. */
  async grey(title) {
    const mean = () =>
      this.plane(title).locator("canvas").evaluate(async (canvas) => {
        await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
        const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        let sum = 0, opaque = 0;
        for (let i = 0; i < pixels.length; i += 4) if (pixels[i + 3] > 0) (sum += pixels[i]), ++opaque;
        return opaque ? sum / opaque : -1;
      });
    for (let tries = 0; tries < 100; ++tries) {
      const value = await mean();
      if (value >= 0) return value;
    }
    throw new Error(`${title} is never drawn`);
  }

  /** Color of a plane's canvas at a share of its width and height, "#rrggbb"; empty where nothing is painted. */
  color(title, across, down) {
    return this.plane(title).locator("canvas").evaluate(async (canvas, [x, y]) => {
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      const [r, g, b, a] = canvas.getContext("2d").getImageData(Math.round(x * canvas.width), Math.round(y * canvas.height), 1, 1).data;
      return a ? `#${[r, g, b].map((c) => c.toString(16).padStart(2, "0")).join("")}` : "";
    }, [across, down]);
  }

  /** Until a place of a plane has that color. */
  async untilColor(title, [across, down], wanted) {
    let color;
    for (let tries = 0; tries < 100; ++tries) {
      color = await this.color(title, across, down);
      if (color === wanted) return;
      await this.page.waitForTimeout(30);
    }
    throw new Error(`${title} at ${across}, ${down} is ${color}, never ${wanted}`);
  }

  /** CSS px of 1 mm by the plane's scale bar. */
  async scale(title) {
    const bar = this.plane(title).locator(".scale-bar");
    const [length, unit] = (await bar.locator("text").textContent()).split(" ");
    const path = await bar.locator("path").last().getAttribute("d");
    return Number(path.match(/h([\d.]+)/)[1]) / (Number(length) * { mm: 1, cm: 10 }[unit]);
  }

  /** CSS px from the plane's left and top edge to the crosshair. */
  async cross(title) {
    const [vertical, horizontal] = await this.plane(title).locator(".slice-crosshair path").evaluateAll((paths) => paths.map((path) => path.getAttribute("d")));
    return [Number(vertical.match(/^M([-\d.]+) /)[1]), Number(horizontal.match(/^M0 ([-\d.]+)/)[1])];
  }

  async middle(title) {
    const box = await this.plane(title).boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
  }
}

async function openSlices(t, args, options) {
  const viewer = await open(t, args, options);
  await viewer.done();
  await viewer.page.keyboard.press("s");
  await viewer.page.getByRole("toolbar", { name: "Slices" }).waitFor();
  await viewer.done();
  return new Slices(viewer);
}

test("one crosshair: clicks, wheel, keys and sliders of one plane move the others", async (t) => {
  const slices = await openSlices(t, [headCt, ...quick]);
  const { page } = slices;
  const first = await slices.at();
  const [x, y] = await slices.middle("Axial");
  // Radiologists' way: the patient's left is on the right, his back is down.
  await page.mouse.click(x + 30, y + 20);
  const clicked = await slices.until((at) => at[0] > first[0] + 1 && at[1] > first[1] + 1, "to the left and back");
  assert.equal(clicked[2], first[2]);
  await slices.viewer.drag([0, -30], { from: await slices.middle("Coronal") });
  const dragged = await slices.until((at) => at[2] > first[2] + 1, "toward the head");
  assert.equal(dragged[1], clicked[1]);

  const { spacing_mm } = await page.evaluate(async () => (await fetch("/api/volume")).json());
  await page.mouse.move(...(await slices.middle("Sagittal")));
  await page.mouse.wheel(0, -100);
  const wheeled = await slices.until((at) => at[0] !== dragged[0], "on the next slice");
  assert.ok(wheeled[0] > dragged[0] && wheeled[0] < dragged[0] + spacing_mm[0] + 0.11, `from ${dragged[0]} to ${wheeled[0]} mm`);
  assert.deepEqual(wheeled.slice(1), dragged.slice(1));
  await slices.plane("Axial").focus();
  await page.keyboard.press("PageDown");
  const paged = await slices.until((at) => at[2] !== wheeled[2], "on the tenth slice below");
  await page.keyboard.press("PageUp");
  const back = await slices.until((at) => at[2] !== paged[2], "ten slices up");
  assert.ok(Math.abs(back[2] - paged[2] - 10 * spacing_mm[2]) < 0.11, `from ${paged[2]} to ${back[2]} mm`);
  await page.getByRole("slider", { name: "Coronal slice" }).press("Home");
  const home = await slices.until((at) => at[1] !== back[1], "at the front");
  assert.ok(home[1] < back[1] - 10);
  assert.deepEqual((await slices.viewer.scene()).camera.azimuth_deg, 0, "the slices turn the view");
});

/** 10 slices of 8 mm from the patient's right (x = 0) to the left, 60 x 60 voxels of 1 mm each: 100 times their number. */
function writeSagittal(file) {
  const voxels = Uint16Array.from({ length: 60 * 60 * 10 }, (_, at) => 100 * Math.floor(at / 3600));
  const header = "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 60 60 10\nencoding: raw\nendian: little\nspace: left-posterior-superior\nspace directions: (0,1,0) (0,0,-1) (8,0,0)\nspace origin: (0,0,0)\n\n";
  writeFileSync(file, Buffer.concat([Buffer.from(header), Buffer.from(voxels.buffer)]));
  return file;
}

test("wheel, keys and slider go from one acquired slice to the next", async (t) => {
  const slices = await openSlices(t, (folder) => [writeSagittal(join(folder, "sagittal.nrrd")), ...quick]);
  const { page } = slices;
  const inX = (mm) => slices.until((at) => at[0] === mm, `at ${mm} mm`);
  const slider = (title) => page.getByRole("slider", { name: `${title} slice` });
  assert.equal(await slider("Sagittal").getAttribute("max"), "9");
  assert.equal(await slider("Coronal").getAttribute("max"), "59");
  await inX(36);
  await page.mouse.move(...(await slices.middle("Sagittal")));
  await page.mouse.wheel(0, -100);
  await inX(40);
  await page.locator(".status-bar .value").filter({ hasText: /^500\b/ }).waitFor();
  // Faster than they are drawn.
  await slices.plane("Sagittal").evaluate((pane) => {
    for (let i = 0; i < 3; ++i) pane.dispatchEvent(new WheelEvent("wheel", { deltaY: 100, bubbles: true, cancelable: true }));
  });
  await inX(16);
  await slices.plane("Sagittal").focus();
  await page.keyboard.press("ArrowUp");
  await inX(24);
  await page.keyboard.press("PageUp");
  await inX(72);
  await slider("Sagittal").press("ArrowLeft");
  await inX(64);
  await slider("Sagittal").press("Home");
  await inX(0);
  // From between two it is not far to the next.
  const scale = await slices.scale("Axial");
  const [x, y] = await slices.middle("Axial");
  await page.mouse.click(x + 2 * scale, y);
  const [between] = await slices.until((at) => at[0] > 36 && at[0] < 40, "between two slices");
  assert.equal(await slider("Sagittal").inputValue(), "5", `at ${between} mm`);
  await slices.plane("Sagittal").focus();
  await page.keyboard.press("ArrowDown");
  await inX(32);
});

test("a click in the picture takes the slices there, and both read the same value", async (t) => {
  // Values grow by 10 a voxel toward the patient's left, and the whole box is opaque.
  const scene = (folder) => {
    const file = join(folder, "ramp.json");
    const transfer = { points: [{ value: 0, opacity: 0.999, color: "#ffffff" }, { value: 5000, opacity: 0.999, color: "#ffffff" }] };
    writeFileSync(file, JSON.stringify({ version: 1, volume: { path: writeRamp(join(folder, "ramp.nrrd")) }, transfer }));
    return [file, ...quick];
  };
  const slices = await openSlices(t, scene);
  const { page, viewer } = slices;
  const box = await viewer.canvas.boundingBox();
  for (const share of [0.4, 0.55]) {
    const before = await slices.at();
    await page.mouse.click(box.x + share * box.width, box.y + 0.45 * box.height);
    const at = await slices.until((now) => now[0] !== before[0], "elsewhere");
    // The status bar tells of the point under the pointer, which is the same.
    await page.waitForFunction((mm) => {
      const text = document.querySelector(".status-bar .position")?.innerText ?? "";
      return mm.every((x, axis) => Math.abs(Math.abs(x) - Number(text.match(/[\d.]+/g)?.[axis])) < 0.11);
    }, at);
    const probed = parseFloat(await page.locator(".status-bar .value").innerText());
    await page.waitForFunction((value) => parseFloat(document.querySelector(".slice-value b")?.innerText) === value, probed);
    assert.ok(Math.abs(probed - (1000 + 10 * at[0])) <= 1.1, `${probed} at ${at[0]} mm`);
  }
});

test("what is read is under the pointer, also when it rests and the slice moves", async (t) => {
  const slices = await openSlices(t, [headCt, ...quick]);
  const { page } = slices;
  const position = page.locator(".status-bar .position");
  const read = async () => (await position.innerText()).match(/[\d.]+/g).map(Number);
  const until = async (pred, what) => {
    for (let tries = 0; ; ++tries) {
      const at = await read();
      if (pred(at)) return at;
      assert.ok(tries < 100, `${what}: ${at}`);
      await page.waitForTimeout(30);
    }
  };
  const [x, y] = await slices.middle("Axial");
  await page.mouse.move(x + 60, y + 20);
  await position.waitFor();
  const first = await slices.at();
  const start = await until((at) => at[2] === Math.abs(first[2]), "not in the axial plane");
  await page.mouse.wheel(0, -100);
  const [, , wheeled] = await slices.until((at) => at[2] !== first[2], "one slice on");
  assert.deepEqual(await until((at) => at[2] === Math.abs(wheeled), "not in the next slice"), [start[0], start[1], Math.abs(wheeled)]);
  await slices.plane("Axial").focus();
  await page.keyboard.press("PageUp");
  const [, , paged] = await slices.until((at) => at[2] !== wheeled, "ten slices on");
  await until((at) => at[2] === Math.abs(paged), "not ten slices on");
  // Nearer about the crosshair, in the pane's middle: it comes nearer to that.
  await page.keyboard.press("+");
  await until((at) => Math.abs(at[0] - start[0]) > 2, "not where it is seen now");
});

test("places are told by the patient's sides everywhere, and typed so", async (t) => {
  // The ramp's box goes from -0.5 to 47.5 mm: its first voxels are at 0, and half a voxel is on the right.
  const scene = (folder) => {
    const file = join(folder, "ramp.json");
    const points = [{ value: 0, opacity: 0.999, color: "#ffffff" }, { value: 5000, opacity: 0.999, color: "#ffffff" }];
    writeFileSync(file, JSON.stringify({ version: 1, volume: { path: writeRamp(join(folder, "ramp.nrrd")) }, transfer: { points } }));
    return [file, ...quick];
  };
  const slices = await openSlices(t, scene);
  const { page, viewer } = slices;
  const place = /^([RL]) ([\d.]+)\s+([AP]) ([\d.]+)\s+([IS]) ([\d.]+) mm$/;
  assert.match(await page.locator(".slice-position").innerText(), place);
  await page.getByRole("slider", { name: "Sagittal slice" }).press("Home");
  await slices.until((at) => at[0] === 0, "on the first slice");
  const axial = await slices.plane("Axial").boundingBox();
  await page.mouse.click(axial.x + 4, axial.y + axial.height / 2 + 60);
  await slices.until((at) => at[0] === -0.5, "at the right side");
  const bar = page.locator(".slice-position");
  assert.match(await bar.innerText(), /^R 0\.5 /);
  const readout = slices.plane("Sagittal").locator(".slice-readout");
  assert.equal(await readout.innerText(), "R 0.5 mm");
  assert.equal(await page.getByRole("slider", { name: "Sagittal slice" }).getAttribute("aria-valuetext"), "R 0.5 mm");
  const box = await viewer.canvas.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.locator(".status-bar .position").waitFor();
  assert.match(await page.locator(".status-bar .position").innerText(), place);

  await viewer.panel("Camera");
  const target = page.getByRole("textbox", { name: "Target x", exact: true });
  for (const [typed, mm, shown] of [["r 12,5", -12.5, "R 12.5"], ["0", 0, "L 0.0"], ["-3", -3, "R 3.0"], ["L 4", 4, "L 4.0"]]) {
    await target.fill(typed);
    await target.press("Enter");
    await viewer.sceneWith((s) => s.camera.target_mm[0] === mm, `a target at ${mm}`);
    assert.equal(await target.inputValue(), shown);
  }
  await target.fill("S 9");
  await target.press("Enter");
  assert.equal(await target.inputValue(), "L 4.0", "another axis' letter is taken");
});

test("values under the pointer are those between the samples, labels those of the nearest voxel", async (t) => {
  const scene = (folder) => {
    const points = [{ value: 0, opacity: 0.999, color: "#ffffff" }, { value: 5000, opacity: 0.999, color: "#ffffff" }];
    const proxies = [{ name: "quarters", path: writeQuarters(join(folder, "quarters.nrrd")), lookup: "nearest" }];
    const file = join(folder, "waves.json");
    writeFileSync(file, JSON.stringify({ version: 1, volume: { path: writeWaves(join(folder, "waves.nrrd")) }, proxies, transfer: { points } }));
    return [file, ...quick];
  };
  const slices = await openSlices(t, scene);
  const { page } = slices;
  const [x, y] = await slices.middle("Coronal");
  let before = "";
  const pointed = async (dx, dy) => {
    await page.mouse.move(x + dx, y + dy);
    await page.waitForFunction((text) => {
      const now = document.querySelector(".status-bar .position")?.innerText;
      return now && now !== text;
    }, before);
    before = await page.locator(".status-bar .position").innerText();
    const [along, , up] = before.match(/[\d.]+/g).map(Number);
    return { along, up, value: parseFloat(await page.locator(".status-bar .value").innerText()) };
  };
  // Samples of the plane are 1 mm apart, its voxels 1.7: at their centres are the kinks that samples miss.
  for (let i = 0; i < 16; ++i) {
    const { up, value } = await pointed(0, 3 * i);
    const wave = 1000 * (1 - Math.abs(1 - ((up / 1.7) % 2)));
    // The place is told to 0.1 mm, which is 29 at most.
    assert.ok(Math.abs(value - wave) < 35, `${value} at ${up} mm, not ${wave}`);
  }
  // The middle, 23.5 mm, is the border between the labels 2 and 3.
  for (const dx of [-3, 4, -20, 20]) {
    const { along } = await pointed(dx, 1);
    await page.locator(".status-bar .label").getByText(along < 23.5 ? "Label 2" : "Label 3").waitFor();
  }
  await page.mouse.move(0, 0);
  await page.locator(".status-bar .position").waitFor({ state: "detached" });
});

test("labels have the colors of the scene, and hidden ones none", async (t) => {
  const scene = (folder) => {
    const points = [{ value: 0, opacity: 0.999, color: "#ffffff" }, { value: 5000, opacity: 0.999, color: "#ffffff" }];
    const rules = [
      { kind: "cdptf", volume: "quarters", points: [{ value: 3, mu_t_per_mm: 1e-9 }] },
      { kind: "mdptf", volume: "quarters", points: [{ value: 2, material: "moss" }] },
      { kind: "cdptf", volume: "quarters", points: [{ value: 1, color: "#ff2080" }] },
    ];
    const file = join(folder, "quarters-scene.json");
    writeFileSync(file, JSON.stringify({
      version: 1,
      volume: { path: writeRamp(join(folder, "ramp.nrrd")) },
      proxies: [{ name: "quarters", path: writeQuarters(join(folder, "quarters.nrrd")), lookup: "nearest" }],
      materials: [{ name: "moss", color: "#208040" }],
      transfer: { points, rules },
    }));
    return [file, ...quick];
  };
  const slices = await openSlices(t, scene);
  const { page, viewer } = slices;
  const own = await page.evaluate(async () => (await fetch("/api/labels")).json());
  const fileColor = (value) => own.quarters.find((label) => label.value === value).color;
  await page.getByRole("slider", { name: "Opacity of the labels" }).press("End");
  // Places of the plane by where the labels are, left to right: its middle is the volume's.
  const pane = await slices.plane("Axial").boundingBox();
  const side = Math.min(pane.width, pane.height);
  const at = (share) => [0.5 + ((share - 0.5) * side) / pane.width, 0.42];
  await slices.untilColor("Axial", at(0.1), "#ff2080");
  await slices.untilColor("Axial", at(0.4), "#208040");
  assert.notEqual(fileColor(4), "#ff2080");
  await slices.untilColor("Axial", at(0.9), fileColor(4));
  const isGrey = (color) => color !== "" && color.slice(1, 3) === color.slice(3, 5) && color.slice(3, 5) === color.slice(5);
  const bare = await slices.color("Axial", ...at(0.6));
  assert.ok(isGrey(bare), `the hidden label is painted ${bare}`);

  await viewer.panel("Labels");
  await viewer.button("Show Label 3").click();
  await slices.untilColor("Axial", at(0.6), fileColor(3));
  await viewer.button("Hide Label 1").click();
  await viewer.sceneWith((s) => s.transfer.rules.some((rule) => rule.points.some((p) => p.value === 1 && p.mu_t_per_mm)), "a hidden label");
  for (let tries = 0; !isGrey(await slices.color("Axial", ...at(0.1))); ++tries) assert.ok(tries < 100, "the label is still painted");
});

test("labels that rules of two values color by the data are so in the slices", async (t) => {
  // The data grows by 10 a mm along x, the labels are 12 mm wide.
  const scene = (folder) => {
    const points = [{ value: 0, opacity: 0.999, color: "#ffffff" }, { value: 5000, opacity: 0.999, color: "#ffffff" }];
    const rules = [
      { kind: "cdptf", volume: "quarters", along: "data", column_form: "steps", columns: [{ at: 1400, points: [{ value: 4, mu_t_per_mm: 1e-9 }] }] },
      { kind: "cpctf", volume: "data", along: "quarters", column_form: "points", columns: [{ at: 2, points: [{ value: 1000, color: "#2040ff" }, { value: 1180, color: "#ffc020" }] }] },
      { kind: "cdptf", volume: "quarters", along: "edges", columns: [{ at: 0, points: [{ value: 3, color: "#ff8000" }] }] },
    ];
    const file = join(folder, "planes-scene.json");
    writeFileSync(file, JSON.stringify({
      version: 1,
      volume: { path: writeRamp(join(folder, "ramp.nrrd")) },
      proxies: [{ name: "quarters", path: writeQuarters(join(folder, "quarters.nrrd")), lookup: "nearest" }, { name: "edges", kind: "gradient" }],
      transfer: { points, rules },
    }));
    return [file, ...quick];
  };
  const slices = await openSlices(t, scene);
  const { page, viewer } = slices;
  const own = await page.evaluate(async () => (await fetch("/api/labels")).json());
  await page.getByRole("slider", { name: "Opacity of the labels" }).press("End");
  const pane = await slices.plane("Axial").boundingBox();
  const side = Math.min(pane.width, pane.height);
  const at = (x_mm) => [0.5 + (((x_mm + 0.5) / 48 - 0.5) * side) / pane.width, 0.42];
  const fileColor = (value) => own.quarters.find((label) => label.value === value).color;
  await slices.untilColor("Axial", at(14), "#2040ff");
  await slices.untilColor("Axial", at(21), "#ffc020");
  await slices.untilColor("Axial", at(30), "#ff8000");
  await slices.untilColor("Axial", at(5), fileColor(1));
  await slices.untilColor("Axial", at(37), fileColor(4));
  const bare = await slices.color("Axial", ...at(44));
  assert.equal(bare.slice(1, 3), bare.slice(5), `what the rule hides is painted ${bare}`);
  assert.notEqual(bare, fileColor(4));
  // And as soon as the rules say otherwise.
  const now = await viewer.scene();
  await viewer.load({ ...now, transfer: { ...now.transfer, rules: [] } });
  await slices.untilColor("Axial", at(14), fileColor(2));
  await slices.untilColor("Axial", at(44), fileColor(4));
});

test("the panes have one scale, are zoomed and moved together, and go back", async (t) => {
  const slices = await openSlices(t, [headCt, ...quick]);
  const { page, viewer } = slices;
  const scales = async () => [await slices.scale("Axial"), await slices.scale("Coronal"), await slices.scale("Sagittal")];
  const alike = (list) => assert.ok(Math.max(...list) / Math.min(...list) < 1 + 1e-6, `${list} px a mm`);
  const [first, ...others] = await scales();
  alike([first, ...others]);
  // The bar is as long as it says: the crosshair of a click 40 px from the middle has gone 40 px / scale.
  // Whole pixels, as mice have them.
  const [x, y] = (await slices.middle("Axial")).map(Math.round);
  await page.mouse.click(x, y);
  const middle = await slices.until((at) => Math.abs(at[0]) < 1000, "anywhere");
  await page.mouse.click(x + 40, y);
  const aside = await slices.until((at) => at[0] !== middle[0], "aside");
  assert.ok(Math.abs((aside[0] - middle[0]) * first - 40) < 0.11 * first + 0.01, `${aside[0] - middle[0]} mm for 40 px at ${first} px a mm`);
  // All of every plane is seen: the whole volume has room.
  const { bounds_mm } = await page.evaluate(async () => (await fetch("/api/volume")).json());
  for (const [title, across, along] of [["Axial", 0, 1], ["Coronal", 0, 2], ["Sagittal", 1, 2]]) {
    const box = await slices.plane(title).boundingBox();
    assert.ok((bounds_mm[1][across] - bounds_mm[0][across]) * first <= box.width + 1 && (bounds_mm[1][along] - bounds_mm[0][along]) * first <= box.height + 1, title);
  }

  const reset = page.getByRole("button", { name: "Show all of every slice" });
  assert.ok(await reset.isDisabled());
  const still = await slices.cross("Axial");
  await page.mouse.move(x + 40, y);
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -100);
  await page.keyboard.up("Control");
  await page.waitForFunction(() => !document.querySelector("[aria-label='Show all of every slice']").disabled);
  const near = await scales();
  alike(near);
  assert.ok(near[0] > 1.3 * first, `${near[0]} px a mm, was ${first}`);
  assert.deepEqual(await slices.at(), aside, "zooming goes through the slices");
  // What is under the pointer stays there.
  const zoomed = await slices.cross("Axial");
  assert.ok(Math.hypot(zoomed[0] - still[0], zoomed[1] - still[1]) < 0.6, `${still} became ${zoomed}`);

  const coronal = await slices.cross("Coronal");
  await viewer.drag([24, 0], { from: [x, y], button: "middle" });
  const moved = await slices.cross("Axial");
  assert.ok(Math.abs(moved[0] - zoomed[0] - 24) < 0.6 && Math.abs(moved[1] - zoomed[1]) < 0.6, `${zoomed} went to ${moved}`);
  assert.ok(Math.abs((await slices.cross("Coronal"))[0] - coronal[0] - 24) < 0.6, "the coronal plane does not follow");
  assert.deepEqual(await slices.at(), aside, "moving moves the crosshair");
  await page.keyboard.down("Shift");
  await viewer.drag([-10, 6], { from: [x, y] });
  await page.keyboard.up("Shift");
  assert.ok(Math.abs((await slices.cross("Axial"))[1] - moved[1] - 6) < 0.6);

  await reset.click();
  assert.deepEqual(await scales(), [first, ...others]);
  assert.ok(await reset.isDisabled());
  const { camera } = await viewer.scene();
  await slices.plane("Coronal").focus();
  await page.keyboard.press("+");
  await page.waitForFunction(() => !document.querySelector("[aria-label='Show all of every slice']").disabled);
  assert.ok((await slices.scale("Sagittal")) > 1.2 * first);
  await page.keyboard.press("f");
  await page.waitForFunction(() => document.querySelector("[aria-label='Show all of every slice']").disabled);
  assert.deepEqual(await scales(), [first, ...others]);
  assert.deepEqual((await viewer.scene()).camera, camera, "the picture was zoomed, too");
});

test("one finger moves the crosshair, two zoom about their middle and move what is seen", async (t) => {
  const slices = await openSlices(t, [headCt, ...quick], { touch: true });
  const { page } = slices;
  const devtools = await page.context().newCDPSession(page);
  const send = (type, points) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  /** Fingers come down one after the other and go from the first to the second of their two places. */
  const touch = async (paths) => {
    const at = (s) => paths.map(([from, to]) => [from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])]);
    for (let n = 1; n <= paths.length; ++n) await send("touchStart", at(0).slice(0, n));
    for (let i = 1; i <= 10; ++i) await send("touchMove", at(i / 10));
    await send("touchEnd", []);
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  };
  const [x, y] = (await slices.middle("Axial")).map(Math.round);
  const first = await slices.scale("Axial");
  await touch([[[x, y], [x + 24, y + 16]]]);
  const at = await slices.until((now) => now[0] > 5, "to the left");
  assert.equal(await slices.scale("Axial"), first, "one finger zooms");
  const reset = page.getByRole("button", { name: "Show all of every slice" });
  assert.ok(await reset.isDisabled());

  // 120 px apart, then 240, about a place beside the crosshair; the crosshair stays at its anatomy.
  const cross = await slices.cross("Axial");
  const box = await slices.plane("Axial").boundingBox();
  const middle = [x - 30 - box.x, y - 10 - box.y];
  await touch([[[x - 90, y - 10], [x - 150, y - 10]], [[x + 30, y - 10], [x + 90, y - 10]]]);
  assert.deepEqual(await slices.at(), at, "the first finger of two moves the crosshair");
  assert.ok(Math.abs((await slices.scale("Coronal")) / first - 2) < 0.02, `${await slices.scale("Coronal")} px a mm, was ${first}`);
  const zoomed = await slices.cross("Axial");
  for (const i of [0, 1]) assert.ok(Math.abs(zoomed[i] - (middle[i] + 2 * (cross[i] - middle[i]))) < 1, `${cross} about ${middle} became ${zoomed}`);

  // As far apart all the time, or nearly: only moved.
  await touch([[[x - 60, y], [x - 20, y + 24]], [[x + 60, y], [x + 104, y + 24]]]);
  const moved = await slices.cross("Axial");
  assert.ok(Math.abs(moved[0] - zoomed[0] - 42) < 1 && Math.abs(moved[1] - zoomed[1] - 24) < 1, `${zoomed} went to ${moved}`);
  assert.ok(Math.abs((await slices.scale("Axial")) / first - 2) < 0.02);
  assert.deepEqual(await slices.at(), at);

  // Together again: all is seen. Then one finger is as before.
  await touch([[[x - 150, y], [x - 40, y]], [[x + 150, y], [x + 40, y]]]);
  await page.waitForFunction(() => document.querySelector("[aria-label='Show all of every slice']").disabled);
  await touch([[[x, y], [x - 30, y]]]);
  await slices.until((now) => now[0] < at[0] - 5, "to the right");
});

test("distances are measured in the slices, by pointer and by keys, and are shown where they lie", async (t) => {
  const slices = await openSlices(t, (folder) => {
    const file = join(folder, "ramp.json");
    const points = [{ value: 0, opacity: 0.999, color: "#ffffff" }, { value: 5000, opacity: 0.999, color: "#ffffff" }];
    writeFileSync(file, JSON.stringify({ version: 1, volume: { path: writeRamp(join(folder, "ramp.nrrd")) }, transfer: { points } }));
    return [file, ...quick];
  });
  const { page, viewer } = slices;
  const voice = page.getByRole("status", { name: "Measuring" });
  let at = await slices.at();
  const lines = async () => {
    const of = (title) => slices.plane(title).locator(".measurement").count();
    return [await of("Axial"), await of("Coronal"), await of("Sagittal"), await page.locator(".view .measurement").count()];
  };
  const untilLines = async (wanted) => {
    for (let tries = 0; JSON.stringify(await lines()) !== JSON.stringify(wanted); ++tries) {
      assert.ok(tries < 100, `lines of axial, coronal, sagittal and picture: ${await lines()}, not ${wanted}`);
      await page.waitForTimeout(30);
    }
  };
  const lengthIn = async (title) => parseFloat(await slices.plane(title).locator(".measurement .tag-text").textContent());
  const scale = await slices.scale("Axial");
  await page.keyboard.press("m");
  const [x, y] = await slices.middle("Axial");
  await page.mouse.click(x - 40, y);
  await voice.filter({ hasText: /^First end at/ }).waitFor();
  await page.mouse.click(x + 40, y);
  // Across the crosshair from right to left: in the axial and the coronal plane, and across the sagittal one.
  await untilLines([1, 1, 0, 1]);
  assert.ok(Math.abs((await lengthIn("Axial")) - 80 / scale) < 0.06, `${await lengthIn("Axial")} mm of 80 px at ${scale} px a mm`);
  assert.equal(await lengthIn("Coronal"), await lengthIn("Axial"));
  assert.deepEqual(await slices.at(), at, "measuring has moved the crosshair");
  await viewer.drag([20, 0], { from: [x + 40, y] });
  await page.waitForFunction(([mm]) => Math.abs(parseFloat(document.querySelector(".slice .tag-text")?.textContent) - mm) < 0.06, [100 / scale]);

  await slices.plane("Axial").focus();
  await page.keyboard.press("PageUp");
  await untilLines([0, 1, 0, 1]);
  await page.keyboard.press("PageDown");
  await untilLines([1, 1, 0, 1]);
  // From between two slices, back on the nearer one.
  at = await slices.at();

  // From the crosshair up and down in the sagittal plane, by keys alone; that lies in the coronal plane, too.
  await slices.plane("Sagittal").focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("Shift+ArrowUp");
  await slices.plane("Sagittal").locator(".key-cursor").waitFor();
  await page.keyboard.press("Enter");
  await voice.filter({ hasText: /^First end at/ }).waitFor();
  for (let i = 0; i < 6; ++i) await page.keyboard.press("Shift+ArrowDown");
  await voice.filter({ hasText: /^[\d.]+ mm$/ }).waitFor();
  await page.keyboard.press("Enter");
  await voice.filter({ hasText: /^Distance/ }).waitFor();
  const told = parseFloat((await voice.innerText()).match(/[\d.]+/)[0]);
  assert.ok(Math.abs(told - 60 / scale) < 0.06, `${told} mm of 60 px at ${scale} px a mm`);
  await untilLines([1, 2, 1, 2]);
  // Its second end, in the plane, by keys: it stays in the plane that has the handle.
  const end = slices.plane("Sagittal").getByRole("button", { name: /^Second end of the distance of/ });
  await end.focus();
  for (let i = 0; i < 2; ++i) await page.keyboard.press("Shift+ArrowUp");
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowUp");
  await voice.filter({ hasText: new RegExp(`^${(35 / scale).toFixed(1)} mm$`) }).waitFor();
  assert.ok(Math.abs((await lengthIn("Sagittal")) - 35 / scale) < 0.06);
  assert.deepEqual(await slices.at(), at, "the keys of the end have gone through the slices");
  await page.keyboard.press("Delete");
  await untilLines([1, 1, 0, 1]);
  assert.match(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), /^Sagittal slice/, "the focus is lost");
  await page.keyboard.press("Escape");
  await page.getByText("Click two points").waitFor({ state: "detached" });
  assert.deepEqual(await slices.at(), at, "the keys have gone through the slices");
  await page.keyboard.press("ArrowUp");
  await slices.until((now) => now[0] > at[0], "one slice on");
  // Beside the volume there is nothing to measure.
  await page.keyboard.press("m");
  const box = await slices.plane("Axial").boundingBox();
  await page.mouse.click(box.x + 30, box.y + box.height / 2 + 60);
  await page.getByText("Nothing there to measure").waitFor();
});

test("the window is dragged, typed and taken from presets", { skip: missing("head-ct.nrrd") }, async (t) => {
  const slices = await openSlices(t, [headCt, ...quick]);
  const { page, viewer } = slices;
  assert.deepEqual(await slices.window(), [40, 400]);
  // In words: a letter before a number is a side of the patient.
  const words = await page.getByRole("toolbar", { name: "Slices" }).locator("label").allInnerTexts();
  assert.deepEqual(words.map((word) => word.trim()), ["Window", "Level"]);
  const soft = await slices.grey("Axial");
  await viewer.button("Bone").click();
  assert.deepEqual(await slices.window(), [500, 2000]);
  assert.equal(await viewer.button("Bone").getAttribute("aria-pressed"), "true");
  const bone = await slices.grey("Axial");
  assert.ok(bone < soft - 3, `grey ${bone}, was ${soft}`);
  // To the right wider, upward brighter.
  await viewer.drag([50, 0], { from: await slices.middle("Axial"), button: "right" });
  const [level, wide] = await slices.window();
  assert.ok(wide > 2100 && Math.abs(level - 500) < 1, `level ${level}, width ${wide}`);
  await viewer.drag([0, -50], { from: await slices.middle("Axial"), button: "right" });
  const [lower, same] = await slices.window();
  assert.ok(lower < 400 && Math.abs(same - wide) < 1, `level ${lower}, width ${same}`);
  assert.ok((await slices.grey("Axial")) > bone, "not brighter");
  const before = await slices.at();
  await page.getByRole("button", { name: /^Drag changes brightness/ }).click();
  await viewer.drag([0, 50], { from: await slices.middle("Sagittal") });
  assert.ok((await slices.number("Level")) > lower + 50);
  assert.deepEqual(await slices.at(), before, "the crosshair went along");
  const level_ = page.getByRole("textbox", { name: "Level", exact: true });
  await level_.fill("40");
  await level_.press("Enter");
  const width_ = page.getByRole("textbox", { name: "Window", exact: true });
  await width_.fill("400");
  await width_.press("Enter");
  assert.equal(await viewer.button("Soft tissue").getAttribute("aria-pressed"), "true");
  assert.ok(Math.abs((await slices.grey("Axial")) - soft) < 0.5);
});
