import { showToast } from "../ui/toast";
import { environmentMapEndings, isEnvironmentMap, lightBy } from "./environment-map";
import { loadSceneFile, openFile } from "./replacing";
import { uploaded, type NamedFile } from "./upload";

/** Opening what the user drops or picks. */

/** A scene file is read here: it need not go through the folder of uploads. */
async function openSceneFile(file: File): Promise<void> {
  try {
    loadSceneFile(file.name, JSON.parse(await file.text()));
  } catch (error) {
    showToast({ tone: "error", text: `${file.name} is no JSON: ${(error as Error).message}` });
  }
}

/** Uploads files and opens what they are together; a scene alone is loaded, an environment map lights what is open. */
export async function openFiles(files: readonly NamedFile[], folder?: string): Promise<void> {
  const alone = files.length === 1 ? files[0]! : null;
  if (alone && /\.json$/i.test(alone.name)) return openSceneFile(alone.file);
  if (alone && isEnvironmentMap(alone.name)) return lightBy(alone.file);
  const path = await uploaded(files, folder);
  if (path) openFile(path);
}

/** "scan/CT/1.dcm" is CT-1.dcm of scan. What is hidden, as some systems put into folders, is left out. */
export function namedInFolder(files: readonly { path: string; file: File }[]): NamedFile[] {
  return files
    .map(({ path, file }) => ({ name: path.split("/").slice(1).join("-"), hidden: /(^|\/)\./.test(path), file }))
    .filter(({ hidden }) => !hidden);
}

/** Lets the user choose files, or a folder, and hands on its files. */
function askForFiles(take: (files: File[]) => void, { accept = "", folder = false, several = true } = {}): void {
  const input = document.createElement("input");
  input.type = "file";
  input.multiple = several;
  input.accept = accept;
  input.webkitdirectory = folder;
  input.onchange = () => take([...(input.files ?? [])]);
  input.click();
}

const withNames = (files: readonly File[]): NamedFile[] => files.map((file) => ({ name: file.name, file }));

/** Opens files that the user chooses. */
export function pickFiles(accept = ""): void {
  askForFiles((files) => void openFiles(withNames(files)), { accept });
}

/** Opens a folder that the user chooses. */
export function pickFolder(): void {
  askForFiles(
    (files) => {
      const inFolder = files.map((file) => ({ path: file.webkitRelativePath, file }));
      void openFiles(namedInFolder(inFolder), inFolder[0]?.path.split("/")[0]);
    },
    { folder: true },
  );
}

/** Uploads files that the user chooses, and hands on their path. */
export function pickUpload(take: (path: string) => void): void {
  const stem = (files: readonly File[]) => files[0]?.name.replace(/\..*/, "") || undefined;
  askForFiles((files) => void uploaded(withNames(files), stem(files)).then((path) => path && take(path)));
}

/** Lights the volume by an environment map that the user chooses. */
export function pickEnvironmentMap(): void {
  askForFiles(([file]) => file && void lightBy(file), { accept: environmentMapEndings, several: false });
}
