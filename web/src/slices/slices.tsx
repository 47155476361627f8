import { useEffect, useMemo, useState } from "preact/hooks";
import { formatPosition } from "../geometry/length";
import { formatValue } from "../model/axis";
import { titleOf } from "../model/label-rules";
import { newestWins } from "../model/latest";
import { ctWindows, windowDigits } from "../model/window";
import { crosshair, setCrosshair } from "../state/crosshair";
import { lengthScale } from "../state/lengths";
import type { Probe } from "../state/protocol";
import type { Vec3 } from "../state/scene-types";
import { labels, volume } from "../state/volume";
import { IconButton, NumberInput } from "../ui/controls";
import { showToast } from "../ui/toast";
import { addOverlay, overlays, view } from "../view/overlay";
import "../styles/slices.css";
import { picking, pickPoint } from "../view/pick";
import { probeAt } from "../view/probing";
import { SliceView } from "./slice-view";
import {
  dragTool,
  initialWindow,
  overlayOpacity,
  overlayVolume,
  resetSlices,
  setWindow,
  slicesMoved,
  sliceWindow,
} from "./state";

/** The label volume over the slices: the chosen one, else the first. */
function shownOverlay(): string {
  const known = Object.keys(labels.value);
  const chosen = overlayVolume.value;
  if (chosen === "") return "";
  return chosen !== null && known.includes(chosen) ? chosen : (known[0] ?? "");
}

/** The three planes through the crosshair, for the cells of the layout around the picture. */
export function SlicePlanes() {
  const overlay = shownOverlay();
  useEffect(() => {
    addOverlay("crosshair", CrosshairMark);
    return () => {
      overlays.value = overlays.peek().filter((one) => one.id !== "crosshair");
    };
  }, []);
  return (
    <>
      <SliceView plane="axial" overlay={overlay} />
      <SliceView plane="coronal" overlay={overlay} />
      <SliceView plane="sagittal" overlay={overlay} />
    </>
  );
}

/** Where the crosshair is in the picture. */
function CrosshairMark() {
  const at = crosshair.value;
  const seen = at && view.value?.project(at);
  if (!seen || seen.depth_mm <= 0) return null;
  const { x, y } = seen;
  return (
    <g class="crosshair-mark">
      <circle cx={x} cy={y} r={7} />
      <path d={`M${x - 13} ${y}h8M${x + 5} ${y}h8M${x} ${y - 13}v8M${x} ${y + 5}v8`} />
    </g>
  );
}

/** What data and labels have at the crosshair, as the picture's probe has it; null until that is known. */
function useAtCrosshair(): Probe | null {
  const [answer, setAnswer] = useState<Probe | null>(null);
  const requests = useMemo(
    () =>
      newestWins<Vec3 | null>(
        async (at) => setAnswer(at && (await probeAt(at))),
        () => setAnswer(null),
      ),
    [],
  );
  const at = crosshair.value;
  useEffect(() => requests.ask(at), [at, volume.value, labels.value]);
  useEffect(() => () => requests.stop(), []);
  return answer;
}

/** What the slices show and where. */
export function SliceBar() {
  const facts = volume.value;
  const at = crosshair.value;
  const under = useAtCrosshair();
  if (!facts || !at) return null;
  const window = sliceWindow.value;
  const digits = windowDigits(window);
  const presets = facts.hounsfield ? ctWindows : [{ name: "Automatic", window: initialWindow.value }];
  const known = Object.keys(labels.value);
  const overlay = shownOverlay();
  const locate = async () => {
    const answer = await pickPoint();
    if (answer?.position_mm) setCrosshair(answer.position_mm);
    else if (answer) showToast({ text: "There is nothing at this place of the picture" });
  };
  return (
    <div class="slice-bar" role="toolbar" aria-label="Slices">
      <IconButton
        icon="fit"
        label="Click a point in the picture to go there"
        pressed={picking.value}
        onClick={() => void locate()}
      />
      <IconButton
        icon="contrast"
        label="Drag changes brightness and contrast (else the right button does)"
        pressed={dragTool.value === "window"}
        onClick={() => (dragTool.value = dragTool.value === "window" ? "crosshair" : "window")}
      />
      <IconButton
        icon="reset"
        label="Show all of every slice"
        keys="F on a slice"
        disabled={!slicesMoved.value}
        onClick={resetSlices}
      />
      <span class="slice-position" aria-live="off">
        {formatPosition(at, lengthScale.value)}
      </span>
      {under?.value != null && (
        <span class="slice-value">
          <b>{formatValue(under.value, facts)}</b>
          {under.labels?.filter((label) => label.of === overlay && label.value !== 0).map(titleOf)}
        </span>
      )}
      <span class="spring" />
      <span class="window-presets">
        {presets.map((preset) => (
          <button
            key={preset.name}
            type="button"
            aria-pressed={preset.window.level === window.level && preset.window.width === window.width}
            onClick={() => setWindow(preset.window)}
          >
            {preset.name}
          </button>
        ))}
      </span>
      <label class="bar-number">
        Window{" "}
        <NumberInput
          label="Window"
          digits={digits}
          min={1e-9}
          value={window.width}
          onChange={(width) => setWindow({ ...window, width })}
        />
      </label>
      <label class="bar-number">
        Level{" "}
        <NumberInput
          label="Level"
          digits={digits}
          value={window.level}
          onChange={(level) => setWindow({ ...window, level })}
        />
      </label>
      {known.length > 0 && (
        <>
          <select
            class="bar-select"
            aria-label="Labels over the slices"
            value={overlay}
            onChange={(event) => (overlayVolume.value = event.currentTarget.value)}
          >
            <option value="">No labels</option>
            {known.map((name) => (
              <option key={name} value={name}>
                {name}
              </option>
            ))}
          </select>
          <input
            class="bar-opacity"
            type="range"
            min={0}
            max={100}
            aria-label="Opacity of the labels"
            disabled={!overlay}
            value={overlayOpacity.value * 100}
            style={{ "--share": overlayOpacity.value }}
            onInput={(event) => (overlayOpacity.value = Number(event.currentTarget.value) / 100)}
          />
        </>
      )}
    </div>
  );
}
