import { signal, type ReadonlySignal } from "@preact/signals";
import type { FrameHeader, PageMessage, ServerMessage } from "./protocol";

/** The WebSocket to the viewer's server: opened once by connect(), opened again whenever it is lost. */

export type LinkState =
  | { kind: "connecting" }
  | { kind: "open" }
  /** Lost; the next attempt is at `retry_at_ms` (Date.now()). */
  | { kind: "lost"; retry_at_ms: number };

const state = signal<LinkState>({ kind: "connecting" });
export const link: ReadonlySignal<LinkState> = state;

type Handler<T> = (message: T) => void;
const handlers = new Map<string, Set<Handler<never>>>();
const frameHandlers = new Set<(header: FrameHeader, picture: Blob) => void>();

let socket: WebSocket | null = null;
let attempts = 0;
let timer: ReturnType<typeof setTimeout> | undefined;

const kFirstRetry_ms = 300;
const kLongestRetry_ms = 8000;

/** Calls `handler` with every message of a type; returns what ends that. */
export function on<T extends ServerMessage["type"]>(
  type: T,
  handler: Handler<Extract<ServerMessage, { type: T }>>,
): () => void {
  const set = handlers.get(type) ?? new Set();
  handlers.set(type, set);
  set.add(handler as Handler<never>);
  return () => set.delete(handler as Handler<never>);
}

/** Calls `handler` with every picture; returns what ends that. */
export function onFrame(handler: (header: FrameHeader, picture: Blob) => void): () => void {
  frameHandlers.add(handler);
  return () => frameHandlers.delete(handler);
}

/** Sends a message; false while there is no connection, and then it is lost. */
export function send(message: PageMessage): boolean {
  if (socket?.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify(message));
  return true;
}

/** Splits a binary frame into header and picture. Throws on bytes that are neither. */
export function parseFrame(bytes: ArrayBuffer): { header: FrameHeader; picture: Blob } {
  const length = new DataView(bytes).getUint32(0, true);
  if (length > bytes.byteLength - 4) throw new Error("a picture's header is longer than its frame");
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length))) as FrameHeader;
  return { header, picture: new Blob([new Uint8Array(bytes, 4 + length)], { type: `image/${header.format}` }) };
}

function receive(data: unknown): void {
  if (data instanceof ArrayBuffer) {
    const { header, picture } = parseFrame(data);
    for (const handler of frameHandlers) handler(header, picture);
    return;
  }
  const message = JSON.parse(String(data)) as ServerMessage;
  for (const handler of handlers.get(message.type) ?? []) (handler as Handler<ServerMessage>)(message);
}

function retryLater(): void {
  const wait_ms = Math.min(kLongestRetry_ms, kFirstRetry_ms * 2 ** attempts++);
  state.value = { kind: "lost", retry_at_ms: Date.now() + wait_ms };
  timer = setTimeout(connect, wait_ms);
}

/** Connects, now: also ends the wait for the next attempt. */
export function connect(): void {
  clearTimeout(timer);
  if (socket && socket.readyState <= WebSocket.OPEN) return;
  const url = new URL("api/socket", document.baseURI);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  url.hash = "";
  const opened = new WebSocket(url);
  socket = opened;
  opened.binaryType = "arraybuffer";
  opened.onopen = () => {
    attempts = 0;
    state.value = { kind: "open" };
  };
  opened.onmessage = (event) => receive(event.data);
  opened.onclose = () => {
    if (socket === opened) retryLater();
  };
}
