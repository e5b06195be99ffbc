// An episode with its player (keys or an agent), its latest image and its latest map.

import type { Action, Agent, Episode, Frame, Keys, Step, WorldMap, WorldRequest } from "./engine.ts";
import { engine } from "./simulator.ts";

/** Size of the agent's view in the play view, in pixels. */
export const VIEW = { width: 320, height: 240 };

export class Session {
  frame: Frame | null = null;
  map: WorldMap | null = null;
  step: Step;
  /** The actions taken so far. */
  readonly actions: Action[] = [];
  /** The events so far, latest first. */
  readonly log: { step: number; text: string; reward: number }[] = [];

  private constructor(readonly episode: Episode, readonly agent: Agent | null, step: Step) {
    this.step = step;
  }

  /** Starts an episode; with `agent` null, keys control it. */
  static async open(request: WorldRequest, agent: Agent | null, size = VIEW): Promise<Session> {
    const episode = await engine.open(request, size);
    const session = new Session(episode, agent, await episode.now());
    await session.draw();
    return session;
  }

  get ended(): boolean {
    return this.step.terminated || this.step.truncated;
  }

  /** Whether time can pass without input: the world has an action that does nothing. Otherwise the episode waits for keys. */
  get canWait(): boolean {
    const { table } = this.episode.actionSpace;
    return !table || table.some((row) => row.every((number) => number === 0));
  }

  async advance(keys: Keys): Promise<void> {
    if (this.ended) return;
    this.note(this.agent ? await this.episode.act(this.agent) : await this.episode.step(keys));
    await this.draw();
  }

  /** Takes an action that was chosen elsewhere. */
  async take(action: Action): Promise<void> {
    if (this.ended) return;
    this.note(await this.episode.step(action));
    await this.draw();
  }

  async draw(): Promise<void> {
    [this.frame, this.map] = await Promise.all([this.episode.frame("agent"), this.episode.map()]);
  }

  private note(step: Step): void {
    this.step = step;
    if (step.action !== null) this.actions.push(step.action);
    for (const event of step.events) {
      const name = event.tag ?? this.map?.objects[event.object]?.class ?? `object ${event.object}`;
      this.log.unshift({ step: step.step, text: `${name} ${(event.effect ?? EFFECTS[event.stimulus] ?? "touched").replace("_", " ")}`, reward: event.reward });
    }
    this.log.length = Math.min(this.log.length, 50);
  }
}

const EFFECTS: Record<string, string> = { AgentCollide: "touched", AgentInteract: "used", AgentInRange: "came near" };

/** How an episode ended, in words. */
export function ending(step: Step): string {
  if (!step.terminated && !step.truncated) return "";
  if (step.success) return "Solved";
  return step.truncated || step.ended_by === "time" || step.ended_by === "steps" ? "Time is up" : "Failed";
}
