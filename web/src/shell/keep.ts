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

/** GET of /api/PATH; null, and told, where that fails. */
async function fetched(path: string, name: string): Promise<Response | null> {
  try {
    const response = await fetch(path);
    if (!response.ok) throw new Error((await response.text()).trim() || `${response.status}`);
    return response;
  } catch (error) {
    showToast({ tone: "error", text: `${name} could not be saved: ${(error as Error).message}` });
    return null;
  }
}

async function download(path: string, name: string): Promise<void> {
  const response = await fetched(path, name);
  if (response) saveBlob(await response.blob(), name);
}

/** Uploads that the user was told of. */
const told = new Set<string>();

/** Says once of every upload that the scene file names it and does not hold it. */
function tellOfUploads(response: Response): void {
  const beside = JSON.parse(response.headers.get("X-Beside") ?? "[]") as string[];
  if (beside.every((name) => told.has(name))) return;
  for (const name of beside) told.add(name);
  showToast({
    text: `The scene file does not contain ${beside.join(", ")}: to render it, put ${beside.length > 1 ? "these" : "it"} beside the scene file.`,
  });
}

export const savePng = () => download("api/picture.png", `${baseName()}.png`);
export const saveExr = () => download("api/picture.exr", `${baseName()}.exr`);

export async function saveScene(): Promise<void> {
  const name = `${baseName()}-scene.json`;
  const response = await fetched("api/scene.json", name);
  if (!response) return;
  saveBlob(await response.blob(), name);
  tellOfUploads(response);
}

/** Copies a link that opens this scene: for whoever may use this viewer, while what was uploaded is there.
 * Where the browser does not let pages copy (plain HTTP to another machine) the link goes into the address bar. */
export async function copyLink(): Promise<void> {
  const response = await fetched("api/scene.json", "The link");
  if (!response) return;
  const address = new URL(document.baseURI);
  address.hash = await encodeScene(await response.json());
  try {
    await navigator.clipboard.writeText(address.href);
    showToast({ text: "Link to this scene copied" });
  } catch {
    history.replaceState(null, "", address.href);
    showToast({ text: "The browser does not let the page copy: the link is in the address bar" });
  }
}
