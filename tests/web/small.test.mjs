// Small windows and large zooms, and the system's high contrast.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { openFull, overflowing, panelTitles, troubles, unreachable, violations } from "./checks.mjs";
import { closeBrowser, open, quick } from "./page.mjs";

after(closeBrowser);

/** One panel at a time, which leaves something of the picture. */
async function crowded(page) {
  const out = [];
  if ((await page.locator(".dock").count()) > 1) out.push("two panels in a small window");
  const { width, height } = await page.getByRole("img", { name: "The rendered volume" }).boundingBox();
  const isSliced = await page.locator(".with-slices").count();
  if (!isSliced && (width < 120 || height < 60)) out.push(`${width} x ${height} are left of the picture`);
  return out;
}

// 640 x 360 is a window of 1280 x 720 at 200 %.
for (const size of [[640, 360], [360, 640], [320, 480]])
  test(`everything is within reach at ${size.join(" x ")}`, async (t) => {
    const viewer = await openFull(t, { size });
    assert.deepEqual(await troubles(viewer, [crowded, overflowing, unreachable, violations]), []);
  });

test("the first screen is within reach in a small window", async (t) => {
  const { page } = await open(t, quick, { size: [640, 360] });
  await page.getByText("Open a volume").waitFor();
  assert.deepEqual([...(await overflowing(page)), ...(await unreachable(page)), ...(await violations(page))], []);
});

test("high contrast has borders, rings of focus, and shows what is chosen", async (t) => {
  const viewer = await openFull(t);
  const { page } = viewer;
  await page.emulateMedia({ forcedColors: "active" });
  const found = new Set();
  const background = (locator) => locator.evaluate((element) => getComputedStyle(element).backgroundColor);
  const rail = page.getByLabel("Panels", { exact: true });
  for (const title of await panelTitles(page)) {
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
