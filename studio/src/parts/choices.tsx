// Which world is shown: task, variant, seed and number.

import type { TaskCard } from "../engine.ts";
import { draft } from "../draft.ts";
import { engine, useAnswer } from "../simulator.ts";

/** A task, from all built-in ones and the draft. */
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

/** A variant of a task; empty is that of all defaults, where there is a choice of it. */
export function VariantPicker({ variants, variant, pick, label = "Variant", isNamed = false }: {
  variants: string[];
  variant: string;
  pick: (variant: string) => void;
  label?: string;
  isNamed?: boolean;
}) {
  return (
    <label class="field">
      {label}
      <select value={variant} onChange={(event) => pick(event.currentTarget.value)}>
        {!isNamed && <option value="">defaults</option>}
        {variants.map((name) => <option key={name}>{name}</option>)}
      </select>
    </label>
  );
}

/** A whole number from 0; anything else is not taken, and the number before it is shown again. */
export function NumberPicker({ label, value, pick }: { label: string; value: number; pick: (value: number) => void }) {
  return (
    <label class="field">
      {label}
      <input
        type="number" min={0} step={1} value={value}
        onChange={(event) => {
          const typed = event.currentTarget.valueAsNumber;
          const taken = Number.isSafeInteger(typed) && typed >= 0 ? typed : value;
          event.currentTarget.value = String(taken);
          pick(taken);
        }}
      />
    </label>
  );
}
