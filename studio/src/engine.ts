// The typed client of the simulator: every call runs in one worker, with a time limit and a way to stop it.
//
// The worker holds the simulator compiled to WebAssembly. A call that takes too long, or that is stopped, ends the worker; the next
// call starts a new one. Episodes that were open in the old worker are lost: calls on them fail with the code `engine/lost`.

import type { WorkerReply, WorkerRequest } from "./worker.ts";

/** Any JSON value. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** The elements of a decision process: state, action, transition, reward, observation; `p` (initial state) and `phi` (observation) are finer. */
export type Element = "S" | "A" | "T" | "R" | "O" | "p" | "phi";

/** A problem of a document, with its position. Lines and columns count from 1; 0 if the position is unknown. */
export interface Problem {
  code: string;
  pointer: string;
  line: number;
  column: number;
  found: string;
  expected: string;
  advice: string | null;
  /** The whole problem in one sentence. */
  message: string;
}

/** The error of a failed call. */
export class EngineError extends Error {
  /**
   * A stable name. From here: `engine/timeout`, `engine/stopped`, `engine/lost`, `engine/crashed`, `engine/load`. From links:
   * `link/damaged`, `link/version`, `link/too-long`. From the simulator: `spec/…`, `env/…`, `generator/…`, `request/…`.
   */
  readonly code: string;
  /** The problems of an invalid document, in the order of the text. */
  readonly problems: Problem[];

  constructor(code: string, message: string, problems: Problem[] = []) {
    super(message);
    this.name = "EngineError";
    this.code = code;
    this.problems = problems;
  }
}

/** A value of a parameter, as in documents: a colour may be a name or a list of three numbers. */
export type Value = Json;

/** A declared parameter: what a slider or a picker needs. */
export interface Parameter {
  name: string;
  role: "fixed" | "variant" | "randomized";
  /** `number`, `integer`, `boolean`, `string`, `color`, `heading`, `position`, `vector`, `layout`, `distribution`, `json`, …. */
  type: string;
  affects: Element[];
  unit: string | null;
  description: string | null;
  /** Variant only: the minimum and the maximum. */
  range: [number, number] | null;
  /** Variant only: the allowed values, with the names that the task gives them. An override uses the name, if there is one. */
  choices: { value: Value; name: string | null }[] | null;
  /** The value if no variant sets one: the default of a variant parameter, the value of a fixed one. */
  value: Value | null;
  /** Randomized only: the distribution, as in the task. */
  distribution: Json | null;
  /** The condition under which the parameter is read. */
  read_if: string | null;
}

/** A variant and its values. */
export interface Variant {
  name: string;
  description: string | null;
  /** The values of all variant parameters in it. */
  values: Record<string, Value>;
}

/** A task in the gallery. */
export interface TaskCard {
  name: string;
  /** The kind of task, such as `navigation`. */
  group: string;
  description: string;
  variants: string[];
  /** The first variants with a description, which a card shows. */
  examples: { variant: string; description: string }[];
}

/** A task with its parameters and variants. */
export interface Task {
  name: string;
  description: string;
  /** The text of its document. */
  text: string;
  parameters: Parameter[];
  variants: Variant[];
  families: { name: string; members: string[] }[];
  /** Conditions that every variant must meet. */
  requirements: string[];
}

/** A world: sampled from a task, or given as JSON. */
export type WorldRequest =
  | {
      /** The name of a built-in task, or the text of a task spec (which begins with `{`). */
      task: string;
      /** The variant; all parameters at their defaults if absent. */
      variant?: string;
      /** Values of variant parameters that replace those of the variant. */
      values?: Record<string, Value>;
      /** 0 if absent. */
      seed?: number;
      /** Index of the world for the seed; 0 if absent. */
      index?: number;
    }
  | {
      /** The JSON of a world. */
      world: string;
    };

/** The kind of a text, and its problems. */
export interface Validation {
  kind: "task" | "world" | "scenario" | "maps" | "l2explorer-world" | "l2explorer-scenario";
  problems: Problem[];
  /** Whether the list of problems is cut short. */
  more: boolean;
  /** Warnings about odd but valid parts, as sentences. */
  warnings: string[];
}

