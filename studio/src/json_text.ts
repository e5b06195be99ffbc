// Finds and changes values in the text of a JSON document, leaving every other character as it is.

import type { Json } from "./engine.ts";

/** The path to a value: keys of objects and indices of arrays. */
export type Path = (string | number)[];

/** A value with its position in the text: `to` is just after its last character. */
export interface Span {
  from: number;
  to: number;
  members?: { key: string; from: number; value: Span }[];
  items?: Span[];
}

/** A replacement in a text. */
export interface Change {
  from: number;
  to: number;
  insert: string;
}

const SCALAR = /[^\s,\]}]+/y;
const STRING = /"(?:[^"\\]|\\.)*"/y;
/** Maximum nesting depth. */
const MAX_DEPTH = 200;

/** All values of a document with their positions; null if the text is not JSON. */
export function spans(text: string): Span | null {
  let at = 0;
  const space = () => {
    while (at < text.length && " \n\r\t".includes(text[at]!)) at += 1;
  };
  const match = (pattern: RegExp): string => {
    pattern.lastIndex = at;
    const found = pattern.exec(text)?.[0];
    if (found === undefined) throw new SyntaxError(`character ${at}`);
    at += found.length;
    return found;
  };
  const expect = (character: string) => {
    if (text[at] !== character) throw new SyntaxError(`character ${at}`);
    at += 1;
  };
  const list = (close: string, item: () => void) => {
    at += 1;
    space();
    while (text[at] !== close) {
      item();
      space();
      if (text[at] === close) break;
      expect(",");
      space();
    }
    at += 1;
  };
  const value = (depth: number): Span => {
    if (depth > MAX_DEPTH) throw new SyntaxError("too deep");
    space();
    const span: Span = { from: at, to: at };
    if (text[at] === "{") {
      const members: NonNullable<Span["members"]> = (span.members = []);
      list("}", () => {
        const from = at;
        const key = JSON.parse(match(STRING)) as string;
        space();
        expect(":");
        members.push({ key, from, value: value(depth + 1) });
      });
    } else if (text[at] === "[") {
      const items: Span[] = (span.items = []);
      list("]", () => items.push(value(depth + 1)));
    } else {
      JSON.parse(match(text[at] === '"' ? STRING : SCALAR));
    }
    span.to = at;
    return span;
  };
  try {
    const root = value(0);
    space();
    return at === text.length ? root : null;
  } catch {
    return null;
  }
}

/** The value at a path, or null. */
export function spanAt(root: Span | null, path: Path): Span | null {
  let span = root;
  for (const step of path) {
    const next = typeof step === "number" ? span?.items?.[step] : span?.members?.find((member) => member.key === step)?.value;
    if (!next) return null;
    span = next;
  }
  return span;
}

/** JSON on one line, spaced as in the documents of Driftworld. */
export function oneLine(value: Json): string {
  if (Array.isArray(value)) return `[${value.map(oneLine).join(", ")}]`;
  if (value === null || typeof value !== "object") return JSON.stringify(value);
  const members = Object.entries(value).map(([key, item]) => `${JSON.stringify(key)}: ${oneLine(item)}`);
  return members.length ? `{ ${members.join(", ")} }` : "{}";
}

/** Whether two values are equal, whatever the order of their keys. */
export function same(a: Json, b: Json): boolean {
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") return a === b;
  const [left, right] = [Object.entries(a), Object.entries(b)];
  const other = b as { [key: string]: Json };
  return Array.isArray(a) === Array.isArray(b) && left.length === right.length
    && left.every(([key, value]) => key in other && same(value, other[key]!));
}

