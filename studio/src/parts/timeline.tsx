// The timeline of a replayed episode: the reward at each moment, the loop, and a slider.

import { useMemo } from "preact/hooks";
import type { Step } from "../engine.ts";
import { type Loop, marks } from "../timeline.ts";

export function Timeline({ steps, moment, loop, seek }: { steps: Step[]; moment: number; loop: Loop | null; seek: (moment: number) => void }) {
  const last = steps.length - 1;
  const moments = useMemo(() => marks(steps.slice(1)), [steps]);
  const maxReward = Math.max(1e-9, ...moments.map(({ reward }) => Math.abs(reward)));
  const x = (step: number) => (last ? (1000 * step) / last : 0);
  return (
    <div class="timeline">
      <svg viewBox="0 0 1000 56" preserveAspectRatio="none" aria-hidden="true">
        <rect class="track" y="24" width="1000" height="8" />
        {loop && <rect class="loop" x={x(loop.from)} width={Math.max(2, x(loop.to) - x(loop.from))} height="56" />}
        {moments.map((mark) => {
          const height = 4 + (22 * Math.abs(mark.reward)) / maxReward;
          const [kind, y] = mark.reward < 0 ? ["loss", 28] : ["gain", 28 - height];
          return <rect key={mark.step} class={kind} x={x(mark.step) - 2} width="4" y={y} height={height} />;
        })}
        <line class="here" x1={x(moment)} x2={x(moment)} y1="0" y2="56" vector-effect="non-scaling-stroke" />
      </svg>
      <input
        type="range" min={0} max={last} value={moment} aria-label="Moment of the episode" aria-valuetext={`step ${moment} of ${last}`}
        onInput={(event) => seek(event.currentTarget.valueAsNumber)}
      />
    </div>
  );
}
