// Calls a function at a given rate, never twice at once.

import { useEffect, useRef } from "preact/hooks";

/** Runs `tick` at this rate while `isRunning`; a slow tick delays the next. An error in a tick is passed to `failed` and stops the clock. */
export function useClock(isRunning: boolean, perSecond: number, tick: () => Promise<void>, failed: (error: unknown) => void): void {
  const latest = useRef({ tick, failed });
  latest.current = { tick, failed };
  useEffect(() => {
    if (!isRunning) return undefined;
    let isOver = false;
    let request = 0;
    let due = performance.now();
    const turn = async (now: number) => {
      if (isOver) return;
      // Half a frame early is on time: screens and worlds have different rates.
      if (now >= due - 8) {
        due = Math.max(due + 1000 / perSecond, now - 100);
        try {
          await latest.current.tick();
        } catch (error) {
          if (!isOver) latest.current.failed(error);
          return;
        }
      }
      if (!isOver) request = requestAnimationFrame((next) => void turn(next));
    };
    request = requestAnimationFrame((now) => void turn(now));
    return () => {
      isOver = true;
      cancelAnimationFrame(request);
    };
  }, [isRunning, perSecond]);
}
