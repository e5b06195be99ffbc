// Tests the page's own logic: addresses, commands, maps, differences, timelines, curves and keys.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./bundle.mjs";

const { hrefOf, parseRoute, wholeNumber } = await load("route.ts");
const commands = await load("commands.ts");
const { scaleOf, toMetres, toPixels, whatIsAt } = await load("map_view.ts");
const { outlines } = await load("difference.ts");
const { nextMoment, moveLoopEnd, marks } = await load("timeline.ts");
const { curves, trailingMeans } = await load("curve.ts");
const { copyOf, nameIn } = await load("draft.ts");
const { placeLabels } = await load("labels.ts");
const { amount, describeRewards } = await load("pay.ts");
const { inputOf, hasInput } = await load("keys.ts");

test("addresses survive a round trip", () => {
  const { view, task, options } = parseRoute(hrefOf("play", "a b/c", { variant: "x&y", seed: 3, index: undefined }));
  assert.deepEqual([view, task, options], ["play", "a b/c", { variant: "x&y", seed: "3" }]);
  assert.deepEqual(parseRoute("#1AbC_-"), { view: "replay", task: "", options: {}, link: "1AbC_-", unknown: null });
  assert.deepEqual([parseRoute("#/foo/bar").view, parseRoute("#/foo/bar").unknown, parseRoute("").unknown], ["gallery", "/foo/bar", null]);
  assert.equal(parseRoute("#/play/%E0%A4%A").task, "%E0%A4%A");
  assert.deepEqual(["7", "-1", "1e99", "x", undefined].map(wholeNumber), [7, 0, 0, 0, 0]);
});

test("a copy of a task gets a new name", () => {
  const text = '{\n  "version": 2,\n  "name": "maze",\n  "groups": [{ "name": "maze" }]\n}';
  assert.equal(copyOf(text), text.replace("maze", "my_maze"));
  assert.deepEqual([nameIn(copyOf(text)), nameIn("{}")], ["my_maze", "my_task"]);
});

test("commands quote what a shell would read", () => {
  const subject = { task: "it's.json", variant: "a b", seed: 7, index: 0 };
  assert.equal(commands.play(subject).command, "driftworld play 'it'\\''s.json#a b' --seed 7");
  assert.equal(commands.shellWord("maze#small"), "maze#small");
  assert.equal(commands.shellWord("#x"), "'#x'");
  assert.equal(commands.shellWord("$(rm -r x)"), "'$(rm -r x)'");
  assert.equal(commands.pythonText('a"\n'), '"a\\"\\n"');
});

test("equal actions of an episode are counted", () => {
  const walk = [[1, 0, 0], [1, 0, 0], [0, 5, 0]];
  assert.deepEqual(commands.runs(walk), [{ action: [1, 0, 0], times: 2 }, { action: [0, 5, 0], times: 1 }]);
  const subject = { task: "maze", variant: "", seed: 0, index: 2 };
  const { command, python } = commands.episode(subject, { kind: "continuous" }, walk);
  assert.equal(command, "printf 'step 2 1 0 0\\nstep 1 0 5 0\\n' | driftworld console maze --index 2");
  assert.match(python, /actions="continuous"/);
  assert.match(commands.episode(subject, { kind: "discrete" }, [3, 3]).command, /step 2 3\\n/);
});

const MAP = {
  width: 20, depth: 10, agent: { x: 0, y: 0, heading: 0, radius: 0.5 },
  walls: [{ points: [[5, 2], [7, 2], [7, 4], [5, 4]], closed: true, color: [0, 0, 0] }],
  zones: [{ name: "mud", points: [[-9, -4], [-5, -4], [-5, -1], [-9, -1]], color: [0, 0, 0], visible: true }],
  objects: [
    { index: 0, class: "door", tag: "gate", x: -3, y: 3, radius: 0.5, reward: 0, present: true, open: true },
    { index: 1, class: "geometric", tag: null, x: 3, y: -3, radius: 0.5, reward: 100, present: true, open: false },
    { index: 2, class: "geometric", tag: null, x: 8, y: -4, radius: 0.5, reward: 1, present: false, open: false },
  ],
};

test("map points convert from metres to pixels and back", () => {
  const scale = scaleOf(MAP, 420);
  assert.deepEqual([scale.pixelsPerMetre, scale.height], [20, 220]);
  assert.deepEqual(toPixels(scale, [1, 2]), [230, 70]);
  assert.deepEqual(toMetres(scale, toPixels(scale, [-3.5, 4])), [-3.5, 4]);
});

test("a map describes what is at a point", () => {
  const described = (x, y) => whatIsAt(MAP, [x, y]);
  assert.deepEqual(described(-3, 3.2), { text: "gate (door), open", object: 0 });
  assert.deepEqual(described(3, -3), { text: "geometric, pays 100", object: 1 });
  assert.equal(described(0.2, 0).text, "the agent");
  assert.match(described(6, 3).text, /^wall/);
  assert.match(described(-7, -2).text, /^zone mud/);
  assert.deepEqual(described(8, -4), { text: "8.0 m east, -4.0 m north", object: null });
});

