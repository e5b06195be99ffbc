// The typed client of the simulator: every call runs in one worker, with a time limit and a way to stop it.
//
// The worker holds the simulator compiled to WebAssembly. A call that takes too long, or that is stopped, ends the worker; the next
// call starts a new one. Episodes that were open in the old worker are gone then: calls on them fail with the code `engine/lost`.

import type { Answered, Asked } from "./worker.ts";

/** Any JSON value. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** The elements of a decision process: state, action, transition, reward, observation; `p` and `phi` are the finer ones. */
export type Element = "S" | "A" | "T" | "R" | "O" | "p" | "phi";

/** A problem of a document, at its place. Lines and columns count from 1; 0 while the place is not known. */
export interface Problem {
  code: string;
  pointer: string;
  line: number;
  column: number;
  found: string;
  expected: string;
  advice: string | null;
  /** All of it in one sentence. */
  message: string;
}

/** Why a call has no result. */
export class EngineError extends Error {
  /**
   * A stable name. From here: `engine/timeout`, `engine/stopped`, `engine/lost`, `engine/crashed`, `engine/load`. From links:
   * `link/damaged`, `link/version`, `link/too-long`. From the simulator: `spec/…`, `env/…`, `generator/…`, `request/…`.
   */
  readonly code: string;
  /** Of a document that is wrong: every problem, in the order of the text. */
  readonly problems: Problem[];

  constructor(code: string, message: string, problems: Problem[] = []) {
    super(message);
    this.name = "EngineError";
    this.code = code;
    this.problems = problems;
  }
}

/** A value of a parameter, as documents have it: a colour may be a name or a list of three numbers. */
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
  /** Variant only: the least and the greatest number. */
  range: [number, number] | null;
  /** Variant only: the values there are; `name` where the task names them. A value in an override is `name`, if there is one. */
  choices: { value: Value; name: string | null }[] | null;
  /** The value where no variant says: the default of a variant parameter, the value of a fixed one. */
  value: Value | null;
  /** Randomized only: the distribution, as the task has it. */
  distribution: Json | null;
  /** The condition under which anything reads it. */
  read_if: string | null;
}

/** A variant and what it sets. */
export interface Variant {
  name: string;
  description: string | null;
  /** The values of all variant parameters in it. */
  values: Record<string, Value>;
}

