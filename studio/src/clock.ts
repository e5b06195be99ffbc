// Calls a function at a given rate, and never before the previous call has ended.

import { useEffect, useRef } from "preact/hooks";

/** Calls `tick` at this rate while `isRunning`; a slow tick delays the next. An error in a tick stops the clock and is passed to `failed`. */
export function useClock(isRunning: boolean, perSecond: number, tick: () => Promise<void>, failed: (error: unknown) => void): void {
  const latest = useRef({ tick, failed });
  latest.current = { tick, failed };
  useEffect(() => {
    if (!isRunning) return undefined;
    let isOver = false;
    let request = 0;
    let due = performance.now();
    const onFrame = async (now: number) => {
      if (isOver) return;
      // A tick may be half a frame early, because screens and worlds have different rates.
      if (now >= due - 8) {
        due = Math.max(due + 1000 / perSecond, now - 100);
        try {
          await latest.current.tick();
        } catch (error) {
          if (!isOver) latest.current.failed(error);
          return;
        }
      }
      if (!isOver) request = requestAnimationFrame((next) => void onFrame(next));
    };
    request = requestAnimationFrame((now) => void onFrame(now));
    return () => {
      isOver = true;
      cancelAnimationFrame(request);
    };
  }, [isRunning, perSecond]);
}