/** `plain` colours or `natural` surfaces; the world's own if absent. */
export type Looks = "plain" | "natural";

/** What an image shows. */
export type Modality = "rgb" | "depth" | "segmentation" | "class" | "instance";

/** The agent's view, or the whole world from above. */
export type View = "agent" | "above";

/** An image: `data` is RGBA, row 0 at the top, as for `ImageData`. */
export interface Frame {
  width: number;
  height: number;
  data: Uint8ClampedArray<ArrayBuffer>;
}

/** The action space of a world. */
export interface ActionSpace {
  /** `discrete`: a row of a table. `continuous`: three numbers in physical units. `normalized`: three numbers in -1..1. */
  kind: "discrete" | "continuous" | "normalized";
  /** The meaning of the three numbers. `none` and `onrails` ignore actions. */
  model: "byvelocity" | "bywaypoint" | "onrails" | "none";
  /** Discrete: a name for each row, such as `ahead left`. Otherwise a name for each number. */
  names: string[];
  /** Discrete: the rows themselves. */
  table: [number, number, number][] | null;
  can_interact: boolean;
  max_speed: number;
  max_turn_rate: number;
  /** Simulated seconds per step. */
  step_seconds: number;
}

/** A row of the table, or three numbers. */
export type Action = number | [number, number, number];

/** Input from keys, in -1..1: the world's nearest action is taken. Positive `turn` is to the right. */
export interface Keys {
  ahead: number;
  turn: number;
  interact: boolean;
}

/** Something that happened to an object in a step. */
export interface StepEvent {
  object: number;
  tag: string | null;
  stimulus: string;
  reward: number;
  destroyed: boolean;
  effect?: "opened" | "closed" | "switched" | "picked_up" | "put_down";
}

/** The state of an episode, after a step or at its start. */
export interface Step {
  /** Number of steps taken. */
  step: number;
  /** Reward of the last step. */
  reward: number;
  terminated: boolean;
  truncated: boolean;
  success: boolean;
  /** `all_collected`, `touch`, `opened`, `carried`, `delivered`, `return`, `energy`, `zone`, `steps`, `time`. */
  ended_by: string | null;
  events: StepEvent[];
  /** The action that was taken; null before the first step. */
  action: Action | null;
  /** Sum of rewards so far. */
  total: number;
  /** Simulated seconds so far. */
  seconds: number;
  /** Remaining energy, in worlds that have it. */
  energy: number | null;
  agent: { x: number; y: number; heading: number };
}

/** A wall on the map: a closed or an open line, in metres. */
export interface MapWall {
  points: [number, number][];
  closed: boolean;
  /** sRGB in 0..1. */
  color: [number, number, number];
}

/** An object on the map. */
export interface MapObject {
  /** Its index in the world, as in events and problems (`/objects/N`). */
  index: number;
  class: string;
  tag: string | null;
  x: number;
  y: number;
  /** Degrees clockwise from north. */
  heading: number;
  /** Radius of its body in metres. */
  radius: number;
  /** sRGB in 0..1. */
  color: [number, number, number];
  /** Reward that it pays now. */
  reward: number;
  /** False once it is gone, and while it is carried. */
  present: boolean;
  carried: boolean;
  /** Whether it is an open door. */
  open: boolean;
}

/** A zone on the map. */
export interface MapZone {
  name: string | null;
  points: [number, number][];
  color: [number, number, number];
  visible: boolean;
}

/** Everything that a flat map shows, in metres: x to the east, y to the north, (0, 0) in the middle. */
export interface WorldMap {
  width: number;
  depth: number;
  walls: MapWall[];
  objects: MapObject[];
  zones: MapZone[];
  agent: { x: number; y: number; heading: number; radius: number };
}

/** An agent: a built-in one, or a network in safetensors format, as exported by `driftworld.learners`. */
export type Agent = "planner" | "random" | "still" | { network: Uint8Array };

