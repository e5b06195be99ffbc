// The order view: shows the variants of a task as a contact sheet and on a map of their distances, with the chosen order as a path.

import { useEffect, useState } from "preact/hooks";
import type { Frame, Matrix, OrderMethod } from "../engine.ts";
import * as commands from "../commands.ts";
import { draft } from "../draft.ts";
import { placeLabels } from "../labels.ts";
import { hrefOf, type Route, wholeNumber } from "../route.ts";
import { engine, requestOf, useAnswer } from "../simulator.ts";
import { Choice, NumberPicker, TaskPicker, VariantPicker } from "../parts/choices.tsx";
import { ErrorNote, Recipes } from "../parts/notes.tsx";
import { Picture, useMedia } from "../parts/pictures.tsx";

const METHODS: Partial<Record<OrderMethod, string>> = {
  gradual: "Small steps: the shortest path through all variants.",
  outward: "From the start to variants farther and farther away.",
  abrupt: "Large steps: the longest path, on which neighbours differ as much as possible.",
  farthest: "Always next: the variant farthest from all earlier ones.",
  nearest: "Always next: the nearest remaining variant.",
  "two-opt": "A short path found quickly: the one of nearest, with its detours removed.",
  random: "A random order, as a baseline for the others.",
  given: "In the task's own order, but with the start first.",
};
/** Maximum number of variants shown at first: more would take longer, and their names would overlap. */
const MAX_SHOWN = 12;
const SIZE = { width: 240, height: 180 };

const variantOf = (label: string): string => label.slice(label.indexOf("#") + 1);

/** A picture of one world of each variant; pictures are added as they are drawn. */
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

