// The author view: edits a task as text, with sliders for its parameters, a live preview of a world, and a clickable map.

import { useEffect, useRef, useState } from "preact/hooks";
import { EngineError, type Frame, type Json, type Problem, type Task, type Value, type Variant, type WorldMap, type WorldRequest } from "../engine.ts";
import * as commands from "../commands.ts";
import { copyOf, draft } from "../draft.ts";
import type { Editor } from "../editor.ts";
import { applyChange, change, type Change, pathOf, type Path, removal, spanAt, spans } from "../json_text.ts";
import { pointGroups, textLayouts, withLetter } from "../layouts.ts";
import { hrefOf, type Route } from "../route.ts";
import { asError, engine } from "../simulator.ts";
import { TEMPLATES } from "../templates.ts";
import { writtenParameters, type WrittenParameter } from "../written.ts";
import { Cells } from "../parts/cells.tsx";
import { Choice, NumberPicker, VariantPicker } from "../parts/choices.tsx";
import { Knobs } from "../parts/knobs.tsx";
import { ErrorNote, Recipes, saveText } from "../parts/notes.tsx";
import { FlatMap, Picture } from "../parts/pictures.tsx";

/** Milliseconds without a key press after which the text is checked. */
const PAUSE_MS = 150;
/** A click within this many metres of a point removes it. */
const REMOVAL_RADIUS = 1.5;

/** The preview of the last valid text. */
interface Preview {
  document: Json;
  task: Task | null;
  parameters: WrittenParameter[];
  frame: Frame;
  map: WorldMap;
}

/** Draws a world of a text. */
async function drawPreview(text: string, kind: string, variant: string, seed: number, index: number): Promise<Preview> {
  const task = kind === "task" ? await engine.task(text) : null;
  const known = task?.variants.some(({ name }) => name === variant);
  const request: WorldRequest = task ? { task: text, ...(known ? { variant } : {}), seed, index } : { world: text };
  const episode = await engine.open(request, { width: 320, height: 240 });
  try {
    const parameters = task ? writtenParameters({ ...task, text }) : [];
    return { document: JSON.parse(text) as Json, task, parameters, frame: await episode.frame("agent"), map: await episode.map() };
  } finally {
    void episode.close().catch(() => undefined);
  }
}

/** The text that an address names: a copy of a built-in task, or a file served by `driftworld studio`; null stands for the draft. */
async function initialText({ task, options: { file } }: Route): Promise<string | null> {
  if (file && /^[\w-]+\.json$/.test(file)) {
    const reply = await fetch(file);
    if (!reply.ok) throw new EngineError("page/file", `${file}: found no file of this name next to the page; open the task with \`driftworld studio\``);
    return reply.text();
  }
  return task && task !== "draft" ? copyOf((await engine.task(task)).text) : null;
}

