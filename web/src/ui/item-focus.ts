import { useLayoutEffect, useRef } from "preact/hooks";

/** The focus of items that are drawn by their number in a list: where one comes or goes the numbers of others change,
 * but not the element that has the focus. Returns what asks for the focus of an item, for when the `count` of those in
 * `root` that match `selector` has changed. */
export function useItemFocus(
  root: { readonly current: Element | null },
  selector: string,
  count: number,
): (index: number) => void {
  const wanted = useRef<number | null>(null);
  useLayoutEffect(() => {
    if (wanted.current !== null)
      root.current?.querySelectorAll<SVGElement>(selector)[wanted.current]?.focus({ preventScroll: true });
    wanted.current = null;
  }, [count]);
  return (index) => (wanted.current = index);
}
