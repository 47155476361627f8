import { signal } from "@preact/signals";
import { Button } from "./controls";
import { Icon } from "./icons";

/** Short messages at the lower edge of the page. */

export interface Toast {
  text: string;
  tone?: "info" | "warning" | "error";
  /** What can be done about it; a button. */
  action?: { label: string; run(): void };
}

const shownToasts = signal<(Toast & { id: number })[]>([]);
let toasts = 0;
const kShown_ms = 5000;
const kErrorShown_ms = 12000;
const kActionShown_ms = 30000;
/** As slow readers need. */
const kLetter_ms = 80;

/** Shows a message for some seconds, long ones longer; the same text again renews it. */
export function showToast(toast: Toast): void {
  const id = ++toasts;
  shownToasts.value = [...shownToasts.value.filter((other) => other.text !== toast.text), { ...toast, id }].slice(-4);
  const least_ms = toast.action ? kActionShown_ms : toast.tone === "error" ? kErrorShown_ms : kShown_ms;
  setTimeout(() => dismiss(id), Math.max(least_ms, kLetter_ms * toast.text.length));
}

function dismiss(id: number): void {
  shownToasts.value = shownToasts.value.filter((toast) => toast.id !== id);
}

export function Toasts() {
  return (
    <div class="toasts" role="status" aria-live="polite">
      {shownToasts.value.map((toast) => (
        <div key={toast.id} class={`toast ${toast.tone ?? "info"}`}>
          {toast.tone && toast.tone !== "info" && <Icon name="warning" />}
          <span>{toast.text}</span>
          {toast.action && (
            <Button
              onClick={() => {
                dismiss(toast.id);
                toast.action!.run();
              }}
            >
              {toast.action.label}
            </Button>
          )}
          <button type="button" class="dismiss" aria-label="Dismiss" onClick={() => dismiss(toast.id)}>
            <Icon name="close" size={12} />
          </button>
        </div>
      ))}
    </div>
  );
}
