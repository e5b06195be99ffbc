// Finds text layouts and lists of points in a task spec, and changes a cell of a layout.

import type { Json } from "./engine.ts";
import type { Path } from "./json_text.ts";

/** A layout of type `text` in a document. */
export interface TextLayout {
  /** The path to its list of rows. */
  path: Path;
  /** Its location, for people: `maze / choices / plus`. */
  label: string;
  rows: string[];
  /** Letters that can be put into a cell, each with its meaning. */
  letters: { letter: string; meaning: string }[];
}

const STANDARD_LETTERS: Record<string, string> = { "#": "wall", ".": "floor", A: "start" };

/** The meaning of a letter of a legend, in words. */
function meaning(entry: Json): string {
  return typeof entry === "string" ? entry : String(Object.values(entry as { [key: string]: Json })[0] ?? "");
}

/** Every text layout in a document, in order. */
export function textLayouts(document: Json): TextLayout[] {
  const found: TextLayout[] = [];
  const visit = (value: Json, path: Path): void => {
    if (value === null || typeof value !== "object" || path.length > 12) return;
    const { text, legend } = Array.isArray(value) ? {} : value;
    if (Array.isArray(text) && text.length > 0 && text.every((row) => typeof row === "string")) {
      const own = legend && typeof legend === "object" && !Array.isArray(legend) ? legend : {};
      const letters = { ...STANDARD_LETTERS, ...Object.fromEntries(Object.entries(own).map(([letter, entry]) => [letter, meaning(entry)])) };
      found.push({
        path: [...path, "text"],
        label: path.filter((step) => step !== "parameters" && step !== "world").join(" / ") || "layout",
        rows: text as string[],
        letters: Object.entries(letters).map(([letter, word]) => ({ letter, meaning: word })),
      });
    }
    const entries: [string | number, Json][] = Array.isArray(value) ? value.map((item, index) => [index, item]) : Object.entries(value);
    for (const [key, item] of entries) visit(item, [...path, key]);
  };
  visit(document, []);
  return found;
}

/** A row with one letter replaced; columns count characters, as in Driftworld. */
export function withLetter(row: string, column: number, letter: string): string {
  const letters = [...row];
  letters[column] = letter;
  return letters.join("");
}

/** A group whose objects are at listed points. */
export interface PointGroup {
  name: string;
  /** The path to its list of points. */
  path: Path;
  /** The path to its count; null if the count is not a plain number. */
  count: Path | null;
  points: [number, number][];
}

/** The groups of a task whose positions are a list of points; a click on the map adds or removes a point. */
export function pointGroups(document: Json): PointGroup[] {
  const groups = document !== null && typeof document === "object" && !Array.isArray(document) ? document["groups"] : null;
  return (Array.isArray(groups) ? groups : []).flatMap((group, index) => {
    const { name, count, placement } = (group ?? {}) as { [key: string]: Json };
    const points = ((placement as { [key: string]: Json } | undefined)?.["points"] as { [key: string]: Json } | undefined)?.["values"];
    const isPoint = (point: Json) => Array.isArray(point) && point.length === 2 && point.every((part) => typeof part === "number");
    const isList = Array.isArray(points) && points.every(isPoint);
    if (!isList) return [];
    return [{
      name: typeof name === "string" ? name : `group ${index}`,
      path: ["groups", index, "placement", "points", "values"],
      count: typeof count === "number" ? ["groups", index, "count"] : null,
      points: points as [number, number][],
    }];
  });
}
