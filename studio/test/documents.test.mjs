// Tests the text of documents: positions, changes, completion and text layouts; and that templates are valid JSON.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { load } from "./bundle.mjs";

const { applyChange, change, cursorAt, oneLine, pathOf, removal, same, spanAt, spans } = await load("json_text.ts");
const { suggestions } = await load("schema.ts");
const { pointGroups, textLayouts, withLetter } = await load("layouts.ts");
const { writtenParameters } = await load("written.ts");
const { TEMPLATES } = await load("templates.ts");

const TEXT = `{
  "name": "a\\"b", "list": [1, [2, 3]],
  "empty": {}, "none": [],
  "deep": {
    "x": 1,
    "y": -2.5e3
  }
}
`;
const at = (path, text = TEXT) => {
  const span = spanAt(spans(text), path);
  return span && text.slice(span.from, span.to);
};
const changed = (path, value, text = TEXT) => applyChange(text, change(text, path, value));

test("spans finds every value of a document, and nothing in invalid JSON", () => {
  assert.equal(at(["name"]), '"a\\"b"');
  assert.equal(at(["list", 1, 0]), "2");
  assert.equal(at(["deep", "y"]), "-2.5e3");
  assert.equal(at(["deep", "z"]), null);
  for (const broken of ["", "{", '{"a" 1}', "[1,,2]", "[1] 2", "{a: 1}", "[".repeat(5000), '{"a": 01}']) assert.equal(spans(broken), null, broken);
});

test("a change replaces one value and leaves the rest", () => {
  assert.equal(changed(["deep", "x"], 7), TEXT.replace('"x": 1', '"x": 7'));
  assert.deepEqual(JSON.parse(changed(["list", 1], { a: [true, null] })).list, [1, { a: [true, null] }]);
});

test("a new member is formatted like its neighbours", () => {
  assert.match(changed(["deep", "z"], 3), /-2\.5e3,\n {4}"z": 3\n/);
  assert.match(changed(["empty", "k"], "v"), /"empty": \{ "k": "v" \}/);
  assert.match(changed(["list", 2], 9), /\[1, \[2, 3\], 9\]/);
  assert.match(changed(["none", 0], 9), /"none": \[9\]/);
  assert.equal(change(TEXT, ["absent", "k"], 1), null);
});

test("a removal also removes the comma", () => {
  const without = (path) => JSON.parse(applyChange(TEXT, removal(TEXT, path)));
  assert.deepEqual(without(["list", 0]).list, [[2, 3]]);
  assert.deepEqual(without(["list", 1]).list, [1]);
  assert.deepEqual(without(["deep", "y"]).deep, { x: 1 });
  assert.equal(removal(TEXT, ["list", 5]), null);
});

test("pointers become paths", () => {
  assert.deepEqual(pathOf("/objects/3/a~1b~0c"), ["objects", 3, "a/b~c"]);
  assert.deepEqual(pathOf(""), []);
});

test("a cursor knows its path in an unfinished text", () => {
  const where = (text) => {
    const { path, at: kind, keys } = cursorAt(text, text.length);
    return [path.join("/"), kind, keys.join()];
  };
  assert.deepEqual(where('{"a": {"b": 1, "c'), ["a", "key", "b"]);
  assert.deepEqual(where('{"a": {"b": '), ["a/b", "value", "b"]);
  assert.deepEqual(where('{"a": [1, {"x": 2}, '), ["a/2", "value", ""]);
  assert.deepEqual(where('{"a": "tru'), ["a", "value", "a"]);
  assert.equal(cursorAt('{"a": tr', 8).from, 6);
});

test("completion follows the schema of tasks, and the task's own parameters", async () => {
  const schema = JSON.parse(await readFile(new URL("../../schemas/task.schema.json", import.meta.url), "utf8"));
  const offered = (text, task = null) => suggestions(schema, cursorAt(text, text.length), task).map(({ insert }) => insert);
  assert.ok(offered("{").includes('"parameters"'));
  assert.ok(!offered('{"parameters": {}, ').includes('"parameters"'));
  assert.ok(offered('{"world": {"environment_params": {"layout": {').includes('"maze"'));
  assert.ok(offered('{"parameters": {"x": {"role": ').includes('"variant"'));
  assert.deepEqual(offered('{"nonsense": {'), []);
  const task = { parameters: [{ name: "light", role: "variant", type: "number", description: null, choices: [{ value: 1, name: null }, { value: [2], name: "two" }] }] };
  assert.ok(offered('{"variants": {"dusk": {', task).includes('"light"'));
  assert.deepEqual(offered('{"variants": {"dusk": {"light": ', task).slice(0, 2), ["1", '"two"']);
  assert.ok(offered('{"world": {"max_steps": {"param": ', task).includes('"light"'));
});

test("text layouts and groups at listed points are found in a task", () => {
  const documents = TEMPLATES.map(({ text }) => JSON.parse(text));
  assert.deepEqual(documents.map((document) => textLayouts(document).length), [0, 1, 0]);
  const [layout] = textLayouts(documents[1]);
  assert.deepEqual(layout.letters.map(({ letter, meaning }) => `${letter} ${meaning}`), ["# wall", ". floor", "A start", "G ball"]);
  assert.deepEqual(spanAt(spans(TEMPLATES[1].text), layout.path).items.length, layout.rows.length);
  assert.equal(withLetter("#..#", 2, "G"), "#.G#");
  assert.deepEqual(pointGroups(documents[2]).map(({ name, points }) => [name, points.length]), [["rocks", 3]]);
  assert.deepEqual(pointGroups(null), []);
});

test("one-line JSON parses to the same value", () => {
  const value = { a: [1, "x", { b: null }], c: {} };
  assert.equal(oneLine(value), '{ "a": [1, "x", { "b": null }], "c": {} }');
  assert.deepEqual(JSON.parse(oneLine(value)), value);
});

test("values are equal regardless of key order", () => {
  assert.ok(same({ a: [1, { b: 2, c: null }] }, { a: [1, { c: null, b: 2 }] }));
  for (const [a, b] of [[{ a: 1 }, { a: 1, b: 1 }], [[1, 2], [2, 1]], [{}, []], [null, {}], ["1", 1], [{ a: 1 }, { b: 1 }]]) assert.ok(!same(a, b));
});

test("choices of parameters are shown as written", () => {
  const text = '{"parameters": {"c": {"choices": ["gold"]}, "l": {"choices": {"big": {"maze": {}}}}, "n": {}}}';
  const full = [1, 0.84, 0];
  const parameters = [
    { name: "c", choices: [{ value: full, name: null }] }, { name: "l", choices: [{ value: { maze: { braid: 0 } }, name: "big" }] }, { name: "n", choices: null },
  ];
  const [color, layout, number] = writtenParameters({ text, parameters });
  assert.deepEqual(color.choices, [{ value: "gold", full, name: null }]);
  assert.deepEqual(layout.choices, [{ value: { maze: {} }, full: { maze: { braid: 0 } }, name: "big" }]);
  assert.equal(number.choices, null);
});
