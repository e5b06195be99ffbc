// The timeline of a replayed episode: finds marks, and moves through loops.

import type { Step } from "./engine.ts";

/** A moment worth marking. */
export interface Mark {
  step: number;
  reward: number;
  text: string;
}

/** The moments with an event, or with a reward that differs from the most common one. */
export function marks(steps: Step[]): Mark[] {
  const counts = new Map<number, number>();
  for (const { reward } of steps) counts.set(reward, (counts.get(reward) ?? 0) + 1);
  const mostCommon = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? 0;
  return steps.flatMap((step) => {
    if (!step.events.length && step.reward === mostCommon) return [];
    const words = step.events.map((event) => `${event.tag ?? "object"} ${event.effect?.replace("_", " ") ?? "met"}`);
    return [{ step: step.step, reward: step.reward, text: [...new Set(words)].join(", ") }];
  });
}

/** A part of an episode that is played repeatedly. */
export interface Loop {
  from: number;
  to: number;
}

/** The next moment: back to the start of the loop at its end; null at the end of the episode. */
export function nextMoment(moment: number, last: number, loop: Loop | null): number | null {
  if (loop && moment >= loop.to) return loop.from;
  return moment < last ? moment + 1 : null;
}

/** The loop with its start or end moved to a moment, and the other end moved along if necessary. */
export function moveLoopEnd(loop: Loop | null, end: "from" | "to", moment: number, last: number): Loop {
  const { from, to } = loop ?? { from: 0, to: last };
  return end === "from" ? { from: moment, to: Math.max(moment, to) } : { from: Math.min(from, moment), to: moment };
}
