// Displays parameter values: colours as swatches, choices by name, long values truncated.

import type { Element, Value } from "../engine.ts";
import { oneLine, same } from "../json_text.ts";
import type { WrittenParameter } from "../written.ts";

/** The elements of a decision process. */
export const ELEMENTS: Record<Element, string> = {
  S: "State", A: "Action", T: "Transition", R: "Reward", O: "Observation", p: "Initial state", phi: "Observation",
};
/** The names of elements, without duplicates. */
export const elementNames = (elements: Element[]): string => [...new Set(elements.map((element) => ELEMENTS[element]))].join(", ");

/** Used to parse names of colours. */
let context: CanvasRenderingContext2D | null = null;

/** A colour as `#rrggbb`, from a CSS name or from three numbers in 0..1; null for anything else. */
export function hexOf(value: Value): string | null {
  if (Array.isArray(value) && value.length === 3 && value.every((part) => typeof part === "number")) {
    return `#${(value as number[]).map((part) => Math.round(Math.min(1, Math.max(0, part)) * 255).toString(16).padStart(2, "0")).join("")}`;
  }
  context ??= document.createElement("canvas").getContext("2d");
  if (typeof value !== "string" || !context) return null;
  context.fillStyle = "#010203";
  context.fillStyle = value;
  return context.fillStyle === "#010203" ? null : context.fillStyle;
}

/** The index of the choice that equals a value; -1 if none does. */
export function choiceOf({ choices }: WrittenParameter, value: Value): number {
  return choices?.findIndex(({ name, value: short, full }) => (name !== null && name === value) || same(short, value) || same(full, value)) ?? -1;
}

/** The text for a value in a list: its name or its JSON, truncated if long. */
export function wordOf(value: Value, name: string | null = null): string {
  const text = name ?? (value === null ? "none" : typeof value === "string" ? value : oneLine(value));
  return text.length > 60 ? `${text.slice(0, 59)}…` : text;
}

/** A value in a table. */
export function ShownValue({ parameter, value }: { parameter: WrittenParameter; value: Value }) {
  const choice = parameter.choices?.[choiceOf(parameter, value)];
  const color = parameter.type === "color" ? hexOf(value) : null;
  const unit = typeof value === "number" && parameter.unit ? ` ${parameter.unit}` : "";
  return (
    <span class="value">
      {color && <span class="swatch" aria-hidden="true" style={{ background: color }} />}
      {choice ? wordOf(choice.value, choice.name) : (color ?? wordOf(value))}{unit}
    </span>
  );
}
