// The variants of a task as a contact sheet, as a map of their distances, and as an order that is walked along it.

import { useEffect, useState } from "preact/hooks";
import type { Frame, Matrix, Order as Found, OrderMethod } from "../engine.ts";
import * as commands from "../commands.ts";
import { draft } from "../draft.ts";
import { hrefOf, type Route, wholeNumber } from "../route.ts";
import { engine, requestOf, useAnswer } from "../simulator.ts";
import { Choice, NumberPicker, TaskPicker, VariantPicker } from "../parts/choices.tsx";
import { ErrorNote, Recipes } from "../parts/notes.tsx";
import { Picture } from "../parts/pictures.tsx";

const METHODS: OrderMethod[] = ["gradual", "outward", "abrupt", "farthest", "nearest", "two-opt", "random", "given"];
/** Variants that are shown at first: more take longer, and their names overlap. */
const MOST = 12;
const SIZE = { width: 240, height: 180 };

const short = (label: string): string => label.slice(label.indexOf("#") + 1);

/** The pictures of the first worlds of variants, as they are drawn. */
function useFrames(task: string, variants: string[], seed: number, index: number): Map<string, Frame> {
  const [frames, setFrames] = useState(new Map<string, Frame>());
  const key = variants.join(" ");
  useEffect(() => {
    let isOver = false;
    setFrames(new Map());
    const draw = async () => {
      for (const variant of variants) {
        const episode = await engine.open(requestOf(task, variant, seed, index), SIZE);
        const frame = await episode.frame("agent");
        void episode.close().catch(() => undefined);
        if (isOver) return;
        setFrames((last) => new Map(last).set(variant, frame));
      }
    };
    draw().catch(() => undefined);
    return () => {
      isOver = true;
    };
  }, [task, key, seed, index]);
  return frames;
}

/** Points with about the distances of the variants, and the way of an order among them. */
function DistanceMap({ matrix, order, now, pick }: { matrix: Matrix; order: Found | null; now: string; pick: (variant: string) => void }) {
  const [xs, ys] = [matrix.points.map(([x]) => x), matrix.points.map(([, y]) => y)];
  const [left, top] = [Math.min(...xs), Math.max(...ys)];
  const width = 560;
  const [across, along] = [Math.max(...xs) - left, top - Math.min(...ys)];
  const scale = Math.min((width - 140) / (across || 1), 340 / (along || 1));
  const height = Math.max(160, along * scale + 80);
  const inset = (width - across * scale) / 2;
  const place = new Map(matrix.labels.map((label, at) => [short(label), [inset + (xs[at]! - left) * scale, 40 + (top - ys[at]!) * scale] as const]));
  const way = order?.labels.map((label) => place.get(short(label))).filter((point) => point !== undefined) ?? [];
  return (
    <svg class="plot" viewBox={`0 0 ${width} ${height}`} role="img" aria-label={`Map of the distances of ${matrix.labels.length} variants`}>
      <polyline class="way" points={way.map((point) => point.join(",")).join(" ")} />
      {[...place].map(([variant, [x, y]], number) => (
        <g key={variant} onClick={() => pick(variant)}>
          <circle class={`dot ${variant === now ? "now" : ""}`} cx={x} cy={y} r={variant === now ? 7 : 5} />
          <text x={x} y={number % 2 ? y + 20 : y - 10} text-anchor="middle">{variant}</text>
        </g>
      ))}
    </svg>
  );
}

