import { scene } from "../state/scene";
import { showToast } from "../ui/toast";
import { encodeScene } from "./link";

/** Pictures, scenes and links to take along. */

function saveBlob(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function baseName(): string {
  const path = scene.peek()?.volume.path ?? "";
  return (
    path
      .split("/")
      .pop()
      ?.replace(/\.(nii\.gz|[^.]+)$/, "") || "voxlume"
  );
}

/** Downloads /api/PATH; tells what went wrong. */
async function download(path: string, name: string): Promise<void> {
  try {
    const response = await fetch(path);
    if (!response.ok) throw new Error((await response.text()).trim() || `${response.status}`);
    saveBlob(await response.blob(), name);
  } catch (error) {
    showToast({ tone: "error", text: `${name} could not be saved: ${(error as Error).message}` });
  }
}

export const savePng = () => download("api/picture.png", `${baseName()}.png`);
export const saveExr = () => download("api/picture.exr", `${baseName()}.exr`);
export const saveScene = () => download("api/scene.json", `${baseName()}-scene.json`);

/** Copies a link that opens this scene: for whoever may use this viewer and has the same volume at the same path.
 * Where the browser does not let pages copy (plain HTTP to another machine) the link goes into the address bar. */
export async function copyLink(): Promise<void> {
  const now = scene.peek();
  if (!now) return;
  const address = new URL(document.baseURI);
  address.hash = await encodeScene(now);
  try {
    await navigator.clipboard.writeText(address.href);
    showToast({ text: "Link to this scene copied" });
  } catch {
    history.replaceState(null, "", address.href);
    showToast({ text: "The browser does not let the page copy: the link is in the address bar" });
  }
}
