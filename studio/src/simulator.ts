// The simulator that the whole page shares, and hooks that wait for it.

import { useEffect, useState } from "preact/hooks";
import { type Agent, createEngine, EngineError, type WorldRequest } from "./engine.ts";
import { draft } from "./draft.ts";

/** The limit is generous: some measures take tens of seconds, and the bar has a button that stops them. */
export const engine = createEngine({ limit: 60_000 });

/** The outcome of a call. While a new call is pending, the previous value is kept. */
export interface Outcome<T> {
  value: T | null;
  error: EngineError | null;
  pending: boolean;
}

/** Converts any error to an `EngineError`. */
export function asError(error: unknown): EngineError {
  return error instanceof EngineError ? error : new EngineError("page/failed", error instanceof Error ? error.message : String(error));
}

/** Makes the call again when one of `inputs` changes, and ignores outdated answers. If `call` is null, nothing is called. */
export function useAnswer<T>(call: (() => Promise<T>) | null, inputs: unknown[]): Outcome<T> {
  const [outcome, setOutcome] = useState<Outcome<T>>({ value: null, error: null, pending: call !== null });
  useEffect(() => {
    let isCurrent = true;
    if (!call) {
      setOutcome({ value: null, error: null, pending: false });
      return undefined;
    }
    setOutcome((last) => ({ ...last, pending: true }));
    call().then(
      (value) => isCurrent && setOutcome({ value, error: null, pending: false }),
      (error: unknown) => isCurrent && setOutcome({ value: null, error: asError(error), pending: false }),
    );
    return () => {
      isCurrent = false;
    };
  }, inputs);
  return outcome;
}

/** The world that a view shows: `draft` is the text of the author view. */
export function requestOf(task: string, variant: string, seed: number, index: number): WorldRequest {
  const text = task === "draft" ? draft.text : task;
  return { task: text, ...(variant ? { variant } : {}), seed, index };
}

let trainedNames: Promise<string[]> | null = null;

/** The tasks for which the page has a trained network. */
export function trainedTasks(): Promise<string[]> {
  trainedNames ??= fetch("networks/index.json").then((reply) => (reply.ok ? (reply.json() as Promise<string[]>) : []), () => []);
  return trainedNames;
}

const networks = new Map<string, Promise<Agent>>();

/** The trained network of a task. */
export function trainedAgent(task: string): Promise<Agent> {
  const known = networks.get(task);
  if (known) return known;
  const agent = fetch(`networks/${encodeURIComponent(task)}.safetensors`).then(async (reply) => {
    if (!reply.ok) throw new EngineError("page/network", `there is no trained network for ${task} on this page`);
    return { network: new Uint8Array(await reply.arrayBuffer()) };
  });
  networks.set(task, agent);
  return agent;
}
