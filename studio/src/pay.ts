// Describes the rewards of a world, and when its episodes end.

/** A reward, with at most two decimal places and a typographic minus sign. */
export const amount = (number: number): string => (Number.isInteger(number) ? String(number) : number.toFixed(2)).replace("-", "−");

/** The parts of a world that determine its rewards and the end of an episode. */
interface World {
  max_steps?: number;
  max_seconds?: number;
  rules?: { step_reward?: number; reward_per_second?: number };
  objects: { class: string; tag?: string; reward?: number; reward_probability?: number; reward_stimulus?: string[]; reward_once_stimulus?: string[] }[];
  environment_params?: { zones?: { name?: string; reward_on_entering?: number }[] };
}

/** The rewards of a world, and when its episodes end, on one line. */
export function describeRewards(json: string, stepSeconds: number): string {
  const { max_steps: steps, max_seconds: seconds, rules, objects, environment_params: environment } = JSON.parse(json) as World;
  const signed = (number: number) => `${number > 0 ? "+" : ""}${Number(number.toFixed(4))}`.replace("-", "−");
  const sources = [
    ...objects.filter((object) => object.reward_stimulus ?? object.reward_once_stimulus)
      .map((object) => ({ name: object.tag ?? object.class, reward: object.reward, odds: object.reward_probability ?? 1 })),
    ...(environment?.zones ?? []).map((zone) => ({ name: zone.name ?? "zone", reward: zone.reward_on_entering, odds: 1 })),
  ];
  const perStep = (rules?.step_reward ?? 0) + (rules?.reward_per_second ?? 0) * stepSeconds;
  return [
    ...new Set(sources.flatMap(({ name, reward, odds }) =>
      reward ? [`${name.replaceAll("_", " ")} ${signed(reward)}${odds < 1 ? `, ${Number((100 * odds).toFixed(1))} % of the time` : ""}`] : [])),
    ...(perStep ? [`every step ${signed(perStep)}`] : []),
    ...(seconds ? [`ends after ${seconds} s`] : []),
    ...(steps ? [`ends after ${steps} steps`] : []),
  ].join(" · ");
}
