import { FileBrowser } from "../shell/file-browser";
import { Dialog } from "../ui/dialog";

/** Chooses a volume below the viewer's folder. */
export function FilePicker(props: { title: string; onPick(path: string): void; onClose(): void }) {
  return (
    <Dialog title={props.title} onClose={props.onClose}>
      <FileBrowser kinds={["volume"]} onChoose={props.onPick} />
    </Dialog>
  );
}
