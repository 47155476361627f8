import { namedInFolder } from "./files";
import type { NamedFile } from "./upload";

/** What a drop brings: files, and the files of folders. */

const fileOf = (entry: FileSystemFileEntry) => new Promise<File>((resolve, reject) => entry.file(resolve, reject));

/** A reader gives some entries a time, and none at the end. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const out: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return out;
    out.push(...some);
  }
}

async function filesBelow(entry: FileSystemEntry): Promise<{ path: string; file: File }[]> {
  if (entry.isFile) return [{ path: entry.fullPath.slice(1), file: await fileOf(entry as FileSystemFileEntry) }];
  const inside: { path: string; file: File }[] = [];
  for (const one of await entriesOf(entry as FileSystemDirectoryEntry)) inside.push(...(await filesBelow(one)));
  return inside;
}

/** The files of a drop with their names, and what they are called together where they come from a folder. To be called
 * while the event is handled: later the transfer is empty. */
export async function droppedFiles(transfer: DataTransfer): Promise<{ files: NamedFile[]; folder?: string }> {
  const items = [...transfer.items].filter((item) => item.kind === "file");
  const entries = items.map((item) => item.webkitGetAsEntry());
  const folders = entries.filter((entry) => entry?.isDirectory);
  if (folders.length === 0) return { files: [...transfer.files].map((file) => ({ name: file.name, file })) };
  const only = entries.length === 1 ? entries[0]!.name : undefined;
  const found = (await Promise.all(entries.map((entry) => (entry ? filesBelow(entry) : [])))).flat();
  // Of several folders each keeps its name before that of its files.
  return { files: namedInFolder(found.map((one) => (only ? one : { ...one, path: `/${one.path}` }))), folder: only };
}
