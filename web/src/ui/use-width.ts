import { useEffect, useState } from "preact/hooks";
import type { RefObject } from "preact";

/** The element's width [CSS px], as it is now; `otherwise` before it is known. */
export function useWidth(element: RefObject<Element>, otherwise: number): number {
  const [width, setWidth] = useState(otherwise);
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => setWidth(Math.round(entry!.contentRect.width) || otherwise));
    observer.observe(element.current!);
    return () => observer.disconnect();
  }, []);
  return width;
}
