// Tests the engine on a page in Chromium: loading, speed, stopping, limits, and documents built to take forever.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { build } from "esbuild";
import { join } from "node:path";
import { browserPath, launch, serve } from "./browser.mjs";
import { built, root } from "./node.mjs";

const skip = browserPath() ? false : "no Chromium";
let [server, browser, page] = [];

before(async () => {
  if (skip) return;
  server = await serve(built);
  browser = await launch();
  page = await browser.page();
  await page.goto(`${server.address}networks/index.json`);
  const bundled = await build({
    entryPoints: [join(root, "studio/src/engine.ts")], bundle: true, format: "iife", globalName: "driftworld", write: false, logLevel: "warning",
  });
  await page.evaluate(`${bundled.outputFiles[0].text}; window.begin = (limit) => driftworld.createEngine({ limit, base: new URL("/", location.href).href });`);
});

after(async () => {
  await browser?.close();
  server?.close();
});

test("the simulator starts, plays and draws", { skip }, async () => {
  const found = await page.evaluate(async () => {
    const engine = window.begin(10_000);
    const { version, milliseconds } = await engine.ready();
    const cards = await engine.tasks();
    const speed = async (looks, width, height) => {
      const open = () => engine.open({ task: "find_objects", variant: "red" }, { looks, width, height });
      let [episode, frames] = [await open(), 0];
      const begun = performance.now();
      for (; performance.now() - begun < 1500; frames += 1) {
        const now = await episode.step({ ahead: 1, turn: frames % 7 ? 0.3 : -1, interact: false });
        if (now.terminated || now.truncated) {
          await episode.close();
          episode = await open();
        }
        const { data } = await episode.frame();
        if (data.length !== width * height * 4) throw new Error("a frame has another size");
      }
      const each = (frames * 1000) / (performance.now() - begun);
      await episode.close();
      return Math.round(each);
    };
    const speeds = { plain: await speed("plain", 320, 240), natural: await speed("natural", 320, 240), small: await speed("natural", 84, 84) };
    engine.stop();
    return { version, milliseconds, cards: cards.length, speeds };
  });
  console.log(`the simulator is loaded in ${found.milliseconds.toFixed(0)} ms; steps with frames a second, at 320 x 240 plain ${found.speeds.plain}, natural ${found.speeds.natural}, at 84 x 84 ${found.speeds.small}`);
  assert.ok(found.cards > 50);
  assert.match(found.version, /^\d+\.\d+\.\d+$/);
  // A few times the documented limits, for busy machines.
  assert.ok(found.milliseconds < 5000 && found.speeds.plain > 20);
});

