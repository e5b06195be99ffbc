// Shows parameters as their author wrote them: `gold` instead of three numbers; a maze without its defaults.

import type { Json, Parameter, Task, Value } from "./engine.ts";

/** A choice as its author wrote it, and in full, as it appears in variants. */
export interface WrittenChoice {
  value: Value;
  full: Value;
  name: string | null;
}

/** A parameter with its choices as its author wrote them. */
export type WrittenParameter = Omit<Parameter, "choices"> & { choices: WrittenChoice[] | null };

/** The parameters of a task, with the choices as written in its text. */
export function writtenParameters({ text, parameters }: Pick<Task, "text" | "parameters">): WrittenParameter[] {
  const document = JSON.parse(text) as { parameters?: Record<string, { choices?: Json }> };
  return parameters.map((parameter) => {
    const choices = document.parameters?.[parameter.name]?.choices;
    const values = choices && typeof choices === "object" ? Object.values(choices as { [key: string]: Json }) : [];
    return {
      ...parameter,
      choices: parameter.choices?.map(({ value, name }, at) => ({ value: values[at] ?? value, full: value, name })) ?? null,
    };
  });
}
