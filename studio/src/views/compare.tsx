// The compare view: plays two variants of a task side by side, with the same seed and actions, and shows their distance in each element.

import type { ComponentChildren } from "preact";
import { useEffect, useMemo, useState } from "preact/hooks";
import type { Distance, Element, Elements as Found, EngineError, Task, Variant } from "../engine.ts";
import * as commands from "../commands.ts";
import { useClock } from "../clock.ts";
import { outlines } from "../difference.ts";
import { draft } from "../draft.ts";
import { hasInput, useHeldKeys } from "../keys.ts";
import { hrefOf, type Route, wholeNumber } from "../route.ts";
import { Session } from "../session.ts";
import { asError, engine, requestOf, useAnswer } from "../simulator.ts";
import { Choice, NumberPicker, TaskPicker, VariantPicker } from "../parts/choices.tsx";
import { ErrorNote, Recipes } from "../parts/notes.tsx";
import { Pad } from "../parts/pad.tsx";
import { FlatMap } from "../parts/pictures.tsx";
import { same } from "../json_text.ts";
import { writtenParameters, type WrittenParameter } from "../written.ts";
import { ELEMENTS, elementNames, ShownValue } from "../parts/value.tsx";
import { Seat } from "../parts/seat.tsx";

/** The verdicts of a test that compares what parameters declare to affect with what they change in worlds. */
const VERDICTS: Record<Found["verdict"], string> = {
  sound: "exactly what the parameters declare",
  idle: "a parameter changes nothing",
  contradicted: "more than the parameters declare",
};

/** A share as a bar with its number. */
export function Meter({ share }: { share: number }) {
  return (
    <svg class="meter" viewBox="0 0 100 8" preserveAspectRatio="none" aria-hidden="true">
      <rect width="100" height="8" rx="2" /><rect width={Math.min(1, Math.max(0, share)) * 100} height="8" rx="2" />
    </svg>
  );
}

/** The parts of a distance, largest first; a part that counts for several elements is listed once. */
function partsOf({ parts }: Distance) {
  const rows = new Map<string, { name: string; measure: string; elements: Element[]; share: number }>();
  for (const { name, measure, raw, element, share } of parts.filter((part) => part.share > 0)) {
    const key = `${name} ${measure} ${raw}`;
    const row = rows.get(key) ?? { name, measure, elements: [], share: 0 };
    rows.set(key, { ...row, elements: [...row.elements, element], share: row.share + share });
  }
  return [...rows.values()].sort((a, b) => b.share - a.share);
}

/** A table, row by row. */
function Table({ heads, rows }: { heads: string[]; rows: ComponentChildren[][] }) {
  return (
    <div class="table">
      <table>
        <thead><tr>{heads.map((word) => <th key={word} scope="col">{word}</th>)}</tr></thead>
        <tbody>{rows.map((cells, row) => <tr key={row}>{cells.map((cell, column) => <td key={column}>{cell}</td>)}</tr>)}</tbody>
      </table>
    </div>
  );
}

function Elements({ distance }: { distance: Distance }) {
  const all = Object.entries(distance.elements) as [Element, number | null][];
  const entries = all.flatMap(([element, value]) => (value === null ? [] : [{ element, value }]));
  const largest = Math.max(1e-9, ...entries.map(({ value }) => value));
  const parts = partsOf(distance);
  return (
    <div class="stage">
      <div class="stack">
        <h2>{distance.total.toFixed(3)} apart</h2>
        <p class="small">{distance.unit} {parts.length > 1 && "The total is the sum of the parts."}</p>
        <p class="faint small">{distance.description}</p>
        {entries.length > 0 && (
          <Table
            heads={["Element", "Distance", ""]}
            rows={entries.map(({ element, value }) => [ELEMENTS[element], value.toFixed(3), <Meter share={value / largest} />])}
          />
        )}
      </div>
      <div class="stack">
        <h2>Where it comes from</h2>
        {entries.length === 0 && (
          <p class="small">By {distance.by}, worlds are compared as a whole: the number has no parts. Other measures split theirs by element.</p>
        )}
        {entries.length > 0 && parts.length === 0 && <p class="faint small">By {distance.by}, nothing differs.</p>}
        {parts.length > 0 && (
          <Table
            heads={["Part", "Counts for", "Measure", "Share"]}
            rows={parts.map(({ name, measure, elements, share }) => [
              <code>{name}</code>, elementNames(elements), measure, `${(100 * share).toFixed(1)}\u00a0%`,
            ])}
          />
        )}
      </div>
    </div>
  );
}