/** A measure, such as `parameters`, `worlds`, `pictures`, `objects`, `rewards`, `dynamics` or `behavior`. */
export type Measure = string;

/** One part of a distance. */
export interface DistancePart {
  name: string;
  element: Element;
  /** The measure, and the scale that its number is divided by. */
  measure: string;
  raw: number;
  normalised: number;
  weight: number;
  /** Share of the whole, in 0..1. */
  share: number;
}

/** The distance between two variants or worlds. */
export interface Distance {
  by: Measure;
  /** The meaning of 1, in a sentence. */
  unit: string;
  /** The measure, the number of worlds, and other notes on the number, in words. */
  description: string;
  total: number;
  /** Null if nothing could differ. */
  elements: Record<"S" | "A" | "T" | "R" | "O", number | null>;
  parts: DistancePart[];
}

/** The first case found in which an element of two variants differs. */
export interface Witness {
  element: Element;
  /** The case in a sentence. */
  message: string;
}

/** The elements in which two variants of a task differ: as declared by their parameters, and as measured in their worlds. */
export interface Elements {
  /** The parameters that differ. */
  parameters: string[];
  declared: Element[];
  measured: Witness[];
  /** Sentences about measured differences that are not declared. */
  contradictions: string[];
  /** Parameters that differ without a measured effect. */
  idle: string[];
  verdict: "sound" | "idle" | "contradicted";
}

/** All distances among variants, and a flat map of them. */
export interface Matrix {
  by: Measure;
  labels: string[];
  rows: number[][];
  /** A point for each label: distances between points approximate those of the matrix. */
  points: [number, number][];
  /** Share of the distances that the flat map shows, in 0..1. */
  shown: number;
}

/** An ordering method. */
export type OrderMethod =
  | "nearest" | "exact" | "two-opt" | "abrupt" | "farthest" | "random" | "target-step" | "gradual" | "outward" | "given";

/** Variants in an order. */
export interface Order {
  method: OrderMethod;
  by: Measure;
  labels: string[];
  /** The distance from each to the next. */
  steps: number[];
  length: number;
}

/** A file that was dropped onto the page: its path in the folder, and its bytes. */
export interface DroppedFile {
  path: string;
  bytes: Uint8Array;
}

/** An episode of a log. */
export interface LoggedEpisode {
  experience: number;
  block: number;
  block_type: "train" | "test";
  task: string;
  reward: number;
  steps: number | null;
  /** Whether its actions were recorded, so that it can be opened with `openLogged`. */
  recorded: boolean;
}

/** A log of a lifetime. */
export interface Log {
  /** The names of the tasks, in order of first appearance. */
  tasks: string[];
  metrics: string[];
  episodes: LoggedEpisode[];
  warnings: string[];
}

/** An episode that fits into a link. */
export interface Link {
  request: WorldRequest;
  looks?: Looks;
  actions: Action[];
}

/** The result of an agent's episode. */
export interface Outcome {
  request: WorldRequest;
  steps: number;
  total: number;
  success: boolean;
  ended_by: string | null;
  actions: Action[];
}

/** An episode that runs in the worker. */
export interface Episode {
  readonly id: number;
  readonly request: WorldRequest;
  readonly actionSpace: ActionSpace;
  /** The longer side of the world's own image size, in pixels. */
  readonly imageSize: number;
  /** The JSON of the world in its initial state. */
  readonly world: string;
  /** Takes an action, or the action nearest to the input from keys. Steps after the end fail with `env/ended`. */
  step(action: Action | Keys): Promise<Step>;
  /** Takes several actions, until the episode ends; returns the steps taken. */
  steps(actions: Action[]): Promise<Step[]>;
  /** The action that an agent would take now; changes only the agent's own state. An agent that takes over from another starts afresh. */
  choose(agent: Agent): Promise<Action>;
  /** `choose`, then `step`. */
  act(agent: Agent): Promise<Step>;
  /** Goes to the state after this number of steps, back or forth within the steps played. A new step from there drops the later ones. */
  seek(step: number): Promise<Step>;
  /** The current state. */
  now(): Promise<Step>;
  /** Draws the agent's view, or the world from above; by default at the size given to `open`. */
  frame(view?: View, modality?: Modality, size?: { width: number; height: number }): Promise<Frame>;
  map(): Promise<WorldMap>;
  /** All actions so far, including those after the moment that `seek` went to. */
  actions(): Promise<Action[]>;
  /** The episode so far as a file for `driftworld replay`. */
  recording(): Promise<string>;
  /** Frees the episode's memory. */
  close(): Promise<void>;
}

