import { signal } from "@preact/signals";
import { loadScene, openPath } from "../state/scene";
import { showToast } from "../ui/toast";
import { decodeScene } from "./link";

/** Opening what the user drops, picks or follows a link to. */

export interface Upload {
  name: string;
  bytes: number;
  sent: number;
  cancel(): void;
}

/** The file on its way to the server; null: none. */
export const upload = signal<Upload | null>(null);

/** PUT with progress, which fetch does not tell. Resolves to the path to open. */
function send(file: File): Promise<string> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("PUT", `api/upload?name=${encodeURIComponent(file.name)}`);
    request.upload.onprogress = (event) => {
      if (upload.value) upload.value = { ...upload.value, sent: event.loaded };
    };
    request.onload = () => {
      if (request.status === 200) resolve((JSON.parse(request.responseText) as { path: string }).path);
      else reject(new Error(request.responseText.trim() || `the server answered ${request.status}`));
    };
    request.onerror = () => reject(new Error("the connection was lost. Is the viewer still running?"));
    request.onabort = () => reject(null);
    upload.value = { name: file.name, bytes: file.size, sent: 0, cancel: () => request.abort() };
    request.send(file);
  });
}

/** A scene file is read here: it need not go through the folder of uploads. */
async function openSceneFile(file: File): Promise<void> {
  try {
    loadScene(JSON.parse(await file.text()));
  } catch (error) {
    showToast({ tone: "error", text: `${file.name} is no JSON: ${(error as Error).message}` });
  }
}

/** Headers of formats whose voxels are in a second file. */
const kHeaders = /\.(mhd|nhdr|hdr)$/i;

/** Uploads files and opens the one that is the volume: of several, the header. */
export async function openFiles(files: readonly File[]): Promise<void> {
  const first = files[0];
  if (!first) return;
  if (files.length === 1 && /\.json$/i.test(first.name)) return openSceneFile(first);
  if (files.length > 1 && files.every((file) => /\.(dcm|ima)$|^[^.]+$/i.test(file.name)))
    return showToast({
      tone: "warning",
      text: "A DICOM series is opened from its folder: start `voxlume view` with that folder, or convert it to one file first.",
    });
  try {
    const paths = new Map<string, string>();
    for (const file of files) paths.set(file.name, await send(file));
    const main = files.find((file) => kHeaders.test(file.name)) ?? first;
    openPath(paths.get(main.name)!);
  } catch (error) {
    if (error) showToast({ tone: "error", text: `${upload.value?.name}: ${(error as Error).message}` });
  } finally {
    upload.value = null;
  }
}

/** Lets the user choose files. */
export function pickFiles(accept = ""): void {
  const input = document.createElement("input");
  input.type = "file";
  input.multiple = true;
  input.accept = accept;
  input.onchange = () => void openFiles([...(input.files ?? [])]);
  input.click();
}

/** Opens the scene of the page's own address, once: reloading later keeps what has been changed since. */
export async function openLinkedScene(): Promise<void> {
  try {
    const linked = await decodeScene(location.hash);
    if (linked) loadScene(linked);
  } catch (error) {
    showToast({ tone: "error", text: (error as Error).message });
  }
  if (location.hash) history.replaceState(null, "", location.pathname + location.search);
}
