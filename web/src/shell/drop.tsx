import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { Icon } from "../ui/icons";
import { showToast } from "../ui/toast";
import { droppedFiles } from "./dropped";
import { openFiles } from "./files";

const over = signal(false);

async function openDropped(transfer: DataTransfer): Promise<void> {
  try {
    const { files, folder } = await droppedFiles(transfer);
    if (files.length === 0) showToast({ text: "There are no files in what was dropped" });
    await openFiles(files, folder);
  } catch (error) {
    showToast({ tone: "error", text: `What was dropped cannot be read: ${(error as Error).message}` });
  }
}

/** Takes files that are dropped anywhere on the page. */
export function DropTarget() {
  useEffect(() => {
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const drag = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      event.dataTransfer!.dropEffect = "copy";
      over.value = true;
    };
    const leave = (event: DragEvent) => {
      if (!event.relatedTarget) over.value = false;
    };
    const drop = (event: DragEvent) => {
      over.value = false;
      if (!hasFiles(event)) return;
      event.preventDefault();
      void openDropped(event.dataTransfer!);
    };
    addEventListener("dragenter", drag);
    addEventListener("dragover", drag);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    return () => {
      removeEventListener("dragenter", drag);
      removeEventListener("dragover", drag);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
    };
  }, []);
  if (!over.value) return null;
  return (
    <div class="drop">
      <div>
        <Icon name="upload" size={28} />
        <strong>Drop to open</strong>
        <span>A volume, the folder or the files of a DICOM series, a scene (.json), or a picture of surroundings as light (.hdr, .exr)</span>
      </div>
    </div>
  );
}