/** Options of the engine. */
export interface EngineOptions {
  /** The address of the folder with `worker.js`; the page's own folder if absent. */
  base?: string;
  /** Time limit of a call in milliseconds; 10,000 if absent. */
  limit?: number;
}

/** The looks of a world, and the size of its frames. */
export interface OpenOptions {
  looks?: Looks;
  width?: number;
  height?: number;
}

/** Options of a distance: the measure and the worlds. */
export interface DistanceOptions {
  by?: Measure;
  worlds?: number;
  seed?: number;
  as?: "variants" | "worlds";
}

/** The variants of a task to compare, and the measure; by default all variants, and a measure that suits them. */
export interface MatrixOptions {
  variants?: string[];
  by?: Measure;
  worlds?: number;
}

/** `MatrixOptions` and the options of the ordering. */
export interface OrderOptions extends MatrixOptions {
  method?: OrderMethod;
  start?: string;
  seed?: number;
}

/** The simulator. Calls run one after the other. */
export interface Engine {
  /** Resolves when the simulator is loaded, with its version of Driftworld and the loading time. */
  ready(): Promise<{ version: string; milliseconds: number }>;
  /** Ends the simulator: running and waiting calls fail with `engine/stopped`, and open episodes are lost. */
  stop(): void;
  /** Called when a call begins and ends, for a spinner and a stop button. */
  onbusy: ((busy: boolean) => void) | null;

  tasks(): Promise<TaskCard[]>;
  /** A task by its name, or from its text. */
  task(nameOrText: string): Promise<Task>;
  /** The parameters of a task, as in `task`. */
  parameters(nameOrText: string): Promise<Parameter[]>;
  /** The problems of a text, as a result: the call does not fail on an invalid text. */
  validate(text: string): Promise<Validation>;
  /** The JSON Schema of a kind of document. */
  schema(kind: "task" | "world" | "scenario"): Promise<Json>;
  /** The JSON of a world, indented. */
  sample(request: WorldRequest): Promise<string>;
  /** Begins an episode. Its frames have the given width and height, or the world's own if absent. */
  open(request: WorldRequest, options?: OpenOptions): Promise<Episode>;
  /** Runs a whole episode of an agent, for at most this number of steps (1000 if absent). */
  run(request: WorldRequest, agent: Agent, steps?: number): Promise<Outcome>;
  /** The first world, starting at `request.index`, in which the agent does not succeed; null if it succeeds in all of them. */
  findFailure(request: WorldRequest, agent: Agent, options?: { worlds?: number; steps?: number }): Promise<Outcome | null>;

  /** The names of measures. */
  measures(): Promise<Measure[]>;
  /** The distance between two variants or worlds; `as: "worlds"` compares the worlds of two requests for variants. */
  distance(a: WorldRequest, b: WorldRequest, options?: DistanceOptions): Promise<Distance>;
  /** The elements in which two variants of a task differ, with a witness of each. */
  elements(task: string, a: string, b: string, options?: { worlds?: number; seed?: number }): Promise<Elements>;
  /** All distances among the variants of a task, or among some of them. */
  matrix(task: string, options?: MatrixOptions): Promise<Matrix>;
  /** The variants of a task in an order. */
  order(task: string, options?: OrderOptions): Promise<Order>;