/** The parameters in which two variants differ, with both values. */
function differing(task: Task, a: Variant | undefined, b: Variant | undefined) {
  const valueIn = (variant: Variant | undefined, parameter: WrittenParameter) => variant?.values[parameter.name] ?? parameter.value;
  return writtenParameters(task)
    .filter(({ role }) => role === "variant")
    .map((parameter) => ({ parameter, values: [valueIn(a, parameter), valueIn(b, parameter)] as const }))
    .filter(({ values: [left, right] }) => !same(left, right));
}

export function Compare({ route }: { route: Route }) {
  const task = route.task || "find_objects";
  const about = useAnswer(() => engine.task(task === "draft" ? draft.text : task), [task]);
  const variants = about.value?.variants ?? [];
  const names = variants.map(({ name }) => name);
  const { a = names[0] ?? "", b = names[1] ?? "", by = "parameters" } = route.options;
  const [seed, index] = [wholeNumber(route.options["seed"]), wholeNumber(route.options["index"])];
  const go = (change: Record<string, string | number>, to = task) => {
    location.hash = hrefOf("compare", to, to === task ? { a, b, by, seed: seed || undefined, index: index || undefined, ...change } : change);
  };
  const [pair, setPair] = useState<[Session, Session] | null>(null);
  const [error, setError] = useState<EngineError | null>(null);
  const [round, setRound] = useState(0);
  const [isOutlined, setOutlined] = useState(true);
  const [leader, setLeader] = useState<"keys" | "planner">("keys");
  const [steps, setSteps] = useState(0);
  const isReady = names.length > 0;

  useEffect(() => {
    if (!isReady) return undefined;
    let isOver = false;
    const opened: Session[] = [];
    const open = async () => {
      for (const name of [a, b]) opened.push(await Session.open(requestOf(task, name, seed, index), null));
      if (isOver) return;
      setPair([opened[0]!, opened[1]!]);
      setError(null);
      setLeader("keys");
    };
    open().catch((reason: unknown) => !isOver && (setPair(null), setError(asError(reason))));
    return () => {
      isOver = true;
      for (const session of opened) void session.episode.close().catch(() => undefined);
    };
  }, [task, a, b, seed, index, isReady, round]);

  const keys = useHeldKeys((code) => {
    if (code === "KeyR") setRound((last) => last + 1);
  });
  useClock(pair !== null && !pair.every((session) => session.ended), 1 / (pair?.[0].episode.actionSpace.step_seconds ?? 0.1), async () => {
    const [left, right] = pair!;
    const input = keys.read();
    if (leader === "keys" && !hasInput(input)) return;
    if (leader === "keys") {
      await left.advance(input);
      await right.advance(input);
    } else {
      // The planner acts in the first world; the second gets the same actions.
      const action = left.ended ? null : await left.episode.choose("planner");
      if (action === null) return setLeader("keys");
      await left.take(action);
      await right.take(action);
    }
    setSteps((last) => last + 1);
  }, (reason) => {
    setPair(null);
    setError(asError(reason));
  });
  const lines = useMemo(
    () => (isOutlined && pair?.[0].frame && pair[1].frame ? outlines(pair[0].frame, pair[1].frame) : []),
    [isOutlined, pair, steps],
  );

  const measures = useAnswer(() => engine.measures(), []).value ?? ["parameters"];
  const distance = useAnswer(
    isReady && a && b ? () => engine.distance(requestOf(task, a, seed, index), requestOf(task, b, seed, index), { by }) : null,
    [task, a, b, by, isReady, round],
  );
  const [testedKey, setTestedKey] = useState("");
  const key = `${task} ${a} ${b} ${round}`;
  const elements = useAnswer(
    testedKey === key ? () => engine.elements(task === "draft" ? draft.text : task, a, b, { worlds: commands.ELEMENT_WORLDS }) : null, [testedKey, key],
  );
  const file = task === "draft" ? draft.file : task;
  const rows = about.value ? differing(about.value, variants.find(({ name }) => name === a), variants.find(({ name }) => name === b)) : [];
  return (
    <>
      <div class="head">
        <div>
          <h1>Compare</h1>
          <p>Two variants with the same seed. Your actions are taken in both; whatever looks different is outlined.</p>
        </div>
        <div class="row end">
          <TaskPicker task={task} pick={(to) => go({}, to)} />
          <VariantPicker isNamed label="Left" variants={names} variant={a} pick={(to) => go({ a: to })} />
          <VariantPicker isNamed label="Right" variants={names} variant={b} pick={(to) => go({ b: to })} />
          <NumberPicker label="Seed" value={seed} pick={(to) => go({ seed: to })} />
          <NumberPicker label="World" value={index} pick={(to) => go({ index: to })} />
        </div>
      </div>
      {(about.error ?? error) && <ErrorNote error={(about.error ?? error)!} again={() => setRound((last) => last + 1)} />}
      <div class="row">
        <button type="button" aria-pressed={isOutlined} onClick={() => setOutlined(!isOutlined)}>Outline differences</button>
        <button type="button" aria-pressed={leader === "planner"} onClick={() => setLeader(leader === "planner" ? "keys" : "planner")}>
          Let the planner lead
        </button>
        <button type="button" onClick={() => setRound((last) => last + 1)}>Again</button>
        <span class="faint small">Arrow keys act in both.</span>
      </div>
      {pair && (
        <div class="pair">
          {pair.map((session, side) => (
            <div key={side} class="side">
              <Seat name={(side ? b : a) || "defaults"} session={session} isYours={side === 0} lines={lines} />
              <FlatMap map={session.map} />
            </div>
          ))}
        </div>
      )}
      {pair && <Pad set={keys.set} />}
      {rows.length > 0 && (
        <section class="card pad stack" aria-label="Parameters that differ">
          <h2>Parameters that differ</h2>
          <Table
            heads={["Parameter", a, b, "Affects"]}
            rows={rows.map(({ parameter, values }) => [
              <code>{parameter.name}</code>, ...values.map((value) => <ShownValue parameter={parameter} value={value} />), elementNames(parameter.affects),
            ])}
          />
        </section>
      )}
      <section class="card pad stack" aria-label="Distance">
        <div class="row spread">
          <Choice label="Measured by" value={by} entries={measures} pick={(to) => go({ by: to })} />
          <button type="button" disabled={!isReady || elements.pending} onClick={() => setTestedKey(key)}>Test what differs in their worlds</button>
        </div>
        {distance.error && (
          <ErrorNote error={distance.error} again={() => setRound((last) => last + 1)}>
            <span>Other measures can compare them:</span>
            {["parameters", "worlds"].filter((other) => other !== by).map((other) => (
              <button key={other} type="button" onClick={() => go({ by: other })}>Compare by {other}</button>
            ))}
          </ErrorNote>
        )}
        {distance.pending && <p class="faint">Measuring …</p>}
        {distance.value && <Elements distance={distance.value} />}
        {elements.error && <ErrorNote error={elements.error} />}
        {elements.value && (
          <div class="stack">
            <h3>
              Differences in their worlds:{" "}
              <span class={`tag ${elements.value.verdict === "sound" ? "good" : "bad"}`}>{VERDICTS[elements.value.verdict]}</span>
            </h3>
            <p class="faint small">For each element, the first difference found: the left value versus the right one.</p>
            <ul class="plain">{elements.value.measured.map((witness) => <li key={witness.element}><b>{ELEMENTS[witness.element]}:</b> {witness.message}</li>)}</ul>
            {elements.value.measured.length === 0 && <p class="faint small">No element differs in the worlds tested.</p>}
            {elements.value.contradictions.map((text) => <p key={text} class="note bad"><span>{text}</span></p>)}
            {elements.value.idle.length > 0 && <p class="faint small">Without effect here: {elements.value.idle.join(", ")}.</p>}
          </div>
        )}
        <Recipes of={{ "This distance": commands.distance(file, a, b, by), "What differs in their worlds": commands.elements(file, a, b) }} />
      </section>
    </>
  );
}
