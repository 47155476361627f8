/** Dragging with the pointer captured, so that it goes on outside the element. */

export interface Drag {
  /** From where the pointer went down [CSS px]. */
  dx: number;
  dy: number;
  /** Since the last call. */
  stepX: number;
  stepY: number;
  event: PointerEvent;
}

/** A pointer that goes down and up and less far in between has clicked [CSS px]. */
export const kClick_px = 4;

export interface DragHandlers {
  move(drag: Drag): void;
  /** Instead of all others where the pointer only clicks: they are called from its first move that is too far. */
  click?(drag: Drag): void;
  /** Pointer up, or the drag was broken off. */
  end?(drag: Drag): void;
}

/** Starts a drag from a pointerdown event: use as `onPointerDown={(e) => startDrag(e, {...})}`. Only the primary button
 * (touch, pen) unless `buttons` says others. Returns what lets go of it before the pointer does; nothing is called then. */
export function startDrag(down: PointerEvent, handlers: DragHandlers, buttons: readonly number[] = [0]): () => void {
  if (!buttons.includes(down.button)) return () => undefined;
  const element = down.currentTarget as Element;
  element.setPointerCapture(down.pointerId);
  down.preventDefault();
  down.stopPropagation();
  if (element instanceof HTMLElement || element instanceof SVGElement) element.focus({ preventScroll: true });
  let lastX = down.clientX;
  let lastY = down.clientY;
  let clicks = handlers.click !== undefined;
  const drag = (event: PointerEvent): Drag => {
    const out = {
      dx: event.clientX - down.clientX,
      dy: event.clientY - down.clientY,
      stepX: event.clientX - lastX,
      stepY: event.clientY - lastY,
      event,
    };
    lastX = event.clientX;
    lastY = event.clientY;
    return out;
  };
  const move = (event: Event) => {
    const pointer = event as PointerEvent;
    if (pointer.pointerId !== down.pointerId) return;
    if (Math.hypot(pointer.clientX - down.clientX, pointer.clientY - down.clientY) >= kClick_px) clicks = false;
    if (!clicks) handlers.move(drag(pointer));
  };
  const letGo = () => {
    element.removeEventListener("pointermove", move);
    element.removeEventListener("pointerup", end);
    element.removeEventListener("pointercancel", end);
  };
  const end = (event: Event) => {
    const pointer = event as PointerEvent;
    if (pointer.pointerId !== down.pointerId) return;
    letGo();
    if (!clicks) handlers.end?.(drag(pointer));
    else if (event.type === "pointerup") handlers.click?.(drag(pointer));
  };
  element.addEventListener("pointermove", move);
  element.addEventListener("pointerup", end);
  element.addEventListener("pointercancel", end);
  return letGo;
}
