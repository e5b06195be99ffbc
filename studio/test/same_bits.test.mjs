// The simulator gives bit-identical answers natively, in Node and in Chromium: worlds, distances, decisions, rewards and pictures.
// `DRIFTWORLD_FULL=1` compares 10,000 frames instead of 400.

import assert from "node:assert/strict";
import { test } from "node:test";
import { browserPath, launch, serve } from "./browser.mjs";
import { built, native, network, started } from "./node.mjs";
import { answers, groups } from "./script.mjs";

const full = process.env.DRIFTWORLD_FULL !== undefined;
const calls = groups(full);
const expected = native(calls);
/** Minimum number of answers in each group, in a full run. */
const MIN_ANSWERS = { frames: 20_000, worlds: 100, distances: 100 };

function same(found) {
  for (const [place, own] of expected.entries()) {
    assert.deepEqual([found[place].name, found[place].answers, found[place].hash], [own.name, own.answers, own.hash]);
    assert.ok(!full || own.answers >= (MIN_ANSWERS[own.name] ?? 0), `${own.name}: found ${own.answers} answers`);
  }
  for (const { name, answers, frames, seconds } of found) {
    console.log(`${name}: ${answers} answers, ${frames} frames, ${seconds.toFixed(2)} s; on the machine ${expected.find((own) => own.name === name).seconds.toFixed(2)} s`);
  }
}

test("answers in Node equal native answers", { skip: full && browserPath() ? "compared in Chromium" : false }, async () => {
  const call = await started();
  same(await answers(calls, async (one, bytes) => call(one, bytes), network));
});

test("one changed answer changes the hash", async () => {
  const call = await started();
  const changed = (one, bytes) => {
    const answer = call(one, bytes);
    return { ...answer, json: one.call === "sample" && one.request.index === 1 ? answer.json.replace("1", "2") : answer.json };
  };
  const worlds = groups(false).filter(({ name }) => name === "worlds");
  const [[right], [wrong]] = [await answers(worlds, async (one) => call(one), network), await answers(worlds, async (one) => changed(one), network)];
  assert.notEqual(right.hash, wrong.hash);
});

test("answers in Chromium equal native answers", { skip: browserPath() ? false : "no Chromium" }, async () => {
  const server = await serve(built);
  const browser = await launch();
  try {
    const page = await browser.page();
    // A page of the same origin in which nothing else runs.
    await page.goto(`${server.address}networks/index.json`);
    const found = await page.evaluate(`(async () => {
      const worker = new Worker(new URL("/worker.js", location.href), { type: "module" });
      const waiting = new Map();
      worker.onmessage = ({ data }) => {
        const { resolve, reject } = waiting.get(data.id) ?? {};
        data.failed === undefined ? resolve?.(data) : reject?.(new Error(data.failed));
      };
      const ready = new Promise((resolve, reject) => waiting.set(-1, { resolve, reject }));
      await ready;
      let id = 0;
      const call = (call, bytes) => new Promise((resolve, reject) => {
        id += 1;
        waiting.set(id, { resolve, reject });
        worker.postMessage({ id, call, ...(bytes ? { bytes } : {}) });
      });
      const network = async (name) => new Uint8Array(await (await fetch("/networks/" + name + ".safetensors")).arrayBuffer());
      return (${answers})(${JSON.stringify(calls)}, call, network);
    })()`);
    same(found);
  } finally {
    await browser.close();
    server.close();
  }
});
