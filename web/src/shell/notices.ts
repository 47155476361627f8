import { on } from "../state/connection";
import { warnings } from "../state/session";
import { refusal } from "../state/scene";
import { showToast } from "../ui/toast";

/** Tells what the server could not do, and how what takes long has ended. */
export function announceTrouble(): void {
  on("trouble", (message) => showToast({ tone: "warning", text: message.message }));
  let known: readonly string[] = [];
  warnings.subscribe((lines) => {
    for (const line of lines) if (!known.includes(line)) showToast({ tone: "warning", text: line });
    known = lines;
  });
  let exporting = false;  // a page that comes later is told of an export's end, too
  on("export", (message) => {
    if (exporting && message.state === "done") showToast({ text: `${message.file} is written` });
    if (message.state === "failed") showToast({ tone: "error", text: message.message ?? `${message.file} could not be written` });
    exporting = message.state === "running";
  });
  refusal.subscribe((what) => {
    if (what) showToast({ tone: "warning", text: `${what.where}: ${what.message}` });
  });
}
