// Runs every shell command and every Python program that the page offers, and checks its result.
//
// DRIFTWORLD_COMMAND is the command, DRIFTWORLD_PYTHON a Python with the package installed; if either is missing, its half is skipped.

import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtemp, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { load } from "./bundle.mjs";

const run = promisify(execFile);
const commands = await load("commands.ts");
const { TEMPLATES } = await load("templates.ts");
const { DRIFTWORLD_COMMAND: command, DRIFTWORLD_PYTHON: python } = process.env;
const network = fileURLToPath(new URL("../../examples/networks/obstacle_course.safetensors", import.meta.url));

const built = { task: "find_objects", variant: "red", seed: 7, index: 2 };
const own = { task: "my_maze.json", variant: "wide", seed: 0, index: 0 };
const walk = [[2.5, -45, 0], [2.5, -45, 0], [0, 0.1, 1]];
/** Each recipe with a file that it writes, or a text that it prints. */
const RECIPES = {
  "play asks for a terminal": [commands.play(built), { command: /terminal/, fails: true }],
  "the planner is filmed": [commands.film(own, "onrails"), { file: "film.gif" }],
  "a network is filmed": [commands.film({ ...built, task: "obstacle_course", variant: "", index: 0 }, { network }), { file: "film.gif" }],
  "a world is drawn": [commands.sample(own), { file: "world.json" }],
  "a task is checked": [commands.validate("my_maze.json"), { command: /a valid task spec/ }],
  "a distance is measured": [commands.distance("find_objects", "blue", "dusk", "parameters"), { command: /1\.4474/, python: /1\.44/ }],
  "elements are tested": [commands.elements("my_maze.json", "plain", "dusk"), { command: /sound/, python: /light/ }],
  "a sheet is drawn": [commands.sheet("my_maze.json", ["plain", "dusk"], 3), { file: "sheet.png" }],
  "an order is found": [commands.order("find_objects", ["blue", "red", "dusk"], "parameters", "gradual", "blue"), { file: "order.png", python: /dusk/ }],
  "an episode is stepped through": [commands.episode(built, { kind: "continuous" }, walk), { command: /return (-0\.3)/, python: /-0\.3/ }],
  "a logged episode is replayed": [commands.replayLog("log", 0), { file: "episode.gif", python: null }],
};

let folder = "";
before(async () => {
  folder = await mkdtemp(join(tmpdir(), "driftworld-recipes-"));
  // Episodes of 4 seconds: films of long ones take minutes.
  await writeFile(join(folder, "my_maze.json"), TEMPLATES[0].text.replace("\"max_seconds\": 120", "\"max_seconds\": 4"));
  if (!command) return;
  await run(command, ["curriculum", "my_maze.json#plain", "my_maze.json#dusk", "--learn", "1", "--eval-episodes", "1", "-o", "scenario.json"], { cwd: folder });
  await run(command, ["run", "scenario.json", "--agent", "random", "-o", "log", "--record"], { cwd: folder });
});
after(() => rm(folder, { recursive: true, force: true }));

for (const [name, [recipe, expected]] of Object.entries(RECIPES)) {
  test(`${name} by the command`, { skip: !command && "DRIFTWORLD_COMMAND names no command" }, async () => {
    // A shell function lets `driftworld` in the recipe run any build.
    const shell = `driftworld() { "${command}" "$@"; }; ${recipe.command}`;
    const { stdout, stderr } = await run("bash", ["-c", shell], { cwd: folder }).catch((error) => (expected.fails ? error : Promise.reject(error)));
    if (expected.command) assert.match(stdout + stderr, expected.command);
    if (expected.file) assert.ok((await readdir(folder)).includes(expected.file));
  });
  test(`${name} in Python`, { skip: !python && "DRIFTWORLD_PYTHON names no Python" }, async () => {
    const path = command ? `${dirname(command)}:${process.env.PATH}` : process.env.PATH;
    const { stdout } = await run(python, ["-c", recipe.python], { cwd: folder, env: { ...process.env, PATH: path } });
    if (expected.python) assert.match(stdout, expected.python);
  });
}
