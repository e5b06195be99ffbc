// Calls whose answers must be bit-identical natively, in Node and in a browser, and their runner for Node and browsers.
// `studio/wasm/examples/answers.rs` is the native runner.

/** Ten worlds of many kinds: mazes, doors and keys, moving and pushable objects, zones, natural looks, discrete and continuous actions. */
const PLAYED = [
  { open: { request: { task: "find_objects", variant: "red" }, style: "natural" }, agent: "planner" },
  { open: { request: { task: "nav_maze" }, style: "natural" }, agent: "planner" },
  { open: { request: { task: "key_corridor" } }, agent: "planner" },
  { open: { request: { task: "door_key" }, style: "natural" }, agent: "random" },
  { open: { request: { task: "dynamic_obstacles" } }, agent: "planner" },
  { open: { request: { task: "hunt" }, style: "natural" }, agent: "planner" },
  { open: { request: { task: "push_box" } }, agent: "planner" },
  { open: { request: { task: "lava_crossing" }, style: "natural" }, agent: "random" },
  { open: { request: { task: "moving_object" } }, agent: "random" },
  { open: { request: { task: "obstacle_course" } }, agent: { network: 0 }, size: [320, 240] },
];

const SAMPLED = [
  "find_objects", "four_rooms", "multi_room", "t_maze", "locked_rooms", "foraging", "stealth", "water_maze", "k_armed", "expedition",
];

const COMPARED = [
  { task: "find_objects", names: ["blue", "red", "dusk", "huddle", "penalty", "wide", "spheres"], by: ["parameters", "worlds", "objects", "occupancy"] },
  { task: "get_to_goal", names: ["plain", "deadly", "soft", "slow"], by: ["parameters", "rewards", "colors", "placements"] },
];

/** Groups of calls: a small set for a quick run, or all of them. */
export function groups(full) {
  const steps = full ? 1000 : 40;
  const played = PLAYED.map((play) => ({ play: { ...play, steps, frames: true } }));
  const worlds = SAMPLED.flatMap((task) => Array.from({ length: full ? 10 : 2 }, (_, index) => ({ call: { call: "sample", request: { task, seed: 7, index } } })));
  const distances = COMPARED.flatMap(({ task, names, by }) => names.flatMap((a, place) => names.slice(0, place).flatMap((b) => by.map((measure) => ({
    call: { call: "distance", a: { task, variant: a }, b: { task, variant: b }, by: measure, worlds: measure === "parameters" ? null : 4 },
  })))));
  const decisions = { open: { request: { task: "obstacle_course", seed: 3 } }, agent: { network: 0 }, steps: full ? 1000 : 100, frames: false };
  const texts = [
    { call: { call: "tasks" } },
    { call: { call: "task", task: "find_objects" } },
    { call: { call: "validate", text: '{ "name": "x", "parameters": { "a": { "role": "variant" } } }' } },
    { call: { call: "elements", task: "find_objects", a: "red", b: "penalty", worlds: 2, seed: 0 } },
    { call: { call: "matrix", task: "blue_red_green" } },
    { call: { call: "order", task: "blue_red_green" } },
  ];
  return [
    { name: "frames", items: [{ network: "obstacle_course" }, ...played] },
    { name: "worlds", items: worlds },
    { name: "distances", items: full ? distances : distances.slice(0, 12) },
    { name: "decisions", items: [{ network: "obstacle_course" }, { play: decisions }] },
    { name: "texts", items: texts },
  ];
}

/**
 * Runs groups of calls. `call` answers a single call, and `network` holds the bytes of a network. The function uses nothing from
 * outside, so that its source can be evaluated in a page.
 */
export async function answers(groups, call, network) {
  const found = [];
  for (const group of groups) {
    const begun = performance.now();
    let [a, b] = [0x811c9dc5, 0x12345678];
    const word = (value) => {
      a = Math.imul(a ^ value, 0x01000193);
      b = Math.imul((b + value) | 0, 0x9e3779b1);
      b ^= b >>> 15;
    };
    const add = (bytes) => {
      const whole = bytes.length >> 2;
      const words = bytes.byteOffset % 4 === 0 ? new Uint32Array(bytes.buffer, bytes.byteOffset, whole) : new Uint32Array(bytes.slice(0, whole * 4).buffer);
      for (let at = 0; at < whole; at += 1) word(words[at] | 0);
      for (let at = whole * 4; at < bytes.length; at += 1) word(bytes[at]);
      word(bytes.length);
    };
    const encoder = new TextEncoder();
    let [asked, frames] = [0, 0];
    const ask = async (one, bytes) => {
      const answer = await call(one, bytes);
      add(encoder.encode(answer.json));
      add(answer.bytes);
      asked += 1;
      frames += answer.bytes.length > 0 ? 1 : 0;
      return JSON.parse(answer.json);
    };
    const play = async ({ open, agent, size, steps, frames }) => {
      let left = steps;
      for (let index = 0; left > 0; index += 1) {
        const opened = await ask({ call: "open", ...open, request: { ...open.request, index } });
        const episode = opened.ok.id;
        for (let over = false; left > 0 && !over; left -= 1) {
          const step = await ask({ call: "act", episode, agent });
          over = step.ok.terminated || step.ok.truncated;
          if (frames) await ask({ call: "frame", episode, view: "agent", modality: "rgb", ...(size ? { size } : {}) });
        }
        await ask({ call: "map", episode });
        await ask({ call: "close", episode });
      }
    };
    for (const item of group.items) {
      if (item.call) await ask(item.call);
      else if (item.network) await ask({ call: "network" }, await network(item.network));
      else await play(item.play);
    }
    const hash = [a, b].map((half) => (half >>> 0).toString(16).padStart(8, "0")).join("");
    found.push({ name: group.name, hash, answers: asked, frames, seconds: (performance.now() - begun) / 1000 });
  }
  return found;
}
