/**
 * Runs `work` for the newest of the requests that come in, one at a time: while one is at work, later ones replace each other.
 * Failures go to `failed`, and the next request is taken up all the same.
 */
export function newestWins<T>(
  work: (request: T, signal: AbortSignal) => Promise<void>,
  failed: (error: unknown) => void,
) {
  let busy = false;
  let waiting: { request: T } | undefined;
  const stop = new AbortController();

  async function run(request: T): Promise<void> {
    busy = true;
    for (let next: { request: T } | undefined = { request }; next && !stop.signal.aborted;) {
      waiting = undefined;
      try {
        await work(next.request, stop.signal);
      } catch (error) {
        if (!stop.signal.aborted) failed(error);
      }
      next = waiting;
    }
    busy = false;
  }

  return {
    ask(request: T) {
      if (busy) waiting = { request };
      else void run(request);
    },
    /** Ends what is at work and takes nothing more. */
    stop: () => stop.abort(),
  };
}
