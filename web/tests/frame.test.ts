import { expect, it, vi } from "vitest";

/** Says what the test wants. */
class Socket {
  static last: Socket;
  readyState = 1;
  onmessage?: (event: { data: unknown }) => void;
  constructor() {
    Socket.last = this;
  }
  say(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

it("knows how far the next picture's scene is, until it is prepared or another one is opened", async () => {
  vi.stubGlobal("WebSocket", Socket);
  vi.stubGlobal("document", { baseURI: "http://host/" });
  const { connect } = await import("../src/state/connection");
  const { compiling } = await import("../src/state/frame");
  connect();
  const say = (message: unknown) => Socket.last.say(message);
  expect(compiling.value).toBeNull();
  say({ type: "compiling", share: 0.4 });
  expect(compiling.value).toBe(0.4);
  say({ type: "compiling", share: 1 });
  expect(compiling.value).toBeNull();
  say({ type: "compiling", share: 0.2 });
  say({ type: "status", stage: "reading", what: "head.nrrd" });
  expect(compiling.value).toBeNull();
});