test("an episode is played, rewound, linked and replayed", { skip }, async () => {
  const found = await page.evaluate(async () => {
    const engine = window.begin(10_000);
    const episode = await engine.open({ task: "door_key", seed: 2 }, { looks: "natural" });
    const steps = [];
    for (let step = 0; step < 150; step += 1) {
      const now = await episode.act("planner");
      steps.push(now);
      if (now.terminated || now.truncated) break;
    }
    const hash = ({ data }) => data.reduce((sum, byte) => (Math.imul(sum, 31) + byte) | 0, 7);
    const last = hash(await episode.frame());
    const middle = await episode.seek(20);
    const fragment = await engine.encodeLink({ request: episode.request, looks: "natural", actions: await episode.actions() });
    const link = await engine.decodeLink(fragment);
    const again = await engine.open(link.request, { looks: link.looks });
    await again.steps(link.actions);
    const map = await again.map();
    const above = await again.frame("above");
    const wrong = await engine.decodeLink(`${fragment}A`).catch((error) => error.code);
    const bad = await engine.validate('{ "name": "x",\\n  "parameters": 3 }');
    engine.stop();
    return { middle, at20: steps[19], last, again: hash(await again.frame().catch(() => ({ data: new Uint8Array() }))), wrong, bad, objects: map.objects.length, above: above.data.length };
  });
  assert.deepEqual(found.middle, found.at20);
  assert.match(found.wrong, /^link\//);
  assert.ok(found.bad.problems.length > 0 && found.bad.problems[0].line > 0, JSON.stringify(found.bad));
  assert.ok(found.objects > 0 && found.above > 0);
});

test("a call that takes too long or is stopped ends, and the next one works", { skip }, async () => {
  const found = await page.evaluate(async () => {
    const engine = window.begin(3000);
    await engine.ready();
    const episode = await engine.open({ task: "maze" });
    const code = (promise) => promise.then(() => "", (error) => error.code);
    const slow = () => engine.distance({ task: "find_objects", variant: "red" }, { task: "find_objects", variant: "blue" }, { by: "behavior", worlds: 1000 });
    const timeout = await code(slow());
    const lost = await code(episode.now());
    const running = code(slow());
    const waiting = code(engine.measures());
    setTimeout(() => engine.stop(), 200);
    const stopped = [await running, await waiting];
    const measures = (await engine.measures()).length;
    engine.stop();
    return { timeout, lost, stopped, measures };
  });
  assert.deepEqual([found.timeout, found.lost, ...found.stopped], ["engine/timeout", "engine/lost", "engine/stopped", "engine/stopped"]);
  assert.ok(found.measures > 10);
});

test("no document blocks the page for a second", { skip }, async () => {
  const found = await page.evaluate(async () => {
    const limit = 1000;
    const engine = window.begin(limit);
    await engine.ready();
    let [longest, last] = [0, performance.now()];
    const ticking = setInterval(() => {
      longest = Math.max(longest, performance.now() - last);
      last = performance.now();
    }, 10);
    const object = '{ "class": "geometric", "coordinates": [1, 1] }';
    const group = (count) => `{ "name": "x", "groups": [{ "name": "g", "count": ${count}, "object": { "class": "geometric" }, "placement": { "annulus": { "center": [0, 0], "inner": 4.5, "outer": 6.4 } } }] }`;
    const maze = (side) => `{ "environment_params": { "layout": { "maze": { "cells": [${side}, ${side}], "cell": 1, "seed": 1 } } } }`;
    const texts = {
      objects: `{ "objects": [${Array(100_000).fill(object).join(",")}] }`,
      nested: `${'{"a":'.repeat(100_000)}1${"}".repeat(100_000)}`,
      lists: `${"[".repeat(500_000)}`,
      count: group(1e9),
      many: group(1e5),
      maze: maze(100_000),
      large: maze(400),
      long: `{ "name": "${"x".repeat(4_000_000)}" }`,
      keys: `{ ${Array.from({ length: 100_000 }, (_, key) => `"k${key}": 1`).join(",")} }`,
      number: '{ "objects": [{ "class": "car", "coordinates": [1e308, -1e308], "scale": 1e308 }] }',
    };
    const results = {};
    for (const [name, text] of Object.entries(texts)) {
      const begun = performance.now();
      const validated = await engine.validate(text).then(({ problems }) => `${problems.length} problems`, (error) => error.code);
      const request = text.includes('"name"') ? { task: text } : { world: text };
      const opened = await engine.open(request).then(async (episode) => {
        await episode.step({ ahead: 1, turn: 0, interact: false });
        const { width } = await episode.frame();
        return `a frame of ${width}`;
      }).catch((error) => error.code);
      results[name] = { validated, opened, milliseconds: Math.round(performance.now() - begun) };
    }
    clearInterval(ticking);
    const measures = (await engine.measures()).length;
    engine.stop();
    return { results, longest, measures };
  });
  for (const [name, { validated, opened, milliseconds }] of Object.entries(found.results)) console.log(`${name}: ${validated}, ${opened}, ${milliseconds} ms`);
  console.log(`longest wait of the page: ${found.longest.toFixed(0)} ms`);
  assert.ok(found.longest < 1000);
  assert.ok(found.measures > 10);
});
