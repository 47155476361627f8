import { signal } from "@preact/signals";
import { link } from "../state/connection";
import { scene } from "../state/scene";
import { hello, status } from "../state/session";
import { Button } from "../ui/controls";
import { Dialog } from "../ui/dialog";
import { Icon } from "../ui/icons";
import { FileBrowser } from "./file-browser";
import { pickFiles, pickFolder } from "./files";
import { openFile } from "./replacing";
import { upload } from "./upload";

/** Choosing what to open: as a whole screen while nothing is, and as a dialog later. */

export const openDialog = signal(false);

function Choices({ onOpen }: { onOpen?(): void }) {
  const samples = hello.value?.samples ?? [];
  const choose = (path: string) => {
    openFile(path);
    onOpen?.();
  };
  return (
    <div class={samples.length > 0 ? "choices" : "choices single"}>
      {samples.length > 0 && (
        <section aria-label="Samples">
          <h3>Samples</h3>
          <div class="samples">
            {samples.map((sample) => (
              <button key={sample.path} type="button" class="sample" onClick={() => choose(sample.path)}>
                <strong>{sample.name}</strong>
                <span>{sample.summary}</span>
              </button>
            ))}
          </div>
        </section>
      )}
      <section aria-label="Files on the viewer's machine">
        <h3>Files where the viewer runs</h3>
        <FileBrowser onOpen={onOpen} />
      </section>
    </div>
  );
}

function FromHere({ onOpen }: { onOpen?(): void }) {
  const pick = (choose: () => void) => () => {
    choose();
    onOpen?.();
  };
  return (
    <div class="from-here">
      <Icon name="upload" />
      <span>Drop a volume, a DICOM folder or a scene anywhere on this page, or choose</span>
      <Button title="Several where they are one volume: slices, or a header and its voxels" onClick={pick(pickFiles)}>
        files
      </Button>
      <Button onClick={pick(pickFolder)}>a folder</Button>
    </div>
  );
}

export function OpenDialog() {
  if (!openDialog.value) return null;
  const close = () => (openDialog.value = false);
  return (
    <Dialog title="Open" wide onClose={close}>
      <Choices onOpen={close} />
      <FromHere onOpen={close} />
    </Dialog>
  );
}

/** The first minute: what there is to open. Also says why the last try failed. */
export function OpeningScreen() {
  const stage = status.value.stage;
  const busy = stage === "reading" || stage === "preparing" || upload.value;
  if (scene.value || busy || link.value.kind !== "open" || !hello.value) return null;
  return (
    <div class="opening floating">
      <div class="opening-inner">
        <h2>Open a volume</h2>
        <p class="lead">
          CT, MRI, microscopy or simulation data: NRRD, NIfTI, MetaImage, DICOM folders, TIFF, VTK, HDF5, OpenVDB.
        </p>
        {stage === "failed" && (
          <div class="failed-note" role="alert">
            <Icon name="warning" />
            <div>
              <strong>{status.value.what ?? "It"} could not be opened</strong>
              <p>{status.value.message}</p>
            </div>
          </div>
        )}
        <Choices />
        <FromHere />
      </div>
    </div>
  );
}
