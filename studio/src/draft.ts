// The text of the author view: kept in the browser, so that a reload loses nothing.

const KEY = "driftworld.draft";

function stored(): string {
  try {
    return localStorage.getItem(KEY) ?? "";
  } catch {
    return "";
  }
}

export const draft = {
  text: stored(),
  /** The name of the task in it, as far as it can be read. */
  get name(): string {
    return /"name"\s*:\s*"([a-z][a-z0-9_]*)"/.exec(this.text)?.[1] ?? "my_task";
  },
  /** The file that the draft is saved as, and that commands name. */
  get file(): string {
    return `${this.name}.json`;
  },
  keep(text: string): void {
    this.text = text;
    try {
      localStorage.setItem(KEY, text);
    } catch {
      // Without storage, the text lasts as long as the page.
    }
  },
};