test("differences are outlined where they are", () => {
  const blank = () => ({ width: 20, height: 12, data: new Uint8ClampedArray(20 * 12 * 4) });
  const [a, b] = [blank(), blank()];
  assert.deepEqual(outlines(a, b), []);
  b.data[4 * (9 * 20 + 18)] = 200;
  const lines = outlines(a, b);
  assert.deepEqual(lines.toSorted().map(String), ["16,12,20,12", "16,8,16,12", "16,8,20,8", "20,8,20,12"]);
  b.data[4 * (9 * 20 + 18)] = 20;
  assert.deepEqual(outlines(a, b), [], "a difference that shading may cause");
  assert.deepEqual(outlines(a, { ...b, width: 10 }), []);
});

test("labels of a map cover no point and no other label", () => {
  const crowd = Array.from({ length: 40 }, (_, at) => ({ x: 100 + ((at * 37) % 90), y: 60 + ((at * 53) % 70), texts: [`${at + 1} variant`, `${at + 1}`] }));
  const labels = placeLabels(crowd, 300, 200);
  const boxes = [...labels.flatMap((label) => label?.box ? [label.box] : []), ...crowd.map(({ x, y }) => [x - 5, y - 5, x + 5, y + 5])];
  const shown = labels.filter(Boolean).length;
  assert.equal(labels[0].text, "1 variant");
  assert.ok(shown >= 5 && shown < 40, `found ${shown} labels`);
  boxes.slice(0, shown).forEach((a, place) => boxes.forEach((b, other) => {
    assert.ok(place === other || a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1], `${a} on ${b}`);
  }));
  assert.deepEqual(placeLabels([{ x: 5, y: 5, texts: ["too long for this"] }], 60, 40), [null]);
});

test("rewards of a world fit on one line", () => {
  const touched = { reward_once_stimulus: ["AgentCollide"] };
  const world = {
    max_steps: 0, max_seconds: 120, rules: { step_reward: 0, reward_per_second: -0.5 },
    objects: [{ class: "geometric", tag: "goal", reward: 100, ...touched }, { class: "rock", reward: -0.5, ...touched }, { class: "rock", reward: -0.5, ...touched }, { class: "tree", reward: 9 }],
    environment_params: { zones: [{ name: "hot_place", reward_on_entering: -3 }, { name: "sand" }] },
  };
  assert.equal(describeRewards(JSON.stringify(world), 0.1), "goal +100 · rock −0.5 · hot place −3 · every step −0.05 · ends after 120 s");
  const seldom = { objects: [{ class: "barrel", tag: "others", reward: 1, reward_probability: 0.1, ...touched }] };
  assert.equal(describeRewards(JSON.stringify(seldom), 0.1), "others +1, 10 % of the time");
  assert.equal(describeRewards(JSON.stringify({ max_steps: 300, objects: [] }), 0.1), "ends after 300 steps");
  assert.equal(describeRewards(JSON.stringify({ rules: { reward_per_second: -0.02 }, objects: [] }), 0.1), "every step −0.002");
  assert.deepEqual([3, -0.125, -7].map(amount), ["3", "−0.13", "−7"]);
});

test("timelines mark what is unusual, and loops keep to their ends", () => {
  const step = (number, reward, events = []) => ({ step: number, reward, events });
  const found = marks([step(1, -1), step(2, -1), step(3, 50), step(4, -1, [{ tag: "door", effect: "picked_up", stimulus: "" }])]);
  assert.deepEqual(found, [{ step: 3, reward: 50, text: "" }, { step: 4, reward: -1, text: "door picked up" }]);
  assert.equal(nextMoment(4, 9, null), 5);
  assert.equal(nextMoment(9, 9, null), null);
  assert.equal(nextMoment(6, 9, { from: 2, to: 6 }), 2);
  assert.deepEqual(moveLoopEnd(null, "to", 4, 9), { from: 0, to: 4 });
  assert.deepEqual(moveLoopEnd({ from: 0, to: 4 }, "from", 7, 9), { from: 7, to: 7 });
});

test("curves are means of learning rewards, task by task", () => {
  assert.deepEqual(trailingMeans([1, 3, 5, 7], 2), [1, 2, 4, 6]);
  const episode = (experience, task, reward, type = "train") => ({ experience, task, reward, block_type: type });
  const found = curves([episode(0, "a", 1), episode(1, "b", 5), episode(2, "a", 3, "test"), episode(3, "a", Number.NaN)]);
  assert.deepEqual(found, [{ task: "a", learned: [[0, 1]], tested: [[2, 3]] }, { task: "b", learned: [[1, 5]], tested: [] }]);
});

test("opposite keys cancel out", () => {
  assert.deepEqual(inputOf(new Set(["ArrowUp", "KeyD", "Space"])), { ahead: 1, turn: 1, interact: true });
  assert.equal(hasInput(inputOf(new Set(["ArrowUp", "KeyS", "KeyX"]))), false);
});
