// The worker: loads the simulator, and answers each message from `engine.ts` with one message.

import { type Caller, load, start } from "./wasm.ts";

/** A numbered call. */
export interface WorkerRequest {
  id: number;
  call: unknown;
  bytes?: Uint8Array;
}

/** The answer to a call, or the reason why the simulator itself failed; the reply with id -1 reports the end of loading. */
export interface WorkerReply {
  id: number;
  json?: string;
  bytes?: Uint8Array<ArrayBuffer>;
  failed?: string;
}

// The types of workers and of pages conflict; this declares the part of a worker that is used.
const scope = self as unknown as {
  location: Location;
  onmessage: ((event: MessageEvent<WorkerRequest>) => void) | null;
  postMessage(reply: WorkerReply, transfer?: Transferable[]): void;
};

const messageOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

const loading: Promise<Caller> = load(scope.location.href).then(start);

loading.then(
  () => scope.postMessage({ id: -1 }),
  (error: unknown) => scope.postMessage({ id: -1, failed: messageOf(error) }),
);

scope.onmessage = async ({ data: { id, call, bytes } }) => {
  try {
    const answer = (await loading)(call, bytes);
    scope.postMessage({ id, ...answer }, [answer.bytes.buffer]);
  } catch (error) {
    scope.postMessage({ id, failed: messageOf(error) });
  }
};
