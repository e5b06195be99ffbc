// Shows a player in a world, human or agent: its name, view and progress.

import { useEffect, useRef } from "preact/hooks";
import type { ComponentChildren } from "preact";
import type { Line } from "../difference.ts";
import { amount } from "../pay.ts";
import { ending, type Session } from "../session.ts";
import { Picture } from "./pictures.tsx";

/** The agents that can play beside you. */
export type Companion = "policy" | "planner";
export const NAMES: Record<Companion, string> = { planner: "Planner", policy: "Trained policy" };
/** A description of each. */
export const MEANINGS: Record<Companion, string> = {
  planner: "A program that knows the map plays the same world",
  policy: "A network that learned this task from pictures plays the same world",
};

export function Seat({ name, session, isYours = false, lines, below, children }: {
  name: string;
  session: Session;
  isYours?: boolean;
  lines?: Line[];
  below?: ComponentChildren;
  children?: ComponentChildren;
}) {
  const frame = useRef<HTMLDivElement>(null);
  useEffect(() => {
    // Keep the focus on a list that is being used with the keyboard.
    if (isYours && !document.activeElement?.matches("select:focus-visible, input")) frame.current?.focus({ preventScroll: true });
  }, [session.episode.id]);
  const { step } = session;
  const end = ending(step);
  return (
    <section class="card seat" aria-label={name}>
      <header>
        <h2>{name}</h2>
        {end ? <span class={`tag ${step.success ? "good" : "bad"}`} role="status">{end}</span> : children}
      </header>
      <div
        ref={frame} class="frame"
        {...(isYours ? { tabIndex: 0, role: "application", "aria-label": "Your view. Arrow keys walk and turn, space uses what is ahead." } : {})}
      >
        <Picture frame={session.frame} label={`What ${name.toLowerCase()} sees`} {...(lines ? { lines } : {})} />
      </div>
      <footer class="number">
        <span>Reward <b>{amount(step.total)}</b></span>
        <span class="faint">step {step.step} · {step.seconds.toFixed(1)} s{step.energy === null ? "" : ` · energy ${amount(step.energy)}`}</span>
      </footer>
      {below}
    </section>
  );
}
