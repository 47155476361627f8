// The page of the viewer as a test has it.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { startBrowser, startViewer } from "../../tools/viewer/chromium_page.mjs";

const top = new URL("../../", import.meta.url).pathname;
const program = process.env.VOXLUME_BINARY ?? `${top}build/release/voxlume`;

/** The head CT, or the built-in phantom where the sample data is not there. */
export const headCt = existsSync(`${top}data/head-ct.nrrd`) ? `${top}data/head-ct.nrrd` : "phantom";

let browser;

/** A viewer and its page at 1280 x 720. Ends with the test `t`, which fails on errors of the page. */
export async function open(t, args, { scheme = "dark", folder, environment } = {}) {
  browser ??= await startBrowser();
  const scratch = mkdtempSync(join(tmpdir(), "voxlume-page-"));
  const viewer = await startViewer([...args, "--folder", folder ?? scratch], environment);
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, colorScheme: scheme, acceptDownloads: true });
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  t.after(async () => {
    await context.close();
    const code = await viewer.end();
    rmSync(scratch, { recursive: true, force: true });
    if (errors.length) throw new Error(`errors of the page: ${errors.join("; ")}`);
    if (code !== 0 && code !== null) throw new Error(`the viewer ended with ${code}`);
  });
  await page.goto(viewer.url);
  return new Page(page, viewer, scratch);
}

export async function closeBrowser() {
  await browser?.close();
  browser = undefined;
}

class Page {
  constructor(page, viewer, scratch) {
    this.page = page;
    this.viewer = viewer;
    this.scratch = scratch;
  }

  get canvas() {
    return this.page.getByRole("img", { name: "The rendered volume" });
  }

  /** The scene as the server has it; fields that are as by default are left out of its file. */
  async scene() {
    const scene = await this.page.evaluate(async () => (await fetch("/api/scene.json")).json());
    scene.camera = { azimuth_deg: 0, elevation_deg: 0, zoom: 1, ...scene.camera };
    return scene;
  }

  /** Until the scene as the server has it satisfies `pred`; then the scene. */
  async sceneWith(pred, what) {
    for (let tries = 0; tries < 100; ++tries) {
      const scene = await this.scene();
      if (pred(scene)) return scene;
      await this.page.waitForTimeout(50);
    }
    throw new Error(`the scene never had ${what}`);
  }

  /** Until a picture is there and done. */
  async done() {
    await this.page.waitForFunction(() => /done$/.test(document.querySelector("[aria-label='Progress of the picture']")?.textContent ?? ""), undefined, { timeout: 60000 });
  }

  /** What the canvas shows, a PNG file. */
  async shown(name) {
    const url = await this.canvas.evaluate((canvas) => canvas.toDataURL("image/png"));
    const file = join(this.scratch, name);
    writeFileSync(file, Buffer.from(url.slice(url.indexOf(",") + 1), "base64"));
    return file;
  }

  /** What `voxlume render` makes of the scene, a PNG file. */
  async rendered(name) {
    const sceneFile = join(this.scratch, `${name}.json`), file = join(this.scratch, name);
    writeFileSync(sceneFile, JSON.stringify(await this.scene()));
    execFileSync(program, ["render", sceneFile, "-o", file], { stdio: "pipe" });
    return file;
  }

  /** Drags the mouse by [dx, dy] pixels, from the middle of the picture unless told. */
  async drag([dx, dy], { from, button = "left" } = {}) {
    const box = await this.canvas.boundingBox();
    const [x, y] = from ?? [box.x + box.width / 2, box.y + box.height / 2];
    await this.page.mouse.move(x, y);
    await this.page.mouse.down({ button });
    for (let i = 1; i <= 8; ++i) {
      await this.page.mouse.move(x + (dx * i) / 8, y + (dy * i) / 8);
      await this.page.waitForTimeout(20);
    }
    await this.page.mouse.up({ button });
  }

  button(name) {
    return this.page.getByRole("button", { name, exact: true });
  }

  /** Opens the panel of that title. */
  async panel(title) {
    await this.page.getByRole("complementary", { name: "Panels" }).or(this.page.getByRole("navigation", { name: "Panels" })).or(this.page.getByRole("toolbar", { name: "Panels" })).getByRole("button", { name: title, exact: true }).click();
  }
}

/** Peak signal to noise of two pictures on display [dB]; Infinity where they are equal. */
export function psnr(a, b) {
  const { psnr: value } = JSON.parse(execFileSync(program, ["compare", a, b, "--metric", "psnr", "--json"], { encoding: "utf8" }));
  return value ?? Infinity;
}

/** A small NRRD file: a ball of 40 voxels across in a cube of 48. */
export function writeBall(file) {
  const n = 48, voxels = Buffer.alloc(n * n * n);
  for (let k = 0, at = 0; k < n; ++k)
    for (let j = 0; j < n; ++j)
      for (let i = 0; i < n; ++i, ++at) voxels[at] = (i - 23.5) ** 2 + (j - 23.5) ** 2 + (k - 23.5) ** 2 < 400 ? 200 : 0;
  writeFileSync(file, Buffer.concat([Buffer.from(`NRRD0004\ntype: uint8\ndimension: 3\nsizes: ${n} ${n} ${n}\nencoding: raw\nspace: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n`), voxels]));
  return file;
}

export { readFileSync };
