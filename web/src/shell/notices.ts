import { on } from "../state/connection";
import { refusal } from "../state/scene";
import { showToast } from "../ui/toast";

/** Tells what the server could not do. */
export function announceTrouble(): void {
  on("trouble", (message) => showToast({ tone: "warning", text: message.message }));
  refusal.subscribe((what) => {
    if (what) showToast({ tone: "warning", text: `${what.where}: ${what.message}` });
  });
}
