// Starts `voxlume view` and a headless Chromium with its page, for tests and measurements.
import { spawn } from "node:child_process";
import { createRequire } from "node:module";
import { existsSync } from "node:fs";

const top = new URL("../../", import.meta.url).pathname;
const require = createRequire(`${top}web/package.json`);
export const { chromium } = require("playwright-core");

/** Chromium's program; null where there is none. */
export function chromiumPath() {
  const named = process.env.VOXLUME_CHROMIUM;
  return [named, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((p) => p && existsSync(p)) ?? null;
}

/** Viewers that run. They end with this process, however that ends: by an error that nobody takes, too, and by signals. */
const running = new Set();
process.on("exit", () => running.forEach((child) => child.kill("SIGINT")));
for (const [signal, code] of [["SIGHUP", 129], ["SIGINT", 130], ["SIGTERM", 143]]) process.on(signal, () => process.exit(code));

/** The program as a viewer; `url` opens it. `end()` is its Ctrl-C and gives its exit code. Port 0 is any that is free. */
export async function startViewer(args, environment = {}, port = 0) {
  const program = process.env.VOXLUME_BINARY ?? `${top}build/release/voxlume`;
  const child = spawn(program, ["view", "--no-open", "--port", `${port}`, ...args], {
    cwd: top,
    env: { ...process.env, VOXLUME_PAGE: `${top}build/web`, VOXLUME_SAMPLES: `${top}data`, ...environment },
    stdio: ["ignore", "pipe", "inherit"],
  });
  running.add(child);
  const exited = new Promise((resolve) => child.once("exit", (code) => resolve(code)));
  exited.then(() => running.delete(child));
  const url = await new Promise((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (data) => {
      text += data;
      if (text.includes("\n")) resolve(text.trim());
    });
    exited.then((code) => reject(new Error(`voxlume view ended with ${code}`)));
  });
  return {
    url,
    end() {
      child.kill("SIGINT");
      return exited;
    },
    kill() {
      child.kill("SIGKILL");
      return exited;
    },
  };
}

/** A browser without a screen. */
export function startBrowser() {
  return chromium.launch({ executablePath: chromiumPath(), args: ["--no-sandbox", "--disable-dev-shm-usage"] });
}
