// Pickers for the world to show: task, variant, seed and number.

import type { TaskCard } from "../engine.ts";
import { draft } from "../draft.ts";
import { engine, useAnswer } from "../simulator.ts";

/** Picks one of the built-in tasks or the draft. */
export function TaskPicker({ task, pick }: { task: string; pick: (task: string) => void }) {
  const cards = useAnswer(() => engine.tasks(), []).value ?? [];
  const groups = [...new Set(cards.map((card) => card.group))];
  return (
    <label class="field">
      Task
      <select value={task} onChange={(event) => pick(event.currentTarget.value)}>
        {draft.text && <option value="draft">{draft.name} (yours)</option>}
        {groups.map((group) => (
          <optgroup key={group} label={group}>
            {cards.filter((card) => card.group === group).map((card: TaskCard) => <option key={card.name}>{card.name}</option>)}
          </optgroup>
        ))}
      </select>
    </label>
  );
}

/** A labelled drop-down list; an entry is a word, or a value with its text. */
export function Choice({ label, value, entries, pick }: {
  label: string;
  value: string;
  entries: readonly (string | readonly [value: string, words: string])[];
  pick: (value: string) => void;
}) {
  return (
    <label class="field">
      {label}
      <select value={value} onChange={(event) => pick(event.currentTarget.value)}>
        {entries.map((entry) => {
          const [id, words] = typeof entry === "string" ? [entry, entry] : entry;
          return <option key={id} value={id}>{words}</option>;
        })}
      </select>
    </label>
  );
}

/** Picks a variant of a task; an empty value stands for the variant with all defaults, if that can be chosen. */
export function VariantPicker({ variants, variant, pick, label = "Variant", isNamed = false }: {
  variants: string[];
  variant: string;
  pick: (variant: string) => void;
  label?: string;
  isNamed?: boolean;
}) {
  const names = [...new Set([...variants, variant])].filter(Boolean);
  return <Choice label={label} value={variant} entries={isNamed ? names : [["", "defaults"], ...names]} pick={pick} />;
}

/** Explanations of the numbers that select a world. */
const MEANINGS: Record<string, string> = {
  Seed: "Worlds are random. The same seed always gives the same worlds.",
  World: "The number of the world among those of this seed, from 0.",
};

/** Picks a whole number from 0; any other input is rejected and the previous number restored. */
export function NumberPicker({ label, value, pick }: { label: string; value: number; pick: (value: number) => void }) {
  return (
    <label class="field" title={MEANINGS[label]}>
      {label}
      <input
        type="number" min={0} step={1} value={value}
        onChange={(event) => {
          const typed = event.currentTarget.valueAsNumber;
          const accepted = Number.isSafeInteger(typed) && typed >= 0 ? typed : value;
          event.currentTarget.value = String(accepted);
          pick(accepted);
        }}
      />
    </label>
  );
}
