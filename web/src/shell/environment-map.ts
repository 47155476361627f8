import { scene } from "../state/scene";
import { tryEdit } from "../state/tried-edit";
import { showToast } from "../ui/toast";
import { uploaded } from "./upload";

/** Environment maps of this computer: pictures of surroundings, which light the volume. */

/** Endings of their names, as a file dialog has them. */
export const environmentMapEndings = ".hdr,.exr";

export function isEnvironmentMap(name: string): boolean {
  return /\.(hdr|exr)$/i.test(name);
}

const kBegins = { hdr: [0x23, 0x3f], exr: [0x76, 0x2f, 0x31, 0x01] } as const;

/** Whether the file is what its name says; asked before it is sent, since these are large. */
async function isWhatItIsCalled(file: File): Promise<boolean> {
  const begin = kBegins[/hdr$/i.test(file.name) ? "hdr" : "exr"];
  const bytes = new Uint8Array(await file.slice(0, begin.length).arrayBuffer());
  return begin.every((byte, i) => bytes[i] === byte);
}

/** Uploads an environment map and lights the volume by it. Where that fails, which is told, all stays as it was. */
export async function lightBy(file: File): Promise<void> {
  const refuse = (why: string) => showToast({ tone: "error", text: `${file.name} ${why}` });
  if (!isEnvironmentMap(file.name)) return refuse("cannot light the volume: expected a .hdr or .exr picture");
  if (!scene.peek()) return refuse("is light for a volume: open one first");
  if (!(await isWhatItIsCalled(file))) return refuse("is damaged: it does not begin as pictures of its kind do");
  const path = await uploaded([{ name: file.name, file }]);
  if (!path) return;
  if (await tryEdit([["/environment/image", path]])) showToast({ text: `${file.name} lights the volume` });
}