export function Author({ route }: { route: Route }) {
  const place = useRef<HTMLDivElement>(null);
  const editor = useRef<Editor | null>(null);
  const context = useRef<{ schema: Json; task: Task | null }>({ schema: {}, task: null });
  const loadedText = useRef<string | null>(null);
  const [text, setText] = useState(draft.text || TEMPLATES[0]!.text);
  const [variant, setVariant] = useState(route.options["variant"] ?? "");
  const [seed, setSeed] = useState(0);
  const [index, setIndex] = useState(0);
  const [shown, setShown] = useState<Preview | null>(null);
  const [problems, setProblems] = useState<Problem[]>([]);
  const [error, setError] = useState<EngineError | null>(null);
  const [round, setRound] = useState(0);
  const [layoutIndex, setLayoutIndex] = useState(0);
  const [target, setTarget] = useState("");
  const [status, setStatus] = useState("");

  useEffect(() => {
    let isOver = false;
    const begin = async () => {
      const { createEditor } = await import("../editor.ts");
      const named = await initialText(route);
      if (isOver || !place.current) return;
      const replaced = draft.replaced();
      editor.current = createEditor(place.current, replaced || text, () => context.current, setText);
      loadedText.current = named;
      if (replaced) setStatus("Undo brings back the text that was here before.");
      if (named !== null || replaced) editor.current.replace(named ?? text);
      // Show the text before completion is available.
      context.current.schema = await engine.schema("task");
    };
    begin().catch((reason: unknown) => setError(asError(reason)));
    return () => {
      isOver = true;
      editor.current?.destroy();
      editor.current = null;
    };
  }, [route.task, route.options["file"]]);

  useEffect(() => {
    draft.keep(text);
    // Once edited, the text is the draft: neither Back nor a reload returns to the text that the address named.
    if (loadedText.current !== null && text !== loadedText.current) history.replaceState(null, "", hrefOf("author", "draft", { variant }));
    let isOver = false;
    const look = async () => {
      const found = await engine.validate(text);
      if (isOver) return;
      setProblems(found.problems);
      editor.current?.mark(found.problems);
      setError(null);
      if (found.problems.length) return;
      const next = await drawPreview(text, found.kind, variant, seed, index);
      if (isOver) return;
      context.current.task = next.task;
      setShown(next);
    };
    const timer = setTimeout(() => void look().catch((reason: unknown) => !isOver && setError(asError(reason))), PAUSE_MS);
    return () => {
      isOver = true;
      clearTimeout(timer);
    };
  }, [text, variant, seed, index, round]);

  const edit = (path: Path, value: Value, kind: "alone" | "drag" = "alone") => {
    const found = change(editor.current?.text() ?? text, path, value);
    if (found) editor.current?.change(found, kind);
    return found !== null;
  };
  const setKnob = (parameter: WrittenParameter, value: Value) => {
    const path: Path = parameter.role === "fixed"
      ? ["parameters", parameter.name, "value"]
      : variant ? ["variants", variant, parameter.name] : ["parameters", parameter.name, "default"];
    const effect = path[2] === "default"
      ? `The default of ${parameter.name} has changed in the text. This affects every variant that does not set its own value.`
      : "";
    setStatus(edit(path, value, "drag") ? effect : `${variant} belongs to a family: change the family in the text, or choose another variant.`);
  };
  const showPath = (path: Path) => {
    const span = spanAt(spans(text), path);
    if (span) editor.current?.show(span.from, span.to);
  };

  const layouts = shown ? textLayouts(shown.document) : [];
  const layout = layouts[Math.min(layoutIndex, layouts.length - 1)];
  const groups = shown ? pointGroups(shown.document) : [];
  const group = groups.find(({ name }) => name === target);
  const clickMap = (point: [number, number], object: number | null) => {
    if (!group) {
      if (object !== null) showPath(shown?.task ? pathOfObject(shown, object) : ["objects", object]);
      return;
    }
    const before = editor.current?.text() ?? text;
    // The text may be newer than the preview.
    const now = spans(before) && pointGroups(JSON.parse(before) as Json).find(({ name }) => name === target);
    if (!now) return;
    const here = now.points.findIndex(([x, y]) => Math.hypot(x - point[0], y - point[1]) <= REMOVAL_RADIUS);
    const edited = here < 0
      ? change(before, [...now.path, now.points.length], point.map((metres) => Math.round(metres * 10) / 10))
      : removal(before, [...now.path, here]);
    if (!edited) return;
    const after = applyChange(before, edited);
    const count = now.count && change(after, now.count, now.points.length + (here < 0 ? 1 : -1));
    const whole = count ? applyChange(after, count) : after;
    editor.current?.change(minimal(before, whole));
  };

  const request = { variant: shown?.task?.variants.some(({ name }) => name === variant) ? variant : "", seed, index };
  const subject = { task: draft.file, ...request };
  const current: Variant | null = shown?.task?.variants.find(({ name }) => name === variant) ?? null;
  return (
    <>
      <div class="head">
        <div>
          <h1>Author</h1>
          <p>A task is one JSON text. The world next to it is redrawn as you type; <kbd>Ctrl</kbd> <kbd>space</kbd> completes.</p>
        </div>
        <div class="row end">
          <label class="field">
            New from
            <select
              value="" onChange={(event) => {
                const template = TEMPLATES[Number(event.currentTarget.value)];
                if (template) {
                  setVariant("");
                  editor.current?.replace(template.text);
                }
                event.currentTarget.value = "";
              }}
            >
              <option value="">a template …</option>
              {TEMPLATES.map((template, number) => <option key={template.name} value={String(number)}>{template.name}</option>)}
            </select>
          </label>
          <button type="button" onClick={() => editor.current?.undo()}>Undo</button>
          <button type="button" onClick={() => editor.current?.redo()}>Redo</button>
          <button type="button" onClick={() => saveText(draft.file, draft.text)}>Save {draft.file}</button>
          {problems.length > 0
            ? <button type="button" class="main" disabled title="First fix the problems listed below the text.">Fix the text to play</button>
            : <a class="button main" href={hrefOf("play", "draft", { variant: request.variant, seed: seed || undefined, index: index || undefined })}>Play</a>}
        </div>
      </div>
      <div class="author">
        <div class="stack">
          <div class="card editor" ref={place} />
          {problems.length > 0
            ? (
              <ul class="problems verdict" aria-label="Problems">
                {problems.slice(0, 20).map((problem, number) => (
                  <li key={number}>
                    <button type="button" onClick={() => showProblem(editor.current, text, problem)}>
                      {problem.message}
                    </button>
                  </li>
                ))}
              </ul>
            )
            : shown && (
              <p class="note good verdict" role="status">
                <span>
                  Valid. {shown.task ? `${shown.task.variants.length} variants, ${shown.task.parameters.length} parameters.` : "A world."}
                  {route.task && route.task !== "draft" && ` A copy of ${route.task}, with worlds of its own.`}
                </span>
              </p>
            )}
          <Recipes of={{ "Check it": commands.validate(draft.file), "Play it": commands.play(subject), "Draw this world": commands.sample(subject) }} />
        </div>
        <div class="stack">
          {error && <ErrorNote error={error} again={() => setRound((last) => last + 1)} />}
          <section class="card pad stack" aria-label="World">
            <div class="row end">
              <VariantPicker variants={shown?.task?.variants.map(({ name }) => name) ?? []} variant={request.variant} pick={setVariant} />
              <NumberPicker label="Seed" value={seed} pick={setSeed} />
              <NumberPicker label="World" value={index} pick={setIndex} />
            </div>
            <div class="views" aria-busy={problems.length > 0}>
              <Picture frame={shown?.frame ?? null} label="What the agent sees at first" />
              <FlatMap map={shown?.map ?? null} click={clickMap} />
            </div>
            {problems.length > 0 && <p class="faint small">The last valid text is shown.</p>}
            {groups.length > 0 && (
              <Choice
                label="A click on the map" value={target} pick={setTarget}
                entries={[["", "finds the object's text"], ...groups.map(({ name }) => [name, `adds a point to ${name}, or removes it`] as const)]}
              />
            )}
          </section>
          {layout && (
            <section class="card pad stack" aria-label="Map of letters">
              <div class="row spread">
                <h2>Map of letters</h2>
                {layouts.length > 1 && (
                  <select aria-label="Which map" value={String(layoutIndex)} onChange={(event) => setLayoutIndex(Number(event.currentTarget.value))}>
                    {layouts.map(({ label }, number) => <option key={label} value={String(number)}>{label}</option>)}
                  </select>
                )}
              </div>
              <Cells layout={layout} put={(row, column, letter) => edit([...layout.path, row], withLetter(layout.rows[row] ?? "", column, letter))} />
            </section>
          )}
          <section class="card pad stack" aria-label="Parameters">
            <h2>{current ? `Parameters of ${current.name}` : "Parameters"}</h2>
            <Knobs parameters={shown?.parameters ?? []} variant={current} set={setKnob} />
            <p class="small faint" role="status">{status}</p>
          </section>
        </div>
      </div>
    </>
  );
}

