// The worker: loads the simulator, and answers one message with one message. `engine.ts` is the other end.

import { type Caller, load, start } from "./wasm.ts";

/** A numbered call. */
export interface Asked {
  id: number;
  call: unknown;
  bytes?: Uint8Array;
}

/** The answer to a call, or the reason why the simulator itself failed; id -1 is about loading. */
export interface Answered {
  id: number;
  json?: string;
  bytes?: Uint8Array<ArrayBuffer>;
  failed?: string;
}

// The types of workers and of pages conflict; this declares the part of a worker that is used.
const scope = self as unknown as {
  location: Location;
  onmessage: ((event: MessageEvent<Asked>) => void) | null;
  postMessage(answer: Answered, transfer?: Transferable[]): void;
};

const words = (error: unknown): string => (error instanceof Error ? error.message : String(error));

const loading: Promise<Caller> = load(scope.location.href).then(start);

loading.then(
  () => scope.postMessage({ id: -1 }),
  (error: unknown) => scope.postMessage({ id: -1, failed: words(error) }),
);

scope.onmessage = async ({ data: { id, call, bytes } }) => {
  try {
    const answer = (await loading)(call, bytes);
    scope.postMessage({ id, ...answer }, [answer.bytes.buffer]);
  } catch (error) {
    scope.postMessage({ id, failed: words(error) });
  }
};
