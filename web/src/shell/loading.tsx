import { useEffect, useState } from "preact/hooks";
import { connect, link, type LinkState } from "../state/connection";
import { compiling, frame } from "../state/frame";
import { scene } from "../state/scene";
import { cancelOpening, status } from "../state/session";
import { Button, IconButton } from "../ui/controls";
import { Icon } from "../ui/icons";
import { signal } from "@preact/signals";
import { formatBytes } from "./file-browser";
import { upload } from "./upload";
import { openDialog } from "./opening";

/** What the page waits for, and what went wrong with it. */

function Bar({ share, label }: { share?: number; label: string }) {
  const known = share !== undefined;
  return (
    <div
      class={known ? "bar" : "bar unknown"}
      role="progressbar"
      aria-label={label}
      aria-valuenow={known ? Math.round(share * 100) : undefined}
      aria-valuemin={0}
      aria-valuemax={100}
    >
      <i style={{ width: known ? `${share * 100}%` : undefined }} />
    </div>
  );
}

/** Uploading, reading, preparing: a card over the picture. */
export function Loading() {
  const sending = upload.value;
  if (sending)
    return (
      <div class="card floating" role="status">
        <div class="card-title">
          <strong>Uploading {sending.name}</strong>
          <span>
            {sending.files > 1 && `${sending.done} of ${sending.files} files, `}
            {formatBytes(sending.sent)} of {formatBytes(sending.bytes)}
          </span>
          <IconButton icon="close" label="Cancel the upload" onClick={sending.cancel} />
        </div>
        <Bar share={sending.bytes ? sending.sent / sending.bytes : undefined} label="Upload" />
      </div>
    );
  const { stage, what, share, message } = status.value;
  if (link.value.kind === "lost" || (stage !== "reading" && stage !== "preparing")) {
    if (!scene.value || frame.value || link.value.kind !== "open" || stage !== "ready") return null;
    return (
      <div class="card floating" role="status">
        <div class="card-title">
          <strong>Rendering the first picture</strong>
        </div>
        <Bar share={compiling.value ?? undefined} label="First picture" />
      </div>
    );
  }
  return (
    <div class="card floating" role="status">
      <div class="card-title">
        <strong>
          {stage === "reading" ? "Reading" : "Preparing"} {what}
        </strong>
        {share !== undefined && <span>{Math.round(share * 100)} %</span>}
        <IconButton icon="close" label="Cancel opening" onClick={cancelOpening} />
      </div>
      <Bar share={share} label="Opening" />
      {message && <p>{message}</p>}
    </div>
  );
}

const dismissed = signal<unknown>(null);

/** Why the last try to open something failed, while another volume is still shown. */
export function OpenFailed() {
  const now = status.value;
  if (now.stage !== "failed" || !scene.value || dismissed.value === now) return null;
  return (
    <div class="card floating failed" role="alert">
      <div class="card-title">
        <Icon name="warning" />
        <strong>{now.what ?? "It"} could not be opened</strong>
        <IconButton icon="close" label="Dismiss" onClick={() => (dismissed.value = now)} />
      </div>
      <p>{now.message}</p>
      <Button
        onClick={() => {
          dismissed.value = now;
          openDialog.value = true;
        }}
      >
        Open another
      </Button>
    </div>
  );
}

/** Whether the server turned this browser away; it says so by HTTP only. Asked at each failed attempt: a viewer that
 * was started again at the same port has another token. */
function useRefusal(state: LinkState): string {
  const [refusal, setRefusal] = useState("");
  useEffect(() => {
    if (state.kind !== "lost") return setRefusal("");
    fetch("api/files?path=")
      .then(async (response) => setRefusal(response.status === 403 ? (await response.text()).trim() : ""))
      .catch(() => undefined);
  }, [state]);
  return refusal;
}

/** While there is no connection: when it is tried again, or what to do. */
export function ConnectionBanner() {
  const state = link.value;
  const lost = state.kind === "lost";
  const refusal = useRefusal(state);
  const [now, setNow] = useState(Date.now());
  useEffect(() => {
    if (!lost) return;
    setNow(Date.now());
    const timer = setInterval(() => setNow(Date.now()), 500);
    return () => clearInterval(timer);
  }, [lost, state]);
  if (!lost) return null;
  const wait_s = Math.max(0, Math.ceil((state.retry_at_ms - now) / 1000));
  return (
    <div class="banner" role="alert">
      <Icon name="warning" />
      <span>
        {refusal ||
          `Not connected to the viewer. ${wait_s > 0 ? `Trying again in ${wait_s} s.` : "Trying again."} If it has ended, start voxlume view again.`}
      </span>
      {!refusal && <Button onClick={connect}>Try now</Button>}
    </div>
  );
}