/** A task in the gallery. */
export interface TaskCard {
  name: string;
  /** What it asks for, such as `navigation`. */
  group: string;
  description: string;
  variants: string[];
  /** Variants that describe themselves, best first: what a card shows. */
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

/** Which world: one that a task draws, or one as it is. */
export type WorldRequest =
  | {
      /** The name of a built-in task, or the text of a task spec (what begins with `{`). */
      task: string;
      /** The variant; all parameters at their defaults if absent. */
      variant?: string;
      /** Values of variant parameters that replace those of the variant. */
      values?: Record<string, Value>;
      /** 0 if absent. */
      seed?: number;
      /** Number of the world under the seed, 0 if absent. */
      index?: number;
    }
  | {
      /** The JSON of a world. */
      world: string;
    };

/** What a text is, and what is wrong with it. */
export interface Validation {
  kind: "task" | "world" | "scenario" | "maps" | "l2explorer-world" | "l2explorer-scenario";
  problems: Problem[];
  /** True where there are more problems than are listed. */
  more: boolean;
  /** What is odd and not wrong, in sentences. */
  warnings: string[];
}

/** `plain` colours or `natural` surfaces; the world's own if absent. */
export type Looks = "plain" | "natural";

/** What an image shows. */
export type Modality = "rgb" | "depth" | "segmentation" | "class" | "instance";

/** What the agent sees, or all of the world from above. */
export type View = "agent" | "above";

/** An image: `data` is RGBA, row 0 on top; what `ImageData` takes. */
export interface Frame {
  width: number;
  height: number;
  data: Uint8ClampedArray<ArrayBuffer>;
}

/** Actions that a world takes. */
export interface ActionSpace {
  /** `discrete`: a row of a table. `continuous`: three numbers in units. `normalized`: three numbers in -1..1. */
  kind: "discrete" | "continuous" | "normalized";
  /** What the three numbers mean. `none` and `onrails` ignore actions. */
  model: "byvelocity" | "bywaypoint" | "onrails" | "none";
  /** Discrete: a name for each row, such as `ahead left`. Otherwise a name for each number. */
  names: string[];
  /** Discrete: the rows themselves. */
  table: [number, number, number][] | null;
  can_interact: boolean;
  max_speed: number;
  max_turn_rate: number;
  /** Seconds of the world in one step. */
  step_seconds: number;
}

/** A row of the table, or three numbers. */
export type Action = number | [number, number, number];

/** What keys ask for, in -1..1: the action of the world that comes nearest is taken. `turn` is to the right. */
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

/** Where an episode stands, after a step or without one. */
export interface Step {
  /** How many steps have been taken. */
  step: number;
  /** What the last step paid. */
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
  /** Seconds of the world so far. */
  seconds: number;
  /** The energy that is left, in worlds that count it. */
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
  /** Its number in the world: what events and problems (`/objects/N`) name. */
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
  /** What it pays now. */
  reward: number;
  /** False once it is gone, and of a thing that is carried. */
  present: boolean;
  carried: boolean;
  /** A door that stands open. */
  open: boolean;
}

/** A zone on the map. */
export interface MapZone {
  name: string | null;
  points: [number, number][];
  color: [number, number, number];
  visible: boolean;
}

/** All that a flat map shows, in metres: x to the east, y to the north, (0, 0) in the middle. */
export interface WorldMap {
  width: number;
  depth: number;
  walls: MapWall[];
  objects: MapObject[];
  zones: MapZone[];
  agent: { x: number; y: number; heading: number; radius: number };
}

/** Who acts: the built-in ones, or a network in the format safetensors as `driftworld.learners` exports it. */
export type Agent = "planner" | "random" | "still" | { network: Uint8Array };

/** What two are compared by, such as `parameters`, `worlds`, `pictures`, `objects`, `rewards`, `dynamics` or `behavior`. */
export type Measure = string;

/** One comparison that a distance is made of. */
export interface DistancePart {
  name: string;
  element: Element;
  /** The measure, and what its number is divided by. */
  measure: string;
  raw: number;
  normalised: number;
  weight: number;
  /** Share of the whole, in 0..1. */
  share: number;
}

/** How far apart two are. */
export interface Distance {
  by: Measure;
  /** What 1 is, in a sentence. */
  unit: string;
  /** By what, from how many worlds, and what else is to be known of the number, in words. */
  description: string;
  total: number;
  /** Null where nothing could differ. */
  elements: Record<"S" | "A" | "T" | "R" | "O", number | null>;
  parts: DistancePart[];
}

/** Where an element of two variants was first seen to differ. */
export interface Witness {
  element: Element;
  /** The case in a sentence. */
  message: string;
}

/** What two variants of a task differ in: what their parameters claim, and what was measured in their worlds. */
export interface Elements {
  /** The parameters that differ. */
  parameters: string[];
  declared: Element[];
  measured: Witness[];
  /** Sentences about what was measured and is not declared. */
  contradictions: string[];
  /** Parameters that differ and made no difference. */
  idle: string[];
  verdict: "sound" | "idle" | "contradicted";
}

/** All distances among variants, and a flat map of them. */
export interface Matrix {
  by: Measure;
  labels: string[];
  rows: number[][];
  /** A point for each label: distances between points are near to those of the matrix. */
  points: [number, number][];
  /** Share of the distances that the flat map shows, in 0..1. */
  shown: number;
}

/** How variants are ordered. */
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
  /** The names of the tasks, in the order in which they first come. */
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

/** How an episode of an agent went. */
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
  /** The side of the image that the world itself asks for, in pixels. */
  readonly imageSize: number;
  /** The JSON of the world that it began in. */
  readonly world: string;
  /** Takes an action, or the action nearest to what keys ask for. Steps after the end fail with `env/ended`. */
  step(action: Action | Keys): Promise<Step>;
  /** Takes several actions; ends early where the episode does. The steps that were taken. */
  steps(actions: Action[]): Promise<Step[]>;
  /** What an agent would do now; changes nothing but the agent's own state. Agents begin anew where the episode does. */
  choose(agent: Agent): Promise<Action>;
  /** `choose` and `step` at once. */
  act(agent: Agent): Promise<Step>;
  /** Goes to the moment after so many steps, back or forth within what has been played. Playing on from there drops the rest. */
  seek(step: number): Promise<Step>;
  /** Where it stands. */
  now(): Promise<Step>;
  /** Draws what the agent sees, or the world from above. Size: that of `open`, unless it is given. */
  frame(view?: View, modality?: Modality, size?: { width: number; height: number }): Promise<Frame>;
  map(): Promise<WorldMap>;
  /** All actions so far, also those beyond the moment that `seek` went to. */
  actions(): Promise<Action[]>;
  /** What was played up to now as a file, which `driftworld replay` plays. */
  recording(): Promise<string>;
  /** Frees it. */
  close(): Promise<void>;
}