/** The change that puts a value at a path; null if the path has no parent. */
export function change(text: string, path: Path, value: Json): Change | null {
  const root = spans(text);
  const there = spanAt(root, path);
  if (there) return { from: there.from, to: there.to, insert: oneLine(value) };
  const parent = spanAt(root, path.slice(0, -1));
  const key = path.at(-1);
  const isMember = typeof key === "string";
  if (!parent || !(isMember ? parent.members : parent.items)) return null;
  const insert = isMember ? `${JSON.stringify(key)}: ${oneLine(value)}` : oneLine(value);
  const starts = isMember ? parent.members!.map((member) => member.from) : parent.items!.map((item) => item.from);
  const ends = isMember ? parent.members!.map((member) => member.value.to) : parent.items!.map((item) => item.to);
  if (!ends.length) return { from: parent.from + 1, to: parent.to - 1, insert: isMember ? ` ${insert} ` : insert };
  // Formatted like the last one: on a line of its own, or on the same line.
  const before = text.slice(ends.at(-2) ?? parent.from + 1, starts.at(-1));
  const gap = before.includes("\n") ? before.slice(before.lastIndexOf("\n")) : " ";
  return { from: ends.at(-1)!, to: ends.at(-1)!, insert: `,${gap}${insert}` };
}

/** The change that removes an item from an array, or a member from an object; null if it does not exist. */
export function removal(text: string, path: Path): Change | null {
  const root = spans(text);
  const parent = spanAt(root, path.slice(0, -1));
  const key = path.at(-1);
  const all = parent?.items?.map((item) => ({ from: item.from, to: item.to }))
    ?? parent?.members?.map((member) => ({ from: member.from, to: member.value.to })) ?? [];
  const index = typeof key === "number" ? key : parent?.members?.findIndex((member) => member.key === key) ?? -1;
  const here = all[index];
  if (!here) return null;
  const [next, previous] = [all[index + 1], all[index - 1]];
  if (next) return { from: here.from, to: next.from, insert: "" };
  return { from: previous?.to ?? here.from, to: here.to, insert: "" };
}

/** A text after a change. */
export function applyChange(text: string, { from, to, insert }: Change): string {
  return text.slice(0, from) + insert + text.slice(to);
}

/** The path of a JSON pointer; numbers are taken as indices. */
export function pathOf(pointer: string): Path {
  const steps = pointer.split("/").slice(1).map((step) => step.replaceAll("~1", "/").replaceAll("~0", "~"));
  return steps.map((step) => (/^\d+$/.test(step) ? Number(step) : step));
}

/** The position of a cursor in a document that may be unfinished. */
export interface Cursor {
  path: Path;
  /** Whether a key or a value belongs here. */
  at: "key" | "value";
  /** Start of the token that is being typed. */
  from: number;
  /** The keys before the cursor in the object around it. */
  keys: string[];
}

/** The cursor at an offset; reads only the text before it. */
export function cursorAt(text: string, offset: number): Cursor {
  const stack: { key: string | number; keys: string[] | null; isValue: boolean }[] = [];
  const token = /"(?:[^"\\]|\\.)*"?|[{}[\],:]|[^\s{}[\],:"]+/g;
  let from = offset;
  for (let found = token.exec(text); found && found.index < offset; found = token.exec(text)) {
    const word = found[0];
    const top = stack.at(-1);
    if (found.index + word.length >= offset && !"{}[],:".includes(word)) {
      from = found.index;
      break;
    }
    if (word === "{") stack.push({ key: "", keys: [], isValue: false });
    else if (word === "[") stack.push({ key: 0, keys: null, isValue: true });
    else if (word === "}" || word === "]") stack.pop();
    else if (word === ":" && top) top.isValue = true;
    else if (word === "," && top) {
      if (typeof top.key === "number") top.key += 1;
      else top.isValue = false;
    } else if (top?.keys && !top.isValue && word.startsWith('"')) {
      top.key = word.slice(1, word.endsWith('"') && word.length > 1 ? -1 : undefined);
      top.keys.push(top.key);
    }
  }
  const top = stack.at(-1);
  const isKey = top !== undefined && !top.isValue;
  const path = stack.map((level) => level.key);
  return { path: isKey ? path.slice(0, -1) : path, at: isKey ? "key" : "value", from, keys: top?.keys ?? [] };
}