/** The path of an object's group in a task, taken to be the first group with its class and tag. */
function pathOfObject({ document, map }: Preview, object: number): Path {
  const found = map.objects.find(({ index }) => index === object);
  const groups = (document as { groups?: { object?: { class?: Json; tag?: Json } }[] }).groups ?? [];
  const place = groups.findIndex((group) => group.object?.class === found?.class && (!found?.tag || !group.object?.tag || group.object.tag === found.tag));
  return place < 0 ? ["groups"] : ["groups", place];
}

function showProblem(editor: Editor | null, text: string, problem: Problem): void {
  const span = spanAt(spans(text), pathOf(problem.pointer));
  if (span) return editor?.show(span.from, span.to);
  const lines = text.split("\n").slice(0, Math.max(0, problem.line - 1));
  const from = lines.reduce((sum, line) => sum + line.length + 1, 0) + Math.max(0, problem.column - 1);
  return editor?.show(from, from);
}

/** The smallest single change from one text to another. */
function minimal(before: string, after: string): Change {
  let from = 0;
  while (from < before.length && before[from] === after[from]) from += 1;
  let end = 0;
  while (end < Math.min(before.length, after.length) - from && before.at(-1 - end) === after.at(-1 - end)) end += 1;
  return { from, to: before.length - end, insert: after.slice(from, after.length - end) };
}
