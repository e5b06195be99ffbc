// Sliders and pickers for the parameters of a task, built from the ranges and choices that it declares.

import type { Value, Variant } from "../engine.ts";
import type { WrittenParameter } from "../written.ts";
import { choiceOf, elementNames, wordOf } from "./value.tsx";

/** Rounds a number to the digits of its slider's step. */
const roundTo = (value: number, step: number): number => Number(value.toFixed(Math.max(0, Math.ceil(-Math.log10(step)))));

function Slider({ id, low, high, isWhole, value, set }: {
  id: string; low: number; high: number; isWhole: boolean; value: number; set: (value: number) => void;
}) {
  const step = isWhole ? 1 : 10 ** Math.floor(Math.log10((high - low) / 100));
  return (
    <input
      id={id} type="range" min={low} max={high} step={step} value={value}
      onInput={(event) => set(roundTo(event.currentTarget.valueAsNumber, step))}
    />
  );
}

function Knob({ parameter, value, set }: { parameter: WrittenParameter; value: Value; set: (value: Value) => void }) {
  const { name, range, choices, type, unit, description, affects } = parameter;
  const id = `knob-${name}`;
  const isWhole = type === "integer";
  const numbers = Array.isArray(value) && value.every((part) => typeof part === "number") ? (value as number[]) : null;
  const title = [description, affects.length ? `Affects ${elementNames(affects).toLowerCase()}.` : ""].filter(Boolean).join(" ");
  const shownValue = choices ? "" : typeof value === "number" ? `${value}${unit ? ` ${unit}` : ""}` : numbers ? numbers.join(" × ") : "";
  const chosen = choiceOf(parameter, value);
  return (
    <div class="knob" title={title}>
      <div class="top"><label for={id}>{name}</label><output for={id}>{shownValue}</output></div>
      {choices
        ? (
          <select
            id={id} value={String(chosen)}
            onChange={(event) => {
              const choice = choices[Number(event.currentTarget.value)];
              if (choice) set(choice.name ?? choice.value);
            }}
          >
            {chosen < 0 && <option value="-1">{wordOf(value)}</option>}
            {choices.map((choice, place) => <option key={place} value={String(place)}>{wordOf(choice.value, choice.name)}</option>)}
          </select>
        )
        : range && typeof value === "number"
          ? <Slider id={id} low={range[0]} high={range[1]} isWhole={isWhole} value={value} set={set} />
          : range && numbers
            ? numbers.map((part, place) => (
              <Slider
                key={place} id={place ? `${id}-${place}` : id} low={range[0]} high={range[1]}
                isWhole={numbers.every(Number.isInteger) && range.every(Number.isInteger)}
                value={part} set={(next) => set(numbers.map((other, index) => (index === place ? next : other)))}
              />
            ))
            : typeof value === "boolean"
              ? <input id={id} type="checkbox" checked={value} onChange={(event) => set(event.currentTarget.checked)} />
              : typeof value === "number"
                ? (
                  <input
                    id={id} type="number" step={isWhole ? 1 : "any"} value={value}
                    onChange={({ currentTarget: { valueAsNumber } }) => Number.isFinite(valueAsNumber) && set(valueAsNumber)}
                  />
                )
                : <code id={id}>{wordOf(value)}</code>}
    </div>
  );
}

/** Controls for the parameters that can be set: those of the shown variant, and fixed numbers and booleans. */
export function Knobs({ parameters, variant, set }: {
  parameters: WrittenParameter[];
  variant: Variant | null;
  set: (parameter: WrittenParameter, value: Value) => void;
}) {
  const shown = parameters.filter(({ role, value }) => role === "variant" || (role === "fixed" && ["number", "boolean"].includes(typeof value)));
  if (!shown.length) return <p class="faint small">Nothing varies in this task. A parameter with the role <code>variant</code> gets a slider or a list here.</p>;
  return (
    <div class="knobs">
      {shown.map((parameter) => (
        <Knob
          key={parameter.name} parameter={parameter} set={(value) => set(parameter, value)}
          value={(parameter.role === "variant" ? variant?.values[parameter.name] : undefined) ?? parameter.value ?? null}
        />
      ))}
    </div>
  );
}
