import { useEffect, useRef } from "preact/hooks";
import { setCrosshair } from "../state/crosshair";
import { layout } from "../state/preferences";
import { scene } from "../state/scene";
import { setTarget } from "./camera-control";
import { ClipHandles } from "./clip-handles";
import { LightHandles } from "./light-handles";
import { measuring, setEnd } from "./distances";
import { hideKeyCursor } from "./key-cursor";
import { Measurements, MeasuringVoice, picturePane } from "./measure";
import { attachNavigation } from "./navigation";
import { EdgeLabels, OrientationCube } from "./orientation";
import { overlays, view, viewSize } from "./overlay";
import { Picture } from "./picture";
import { followViewSize } from "./picture-size";
import { pointAt, probeAt } from "./probing";
import { ScaleBar } from "./scale-bar";
import { SplitHandle } from "./split-handle";
import { Toolbar, ToolHint } from "./toolbar";

const viewKeys = "Arrow keys orbit, plus and minus zoom.";
const measuringKeys = "Arrow keys move the cursor, Enter sets an end of a distance, Escape drops it.";

/** The picture, what is drawn over it and what pointing at it does. */
export function View() {
  const area = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = area.current!;
    const inArea = (x: number, y: number) => {
      const { left, top } = element.getBoundingClientRect();
      return { x: x - left, y: y - top };
    };
    const observer = new ResizeObserver(() => {
      viewSize.value = { width: element.clientWidth || 1, height: element.clientHeight || 1 };
    });
    observer.observe(element);
    const detach = attachNavigation(element, {
      click: async (x, y) => {
        const at = inArea(x, y);
        if (measuring.peek()) return void setEnd(picturePane(), at.x, at.y);
        pointAt(() => at);
        if (layout.peek() !== "slices") return;
        const place = (await probeAt(at))?.position_mm;
        if (place) setCrosshair(place);
      },
      doubleClick: async (x, y) => {
        const at = inArea(x, y);
        if (measuring.peek()) return;
        const place = (await probeAt(at))?.position_mm;
        if (place) setTarget(place);
      },
    });
    const hover = (event: PointerEvent) => {
      const over = event.target instanceof Element && event.target.closest(".floating");
      if (event.movementX || event.movementY) hideKeyCursor();
      const at = inArea(event.clientX, event.clientY);
      pointAt(event.buttons === 0 && !over ? () => at : null);
    };
    // After a drag it rests where it is let go.
    const rest = (event: PointerEvent) => event.pointerType === "mouse" && hover(event);
    const leave = () => pointAt(null);
    element.addEventListener("pointermove", hover);
    element.addEventListener("pointerup", rest);
    element.addEventListener("pointerleave", leave);
    const stopFollowing = followViewSize();
    return () => {
      observer.disconnect();
      detach();
      element.removeEventListener("pointermove", hover);
      element.removeEventListener("pointerup", rest);
      element.removeEventListener("pointerleave", leave);
      stopFollowing();
    };
  }, []);
  const ready = scene.value && view.value;
  return (
    <div
      ref={area}
      class={measuring.value ? "view measuring" : "view"}
      tabindex={0}
      inert={!scene.value}
      role="application"
      aria-label={`View of the volume. ${measuring.value ? measuringKeys : viewKeys} Question mark lists all keys.`}
    >
      <Picture />
      <MeasuringVoice />
      {ready && (
        <>
          <svg class="overlay">
            <EdgeLabels />
            <ScaleBar />
            <SplitHandle />
            <ClipHandles />
            <LightHandles />
            {overlays.value.map(({ id, component: Overlay }) => (
              <Overlay key={id} />
            ))}
            <Measurements />
          </svg>
          <Toolbar />
          <ToolHint />
          <OrientationCube />
        </>
      )}
    </div>
  );
}