export function Order({ route }: { route: Route }) {
  const task = route.task || "find_objects";
  const source = task === "draft" ? draft.text : task;
  const about = useAnswer(() => engine.task(source), [task]);
  const all = about.value?.variants.map(({ name }) => name) ?? [];
  const { by = "parameters", method = "gradual", start: startText } = route.options;
  const start = startText ?? all[0] ?? "";
  const [seed, index] = [wholeNumber(route.options["seed"]), wholeNumber(route.options["index"])];
  const isAll = route.options["all"] === "1";
  const variants = isAll ? all : [...new Set([start, ...all])].filter(Boolean).slice(0, MOST);
  const go = (change: Record<string, string | number>, to = task) => {
    location.hash = hrefOf("order", to, to === task
      ? { by, method, start, seed: seed || undefined, index: index || undefined, all: isAll ? 1 : undefined, ...change }
      : change);
  };
  const [round, setRound] = useState(0);
  const key = `${task} ${variants.join(" ")} ${by} ${round}`;
  const matrix = useAnswer(variants.length > 1 ? () => engine.matrix(source, { variants, by }) : null, [key]);
  const order = useAnswer(
    variants.length > 1 ? () => engine.order(source, { variants, by, method: method as OrderMethod, start }) : null, [key, method, start],
  );
  const frames = useFrames(task, variants, seed, index);
  const measures = useAnswer(() => engine.measures(), []).value ?? ["parameters"];
  const way = order.value?.labels.map(short) ?? variants;
  const [at, setAt] = useState(0);
  const now = way[Math.min(at, way.length - 1)] ?? "";
  useEffect(() => setAt(0), [task, method, start]);
  const step = order.value?.steps[at];
  const error = about.error ?? matrix.error ?? order.error;
  const description = about.value?.variants.find(({ name }) => name === now)?.description ?? "";
  return (
    <>
      <div class="head">
        <div>
          <h1>Order</h1>
          <p>Variants on a flat map of their distances, and an order to walk along it: what is like what, and what comes next.</p>
        </div>
        <div class="row end">
          <TaskPicker task={task} pick={(to) => go({}, to)} />
          <Choice label="Distance by" value={by} entries={measures} pick={(to) => go({ by: to })} />
          <Choice label="Method" value={method} entries={METHODS} pick={(to) => go({ method: to })} />
          <VariantPicker isNamed label="Start" variants={all} variant={start} pick={(to) => go({ start: to })} />
          <NumberPicker label="Seed" value={seed} pick={(to) => go({ seed: to })} />
        </div>
      </div>
      {error && <ErrorNote error={error} again={() => setRound((last) => last + 1)} />}
      <div class="stage wide">
        <section class="card pad stack" aria-label="Map of distances">
          <div class="row spread">
            <h2>Map of distances</h2>
            {matrix.value && <span class="faint small">shows {Math.round(100 * matrix.value.shown)} % of them</span>}
          </div>
          {matrix.pending && <p class="faint">Measuring …</p>}
          {matrix.value && <DistanceMap matrix={matrix.value} order={order.value} now={now} pick={(variant) => setAt(Math.max(0, way.indexOf(variant)))} />}
          {all.length === 1 && <p class="faint">There is one variant only; an order needs two.</p>}
        </section>
        <section class="card pad stack" aria-label="The way">
          <div class="row spread">
            <h2>{now || "–"}</h2>
            <span class="faint small number">{at + 1} of {way.length}</span>
          </div>
          <div class="still"><Picture frame={frames.get(now) ?? null} label={`A world of ${now}`} /></div>
          <p class="small faint">{description}</p>
          <input
            type="range" aria-label="Along the order" aria-valuetext={now} min={0} max={Math.max(0, way.length - 1)} value={at}
            onInput={(event) => setAt(event.currentTarget.valueAsNumber)}
          />
          <dl class="facts">
            <div><dt>next step</dt><dd>{step === undefined ? "–" : step.toFixed(3)}</dd></div>
            <div><dt>whole way</dt><dd>{order.value?.length.toFixed(3) ?? "–"}</dd></div>
          </dl>
          <a class="button" href={hrefOf("play", task, { variant: now, seed: seed || undefined })}>Play {now}</a>
          <Recipes of={{ "This order": commands.order(task === "draft" ? draft.file : task, variants, by, method, start) }} />
        </section>
      </div>
      <section class="card pad stack" aria-label="Contact sheet">
        <div class="row spread">
          <h2>Contact sheet</h2>
          {all.length > MOST && (
            <button type="button" aria-pressed={isAll} onClick={() => go({ all: isAll ? 0 : 1 })}>All {all.length} variants</button>
          )}
        </div>
        <ul class="sheet">
          {way.map((variant, place) => (
            <li key={variant}>
              <button type="button" aria-pressed={variant === now} onClick={() => setAt(place)}>
                <Picture frame={frames.get(variant) ?? null} label="" /><span>{variant}</span>
              </button>
            </li>
          ))}
        </ul>
        <Recipes of={{ "This sheet": commands.sheet(task === "draft" ? draft.file : task, variants, seed) }} />
      </section>
    </>
  );
}
