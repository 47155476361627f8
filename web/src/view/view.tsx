import { useEffect, useRef } from "preact/hooks";
import { overlays, view, viewSize } from "./overlay";
import { Picture } from "./picture";

/** The picture and what is drawn over it. */
export function View() {
  const area = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = area.current!;
    const observer = new ResizeObserver(() => {
      viewSize.value = { width: element.clientWidth || 1, height: element.clientHeight || 1 };
    });
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  return (
    <div ref={area} class="view" tabIndex={0} aria-label="View of the volume">
      <Picture />
      <svg class="overlay" aria-hidden={!view.value}>
        {view.value && overlays.value.map(({ id, component: Overlay }) => <Overlay key={id} />)}
      </svg>
    </div>
  );
}