/** How the engine is started. */
export interface EngineOptions {
  /** The address of the folder with `worker.js`; that of the page if absent. */
  base?: string;
  /** Milliseconds that a call may take; 10,000 if absent. */
  limit?: number;
}

/** In which looks a world is opened, and how large its frames are. */
export interface OpenOptions {
  looks?: Looks;
  width?: number;
  height?: number;
}

/** Which worlds a distance compares, and by what. */
export interface DistanceOptions {
  by?: Measure;
  worlds?: number;
  seed?: number;
  as?: "variants" | "worlds";
}

/** Which variants of a task are compared, and by what; all, and by what the task declares, if absent. */
export interface MatrixOptions {
  variants?: string[];
  by?: Measure;
  worlds?: number;
}

/** The same, and how they are ordered. */
export interface OrderOptions extends MatrixOptions {
  method?: OrderMethod;
  start?: string;
  seed?: number;
}

/** The simulator. Calls run one after the other. */
export interface Engine {
  /** Resolves when the simulator is loaded. The version of Driftworld in it, and how long loading took. */
  ready(): Promise<{ version: string; milliseconds: number }>;
  /** Ends what runs: the calls that wait fail with `engine/stopped`, open episodes are lost. */
  stop(): void;
  /** Calls are told here when they begin and end, for a spinner and a stop button. */
  onbusy: ((busy: boolean) => void) | null;

  tasks(): Promise<TaskCard[]>;
  /** A task by its name, or from its text. */
  task(nameOrText: string): Promise<Task>;
  /** The parameters of a task; those of `task`. */
  parameters(nameOrText: string): Promise<Parameter[]>;
  /** All that is wrong with a text; a result, and not an error, also where much is. */
  validate(text: string): Promise<Validation>;
  /** The JSON Schema of a kind of document. */
  schema(kind: "task" | "world" | "scenario"): Promise<Json>;
  /** The JSON of a world, indented. */
  sample(request: WorldRequest): Promise<string>;
  /** Begins an episode. Width and height are those of its frames; the world's own if absent. */
  open(request: WorldRequest, options?: OpenOptions): Promise<Episode>;
  /** Runs a whole episode of an agent, in at most so many steps (1000 if absent). */
  run(request: WorldRequest, agent: Agent, steps?: number): Promise<Outcome>;
  /** The first world from `request.index` on in which the agent does not succeed; null if it succeeds in all of them. */
  findFailure(request: WorldRequest, agent: Agent, options?: { worlds?: number; steps?: number }): Promise<Outcome | null>;

  /** The names of measures. */
  measures(): Promise<Measure[]>;
  /** How far apart two are. Variants are compared as such, worlds as worlds (`as: "worlds"` compares the two worlds of requests). */
  distance(a: WorldRequest, b: WorldRequest, options?: DistanceOptions): Promise<Distance>;
  /** What two variants of one task differ in, with a witness of each element. */
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
  /** The worker that it is meant for: calls on episodes of another one are lost. */
  generation: number | null;
  resolve(answer: { value: Json; bytes: Uint8Array<ArrayBuffer> }): void;
  reject(error: EngineError): void;
}

class WorkerEngine implements Engine {
  onbusy: ((busy: boolean) => void) | null = null;
  readonly limit: number;
  /** The address of the folder that the page lies in. */
  private readonly base: string;
  readonly makeWorker: () => Worker;
  /** Counts the workers. */
  generation = 0;
  private worker: Worker | null = null;
  private loaded: Promise<void> = Promise.resolve();
  private waiting: Waiting[] = [];
  private running: Waiting | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asked = 0;
  private milliseconds = 0;
  /** Numbers of networks in the worker that runs. */
  private networks = new WeakMap<Uint8Array, { generation: number; number: number }>();

  constructor({ base = document.baseURI, limit = 10_000 }: EngineOptions) {
    this.base = base;
    this.makeWorker = () => new Worker(new URL("worker.js", base), { type: "module" });
    this.limit = limit;
    this.begin();
  }

  private begin(): void {
    const begun = performance.now();
    const worker = this.makeWorker();
    this.generation += 1;
    this.worker = worker;
    this.loaded = new Promise((resolve, reject) => {
      worker.onmessage = ({ data }: MessageEvent<Answered>) => {
        if (data.id >= 0) {
          this.answered(data);
        } else if (data.failed === undefined) {
          this.milliseconds = performance.now() - begun;
          resolve();
        } else {
          reject(new EngineError("engine/load", data.failed));
        }
      };
      worker.onerror = (event) => reject(new EngineError("engine/load", event.message || "the worker cannot be started"));
    });
    this.loaded.catch(() => {});
  }