  /** Reads the files of a log. */
  log(files: DroppedFile[]): Promise<Log>;
  /** Opens an episode of the log that was read last, with all its actions: `seek` plays it. */
  openLogged(experience: number, options?: OpenOptions): Promise<Episode>;

  /** An episode as the fragment of an address, without `#`: at most 2 kB for 300 steps of a built-in task. */
  encodeLink(link: Link): Promise<string>;
  /** The episode of a fragment. Fails with `link/damaged` or `link/version`. */
  decodeLink(fragment: string): Promise<Link>;
}

/** Starts the simulator in a worker. */
export function createEngine(options: EngineOptions = {}): Engine {
  return new WorkerEngine(options);
}

/** A call that waits for its turn, or runs. */
interface Waiting {
  id: number;
  call: Record<string, unknown>;
  bytes: Uint8Array | undefined;
  /** The worker that the call needs, because its episode lives there; null if any worker will do. */
  generation: number | null;
  resolve(answer: { value: Json; bytes: Uint8Array<ArrayBuffer> }): void;
  reject(error: EngineError): void;
}

class WorkerEngine implements Engine {
  onbusy: ((busy: boolean) => void) | null = null;
  readonly limit: number;
  /** The address of the folder with `worker.js`. */
  private readonly base: string;
  readonly makeWorker: () => Worker;
  /** The number of the current worker, from 1. */
  generation = 0;
  private worker: Worker | null = null;
  private loaded: Promise<void> = Promise.resolve();
  private waiting: Waiting[] = [];
  private running: Waiting | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private lastId = 0;
  private milliseconds = 0;
  /** Numbers of networks in the current worker. */
  private networks = new WeakMap<Uint8Array, { generation: number; number: number }>();

  constructor({ base = document.baseURI, limit = 10_000 }: EngineOptions) {
    this.base = base;
    this.makeWorker = () => new Worker(new URL("worker.js", base), { type: "module" });
    this.limit = limit;
    this.startWorker();
  }

  private startWorker(): void {
    const start = performance.now();
    const worker = this.makeWorker();
    this.generation += 1;
    this.worker = worker;
    this.loaded = new Promise((resolve, reject) => {
      worker.onmessage = ({ data }: MessageEvent<WorkerReply>) => {
        if (data.id >= 0) {
          this.handleReply(data);
        } else if (data.failed === undefined) {
          this.milliseconds = performance.now() - start;
          resolve();
        } else {
          reject(new EngineError("engine/load", data.failed));
        }
      };
      worker.onerror = (event) => reject(new EngineError("engine/load", event.message || "the worker cannot be started"));
    });
    this.loaded.catch(() => {});
  }

  /** Ends the worker and all calls; the running one fails with `reason`. */
  private end(reason: EngineError): void {
    clearTimeout(this.timer);
    this.worker?.terminate();
    this.worker = null;
    const { running, waiting } = this;
    this.running = null;
    this.waiting = [];
    running?.reject(reason);
    const others = reason.code === "engine/stopped" ? reason : new EngineError("engine/lost", "an earlier call ended the simulator; try again");
    for (const call of waiting) call.reject(others);
    if (running) this.onbusy?.(false);
  }

  stop(): void {
    this.end(new EngineError("engine/stopped", "it was stopped"));
  }

  /** Sends a call when its turn has come. */
  send(call: Record<string, unknown>, bytes?: Uint8Array, generation: number | null = null): Promise<{ value: Json; bytes: Uint8Array<ArrayBuffer> }> {
    return new Promise((resolve, reject) => {
      this.lastId += 1;
      this.waiting.push({ id: this.lastId, call, bytes, generation, resolve, reject });
      this.next();
    });
  }

