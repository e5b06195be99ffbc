// The order view: the variants of a task as a contact sheet, as a map of their distances, and as an ordered path on it.

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
  gradual: "Small steps: the shortest way through all variants.",
  outward: "From the start to ever farther variants.",
  abrupt: "Large steps: the longest way, so that neighbours are unlike each other.",
  farthest: "Each time the variant farthest from all before it.",
  nearest: "Each time the nearest variant that is left.",
  "two-opt": "A short way that is found fast: that of nearest, with its detours mended.",
  random: "By chance, to compare the others with.",
  given: "As the task lists them, the start first.",
};
/** Maximum number of variants shown at first: more take longer, and their names overlap. */
const MAX_SHOWN = 12;
const SIZE = { width: 240, height: 180 };

const short = (label: string): string => label.slice(label.indexOf("#") + 1);

/** Pictures of a world of each variant, added as they are drawn. */
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

/** Variants as points that approximate their distances, numbered in the order of a path. */
function DistanceMap({ matrix, way, now, pick }: { matrix: Matrix; way: string[]; now: string; pick: (variant: string) => void }) {
  const width = useMedia("(max-width: 40rem)") ? 340 : 560;
  const [xs, ys] = [matrix.points.map(([x]) => x), matrix.points.map(([, y]) => y)];
  const [left, top] = [Math.min(...xs), Math.max(...ys)];
  const [across, along] = [Math.max(...xs) - left, top - Math.min(...ys)];
  const scale = Math.min((width - 120) / (across || 1), 340 / (along || 1));
  const height = Math.max(160, along * scale + 80);
  const inset = (width - across * scale) / 2;
  const names = matrix.labels.map(short);
  const stops = way.flatMap((variant, place) => {
    const at = names.indexOf(variant);
    const texts = [`${place + 1} ${variant}`, `${place + 1}`];
    return at < 0 ? [] : [{ variant, texts, x: inset + (xs[at]! - left) * scale, y: 40 + (top - ys[at]!) * scale }];
  });
  // The selected variant always has a label.
  const first = stops.findIndex(({ variant }) => variant === now);
  const ranked = [...stops.slice(first, first + 1), ...stops.filter((_, place) => place !== first)];
  const labels = placeLabels(ranked, width, height);
  return (
    <svg class="plot points" viewBox={`0 0 ${width} ${height}`} role="img" aria-label={`Map of the distances of ${names.length} variants`}>
      <polyline class="way" points={stops.map(({ x, y }) => `${x},${y}`).join(" ")} />
      {ranked.map(({ variant, texts, x, y }, place) => (
        <g key={variant} onClick={() => pick(variant)}>
          <title>{texts[0]}</title>
          <circle class={`dot ${variant === now ? "now" : ""}`} cx={x} cy={y} r={variant === now ? 7 : 5} />
          {labels[place] && <text x={labels[place].x} y={labels[place].y} text-anchor="middle">{labels[place].text}</text>}
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
  const way = order.value?.labels.map(short) ?? variants;
  const [at, setAt] = useState(0);
  const now = way[Math.min(at, way.length - 1)] ?? "";
  useEffect(() => setAt(0), [task, method, start]);
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
          {matrix.value && <DistanceMap matrix={matrix.value} way={way} now={now} pick={(variant) => setAt(Math.max(0, way.indexOf(variant)))} />}
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
          <p class="small">
            {order.value ? `${METHODS[method as OrderMethod]} The whole way is ${order.value.length.toFixed(3)}.` : "Not ordered yet: as the task lists them."}
          </p>
          <ol class="picks" aria-label="Variants in order, each with its distance from the one before">
            {way.map((variant, place) => (
              <li key={variant}>
                <button type="button" {...(variant === now ? { "aria-current": "step" as const } : {})} onClick={() => setAt(place)}>
                  <span>{order.value && place + 1} {variant}</span><span class="number faint">{order.value?.steps[place - 1]?.toFixed(3)}</span>
                </button>
              </li>
            ))}
          </ol>
          <a class="button" href={hrefOf("play", task, { variant: now, seed: seed || undefined })}>Play {now}</a>
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
          {way.map((variant, place) => (
            <li key={variant}>
              <button type="button" aria-pressed={variant === now} onClick={() => setAt(place)}>
                <Picture frame={frames.get(variant) ?? null} label="" /><span>{order.value && place + 1} {variant}</span>
              </button>
            </li>
          ))}
        </ul>
        <Recipes of={{ "This sheet": commands.sheet(task === "draft" ? draft.file : task, variants, seed) }} />
      </section>
    </>
  );
}
