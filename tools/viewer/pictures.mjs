// Draws the pictures of docs/viewer.md: screenshots of the viewer with the sample data.
// Usage: node tools/viewer/pictures.mjs [FOLDER]
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { startBrowser, startViewer } from "./chromium_page.mjs";

const folder = process.argv[2] ?? "docs/pictures";
mkdirSync(folder, { recursive: true });
const browser = await startBrowser();

async function shoot(name, args, act, colorScheme = "dark") {
  const viewer = await startViewer(args);
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, colorScheme });
  await page.goto(viewer.url);
  await act({
    page,
    press: (key) => page.keyboard.press(key),
    panel: (title) => page.getByLabel("Panels", { exact: true }).getByRole("button", { name: title, exact: true }).click(),
    done: async () => {
      await page.waitForTimeout(1200);
      await page.waitForFunction(() => /done$/.test(document.querySelector("[aria-label='Progress of the picture']")?.textContent ?? ""), undefined, { timeout: 120000 });
      await page.waitForTimeout(500);
    },
  });
  await page.screenshot({ path: join(folder, `viewer-${name}.png`) });
  await page.close();
  await viewer.end();
}

const head = "data/head-ct.nrrd";
await shoot("transfer", [head, "--preset", "ct-muscle-bone", "--spp", "64", "--camera", "28,8,1.6"], async ({ page, panel, done }) => {
  await panel("Transfer function");
  await page.waitForFunction(() => [...document.querySelectorAll("[role=radiogroup][aria-label=Presets] img")].filter((i) => i.naturalWidth > 0).length >= 6, undefined, { timeout: 60000 });
  await done();
});
await shoot("labels", ["examples/brain-regions.json", "--spp", "64", "--denoise", "decoupled"], async ({ panel, done }) => {
  await panel("Labels");
  await done();
});
await shoot("slices", [head, "--preset", "ct-bone", "--spp", "64", "--camera", "35,10,1.5"], async ({ page, press, done }) => {
  await done();
  await press("s");
  await done();
  const box = await page.getByRole("img", { name: "The rendered volume" }).boundingBox();
  await page.mouse.click(box.x + box.width * 0.55, box.y + box.height * 0.45);
  await done();
});
await shoot("lights", [head, "--preset", "ct-skin", "--spp", "128", "--camera", "-25,5,1.5"], async ({ panel, done }) => {
  await done();
  await panel("Lights and background");
  await done();
}, "light");
await shoot("opening", [], async ({ page }) => {
  await page.waitForTimeout(1500);
});
await browser.close();
