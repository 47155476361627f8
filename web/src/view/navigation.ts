import { newGesture } from "../state/scene";
import { kClick_px } from "../ui/drag";
import { orbitByPixels, panByPixels, rollBy, zoomBy } from "./camera-control";

/** Drags, wheel and touches on the view move the camera: one finger or the left button orbits; two fingers, the right
 * or the middle button or Shift pan; wheel, pinch and Ctrl zoom; twist and Alt roll. */

export interface NavigationHandlers {
  /** The pointer went down and up at one place [client px]. */
  click(x: number, y: number): void;
  doubleClick(x: number, y: number): void;
}

interface Touch {
  x: number;
  y: number;
}

const kDoubleClick_ms = 350;
const kWheelRest_ms = 400;

export function attachNavigation(area: HTMLElement, handlers: NavigationHandlers): () => void {
  const touches = new Map<number, Touch>();
  let gesture = "";
  let travelled = 0;
  let wasMultiple = false;
  let lastClick = { x: 0, y: 0, time_ms: -Infinity };
  let wheelGesture = { name: "", time_ms: -Infinity };

  const down = (event: PointerEvent) => {
    // Handles and buttons over the picture have their own.
    if (event.target instanceof Element && event.target.closest(".handle, button, .floating")) return;
    area.focus({ preventScroll: true });
    area.setPointerCapture(event.pointerId);
    if (touches.size === 0) {
      travelled = 0;
      wasMultiple = false;
      gesture = newGesture("view");
    }
    touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (touches.size > 1) wasMultiple = true;
    if (event.button === 1) event.preventDefault();
  };

  const oneMoves = (event: PointerEvent, dx: number, dy: number) => {
    const buttons = event.buttons;
    if (event.altKey) rollBy(dx * 0.4, gesture);
    else if (event.ctrlKey || event.metaKey) zoomBy(Math.exp(-dy * 0.006), gesture);
    else if (event.shiftKey || buttons & 2 || buttons & 4) panByPixels(dx, dy, gesture);
    else orbitByPixels(dx, dy, gesture);
  };

  const move = (event: PointerEvent) => {
    const before = touches.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    const dx = now.x - before.x;
    const dy = now.y - before.y;
    travelled += Math.hypot(dx, dy);
    if (travelled < kClick_px && touches.size === 1) return;
    touches.set(event.pointerId, now);
    if (touches.size === 1) return oneMoves(event, dx, dy);
    const other = [...touches].find(([id]) => id !== event.pointerId)?.[1];
    if (!other || touches.size !== 2) return;
    const span = (a: Touch) => ({
      length: Math.hypot(a.x - other.x, a.y - other.y),
      angle: Math.atan2(a.y - other.y, a.x - other.x),
    });
    const was = span(before);
    const is = span(now);
    panByPixels(dx / 2, dy / 2, gesture);
    if (was.length > 20 && is.length > 20) zoomBy(is.length / was.length, gesture);
    let twist = ((is.angle - was.angle) * 180) / Math.PI;
    if (twist > 180) twist -= 360;
    if (twist < -180) twist += 360;
    rollBy(twist, gesture);
  };

  const up = (event: PointerEvent) => {
    if (!touches.delete(event.pointerId) || touches.size > 0) return;
    if (wasMultiple || travelled >= kClick_px || event.type === "pointercancel" || event.button !== 0) return;
    const { clientX: x, clientY: y, timeStamp: time_ms } = event;
    const isDouble = time_ms - lastClick.time_ms < kDoubleClick_ms && Math.hypot(x - lastClick.x, y - lastClick.y) < 12;
    lastClick = { x, y, time_ms: isDouble ? -Infinity : time_ms };
    if (isDouble) handlers.doubleClick(x, y);
    else handlers.click(x, y);
  };

  const wheel = (event: WheelEvent) => {
    if (event.target instanceof Element && event.target.closest(".floating")) return;
    event.preventDefault();
    if (event.timeStamp - wheelGesture.time_ms > kWheelRest_ms) wheelGesture.name = newGesture("wheel");
    wheelGesture.time_ms = event.timeStamp;
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1);
    // Pinches on a touchpad come as small steps with Ctrl.
    zoomBy(Math.exp(-Math.max(-200, Math.min(200, pixels)) * (event.ctrlKey ? 0.008 : 0.0015)), wheelGesture.name);
  };

  const noMenu = (event: Event) => event.preventDefault();
  area.addEventListener("pointerdown", down);
  area.addEventListener("pointermove", move);
  area.addEventListener("pointerup", up);
  area.addEventListener("pointercancel", up);
  area.addEventListener("wheel", wheel, { passive: false });
  area.addEventListener("contextmenu", noMenu);
  return () => {
    area.removeEventListener("pointerdown", down);
    area.removeEventListener("pointermove", move);
    area.removeEventListener("pointerup", up);
    area.removeEventListener("pointercancel", up);
    area.removeEventListener("wheel", wheel);
    area.removeEventListener("contextmenu", noMenu);
  };
}
