import { FileBrowser } from "../shell/file-browser";
import { pickUpload } from "../shell/files";
import { Button } from "../ui/controls";
import { Dialog } from "../ui/dialog";

/** Chooses a volume below the viewer's folder, or one of this computer. */
export function FilePicker(props: { title: string; onPick(path: string): void; onClose(): void }) {
  return (
    <Dialog title={props.title} onClose={props.onClose}>
      <FileBrowser kinds={["volume"]} onChoose={props.onPick} />
      <div class="from-here">
        <Button icon="upload" onClick={() => pickUpload(props.onPick)}>
          Upload from this computer
        </Button>
      </div>
    </Dialog>
  );
}
