// The moments of a replayed episode: what they paid, where a loop ends, and which moment keys lead to.

import type { Step } from "./engine.ts";

/** A moment that is worth a mark. */
export interface Mark {
  step: number;
  reward: number;
  text: string;
}

/** The moments with an event, or with a reward that is not that of most steps. */
export function marks(steps: Step[]): Mark[] {
  const counts = new Map<number, number>();
  for (const { reward } of steps) counts.set(reward, (counts.get(reward) ?? 0) + 1);
  const usual = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? 0;
  return steps.flatMap((step) => {
    if (!step.events.length && step.reward === usual) return [];
    const words = step.events.map((event) => `${event.tag ?? "object"} ${event.effect?.replace("_", " ") ?? "met"}`);
    return [{ step: step.step, reward: step.reward, text: [...new Set(words)].join(", ") }];
  });
}

/** A part of an episode that is played over and over. */
export interface Loop {
  from: number;
  to: number;
}

/** The moment after another, back at the start of the loop where that ends; null at the end of all. */
export function following(moment: number, last: number, loop: Loop | null): number | null {
  if (loop && moment >= loop.to) return loop.from;
  return moment < last ? moment + 1 : null;
}

/** The loop after its start or its end was put at a moment: the other end gives way. */
export function looped(loop: Loop | null, end: "from" | "to", moment: number, last: number): Loop {
  const { from, to } = loop ?? { from: 0, to: last };
  return end === "from" ? { from: moment, to: Math.max(moment, to) } : { from: Math.min(from, moment), to: moment };
}
