import { effect } from "@preact/signals";
import { frame } from "./frame";
import { link } from "./connection";
import { revision } from "./scene";

/** For what the page drives by itself, frame by frame: the next step waits until the last one is on screen. */

const kFrame_ms = 1000 / 30;
/** A picture that takes longer, or never comes, holds nothing up for more than this. */
const kPatience_ms = 1000;

/** Resolves when a picture is there that shows a revision after `since`, and not before a thirtieth of a second. */
export function shownAfter(since: number): Promise<void> {
  const earliest = new Promise((resolve) => setTimeout(resolve, kFrame_ms));
  const seen = new Promise<void>((resolve) => {
    let stop: (() => void) | undefined;
    const done = () => {
      clearTimeout(timer);
      queueMicrotask(() => stop?.());
      resolve();
    };
    const timer = setTimeout(done, kPatience_ms);
    stop = effect(() => {
      const newest = frame.value?.header.revision ?? 0;
      if (revision.value > since && newest >= revision.value) done();
    });
  });
  return Promise.all([earliest, seen]).then(() => {});
}

/** Whether it makes sense to go on: connected, and somebody is looking. */
export function canGoOn(): boolean {
  return link.peek().kind === "open" && document.visibilityState === "visible";
}
