// The learning curves of a log: smoothed rewards of learning episodes, and rewards of evaluations.

import type { LoggedEpisode } from "./engine.ts";

/** The curve of one task. */
export interface Curve {
  task: string;
  /** Learning episodes: the number of the experience, and the trailing mean of the rewards. */
  learned: [number, number][];
  /** Evaluation episodes: the number of the experience, and its reward. */
  tested: [number, number][];
}

/** For each number, the mean of the last `window` numbers up to it. */
export function trailingMeans(numbers: number[], window: number): number[] {
  let sum = 0;
  return numbers.map((number, at) => {
    sum += number - (numbers[at - window] ?? 0);
    return sum / Math.min(at + 1, window);
  });
}

/** A curve for each task, in order of first appearance. */
export function curves(episodes: LoggedEpisode[]): Curve[] {
  const tasks = [...new Set(episodes.map(({ task }) => task))];
  return tasks.map((task) => {
    const own = episodes.filter((episode) => episode.task === task && Number.isFinite(episode.reward));
    const train = own.filter(({ block_type: type }) => type === "train");
    const means = trailingMeans(train.map(({ reward }) => reward), Math.max(1, Math.ceil(train.length / 20)));
    return {
      task,
      learned: train.map(({ experience }, at) => [experience, means[at]!]),
      tested: own.filter(({ block_type: type }) => type === "test").map(({ experience, reward }) => [experience, reward]),
    };
  });
}