  private next(): void {
    if (this.running) return;
    const call = this.waiting.shift();
    if (!call) return;
    if (!this.worker) this.startWorker();
    if (call.generation !== null && call.generation !== this.generation) {
      call.reject(new EngineError("engine/lost", "the episode ended with the simulator that it ran in; open it again"));
      this.next();
      return;
    }
    this.running = call;
    this.onbusy?.(true);
    this.loaded.then(
      () => {
        if (this.running !== call) return;
        this.timer = setTimeout(
          () => this.end(new EngineError("engine/timeout", `it took more than ${this.limit / 1000} s and was stopped; request less`)),
          this.limit,
        );
        const request: WorkerRequest = { id: call.id, call: call.call, ...(call.bytes ? { bytes: call.bytes } : {}) };
        this.worker?.postMessage(request);
      },
      (error: EngineError) => {
        if (this.running === call) this.end(error);
      },
    );
  }

  private handleReply({ id, json, bytes, failed }: WorkerReply): void {
    const call = this.running;
    if (call?.id !== id) return;
    if (failed !== undefined || json === undefined || bytes === undefined) {
      this.end(new EngineError("engine/crashed", `the simulator failed: ${failed ?? "no answer"}; please report what you did`));
      return;
    }
    clearTimeout(this.timer);
    this.running = null;
    const answer = JSON.parse(json) as { ok: Json } | { error: { code: string; message: string; problems: Problem[] } };
    if ("error" in answer) {
      call.reject(new EngineError(answer.error.code, answer.error.message, answer.error.problems));
    } else {
      call.resolve({ value: answer.ok, bytes });
    }
    this.onbusy?.(false);
    this.next();
  }

  /** The answer of a call that has no bytes. */
  async ask<T>(call: Record<string, unknown>, generation: number | null = null): Promise<T> {
    return (await this.send(call, undefined, generation)).value as T;
  }

  /** An agent as calls name it; each worker is sent a network only once. */
  async agent(agent: Agent): Promise<Json> {
    if (typeof agent === "string") return agent;
    const known = this.networks.get(agent.network);
    if (known && known.generation === this.generation && this.worker) return { network: known.number };
    const number = (await this.send({ call: "network" }, agent.network)).value as number;
    this.networks.set(agent.network, { generation: this.generation, number });
    return { network: number };
  }

  async ready(): Promise<{ version: string; milliseconds: number }> {
    const version = await this.ask<string>({ call: "version" });
    return { version, milliseconds: this.milliseconds };
  }

  async tasks(): Promise<TaskCard[]> {
    // The build stores the answer of the same simulator in this file.
    const stored = await fetch(new URL("tasks.json", this.base)).catch(() => null);
    return stored?.ok ? ((await stored.json()) as TaskCard[]) : this.ask({ call: "tasks" });
  }

  task = (task: string): Promise<Task> => this.ask({ call: "task", task });

  parameters = async (task: string): Promise<Parameter[]> => (await this.task(task)).parameters;

  validate = (text: string): Promise<Validation> => this.ask({ call: "validate", text });

  schema = (kind: "task" | "world" | "scenario"): Promise<Json> => this.ask({ call: "schema", kind });

  sample = (request: WorldRequest): Promise<string> => this.ask({ call: "sample", request });

  open = (request: WorldRequest, options: OpenOptions = {}): Promise<Episode> => this.begin(request, { call: "open", request, ...openArguments(options) });

  private async begin(request: WorldRequest | null, call: Record<string, unknown>): Promise<Episode> {
    const info = await this.ask<EpisodeInfo>(call);
    return new WorkerEpisode(this, this.generation, request ?? { world: info.world }, info);
  }

  async run(request: WorldRequest, agent: Agent, steps = 1000): Promise<Outcome> {
    const outcome = await this.ask<Omit<Outcome, "request">>({ call: "run", request, agent: await this.agent(agent), steps });
    return { request, ...outcome };
  }

  async findFailure(request: WorldRequest, agent: Agent, { worlds = 100, steps = 1000 } = {}): Promise<Outcome | null> {
    const first = "world" in request ? 0 : (request.index ?? 0);
    const end = "world" in request ? 1 : first + worlds;
    for (let index = first; index < end; index += 1) {
      const outcome = await this.run("world" in request ? request : { ...request, index }, agent, steps);
      if (!outcome.success) return outcome;
    }
    return null;
  }

  measures = (): Promise<Measure[]> => this.ask({ call: "measures" });

