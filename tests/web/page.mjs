// The page of the viewer as a test has it.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { startBrowser, startViewer } from "../../tools/viewer/chromium_page.mjs";

const top = new URL("../../", import.meta.url).pathname;
export const program = process.env.VOXLUME_BINARY ?? `${top}build/release/voxlume`;

/** The head CT, or the built-in phantom where the sample data is not there. */
export const headCt = existsSync(`${top}data/head-ct.nrrd`) ? `${top}data/head-ct.nrrd` : "phantom";

/** Not there without the sample data (./vx samples). */
export const sample = (name) => (existsSync(`${top}data/${name}`) ? `${top}data/${name}` : null);
export const missing = (...names) => (names.every(sample) ? false : "without the sample data");
export const samples = `${top}data`;

/** What most tests need of a picture, and no more. */
export const quick = ["--spp", "4", "--denoise", "none"];

let browser;

/** In the page: what it and its server have said to each other, for Page.settled(). */
function watchSocket() {
  const seen = { edit: 0, answered: 0, scenes: 0, revision: 0, frames: [], shown: null };
  window.seenBySocket = seen;
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(...args) {
      super(...args);
      this.addEventListener("message", (event) => {
        if (typeof event.data !== "string") {
          const length = new DataView(event.data).getUint32(0, true);
          seen.frames.push(JSON.parse(new TextDecoder().decode(new Uint8Array(event.data, 4, length))));
          return;
        }
        const message = JSON.parse(event.data);
        if (message.type === "edited" || message.type === "scene") seen.revision = message.revision;
        if (message.type === "scene") seen.scenes = 0;
        if ((message.type === "edited" || message.type === "refused") && message.seq) seen.answered = message.seq;
        if (message.type === "hello") Object.assign(seen, { edit: 0, answered: 0, scenes: 0, frames: [], shown: null });
      });
    }
    send(text) {
      const message = JSON.parse(text);
      if (message.type === "edit" || message.type === "passing") seen.edit = message.seq;
      if (message.type === "undo" || message.type === "redo" || message.type === "load") ++seen.scenes;
      if (message.type === "shown") seen.shown = seen.frames.findLast((header) => header.frame === message.frame);
      super.send(text);
    }
  };
}

/** A viewer and its page. Ends with the test `t`, which fails on errors of the page. `args` may be a function of the
 * test's own folder, which the viewer opens files of; `resolution` is the picture's pixels for each of the page. */
export async function open(t, args, options = {}) {
  const { scheme = "dark", folder, environment, size = [1280, 720], resolution = 0.5, touch = false } = options;
  browser ??= await startBrowser();
  const scratch = mkdtempSync(join(tmpdir(), "voxlume-page-"));
  const viewer = await startViewer([...(typeof args === "function" ? args(scratch) : args), "--folder", folder ?? scratch], environment);
  const [width, height] = size;
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, acceptDownloads: true, hasTouch: touch });
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await context.addInitScript(watchSocket);
  await context.addInitScript((share) => location.protocol === "http:" && localStorage.setItem("voxlume.resolution", String(share)), resolution);
  const page = await context.newPage();
  const out = new Page(page, viewer, scratch);
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  t.after(async () => {
    await context.close();
    const code = await out.viewer.end();
    rmSync(scratch, { recursive: true, force: true });
    if (errors.length) throw new Error(`errors of the page: ${errors.join("; ")}`);
    if (code !== 0 && code !== null) throw new Error(`the viewer ended with ${code}`);
  });
  await page.goto(viewer.url);
  return out;
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

  /** Until the picture on the canvas is done and shows all that was edited, at the size of the view. */
  async done() {
    await this.page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    await this.page.waitForFunction(() => {
      const { edit, answered, scenes, revision, shown } = window.seenBySocket;
      const view = document.querySelector(".view");
      const share = JSON.parse(localStorage.getItem("voxlume.resolution"));
      return shown?.done && !shown.moving && edit === answered && scenes === 0 && shown.revision >= revision &&
        shown.full[0] === Math.max(64, Math.round(view.clientWidth * share)) && shown.full[1] === Math.max(64, Math.round(view.clientHeight * share));
    }, undefined, { timeout: 60000 });
  }

  /** Until a further picture is on the canvas after `act`, and is done: for what changes the picture but not the scene. */
  async newPicture(act) {
    const before = (await this.header())?.frame ?? -1;
    await act();
    await this.page.waitForFunction((frame) => window.seenBySocket.shown?.frame > frame, before, { timeout: 60000 });
    await this.done();
  }

  /** Loads a scene as the menu does with a file. */
  async load(scene) {
    await this.button("Scene file").click();
    const [chooser] = await Promise.all([this.page.waitForEvent("filechooser"), this.page.getByRole("menuitem", { name: /Load scene/ }).click()]);
    await chooser.setFiles({ name: "scene.json", mimeType: "application/json", buffer: Buffer.from(JSON.stringify(scene)) });
  }

  /** Header of the picture on the canvas. */
  header() {
    return this.page.evaluate(() => window.seenBySocket.shown);
  }

  /** What the status bar tells of the picture. */
  progress() {
    return this.page.getByLabel("Progress of the picture").innerText();
  }

  /** Undoes one step. */
  async undo() {
    await this.button("Undo").click();
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

/** A cube of 48 x 48 x 48 voxels of 1 mm (or `side_mm`; `dz` mm along z), its first voxel's centre at the origin. */
function writeCube(file, valueAt, dz = 1, side_mm = 1) {
  const n = 48, voxels = new Uint16Array(n * n * n);
  for (let k = 0, at = 0; k < n; ++k) for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i, ++at) voxels[at] = valueAt(i, j, k);
  const header = `NRRD0004\ntype: uint16\ndimension: 3\nsizes: ${n} ${n} ${n}\nencoding: raw\nendian: little\nspace: left-posterior-superior\nspace directions: (${side_mm},0,0) (0,${side_mm},0) (0,0,${dz})\nspace origin: (0,0,0)\n\n`;
  writeFileSync(file, Buffer.concat([Buffer.from(header), Buffer.from(voxels.buffer)]));
  return file;
}

/** A small NRRD file: a ball of 40 voxels of that side in 48. */
export const writeBallOf = (file, side_mm) => writeCube(file, (i, j, k) => ((i - 23.5) ** 2 + (j - 23.5) ** 2 + (k - 23.5) ** 2 < 400 ? 200 : 0), side_mm, side_mm);
/** A small NRRD file: a ball of 40 mm about (23.5, 23.5, 23.5) with the value 200. */
export const writeBall = (file) => writeBallOf(file, 1);
/** A small NRRD file: 1000 + 10 x. */
export const writeRamp = (file) => writeCube(file, (i) => 1000 + 10 * i);

/** A small NRRD file: 0 and 1000 by turns along z, where a voxel is 1.7 mm. */
export const writeWaves = (file) => writeCube(file, (i, j, k) => 1000 * (k % 2), 1.7);
/** A small NRRD file of labels: 1 to 4 in quarters from the patient's right to the left. */
export const writeQuarters = (file) => writeCube(file, (i) => 1 + Math.floor(i / 12));

export { readFileSync, startViewer };