/** Variants as points, numbered along the path. Distances between points approximate those between variants. */
function DistanceMap({ matrix, path, selected, pick }: { matrix: Matrix; path: string[]; selected: string; pick: (variant: string) => void }) {
  const width = useMedia("(max-width: 40rem)") ? 340 : 560;
  const [xs, ys] = [matrix.points.map(([x]) => x), matrix.points.map(([, y]) => y)];
  const [left, top] = [Math.min(...xs), Math.max(...ys)];
  const [spanX, spanY] = [Math.max(...xs) - left, top - Math.min(...ys)];
  const scale = Math.min((width - 120) / (spanX || 1), 340 / (spanY || 1));
  const height = Math.max(160, spanY * scale + 80);
  const inset = (width - spanX * scale) / 2;
  const names = matrix.labels.map(variantOf);
  const stops = path.flatMap((variant, rank) => {
    const index = names.indexOf(variant);
    const texts = [`${rank + 1} ${variant}`, `${rank + 1}`];
    return index < 0 ? [] : [{ variant, texts, x: inset + (xs[index]! - left) * scale, y: 40 + (top - ys[index]!) * scale }];
  });
  // The selected variant chooses its label first, so it always has one.
  const first = stops.findIndex(({ variant }) => variant === selected);
  const sorted = [...stops.slice(first, first + 1), ...stops.filter((_, index) => index !== first)];
  const labels = placeLabels(sorted, width, height);
  return (
    <svg class="plot points" viewBox={`0 0 ${width} ${height}`} role="img" aria-label={`Map of the distances of ${names.length} variants`}>
      <polyline class="way" points={stops.map(({ x, y }) => `${x},${y}`).join(" ")} />
      {sorted.map(({ variant, texts, x, y }, index) => (
        <g key={variant} onClick={() => pick(variant)}>
          <title>{texts[0]}</title>
          <circle class={`dot ${variant === selected ? "now" : ""}`} cx={x} cy={y} r={variant === selected ? 7 : 5} />
          {labels[index] && <text x={labels[index].x} y={labels[index].y} text-anchor="middle">{labels[index].text}</text>}
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
  const variants = isAll ? all : [...new Set([start, ...all])].filter(Boolean).slice(0, MAX_SHOWN);
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
  const path = order.value?.labels.map(variantOf) ?? variants;
  const [position, setPosition] = useState(0);
  const selected = path[Math.min(position, path.length - 1)] ?? "";
  useEffect(() => setPosition(0), [task, method, start]);
  const error = about.error ?? matrix.error ?? order.error;
  const description = about.value?.variants.find(({ name }) => name === selected)?.description ?? "";
  return (
    <>
      <div class="head">
        <div>
          <h1>Order</h1>
          <p>Shows which variants are alike, on a flat map of their distances, and an order in which to visit them.</p>
        </div>
        <div class="row end">
          <TaskPicker task={task} pick={(to) => go({}, to)} />
          <Choice label="Distance by" value={by} entries={measures} pick={(to) => go({ by: to })} />
          <Choice label="Method" value={method} entries={Object.keys(METHODS)} pick={(to) => go({ method: to })} />
          <VariantPicker isNamed label="Start" variants={all} variant={start} pick={(to) => go({ start: to })} />
          <NumberPicker label="Seed" value={seed} pick={(to) => go({ seed: to })} />
        </div>
      </div>
      {error && <ErrorNote error={error} again={() => setRound((last) => last + 1)} />}
      <div class="stage wide">
        <section class="card pad stack" aria-label="Map of distances">
          <h2>Map of distances</h2>
          {matrix.value && (
            <p class="faint small">
              Near points are alike. A flat map cannot keep every distance: this one keeps {Math.round(100 * matrix.value.shown)} % of them.
            </p>
          )}
          {matrix.pending && <p class="faint">Measuring …</p>}
          {matrix.value && <DistanceMap matrix={matrix.value} path={path} selected={selected} pick={(variant) => setPosition(Math.max(0, path.indexOf(variant)))} />}
          {all.length === 1 && <p class="faint">There is only one variant; an order needs at least two.</p>}
        </section>
        <section class="card pad stack" aria-label="The path">
          <div class="row spread">
            <h2>{selected || "–"}</h2>
            <span class="faint small number">{position + 1} of {path.length}</span>
          </div>
          <div class="still"><Picture frame={frames.get(selected) ?? null} label={`A world of ${selected}`} /></div>
          <p class="small faint">{description}</p>
          <input
            type="range" aria-label="Along the order" aria-valuetext={selected} min={0} max={Math.max(0, path.length - 1)} value={position}
            onInput={(event) => setPosition(event.currentTarget.valueAsNumber)}
          />
          <p class="small">
            {order.value ? `${METHODS[method as OrderMethod]} The path's length is ${order.value.length.toFixed(3)}.` : "Not ordered yet: shown as the task lists them."}
          </p>
          <ol class="picks" aria-label="Variants in order, each with its distance from the one before">
            {path.map((variant, rank) => (
              <li key={variant}>
                <button type="button" {...(variant === selected ? { "aria-current": "step" as const } : {})} onClick={() => setPosition(rank)}>
                  <span>{order.value && rank + 1} {variant}</span><span class="number faint">{order.value?.steps[rank - 1]?.toFixed(3)}</span>
                </button>
              </li>
            ))}
          </ol>
          <a class="button" href={hrefOf("play", task, { variant: selected, seed: seed || undefined })}>Play {selected}</a>
          <Recipes of={{ "This order": commands.order(task === "draft" ? draft.file : task, variants, by, method, start) }} />
        </section>
      </div>
      <section class="card pad stack" aria-label="Contact sheet">
        <div class="row spread">
          <h2>Contact sheet</h2>
          {all.length > MAX_SHOWN && (
            <button
              type="button" aria-pressed={isAll} title={`The first ${MAX_SHOWN} are shown, as more take longer`} onClick={() => go({ all: isAll ? 0 : 1 })}
            >
              {isAll ? `All ${all.length} variants` : `${MAX_SHOWN} of ${all.length} variants: show all`}
            </button>
          )}
        </div>
        <ul class="sheet">
          {path.map((variant, rank) => (
            <li key={variant}>
              <button type="button" aria-pressed={variant === selected} onClick={() => setPosition(rank)}>
                <Picture frame={frames.get(variant) ?? null} label="" /><span>{order.value && rank + 1} {variant}</span>
              </button>
            </li>
          ))}
        </ul>
        <Recipes of={{ "This sheet": commands.sheet(task === "draft" ? draft.file : task, variants, seed) }} />
      </section>
    </>
  );
}
