// Completions from a JSON Schema: the keys and values that are allowed at a position of a document.

import type { Json, Task } from "./engine.ts";
import { type Cursor, type Path, oneLine } from "./json_text.ts";

type Schema = { [key: string]: Json };

/** A completion: `insert` is JSON. */
export interface Suggestion {
  insert: string;
  detail: string;
}

const isSchema = (value: Json | undefined): value is Schema => typeof value === "object" && value !== null && !Array.isArray(value);

/** A schema and all its alternatives, with references resolved. */
function branches(root: Schema, schema: Json | undefined, seen = new Set<Json>()): Schema[] {
  if (!isSchema(schema) || seen.has(schema)) return [];
  seen.add(schema);
  const found = [schema];
  const reference = schema["$ref"];
  if (typeof reference === "string" && reference.startsWith("#/$defs/")) {
    const definitions = root["$defs"];
    const target = isSchema(definitions) ? definitions[reference.slice("#/$defs/".length)] : undefined;
    found.push(...branches(root, target, seen));
  }
  for (const word of ["anyOf", "oneOf", "allOf"]) {
    const parts = schema[word];
    if (Array.isArray(parts)) for (const part of parts) found.push(...branches(root, part, seen));
  }
  return found;
}

/** The schemas that apply at a path. */
function schemasAt(root: Schema, path: Path): Schema[] {
  let here = branches(root, root);
  for (const step of path) {
    const seen = new Set<Json>();
    here = here.flatMap((schema) => {
      const properties = schema["properties"];
      const prefix = schema["prefixItems"];
      const next = typeof step === "number"
        ? (Array.isArray(prefix) ? prefix[step] : undefined) ?? schema["items"]
        : (isSchema(properties) ? properties[step] : undefined) ?? schema["additionalProperties"];
      return branches(root, next, seen);
    });
  }
  return here;
}

const firstSentence = (schema: Json | undefined): string => {
  const text = isSchema(schema) ? schema["description"] : undefined;
  return typeof text === "string" ? text.split("\n")[0]!.split(/(?<=\.)\s/)[0]! : "";
};

/** Completions from a task: the names of its parameters and, in variants, their choices. */
function fromTask(task: Task | null, { path, at }: Cursor): Suggestion[] {
  if (!task) return [];
  const variables = task.parameters.filter((parameter) => parameter.role === "variant");
  if (path[0] === "variants" && path.length === 2 && at === "key") {
    return variables.map((parameter) => ({ insert: JSON.stringify(parameter.name), detail: parameter.description ?? parameter.type }));
  }
  if (path[0] === "variants" && path.length === 3 && at === "value") {
    const choices = variables.find((parameter) => parameter.name === path[2])?.choices ?? [];
    return choices.map((choice) => ({ insert: choice.name === null ? oneLine(choice.value) : JSON.stringify(choice.name), detail: "a choice" }));
  }
  if (path.at(-1) === "param" && at === "value") {
    return task.parameters.map((parameter) => ({ insert: JSON.stringify(parameter.name), detail: parameter.description ?? parameter.type }));
  }
  return [];
}

/** The completions at a cursor, without duplicates. */
export function suggestions(schema: Json, cursor: Cursor, task: Task | null = null): Suggestion[] {
  if (!isSchema(schema)) return [];
  const found = new Map(fromTask(task, cursor).map((suggestion) => [suggestion.insert, suggestion]));
  const add = (value: Json, detail: string) => {
    const insert = oneLine(value);
    if (!found.has(insert)) found.set(insert, { insert, detail });
  };
  for (const place of schemasAt(schema, cursor.path)) {
    if (cursor.at === "key") {
      const properties = place["properties"];
      for (const [key, value] of isSchema(properties) ? Object.entries(properties) : []) {
        if (!cursor.keys.includes(key)) add(key, firstSentence(value));
      }
    } else {
      const values = [place["const"], ...(Array.isArray(place["enum"]) ? place["enum"] : [])];
      for (const value of values) if (value !== undefined) add(value, firstSentence(place));
      if (place["type"] === "boolean") [true, false].forEach((value) => add(value, firstSentence(place)));
      if (place["default"] !== undefined && oneLine(place["default"]).length < 40) add(place["default"], "the default");
    }
  }
  return [...found.values()];
}
