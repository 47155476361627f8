// Measures the viewer as its user has it, in a browser on the same machine: time from the start of the program
// to the first picture, frames drawn a second while the camera turns, and how long an edit takes from the
// page's message to the pixels that show it. JSON on standard output.
// Usage: node tools/viewer/speed.mjs [VOLUME [SECONDS]]
import { readFileSync } from "node:fs";
import { startBrowser, startViewer } from "./chromium_page.mjs";

const volume = process.argv[2] ?? "data/head-ct.nrrd";
const seconds = Number(process.argv[3] ?? 8);

/** In the page: notes when edits are sent, answered and drawn. The page answers a frame once it has drawn it. */
function watchSocket() {
  const log = { edits: new Map(), frames: [], drawn: [] };
  window.voxlumeSpeed = log;
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(...args) {
      super(...args);
      this.addEventListener("message", (event) => {
        if (typeof event.data === "string") {
          const message = JSON.parse(event.data);
          if (message.type === "edited" && message.seq != null) log.edits.get(message.seq).revision = message.revision;
          return;
        }
        const view = new DataView(event.data);
        const header = JSON.parse(new TextDecoder().decode(new Uint8Array(event.data, 4, view.getUint32(0, true))));
        log.frames[header.frame] = header;
      });
    }
    send(text) {
      const message = JSON.parse(text);
      const now = performance.now();
      if (message.type === "edit") log.edits.set(message.seq, { sent: now });
      if (message.type === "shown") log.drawn.push({ frame: message.frame, at: now });
      super.send(text);
    }
  };
}

/** In the page: what was drawn since `from` [ms of the page's clock]. */
function summary(from) {
  const { edits, frames, drawn } = window.voxlumeSpeed;
  const percentile = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];
  const shown = drawn.filter((d) => d.at >= from && frames[d.frame]?.moving).map((d) => ({ ...frames[d.frame], at: d.at }));
  const latencies = [];
  for (const edit of edits.values()) {
    if (edit.sent < from || edit.revision === undefined) continue;
    const seen = drawn.find((d) => d.at >= edit.sent && frames[d.frame]?.revision >= edit.revision);
    if (seen) latencies.push(seen.at - edit.sent);
  }
  const last = shown.at(-1);
  const middle = (of) => percentile(shown.map(of), 0.5);
  return {
    fps: shown.length > 1 ? ((shown.length - 1) * 1000) / (last.at - shown[0].at) : 0,
    internal: last && [last.width, last.height],
    shown_at: last?.full,
    spp: middle((f) => f.spp),
    compile_ms: 1e3 * middle((f) => f.compile_s),
    trace_ms: 1e3 * middle((f) => f.trace_s),
    denoise_ms: 1e3 * middle((f) => f.denoise_s),
    develop_ms: 1e3 * middle((f) => f.develop_s),
    edit_to_pixel_ms: { median: percentile(latencies, 0.5), p95: percentile(latencies, 0.95), edits: latencies.length },
  };
}

async function measure(browser, [width, height]) {
  const begin = performance.now();
  const viewer = await startViewer([volume, "--size", `${width}x${height}`]);
  const page = await browser.newPage({ viewport: { width: width + 640, height: height + 360 } });
  await page.addInitScript(watchSocket);
  await page.goto(viewer.url);
  await page.waitForFunction(() => window.voxlumeSpeed.drawn.length > 0, undefined, { polling: 5 });
  const firstPicture_s = (performance.now() - begin) / 1000;
  // The picture is to be of this size whatever bars and panels leave it.
  const canvas = page.locator(".view canvas").first();
  await page.addStyleTag({ content: `.view { position: fixed !important; width: ${width}px !important; height: ${height}px !important; }` });
  await page.waitForTimeout(2000);
  const box = await canvas.boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const drag = async (length_s) => {
    const from = await page.evaluate(() => performance.now());
    await page.mouse.move(...middle);
    await page.mouse.down();
    for (let i = 0, until = performance.now() + 1000 * length_s; performance.now() < until; ++i) {
      await page.mouse.move(middle[0] + 120 * Math.sin(i / 30), middle[1] + 20 * Math.sin(i / 47));
      await page.waitForTimeout(12);
    }
    await page.mouse.up();
    await page.waitForTimeout(700);
    return page.evaluate(summary, from);
  };
  await drag(2);
  const orbit = await drag(seconds);

  // Single steps of a picture at rest, by the keyboard: of the camera and of the transfer function.
  const steps = async (element) => {
    await element.focus();
    const from = await page.evaluate(() => performance.now());
    for (let i = 0; i < 20; ++i) {
      await page.keyboard.press("ArrowRight");
      await page.waitForTimeout(900);
    }
    return (await page.evaluate(summary, from)).edit_to_pixel_ms;
  };
  const step = await steps(page.locator(".view"));
  if (!(await page.getByRole("slider", { name: "Density" }).count()))
    await page.getByRole("button", { name: "Transfer function", exact: true }).first().click();
  const transfer_step = await steps(page.getByRole("slider", { name: "Density" }));
  await page.close();
  await viewer.end();
  return { size: [width, height], first_picture_s: firstPicture_s, orbit, step, transfer_step };
}

const browser = await startBrowser();
const sizes = [];
for (const size of [[640, 360], [1280, 720]]) sizes.push(await measure(browser, size));
await browser.close();
const machine = readFileSync("/proc/cpuinfo", "utf8").match(/model name\s*: (.*)/)?.[1];
console.log(JSON.stringify({ machine, volume, seconds, sizes }, null, 2));