  distance(a: WorldRequest, b: WorldRequest, { as, ...options }: DistanceOptions = {}): Promise<Distance> {
    return this.ask({ call: "distance", a, b, as_worlds: as === "worlds", ...options });
  }

  elements(task: string, a: string, b: string, { worlds = 8, seed = 0 } = {}): Promise<Elements> {
    return this.ask({ call: "elements", task, a, b, worlds, seed });
  }

  matrix = (task: string, options: MatrixOptions = {}): Promise<Matrix> => this.ask({ call: "matrix", task, ...options });

  order = (task: string, options: OrderOptions = {}): Promise<Order> => this.ask({ call: "order", task, ...options });

  async log(files: DroppedFile[]): Promise<Log> {
    const joined = new Uint8Array(files.reduce((sum, file) => sum + file.bytes.length, 0));
    let offset = 0;
    for (const { bytes } of files) {
      joined.set(bytes, offset);
      offset += bytes.length;
    }
    const call = { call: "log", files: files.map(({ path, bytes }) => ({ path, length: bytes.length })) };
    return (await this.send(call, joined)).value as unknown as Log;
  }

  openLogged(experience: number, options: OpenOptions = {}): Promise<Episode> {
    return this.begin(null, { call: "open_logged", experience, ...openArguments(options) });
  }

  encodeLink = (link: Link): Promise<string> => this.ask({ call: "encode_link", link });

  decodeLink = (fragment: string): Promise<Link> => this.ask({ call: "decode_link", fragment });
}

/** The arguments of a call that opens a world. */
function openArguments({ looks, width, height }: OpenOptions): Record<string, unknown> {
  const style = { ...(looks ? { style: looks } : {}) };
  return width && height ? { ...style, size: [width, height] } : style;
}

/** The simulator's description of a new episode. */
interface EpisodeInfo {
  id: number;
  image_size: number;
  world: string;
  action_space: ActionSpace;
}

class WorkerEpisode implements Episode {
  readonly id: number;
  readonly actionSpace: ActionSpace;
  readonly imageSize: number;
  readonly world: string;

  constructor(
    private readonly engine: WorkerEngine,
    private readonly generation: number,
    readonly request: WorldRequest,
    info: EpisodeInfo,
  ) {
    this.id = info.id;
    this.actionSpace = info.action_space;
    this.imageSize = info.image_size;
    this.world = info.world;
  }

  private ask<T>(call: Record<string, unknown>): Promise<T> {
    return this.engine.ask({ ...call, episode: this.id }, this.generation);
  }

  async step(action: Action | Keys): Promise<Step> {
    const [step] = await this.ask<[Step]>({ call: "step", steps: [action] });
    return step;
  }

  steps = (actions: Action[]): Promise<Step[]> => this.ask({ call: "step", steps: actions });

  choose = async (agent: Agent): Promise<Action> => this.ask({ call: "choose", agent: await this.engine.agent(agent) });

  act = async (agent: Agent): Promise<Step> => this.ask({ call: "act", agent: await this.engine.agent(agent) });

  seek = (step: number): Promise<Step> => this.ask({ call: "seek", step });

  now = (): Promise<Step> => this.ask({ call: "now" });

  async frame(view: View = "agent", modality: Modality = "rgb", size?: { width: number; height: number }): Promise<Frame> {
    const ownSize = size ? { size: [size.width, size.height] } : {};
    const call = { call: "frame", episode: this.id, view, modality, ...ownSize };
    const { value, bytes } = await this.engine.send(call, undefined, this.generation);
    const { width, height } = value as { width: number; height: number };
    return { width, height, data: new Uint8ClampedArray(bytes.buffer) };
  }

  map = (): Promise<WorldMap> => this.ask({ call: "map" });

  actions = (): Promise<Action[]> => this.ask({ call: "actions" });

  recording = (): Promise<string> => this.ask({ call: "recording" });

  async close(): Promise<void> {
    await this.ask({ call: "close" }).catch(() => {});
  }
}
