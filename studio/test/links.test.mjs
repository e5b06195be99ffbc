// An episode survives a round trip through a link bit for bit; damaged, hostile and incompatible links give typed errors.
// `DRIFTWORLD_FULL=1` tests 1,000 episodes of two agents instead of 40.

import assert from "node:assert/strict";
import { test } from "node:test";
import { crc32, deflateRawSync, inflateRawSync } from "node:zlib";
import { started } from "./node.mjs";

const full = process.env.DRIFTWORLD_FULL !== undefined;
const EPISODES = full ? 1000 : 40;
const STEPS = 300;

const simulator = await started();

/** The value of a call, or its error. */
function ask(call) {
  const answer = JSON.parse(simulator(call).json);
  if (answer.error) throw Object.assign(new Error(answer.error.message), answer.error);
  return answer.ok;
}

/** A seeded random number generator, so that failures are reproducible. */
function numbers(seed) {
  let state = seed >>> 0;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

const cards = ask({ call: "tasks" });

test("1,000 episodes survive a round trip through links of at most 2 kB", () => {
  const lengths = [];
  for (let number = 0; number < EPISODES; number += 1) {
    const card = cards[Math.floor((number * cards.length) / EPISODES)];
    const request = { task: card.name, variant: card.variants[number % card.variants.length], seed: 5, index: number };
    const agent = number % 2 ? "random" : "planner";
    const { actions, total } = ask({ call: "run", request, agent, steps: STEPS });
    const link = ask({ call: "encode_link", link: { request, actions } });
    const back = ask({ call: "decode_link", fragment: link });
    assert.match(link, /^[A-Za-z0-9_-]+$/);
    assert.deepEqual(back.actions, actions, `${card.name} ${agent}`);
    const again = ask({ call: "open", request: back.request });
    const steps = back.actions.length ? ask({ call: "step", episode: again.id, steps: back.actions }) : [{ total: 0 }];
    assert.equal(steps.at(-1).total, total);
    ask({ call: "close", episode: again.id });
    lengths.push(link.length);
  }
  lengths.sort((a, b) => a - b);
  const longest = lengths.at(-1);
  console.log(`links of ${EPISODES} episodes: median ${lengths[EPISODES >> 1]}, longest ${longest} characters`);
  assert.ok(longest <= 2000, `found a link of ${longest} characters`);
});

test("episodes played by keys and by several agents survive a round trip", () => {
  const request = { task: "find_objects", values: { spread: 10 }, seed: 1 };
  const { id } = ask({ call: "open", request, style: "natural" });
  const draw = numbers(1);
  for (let step = 0; step < STEPS; step += 1) {
    const who = Math.floor(step / 40) % 3;
    if (who === 0) ask({ call: "step", episode: id, steps: [{ ahead: draw(3) - 1, turn: draw(3) - 1, interact: false }] });
    else ask({ call: "act", episode: id, agent: who === 1 ? "planner" : "random" });
  }
  const link = { request, looks: "natural", actions: ask({ call: "actions", episode: id }) };
  const fragment = ask({ call: "encode_link", link });
  assert.ok(fragment.length <= 2000, `found ${fragment.length} characters`);
  assert.deepEqual(ask({ call: "decode_link", fragment }).actions, link.actions);
});

const { actions } = ask({ call: "run", request: { task: "maze" }, agent: "planner", steps: 50 });
const whole = ask({ call: "encode_link", link: { request: { task: "maze" }, actions } });
const original = ask({ call: "decode_link", fragment: whole });

/** A link with a valid checksum for any content. */
function sealed(format, unpacked) {
  const packed = deflateRawSync(unpacked);
  const sum = Buffer.alloc(4);
  sum.writeUInt32LE(typeof crc32 === "function" ? crc32(packed) : 0);
  return Buffer.concat([Buffer.from([format]), sum, packed]).toString("base64url");
}

/** The messages about links: without bytes and offsets, which mean nothing to a person who copied one. */
const MESSAGES = {
  "link/damaged": /^this link is incomplete or was changed; copy all of it$/,
  "link/version": /^this link was made by another version of Driftworld, or was changed; |^link: found .* made by Driftworld /,
};

function code(fragment) {
  try {
    ask({ call: "decode_link", fragment });
    return "";
  } catch (error) {
    assert.match(error.message, MESSAGES[error.code] ?? /^$/);
    return error.code;
  }
}

test("damaged links give typed errors, never another episode", () => {
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_%=/ é";
  const draw = numbers(2);
  const seen = new Map();
  for (let trial = 0; trial < (full ? 10_000 : 1_000); trial += 1) {
    let text = whole;
    const at = draw(text.length);
    const kind = draw(5);
    if (kind === 0) text = text.slice(0, at);
    else if (kind === 1) text = text.slice(at);
    else if (kind === 2) text = text.slice(0, at) + letters[draw(letters.length)] + text.slice(at + 1);
    else if (kind === 3) text += letters[draw(letters.length)];
    else text = Array.from({ length: draw(400) }, () => letters[draw(letters.length)]).join("");
    if (text === whole) continue;
    const found = code(text);
    seen.set(found, (seen.get(found) ?? 0) + 1);
    if (found === "") assert.deepEqual(ask({ call: "decode_link", fragment: text }), original);
    else assert.match(found, /^link\/(damaged|version)$/, text);
  }
  console.log(`damaged links: ${[...seen].map(([found, count]) => `${found || "the same episode"} ${count}`).join(", ")}`);
  assert.ok((seen.get("link/damaged") ?? 0) > 500);
});

test("hostile links give typed errors", { skip: typeof crc32 === "function" ? false : "this Node.js has no crc32" }, () => {
  const bytes = Buffer.from(whole, "base64url");
  const plain = inflateRawSync(bytes.subarray(5));
  const end = plain.indexOf(10);
  const header = JSON.parse(plain.subarray(0, end).toString());
  const with_ = (changes, numbers = plain.subarray(end + 1), format = 1) => sealed(format, Buffer.concat([Buffer.from(`${JSON.stringify({ ...header, ...changes })}\n`), numbers]));
  const check = (fragment, expected) => assert.equal(code(fragment), expected);
  check(with_({}), "");
  check(with_({}, undefined, 2), "link/version");
  check(with_({ hash: "000000000000" }), "link/version");
  check(with_({ total: "0" }), "link/version");
  check(with_({ request: { task: "no_such_task" } }), "link/version");
  check(with_({ steps: 1e9 }), "link/damaged");
  check(with_({ steps: header.steps + 1 }), "link/damaged");
  check(with_({}, Buffer.alloc(header.steps, 0xff)), "link/damaged");
  check(with_({ more: 1 }), "link/damaged");
  check(sealed(1, Buffer.alloc(1 << 26)), "link/damaged");
  check("A".repeat(1 << 20), "link/damaged");
  check("", "link/damaged");
});
