// Writes shell commands and Python programs that do the same as actions on the page.

import type { Action, ActionSpace } from "./engine.ts";

/** A world as commands and Python name it: `task` is a built-in task, or the file that the draft is saved as. */
export interface Subject {
  task: string;
  variant: string;
  seed: number;
  index: number;
}

/** An action as a shell command and as a Python program. */
export interface Recipe {
  command: string;
  python: string;
}

/** Quotes a word for a POSIX shell if necessary. */
export function shellWord(word: string): string {
  return /^[\w@%+=:,./-]+$/.test(word) || /^[\w./-]+#[\w-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

/** A Python string literal. */
export const pythonText = (text: string): string => JSON.stringify(text);

const shell = (...words: (string | number)[]): string => ["driftworld", ...words.map(String).map(shellWord)].join(" ");
const name = ({ task, variant }: Pick<Subject, "task" | "variant">): string => (variant ? `${task}#${variant}` : task);
const where = ({ seed, index }: Subject): string[] =>
  [...(seed ? ["--seed", String(seed)] : []), ...(index ? ["--index", String(index)] : [])];

const MAKE = "import driftworld\nimport gymnasium\n\n";

/** Python that makes an environment and resets it to the world. */
function environment(subject: Subject, actions: string | null): string {
  const options = actions ? `, actions="${actions}"` : "";
  const reset = `env.reset(seed=${subject.seed}, options={"index": ${subject.index}})`;
  return `${MAKE}env = gymnasium.make("driftworld/Task-v0", task=${pythonText(name(subject))}${options})\nobservation, info = ${reset}\n`;
}

export const play = (subject: Subject): Recipe => ({
  command: shell("play", name(subject), ...where(subject)),
  python: environment(subject, null),
});

/** An agent's episode as a film; `network` is the path of a trained network. The wheel includes the command. */
export function film(subject: Subject, agent: "onrails" | "random" | { network: string }): Recipe {
  const word = typeof agent === "string" ? agent : `net:${agent.network}`;
  const words = ["film", name(subject), ...where(subject), "--agent", word, "-o", "film.gif"];
  return { command: shell(...words), python: `import subprocess\n\nsubprocess.run([${["driftworld", ...words].map(pythonText).join(", ")}], check=True)\n` };
}

export const sample = (subject: Subject): Recipe => ({
  command: shell("sample", name(subject), ...where(subject), "-o", "world.json"),
  python: `import driftworld\n\nworld = driftworld.variant(${pythonText(name(subject))}).sample(seed=${subject.seed}, index=${subject.index})\n`,
});

export const validate = (file: string): Recipe => ({
  command: shell("validate", file, "--worlds", 10),
  python: `import driftworld\n\nprint(driftworld.validate(${pythonText(file)}))\n`,
});

export const distance = (task: string, a: string, b: string, by: string): Recipe => ({
  command: shell("distance", name({ task, variant: a }), name({ task, variant: b }), "--by", by, "--explain"),
  python: `import driftworld\n\na, b = driftworld.variant(${pythonText(name({ task, variant: a }))}), driftworld.variant(${
    pythonText(name({ task, variant: b }))})\nprint(driftworld.distance(a, b, by=${pythonText(by)}))\n`,
});

/** Number of pairs of worlds that the page compares to find differing elements: enough to show something within seconds. */
export const ELEMENT_WORLDS = 8;

export const elements = (task: string, a: string, b: string): Recipe => ({
  command: shell("elements", task, a, b, "--worlds", ELEMENT_WORLDS),
  python: `import driftworld\n\nprint(driftworld.elements(${[task, a, b].map(pythonText).join(", ")}, worlds=${ELEMENT_WORLDS}))\n`,
});

export const sheet = (task: string, variants: string[], seed: number): Recipe => ({
  command: shell("sheet", ...variants.map((variant) => name({ task, variant })), "--seed", seed, "-o", "sheet.png"),
  python: `import driftworld\n\nworlds = {name: variant.sample(seed=${seed}) for name, variant in driftworld.variants(${
    variants.map((variant) => pythonText(name({ task, variant }))).join(", ")})}\n`,
});

export const order = (task: string, variants: string[], by: string, method: string, start: string): Recipe => ({
  command: shell("order", ...variants.map((variant) => name({ task, variant })), "--by", by, "--order", method, "--start", start, "--plot", "order.png"),
  python: `import driftworld\n\nvariants = [${
    variants.map((variant) => pythonText(name({ task, variant }))).join(", ")}]\norder = driftworld.order(driftworld.distance_matrix(variants, by=${
    pythonText(by)}), ${pythonText(method)}, start=${pythonText(name({ task, variant: start }))})\nprint(order)\n`,
});

export const replayLog = (log: string, episode: number): Recipe => ({
  command: shell("replay", log, "--episode", episode, "-o", "episode.gif"),
  python: `import driftworld\n\ndriftworld.Recording.read(${pythonText(log)}, ${episode}).save("episode.gif")\n`,
});

/** The file that a recording is saved as. */
export const RECORDING = "episode.jsonl";

/** Runs of equal actions, with their lengths. */
export function runs(actions: Action[]): { action: Action; times: number }[] {
  const found: { action: Action; times: number }[] = [];
  for (const action of actions) {
    const last = found.at(-1);
    if (last && String(last.action) === String(action)) last.times += 1;
    else found.push({ action, times: 1 });
  }
  return found;
}

const STEP = "        observation, reward, terminated, truncated, info = env.step(action)\n        total += reward\n";

/** An episode, action by action: `console` reads the actions from a pipe, Python takes them in a loop. */
export function episode(subject: Subject, space: Pick<ActionSpace, "kind">, actions: Action[]): Recipe {
  const counted = runs(actions);
  const lines = counted.map(({ action, times }) => `step ${times} ${typeof action === "number" ? action : action.join(" ")}`);
  const rows = counted.map(({ action, times }) => `    (${typeof action === "number" ? action : `[${action.join(", ")}]`}, ${times}),\n`);
  const command = lines.length
    ? `printf '${lines.join("\\n")}\\n' | ${shell("console", name(subject), ...where(subject))}`
    : shell("console", name(subject), ...where(subject));
  const python = `${environment(subject, space.kind === "continuous" ? "continuous" : null)}total = 0.0\nfor action, times in [\n${
    rows.join("")}]:\n    for _ in range(times):\n${STEP}print(total)\n`;
  return { command, python };
}
