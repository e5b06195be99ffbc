// Addresses of the page: `#/play/maze?variant=small&seed=3` selects a view and its contents; a fragment without the slash encodes an episode.

/** The views of the page. */
export const VIEWS = ["gallery", "play", "author", "compare", "order", "replay"] as const;
export type ViewName = (typeof VIEWS)[number];

/** The contents of an address's fragment. */
export interface Route {
  view: ViewName;
  /** A built-in task, or `draft` for the text of the author view; empty if the address names none. */
  task: string;
  options: Record<string, string>;
  /** The encoded episode, for the view `replay`. */
  link: string | null;
  /** The path, if it names no view; else null. */
  unknown: string | null;
}

/** Parses a fragment, with or without its `#`. An unknown view becomes the gallery. */
export function parseRoute(fragment: string): Route {
  const text = fragment.replace(/^#/, "");
  if (text && !text.startsWith("/")) return { view: "replay", task: "", options: {}, link: text, unknown: null };
  const [path = "", query = ""] = text.split("?", 2);
  const [, name, task = ""] = path.split("/");
  const view = VIEWS.find((known) => known === name);
  const options = Object.fromEntries(new URLSearchParams(query));
  return { view: view ?? "gallery", task: view ? decode(task) : "", options, link: null, unknown: view || !name ? null : decode(path) };
}

/** The fragment of a route, with `#`. */
export function hrefOf(view: ViewName, task = "", options: Record<string, string | number | undefined> = {}): string {
  const query = new URLSearchParams();
  for (const [key, value] of Object.entries(options)) if (value !== undefined && value !== "") query.set(key, String(value));
  return `#/${view}${task ? `/${encodeURIComponent(task)}` : ""}${query.size ? `?${query}` : ""}`;
}

/** An option as a whole number; 0 if it is not one, or is too large. */
export function wholeNumber(text: string | undefined): number {
  const number = Number(text ?? 0);
  return Number.isSafeInteger(number) && number >= 0 ? number : 0;
}

function decode(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
