// Turns held keys into input for an agent.

import { useLayoutEffect, useRef } from "preact/hooks";
import type { Keys } from "./engine.ts";

const AHEAD = ["ArrowUp", "KeyW"];
const BACK = ["ArrowDown", "KeyS"];
const LEFT = ["ArrowLeft", "KeyA"];
const RIGHT = ["ArrowRight", "KeyD"];
const USE = ["Space", "KeyE"];
/** All keys that control an agent. */
export const CONTROL_KEYS = [AHEAD, BACK, LEFT, RIGHT, USE].flat();

/** The input from held keys. */
export function inputOf(held: ReadonlySet<string>): Keys {
  const any = (codes: string[]) => Number(codes.some((code) => held.has(code)));
  return { ahead: any(AHEAD) - any(BACK), turn: any(RIGHT) - any(LEFT), interact: any(USE) === 1 };
}

/** Whether there is any input. */
export const hasInput = (keys: Keys): boolean => keys.ahead !== 0 || keys.turn !== 0 || keys.interact;

/** Whether a key press is meant for a control, such as a list, rather than for the world. */
const isForControl = (target: EventTarget | null): boolean =>
  target instanceof Element && target.closest("input, select, textarea, button, a, summary, [contenteditable], .editor") !== null;

/** The keys held while the page has the focus; `press` is called for each new one. A key that is released early still counts in the next `read`. */
export function useHeldKeys(press: (code: string) => void): { read(): Keys; set(code: string, isDown: boolean): void } {
  const held = useRef(new Set<string>());
  const tapped = useRef(new Set<string>());
  const onPress = useRef(press);
  onPress.current = press;
  const set = (code: string, isDown: boolean) => {
    if (isDown) {
      held.current.add(code);
      tapped.current.add(code);
      onPress.current(code);
    } else {
      held.current.delete(code);
    }
  };
  useLayoutEffect(() => {
    const down = (event: KeyboardEvent) => {
      if (isForControl(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
      if (CONTROL_KEYS.includes(event.code)) event.preventDefault();
      if (!event.repeat) {
        if (CONTROL_KEYS.includes(event.code)) set(event.code, true);
        else onPress.current(event.code);
      }
    };
    const up = (event: KeyboardEvent) => set(event.code, false);
    const blur = () => held.current.clear();
    window.addEventListener("keydown", down);
    window.addEventListener("keyup", up);
    window.addEventListener("blur", blur);
    return () => {
      window.removeEventListener("keydown", down);
      window.removeEventListener("keyup", up);
      window.removeEventListener("blur", blur);
    };
  }, []);
  const read = () => {
    const keys = inputOf(new Set([...held.current, ...tapped.current]));
    tapped.current.clear();
    return keys;
  };
  return { read, set };
}
