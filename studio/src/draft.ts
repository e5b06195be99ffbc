// The text in the author view, stored in the browser so that a reload loses nothing.

const KEY = "driftworld.draft";
/** The key of the text that `take` replaced. */
const REPLACED = "driftworld.replaced";

function stored(key: string): string {
  try {
    return localStorage.getItem(key) ?? "";
  } catch {
    return "";
  }
}

function store(key: string, text: string): void {
  try {
    localStorage.setItem(key, text);
  } catch {
    // Without storage, the text is lost when the page closes.
  }
}

/** The name of the task in a text; `my_task` if it has none. */
export const nameIn = (text: string): string => /"name"\s*:\s*"([a-z][a-z0-9_]*)"/.exec(text)?.[1] ?? "my_task";

/** A copy of a built-in task's text, with a new name. */
export const copyOf = (text: string): string => text.replace(`"name": "${nameIn(text)}"`, `"name": "my_${nameIn(text)}"`);

export const draft = {
  text: stored(KEY),
  /** Called with the task's name when the text changes. */
  onname: null as ((name: string) => void) | null,
  /** The name of the task in it; empty without a text. */
  get name(): string {
    return this.text && nameIn(this.text);
  },
  /** The name under which the draft is saved, and which commands use. */
  get file(): string {
    return `${this.name}.json`;
  },
  keep(text: string): void {
    this.text = text;
    store(KEY, text);
    this.onname?.(this.name);
  },
  /** Replaces the text from outside the editor; the editor can then restore the previous text. */
  take(text: string): void {
    if (this.text && this.text !== text) store(REPLACED, this.text);
    this.keep(text);
  },
  /** Returns the text that `take` last replaced, and forgets it; empty if there is none. */
  replaced(): string {
    const text = stored(REPLACED);
    store(REPLACED, "");
    return text;
  },
};
