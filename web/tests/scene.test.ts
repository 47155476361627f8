import { beforeEach, describe, expect, it, vi } from "vitest";

/** A server that notes what it is told and says what the tests want. */
class Socket {
  static OPEN = 1;
  static last: Socket;
  readyState = 0;
  sent: Record<string, unknown>[] = [];
  onopen?: () => void;
  onclose?: () => void;
  onmessage?: (event: { data: unknown }) => void;
  constructor(readonly url: URL) {
    Socket.last = this;
  }
  send(text: string) {
    this.sent.push(JSON.parse(text));
  }
  open() {
    this.readyState = Socket.OPEN;
    this.onopen?.();
  }
  lose() {
    this.readyState = 3;
    this.onclose?.();
  }
  say(message: unknown) {
    this.onmessage?.({ data: message instanceof ArrayBuffer ? message : JSON.stringify(message) });
  }
}

const scene = { version: 1, camera: { azimuth_deg: 0, zoom: 1 }, transfer: { points: [] } };

async function start() {
  vi.resetModules();
  const connection = await import("../src/state/connection");
  const state = await import("../src/state/scene");
  connection.connect();
  Socket.last.open();
  Socket.last.say({ type: "hello" });
  Socket.last.say({ type: "scene", revision: 1, scene, can_undo: false, can_redo: false });
  return { connection, ...state, edits: () => Socket.last.sent.filter((message) => message.type === "edit") };
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Socket);
  vi.stubGlobal("document", { baseURI: "https://host:8080/#scene=x" });
});

describe("the scene on the page", () => {
  it("is reached at api/socket, encrypted where the page is", async () => {
    await start();
    expect(Socket.last.url.href).toBe("wss://host:8080/api/socket");
  });

  it("leaves alone what is only shown in passing", async () => {
    const { edit, showPassing, scene: shown, refusal } = await start();
    edit([["/camera/zoom", 2]], "drag");
    edit([["/camera/zoom", 3]], "drag");
    showPassing([["/camera/azimuth_deg", 90]]);
    const types = Socket.last.sent.map(({ type, seq }) => `${type} ${seq}`);
    expect(types.slice(-2)).toEqual(["edit 1", "passing 2"]); // in the order in which they were made
    expect(shown.value!.camera.azimuth_deg).toBe(0);
    Socket.last.say({ type: "edited", seq: 2, revision: 4, sections: {}, can_undo: true, can_redo: false });
    showPassing([["/lights/7/intensity", 1]]);
    showPassing([]);
    Socket.last.say({ type: "refused", seq: 3, where: "/lights/7", message: "the list has 1 element" });
    expect(refusal.value).toBeNull();
  });

  it("shows an edit at once and takes it back when it is refused", async () => {
    const { edit, scene: shown, refusal } = await start();
    const transfer = shown.value!.transfer;
    edit([["/camera/zoom", -1]]);
    expect(shown.value!.camera.zoom).toBe(-1);
    expect(shown.value!.transfer).toBe(transfer);
    Socket.last.say({ type: "refused", seq: 1, where: "/camera/zoom", message: "found -1" });
    expect(shown.value!.camera.zoom).toBe(1);
    expect(refusal.value).toEqual({ where: "/camera/zoom", message: "found -1" });
  });

  it("sends a drag's edits that come at once as two messages: the first, and the last of the rest", async () => {
    const { edit, edits, newGesture, scene: shown } = await start();
    vi.advanceTimersByTime(100);
    const gesture = newGesture("orbit");
    for (const azimuth_deg of [1, 2, 3, 4]) edit([["/camera/azimuth_deg", azimuth_deg]], gesture);
    expect(shown.value!.camera.azimuth_deg).toBe(4);
    vi.advanceTimersByTime(100);
    expect(edits()).toEqual([
      { type: "edit", seq: 1, set: [["/camera/azimuth_deg", 1]], gesture },
      { type: "edit", seq: 2, set: [["/camera/azimuth_deg", 4]], gesture },
    ]);
  });

  it("keeps the order of edits: what waits goes before the next one, and before undo", async () => {
    const { edit, newGesture, undo } = await start();
    const gesture = newGesture("orbit");
    edit([["/camera/azimuth_deg", 1]], gesture);
    edit([["/camera/azimuth_deg", 2]], gesture);
    edit([["/lights/-", { kind: "point" }]]);
    edit([["/camera/azimuth_deg", 3]], gesture);
    undo();
    const set = Socket.last.sent.map((message) => (message.set as unknown[][] | undefined)?.[0]?.[1] ?? message.type);
    expect(set).toEqual([1, 2, { kind: "point" }, 3, "undo"]);
  });

  it("after a lost connection is what the server says, without edits that were on their way", async () => {
    const { connection, edit, scene: shown } = await start();
    edit([["/camera/zoom", 5]]);
    Socket.last.lose();
    expect(connection.link.value.kind).toBe("lost");
    edit([["/camera/zoom", 7]]);
    expect(shown.value!.camera.zoom).toBe(5);
    vi.advanceTimersByTime(1000);
    Socket.last.open();
    Socket.last.say({ type: "hello" });
    Socket.last.say({ type: "scene", revision: 9, scene, can_undo: true, can_redo: false });
    expect(shown.value!.camera.zoom).toBe(1);
    expect(connection.link.value.kind).toBe("open");
  });
});

describe("pictures", () => {
  const frame = (header: unknown, picture: number[], claimed?: number) => {
    const text = new TextEncoder().encode(JSON.stringify(header));
    const bytes = new Uint8Array(4 + text.length + picture.length);
    new DataView(bytes.buffer).setUint32(0, claimed ?? text.length, true);
    bytes.set(text, 4);
    bytes.set(picture, 4 + text.length);
    return bytes.buffer;
  };

  it("come with their header", async () => {
    const { connection } = await start();
    const seen = vi.fn();
    connection.onFrame(seen);
    Socket.last.say(frame({ frame: 7, format: "png" }, [1, 2, 3]));
    const [header, picture] = seen.mock.calls[0] as [{ frame: number }, Blob];
    expect(header.frame).toBe(7);
    expect([picture.type, picture.size]).toEqual(["image/png", 3]);
  });

  it("whose header is longer than they are, are refused", async () => {
    const { connection } = await start();
    expect(() => connection.parseFrame(frame({ frame: 7 }, [], 1e6))).toThrow("header");
  });
});