  /** Ends the worker and all calls; the first that ran fails for `reason`. */
  private end(reason: EngineError): void {
    clearTimeout(this.timer);
    this.worker?.terminate();
    this.worker = null;
    const { running, waiting } = this;
    this.running = null;
    this.waiting = [];
    running?.reject(reason);
    const others = reason.code === "engine/stopped" ? reason : new EngineError("engine/lost", "a call before this one ended the simulator; ask again");
    for (const call of waiting) call.reject(others);
    if (running) this.onbusy?.(false);
  }

  stop(): void {
    this.end(new EngineError("engine/stopped", "it was stopped"));
  }

  /** Sends a call when its turn has come. */
  send(call: Record<string, unknown>, bytes?: Uint8Array, generation: number | null = null): Promise<{ value: Json; bytes: Uint8Array<ArrayBuffer> }> {
    return new Promise((resolve, reject) => {
      this.asked += 1;
      this.waiting.push({ id: this.asked, call, bytes, generation, resolve, reject });
      this.next();
    });
  }

  private next(): void {
    if (this.running) return;
    const call = this.waiting.shift();
    if (!call) return;
    if (!this.worker) this.begin();
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
          () => this.end(new EngineError("engine/timeout", `it took more than ${this.limit / 1000} s and was ended; ask for less`)),
          this.limit,
        );
        const asked: Asked = { id: call.id, call: call.call, ...(call.bytes ? { bytes: call.bytes } : {}) };
        this.worker?.postMessage(asked);
      },
      (error: EngineError) => {
        if (this.running === call) this.end(error);
      },
    );
  }

  private answered({ id, json, bytes, failed }: Answered): void {
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

  /** An agent as calls name it; a network is handed over once to each worker. */
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
    // The build asked the same simulator already.
    const kept = await fetch(new URL("tasks.json", this.base)).catch(() => null);
    return kept?.ok ? ((await kept.json()) as TaskCard[]) : this.ask({ call: "tasks" });
  }

  task = (task: string): Promise<Task> => this.ask({ call: "task", task });

  parameters = async (task: string): Promise<Parameter[]> => (await this.task(task)).parameters;

  validate = (text: string): Promise<Validation> => this.ask({ call: "validate", text });

  schema = (kind: "task" | "world" | "scenario"): Promise<Json> => this.ask({ call: "schema", kind });

  sample = (request: WorldRequest): Promise<string> => this.ask({ call: "sample", request });

  open = (request: WorldRequest, options: OpenOptions = {}): Promise<Episode> => this.opened(request, { call: "open", request, ...drawn(options) });

  private async opened(request: WorldRequest | null, call: Record<string, unknown>): Promise<Episode> {
    const found = await this.ask<Opened>(call);
    return new WorkerEpisode(this, this.generation, request ?? { world: found.world }, found);
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
    const all = new Uint8Array(files.reduce((sum, file) => sum + file.bytes.length, 0));
    let at = 0;
    for (const { bytes } of files) {
      all.set(bytes, at);
      at += bytes.length;
    }
    const call = { call: "log", files: files.map(({ path, bytes }) => ({ path, length: bytes.length })) };
    return (await this.send(call, all)).value as unknown as Log;
  }

  openLogged(experience: number, options: OpenOptions = {}): Promise<Episode> {
    return this.opened(null, { call: "open_logged", experience, ...drawn(options) });
  }

  encodeLink = (link: Link): Promise<string> => this.ask({ call: "encode_link", link });

  decodeLink = (fragment: string): Promise<Link> => this.ask({ call: "decode_link", fragment });
}

/** How a world and its pictures are opened, as calls say it. */
function drawn({ looks, width, height }: OpenOptions): Record<string, unknown> {
  const own = { ...(looks ? { style: looks } : {}) };
  return width && height ? { ...own, size: [width, height] } : own;
}

/** What the simulator says of an episode that begins. */
interface Opened {
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
    opened: Opened,
  ) {
    this.id = opened.id;
    this.actionSpace = opened.action_space;
    this.imageSize = opened.image_size;
    this.world = opened.world;
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
    const wanted = size ? { size: [size.width, size.height] } : {};
    const call = { call: "frame", episode: this.id, view, modality, ...wanted };
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
