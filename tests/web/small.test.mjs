// Small windows and large zooms, and the system's high contrast.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { overflowing, unreachable, violations } from "./checks.mjs";
import { axeSource, closeBrowser, headCt, open, quick, sample, samples } from "./page.mjs";

after(closeBrowser);

const labels = sample("aal.nii.gz") ? ["--labels", sample("aal.nii.gz")] : [];
const volume = sample("mri-brain.nii.gz") ?? headCt;
const folder = sample("aal.nii.gz") ? samples : undefined;

const titlesOf = (page) => page.getByLabel("Panels", { exact: true }).getByRole("button").evaluateAll((buttons) => buttons.map((b) => b.getAttribute("aria-label")));

// 640 x 360 is a window of 1280 x 720 at 200 %.
for (const size of [[640, 360], [360, 640], [320, 480]])
  test(`everything is within reach at ${size.join(" x ")}`, async (t) => {
    const viewer = await open(t, [volume, ...labels, ...quick, "--turntable"], { size, folder });
    const { page } = viewer;
    await viewer.done();
    await page.evaluate(axeSource);
    const found = new Set();
    const check = async (where) => {
      for (const what of [...(await overflowing(page)), ...(await unreachable(page)), ...(await violations(page))]) found.add(`${where}: ${what}`);
    };
    await check("no panel");
    for (const title of await titlesOf(page)) {
      await viewer.panel(title);
      await page.getByRole("complementary", { name: title }).waitFor();
      assert.equal(await page.locator(".dock").count(), 1, "two panels in a small window");
      const { width, height } = await viewer.canvas.boundingBox();
      assert.ok(width >= 120 && height >= 60, `${width} x ${height} are left of the picture beside ${title}`);
      await check(title);
    }
    await viewer.panel("Animation");
    for (const menu of ["Save the picture", "Scene file", "Resolution and theme"]) {
      await viewer.button(menu).click();
      await check(menu);
      await page.keyboard.press("Escape");
    }
    for (const [key, tool] of [["m", "Click two points"], ["c", "Drag a face"]]) {
      await page.keyboard.press(key);
      await page.getByText(tool).waitFor();
      await check(tool);
      await page.keyboard.press(key);
    }
    await page.keyboard.press("s");
    await page.getByRole("toolbar", { name: "Slices" }).waitFor();
    await check("slices");
    await viewer.panel("Transfer function");
    await check("slices and a panel");
    await page.keyboard.press("Control+o");
    await page.getByRole("dialog", { name: "Open" }).waitFor();
    await check("the dialog that opens files");
    await page.keyboard.press("Escape");
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Keys and gestures" }).waitFor();
    await check("help");
    assert.deepEqual([...found], []);
  });

test("the first screen is within reach in a small window", async (t) => {
  const { page } = await open(t, quick, { size: [640, 360] });
  await page.getByText("Open a volume").waitFor();
  await page.evaluate(axeSource);
  assert.deepEqual([...(await overflowing(page)), ...(await unreachable(page)), ...(await violations(page))], []);
});

test("high contrast has borders, rings of focus, and shows what is chosen", async (t) => {
  const viewer = await open(t, [volume, ...labels, ...quick, "--turntable"], { folder });
  const { page } = viewer;
  await page.emulateMedia({ forcedColors: "active" });
  await viewer.done();
  await page.evaluate(axeSource);
  const found = new Set();
  const background = (locator) => locator.evaluate((element) => getComputedStyle(element).backgroundColor);
  const rail = page.getByLabel("Panels", { exact: true });
  for (const title of await titlesOf(page)) {
    const button = rail.getByRole("button", { name: title, exact: true });
    const before = await background(button);
    await button.click();
    await page.getByRole("complementary", { name: title }).waitFor();
    await page.mouse.move(400, 400);
    if ((await background(button)) === before) found.add(`${title} looks the same open and closed`);
    const plain = await page.evaluate(() =>
      [...document.querySelectorAll(".rail button, .top-bar button, .tools button, .dock .button, .dock .icon-button, .dock .number, .dock select, .dock .toggle input")]
        .filter((control) => {
          const style = getComputedStyle(control);
          return style.borderTopStyle === "none" || parseFloat(style.borderTopWidth) < 1 || style.borderTopColor === style.backgroundColor;
        })
        .map((control) => control.outerHTML.slice(0, 100)));
    for (const what of plain) found.add(`${title}: no border: ${what}`);
    for (const what of await violations(page)) found.add(`${title}: ${what}`);
    if (title !== "Animation") await button.click();
  }
  // Chosen and not, on and off.
  await viewer.panel("Camera");
  const [chosen, other] = await page.locator(".dock .segmented input").evaluateAll((all) =>
    [true, false].map((on) => getComputedStyle(all.find((one) => one.checked === on).nextElementSibling).backgroundColor));
  assert.notEqual(chosen, other, "what is chosen of two looks as what is not");
  await viewer.panel("Clip box");
  const cut = page.getByRole("switch", { name: "Cut the volume" });
  const off = await background(cut);
  await cut.click();
  await page.mouse.move(400, 400);
  assert.notEqual(await background(cut), off, "a switch looks the same on and off");
  // Every stop of the Tab key is seen.
  await page.locator(".view").focus();
  for (let stop = 0; stop < 60; ++stop) {
    await page.keyboard.press("Tab");
    const hidden = await page.evaluate(() => {
      const focused = document.activeElement;
      if (!focused || focused === document.body) return "";
      for (const element of [focused, focused.parentElement, focused.nextElementSibling]) {
        const style = element && getComputedStyle(element);
        if (style && style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2) return "";
      }
      return focused.outerHTML.slice(0, 120);
    });
    if (hidden) found.add(`no ring of focus: ${hidden}`);
  }
  assert.deepEqual([...found], []);
});
