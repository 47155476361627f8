import { signal } from "@preact/signals";
import { showToast } from "../ui/toast";

/** Files on their way to the server. */

/** What is on its way to the server. */
export interface Upload {
  /** Of the file, or of what the files are together. */
  name: string;
  files: number;
  /** Files that are there. */
  done: number;
  bytes: number;
  sent: number;
  cancel(): void;
}

/** Null: nothing is on its way. */
export const upload = signal<Upload | null>(null);

/** A file and its name among those that it comes with. */
export interface NamedFile {
  name: string;
  file: File;
}

/** As many files of a set as the server takes. */
const kMostFiles = 20000;

/** PUT with progress, which fetch does not tell. Resolves to the path to open; rejects with null where it was cancelled. */
function send({ name, file }: NamedFile, set: Record<string, string>): Promise<string> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const before = upload.peek()!.sent;
    const advance = (bytes: number, done = 0) => {
      const now = upload.peek();
      if (now) upload.value = { ...now, sent: before + bytes, done: now.done + done };
    };
    request.open("PUT", `api/upload?${new URLSearchParams({ ...set, name })}`);
    request.upload.onprogress = (event) => advance(event.loaded);
    request.onload = () => {
      if (request.status !== 200)
        return reject(new Error(request.responseText.trim() || `the server answered ${request.status}`));
      advance(file.size, 1);
      resolve((JSON.parse(request.responseText) as { path: string }).path);
    };
    request.onerror = () => reject(new Error("the connection was lost. Is the viewer still running?"));
    request.onabort = () => reject(null);
    upload.value = { ...upload.peek()!, cancel: () => request.abort() };
    request.send(file);
  });
}

/** Uploads files, which are one volume together where they are several: a header and its voxels, or the slices of a
 * series. Resolves to the path to open; to null where that failed, which is told. `folder` is what they are called
 * together. */
export async function uploaded(files: readonly NamedFile[], folder = "series"): Promise<string | null> {
  const first = files[0];
  if (!first || upload.peek()) return null;
  if (files.length > kMostFiles) {
    showToast({ tone: "error", text: `These are ${files.length} files; expected at most ${kMostFiles}` });
    return null;
  }
  const several = files.length > 1;
  const set: Record<string, string> = several ? { set: crypto.getRandomValues(new Uint32Array(4)).join("-"), folder } : {};
  const name = several ? folder : first.name;
  const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
  upload.value = { name, files: files.length, done: 0, bytes, sent: 0, cancel: () => undefined };
  try {
    let path: string | null = null;
    for (const file of files) path = await send(file, set);
    return path;
  } catch (error) {
    if (error) showToast({ tone: "error", text: `${name}: ${(error as Error).message}` });
    return null;
  } finally {
    upload.value = null;
  }
}
