// Plots the learning curves of a log; a click opens the nearest recorded episode.

import { useMemo } from "preact/hooks";
import type { Log } from "../engine.ts";
import { curves } from "../curve.ts";
import { amount } from "../pay.ts";

export function Curves({ log, now, pick }: { log: Log; now: number | null; pick: (experience: number) => void }) {
  const all = useMemo(() => curves(log.episodes), [log]);
  const points = all.flatMap(({ learned, tested }) => [...learned, ...tested]);
  const [width, height, pad] = [640, 240, 36];
  const maxExperience = Math.max(1, ...log.episodes.map(({ experience }) => experience));
  const [low, high] = [Math.min(0, ...points.map(([, y]) => y)), Math.max(1e-9, ...points.map(([, y]) => y))];
  const toPixels = ([x, y]: [number, number]): [number, number] =>
    [pad + ((width - pad - 8) * x) / maxExperience, height - 24 - ((height - 36) * (y - low)) / (high - low)];
  return (
    <>
      <svg
        class="plot" viewBox={`0 0 ${width} ${height}`} role="img" aria-label={`Learning curves of ${all.length} tasks`}
        onClick={(event) => {
          const box = event.currentTarget.getBoundingClientRect();
          const wanted = ((((event.clientX - box.left) * width) / box.width - pad) * maxExperience) / (width - pad - 8);
          const distance = ({ experience }: { experience: number }) => Math.abs(experience - wanted);
          const nearest = log.episodes.filter(({ recorded }) => recorded).sort((a, b) => distance(a) - distance(b))[0];
          if (nearest) pick(nearest.experience);
        }}
      >
        <line class="axis" x1={pad} x2={width - 8} y1={toPixels([0, 0])[1]} y2={toPixels([0, 0])[1]} />
        <text class="label" x={pad - 4} y={toPixels([0, high])[1] + 4} text-anchor="end">{amount(Number(high.toPrecision(3)))}</text>
        <text class="label" x={pad - 4} y={toPixels([0, low])[1] + 4} text-anchor="end">{amount(Number(low.toPrecision(3)))}</text>
        <text class="label" x={width - 8} y={height - 6} text-anchor="end">experience {maxExperience}</text>
        {all.map((curve, number) => (
          <g key={curve.task} class={`series s${number % 6}`}>
            <polyline points={curve.learned.map((point) => toPixels(point).join(",")).join(" ")} />
            {curve.tested.map((point) => <circle key={point[0]} cx={toPixels(point)[0]} cy={toPixels(point)[1]} r="2" />)}
          </g>
        ))}
        {now !== null && <line class="here" x1={toPixels([now, 0])[0]} x2={toPixels([now, 0])[0]} y1="8" y2={height - 24} />}
      </svg>
      <ul class="legend">
        {all.map((curve, number) => (
          <li key={curve.task} class={`s${number % 6}`}><span class="swatch" aria-hidden="true" />{curve.task}</li>
        ))}
      </ul>
      <p class="faint small">Lines: learning, as trailing means over a twentieth of the episodes. Dots: evaluations.</p>
    </>
  );
}
