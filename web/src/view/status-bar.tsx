import { formatPosition } from "../geometry/length";
import { formatValue } from "../model/axis";
import { titleOf } from "../model/label-rules";
import { compiling, frame, progress } from "../state/frame";
import { labelColors } from "../state/label-colors";
import { lengthScale } from "../state/lengths";
import type { FrameHeader, Probe } from "../state/protocol";
import { viewers } from "../state/session";
import { volume } from "../state/volume";
import { pointed } from "./probing";

/** The line below the picture: what is under the pointer, and how far the picture is. */

/** Not what no label marks. */
const isMarked = ({ value }: { value: number }) => value !== 0;

function Pointed({ at }: { at: Probe }) {
  const facts = volume.value;
  return (
    <>
      <span
        class="cell position"
        title="Position under the pointer: distance from the origin toward the patient's side"
      >
        {at.position_mm && formatPosition(at.position_mm, lengthScale.value)}
      </span>
      {facts && at.value != null && <span class="cell value">{formatValue(at.value, facts)}</span>}
      {at.labels?.filter(isMarked).map((label) => (
        <span key={label.of} class="cell label" title={`Label ${label.value} of ${label.of}`}>
          <i style={{ background: labelColors.value[label.of]?.get(label.value)?.color }} />
          {titleOf(label)}
        </span>
      ))}
    </>
  );
}

const limits: Record<FrameHeader["limit"], string> = {
  tracing: "tracing light",
  denoising: "denoising",
  compiling: "preparing the scene",
  developing: "developing the picture",
  nothing: "",
};

function duration(s: number): string {
  if (s < 90) return `${Math.max(1, Math.round(s))} s`;
  return s < 5400 ? `${Math.round(s / 60)} min` : `${(s / 3600).toFixed(1)} h`;
}

const samples = (spp: number) => (spp < 10 ? spp.toFixed(spp % 1 ? 1 : 0) : Math.round(spp).toString());

function Work({ header }: { header: FrameHeader }) {
  const details = [
    `${header.width} x ${header.height} of ${header.full[0]} x ${header.full[1]} pixels`,
    ...(["compile", "trace", "denoise", "develop"] as const).map(
      (part) => `${part} ${(header[`${part}_s`] * 1000).toFixed(1)} ms`,
    ),
  ].join("\n");
  if (header.moving)
    return (
      <>
        <span class="cell">
          {header.width} x {header.height}
        </span>
        <span class="cell">{header.fps.toFixed(header.fps < 10 ? 1 : 0)} fps</span>
        <span class="cell dim" title={details}>
          {(header.frame_s * 1000).toFixed(0)} ms, most of it {limits[header.limit]}
        </span>
      </>
    );
  const now = progress.value;
  const spp = Math.max(header.spp, header.done ? 0 : (now?.spp ?? 0));
  const noise = header.done ? header.noise : (now?.noise ?? header.noise);
  return (
    <>
      <span class="cell" title={details}>
        {samples(spp)} spp
      </span>
      {noise !== null && (
        <span class="cell" title="Mean of standard error / luminance">
          noise {(noise * 100).toFixed(1)} %
        </span>
      )}
      <span class="cell dim">
        {header.done ? "done" : now?.remaining_s != null ? `${duration(now.remaining_s)} left` : limits[header.limit]}
      </span>
    </>
  );
}

export function StatusBar() {
  const header = frame.value?.header;
  const at = pointed.value;
  return (
    <footer class="status-bar">
      <div class="pointed">
        {at ? (
          <Pointed at={at} />
        ) : (
          <span class="cell dim">{volume.value ? "Point at the volume to read its values" : ""}</span>
        )}
      </div>
      <div class="work" role="group" aria-label="Progress of the picture">
        {viewers.value > 1 && <span class="cell dim">{viewers.value} viewers</span>}
        {compiling.value !== null && (
          <span class="cell">preparing the scene {Math.floor(compiling.value * 100)} %</span>
        )}
        {header && <Work header={header} />}
      </div>
    </footer>
  );
}
