// Typical user tasks, done with the keyboard alone in headless Chromium.
//
// DRIFTWORLD_PAGE is the built page, DRIFTWORLD_COMMAND the command that writes a log to drop. With DRIFTWORLD_SHOTS, each task saves
// screenshots of the page into that folder: on a desktop in light and dark mode, and on a phone.

import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { browserPath, launch, overflow, SCREENS, serve, shot } from "./browser.mjs";

const { DRIFTWORLD_PAGE: folder, DRIFTWORLD_COMMAND: command } = process.env;
const skip = (!folder && "DRIFTWORLD_PAGE names no built page") || (!browserPath() && "there is no Chromium");
/** Time within which even a busy machine draws its first world. */
const TIMEOUT_MS = 60_000;

let server;
let browser;
before(async () => {
  if (skip) return;
  server = await serve(folder);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
});

/** Opens an address, performs a task, checks that the page has no errors and no overflow, and takes screenshots. */
function task(name, address, does) {
  test(name, { skip, timeout: 5 * TIMEOUT_MS }, async () => {
    const page = await browser.page();
    page.setDefaultTimeout(TIMEOUT_MS);
    await page.goto(server.address + address);
    await does(page);
    for (const [screen, { width, height, scheme }] of Object.entries(SCREENS)) {
      await page.emulateMedia({ colorScheme: scheme, reducedMotion: "reduce" });
      await page.setViewportSize({ width, height });
      // Wait for the new layout before the screenshot.
      await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      await shot(page, `${name.split(":")[0].replaceAll(" ", "-")}-${screen}`);
      assert.deepEqual(await overflow(page), [], `${name}, ${screen}`);
    }
    assert.deepEqual(page.faults, []);
    await page.context().close();
  });
}

/** The accessible name of the focused element. */
const focused = (page) => page.evaluate(() => {
  const host = document.activeElement;
  const element = host?.shadowRoot?.activeElement ?? host;
  return (element?.getAttribute("aria-label") ?? element?.labels?.[0]?.firstChild?.textContent ?? element?.textContent ?? "").trim();
});

/** Presses Tab until the element with this name has the focus. */
async function tabTo(page, name) {
  const matches = (found) => (typeof name === "string" ? found === name : name.test(found));
  for (let presses = 0; presses < 250; presses += 1) {
    if (matches(await focused(page))) return;
    await page.keyboard.press("Tab");
  }
  assert.fail(`Tab never reaches ${name}`);
}

/** Chooses an entry of a list by typing its first letters. */
async function choose(page, list, entry) {
  await tabTo(page, list);
  await page.keyboard.type(entry);
}

const text = (page, selector) => page.locator(selector).first().innerText();
const until = (page, works, ...given) => page.waitForFunction(works, ...given, { polling: 100 });
/** The number of steps that a seat has taken. */
const stepsOf = async (page, seat) => Number(/step (\d+)/.exec(await text(page, `section.seat[aria-label="${seat}"] footer`))[1]);
const untilSteps = (page, seat, least) => until(page, ([name, count]) => {
  const found = /step (\d+)/.exec(document.querySelector(`section.seat[aria-label="${name}"] footer`)?.textContent ?? "");
  return found !== null && Number(found[1]) >= count;
}, [seat, least]);
/** A hash of the pixels of a picture. */
const hash = (selector) => {
  const canvas = document.querySelector(selector);
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.reduce((sum, byte) => (Math.imul(sum, 31) + byte) | 0, 7);
};
const pixels = (page, selector) => page.evaluate(hash, selector);
/** Waits until a picture has these pixels, or others. */
async function untilPixels(page, selector, wanted, isSame) {
  const end = Date.now() + TIMEOUT_MS;
  while (((await pixels(page, selector)) === wanted) !== isSame) {
    assert.ok(Date.now() < end, `${selector} ${isSame ? "never has the pixels expected" : "does not change"}`);
    await page.waitForTimeout(100);
  }
}
/** Runs a function in a temporary folder. */
async function inFolder(does) {
  const place = await mkdtemp(join(tmpdir(), "driftworld-page-"));
  try {
    await does(place);
  } finally {
    await rm(place, { recursive: true, force: true });
  }
}
const walk = async (page, seat, least) => {
  await page.keyboard.down("ArrowUp");
  await untilSteps(page, seat, least);
  await page.keyboard.up("ArrowUp");
};

task("01 gallery: find a task, and play it", "", async (page) => {
  await page.waitForSelector(".gallery .card");
  assert.match(await text(page, ".head p"), /^\d+ tasks with \d+ variants/);
  await tabTo(page, "Search");
  await page.keyboard.type("dead ends");
  await until(page, () => document.querySelectorAll(".gallery .card").length < 5);
  await page.keyboard.press("Control+A");
  await page.keyboard.type("no such thing");
  await page.waitForSelector(".empty");
  await tabTo(page, "Show all");
  await page.keyboard.press("Enter");
  await tabTo(page, "Play find_objects");
  await until(page, () => new Set(document.querySelector(".gallery canvas").getContext("2d").getImageData(0, 0, 99, 99).data).size > 9);
});

task("02 play: walk, and begin again", "#/play/find_objects?variant=blue", async (page) => {
  await page.waitForSelector(".seat");
  const before = await pixels(page, ".seat canvas");
  assert.match(await focused(page), /^Your view/);
  await walk(page, "You", 10);
  assert.notEqual(await pixels(page, ".seat canvas"), before);
  await page.keyboard.press("KeyR");
  await until(page, () => / 0 ·/.test(document.querySelector(".seat footer")?.textContent ?? ""));
  await untilPixels(page, ".seat canvas", before, true);
  await walk(page, "You", 5);
});

task("03 planner: it plays beside you", "#/play/maze?variant=small", async (page) => {
  await page.waitForSelector(".seat");
  await tabTo(page, "Planner");
  await page.keyboard.press("Enter");
  await page.waitForSelector('.seat[aria-label="Planner"]');
  await tabTo(page, "6 times real time");
  await page.keyboard.press("Enter");
  await tabTo(page, "Go");
  await page.keyboard.press("Enter");
  await until(page, () => document.activeElement.matches(".frame"), undefined);
  await page.waitForSelector('.seat[aria-label="Planner"] .tag.good', { timeout: 2 * TIMEOUT_MS });
});

task("04 policy: where it fails", "#/play/obstacle_course?with=policy", async (page) => {
  await page.waitForSelector('.seat[aria-label="Trained policy"]');
  await walk(page, "Trained policy", 10);
  await tabTo(page, "Show me where the policy fails");
  await page.keyboard.press("Enter");
  await until(page, () => /It (succeeds in worlds|fails in world) \d+/.test(document.body.textContent), undefined);
  await page.selectOption("label.field:has-text('Variant') select", { index: 2 });
  await until(page, () => !/It (succeeds|fails) in/.test(document.body.textContent), undefined);
});

task("05 share: an episode is a link", "#/play/four_rooms?seed=3", async (page) => {
  await page.waitForSelector(".seat");
  await walk(page, "You", 12);
  await page.keyboard.press("KeyP");
  await page.waitForSelector(".seat .tag");
  // Let a running step finish.
  await page.waitForTimeout(500);
  await tabTo(page, "Share as a link");
  await page.keyboard.press("Enter");
  await page.waitForSelector('input[aria-label="The link"]');
  const [link, steps, last] = [await page.inputValue('input[aria-label="The link"]'), await stepsOf(page, "You"), await pixels(page, ".seat canvas")];
  assert.ok(link.split("#")[1].length <= 2048);
  if (command) {
    await tabTo(page, "Save");
    const [saved] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
    await inFolder(async (place) => {
      await saved.saveAs(join(place, saved.suggestedFilename()));
      const { stdout } = await promisify(execFile)(command, ["replay", "episode.jsonl"], { cwd: place });
      assert.match(stdout, new RegExp(`${steps} steps .*as recorded`), "the command replays what the page recorded");
    });
  }
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForSelector(".timeline");
  await page.keyboard.press("End");
  await until(page, (count) => document.querySelector(".seat footer").textContent.includes(`step ${count} of ${count}`), steps);
  await untilPixels(page, ".seat canvas", last, true);
  await page.goto("about:blank");
  await page.goto(`${link.slice(0, -5)}AAAAA`);
  await page.waitForSelector(".note.bad");
});

task("06 author: a mistake at its place, undone, and a slider", "#/author", async (page) => {
  await page.waitForSelector(".editor");
  await choose(page, "New from", "a maze");
  await page.waitForSelector(".note.good");
  const before = await pixels(page, ".views canvas");
  await tabTo(page, "Text of the task");
  await page.keyboard.press("Control+Home");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Backspace");
  await page.keyboard.type("99");
  await page.waitForSelector(".problems button");
  assert.match(await text(page, ".problems button"), /^2:\d+ /);
  await shot(page, "06-author-mistake");
  await page.keyboard.press("Control+Z");
  await page.waitForSelector(".note.good");
  await page.locator("#knob-light").focus();
  await page.keyboard.press("Home");
  await untilPixels(page, ".views canvas", before, false);
});

task("07 letters: a wall is built on a map", "#/author", async (page) => {
  await page.waitForSelector(".editor");
  await choose(page, "New from", "a map");
  await page.waitForSelector(".cells");
  await tabTo(page, /^row 1, column 1/);
  for (const key of ["ArrowDown", "ArrowRight", "ArrowRight", "#"]) await page.keyboard.press(key);
  await page.waitForSelector('[aria-label="row 2, column 3: wall"]');
  assert.match(await page.evaluate(() => localStorage.getItem("driftworld.draft")), /"#\.#\.\.#\.\.\.\.#"/);
  await page.waitForSelector(".note.good");
});

task("08 compare: two variants under one set of actions", "#/compare/find_objects", async (page) => {
  await page.waitForSelector(".seat");
  await choose(page, "Right", "dusk");
  await page.waitForSelector('.seat[aria-label="dusk"]');
  await page.waitForSelector(".meter");
  await page.locator(".seat .frame").first().focus();
  await walk(page, "dusk", 6);
  // Both take every action; one may be shown a moment after the other.
  await until(page, () => new Set([...document.querySelectorAll(".seat footer")].map((footer) => /step \d+/.exec(footer.textContent)?.[0])).size === 1);
  assert.match(await text(page, 'section[aria-label="Distance"]'), /1\.447 apart/);
  assert.match(await text(page, 'section[aria-label="Distance"] tbody'), /Observation\s+1\.447/);
  await tabTo(page, "Let the planner lead");
  await page.keyboard.press("Enter");
  await untilSteps(page, "dusk", 20);
  await page.keyboard.press("Enter");
  await tabTo(page, "Test what differs in their worlds");
  await page.keyboard.press("Enter");
  await page.waitForSelector("ul.plain", { timeout: 3 * TIMEOUT_MS });
});

task("09 order: walk along it", "#/order/find_objects", async (page) => {
  await page.waitForSelector("svg.plot");
  await choose(page, "Method", "outward");
  await until(page, () => location.hash.includes("outward"));
  await page.waitForSelector("svg.plot");
  await tabTo(page, "Along the order");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await until(page, () => document.body.textContent.includes("3 of "));
  assert.match(await text(page, "ol.picks [aria-current]"), /^3 \w+\s+\d\.\d{3}$/);
  const overlaps = await page.evaluate(() => {
    const boxes = [...document.querySelectorAll("svg.points text")].map((label) => label.getBoundingClientRect());
    return boxes.filter((a, place) => boxes.slice(place + 1).some((b) => a.left < b.right && b.left < a.right && a.top + 2 < b.bottom && b.top + 2 < a.bottom)).length;
  });
  assert.equal(overlaps, 0);
  await until(page, () => [...document.querySelectorAll(".sheet canvas")].every((canvas) => canvas.width === 240));
});

task("10 replay: a log on a timeline", "#/replay", async (page) => {
  await page.waitForSelector(".empty");
  await shot(page, "10-replay-empty");
  if (!command) return;
  await inFolder(async (place) => {
    const run = (...words) => promisify(execFile)(command, words, { cwd: place });
    await run("curriculum", "find_objects#blue", "find_objects#red", "--learn", "8", "--eval-episodes", "2", "-o", "scenario.json");
    await run("run", "scenario.json", "--agent", "random", "-o", "log", "--record");
    await page.setInputFiles("input[type=file]", join(place, "log"));
    await page.waitForSelector(".timeline");
    await page.waitForSelector("svg.plot");
    const moment = () => page.inputValue(".timeline input").then(Number);
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Shift+ArrowRight");
    await until(page, () => document.querySelector(".timeline input").value === "11");
    await page.keyboard.press("KeyI");
    for (let times = 0; times < 3; times += 1) await page.keyboard.press("ArrowRight");
    await page.keyboard.press("KeyO");
    await page.keyboard.press("Space");
    await page.waitForTimeout(1500);
    const now = await moment();
    assert.ok(now >= 11 && now <= 14, `the loop of 11 to 14 is at ${now}`);
    await page.keyboard.press("Space");
  });
});

task("11 mouse: a rock is put on the map and removed", "#/author", async (page) => {
  await page.waitForSelector(".editor");
  await choose(page, "New from", "a park");
  await choose(page, "A click on the map", "adds");
  const rocks = () => page.evaluate(() => {
    const { count, placement } = JSON.parse(localStorage.getItem("driftworld.draft")).groups[0];
    return [count, placement.points.values.length];
  });
  const map = page.locator(".map canvas");
  const at = async (count) => {
    await until(page, (wanted) => JSON.parse(localStorage.getItem("driftworld.draft")).groups[0].count === wanted, count);
    assert.deepEqual(await rocks(), [count, count]);
    await page.waitForSelector(".note.good");
  };
  await at(3);
  const { width, height } = await map.boundingBox();
  const corner = { position: { x: width * 0.2, y: height * 0.2 } };
  await map.click(corner);
  await at(4);
  await until(page, () => /5 objects|[6-9] objects/.test(document.querySelector(".map canvas").getAttribute("aria-label")));
  await map.click(corner);
  await at(3);
  await tabTo(page, "Undo");
  await page.keyboard.press("Enter");
  await at(4);
});

task("12 draft: completion, and an edited task that Back does not replace", "#/author/maze", async (page) => {
  await page.waitForSelector(".note.good");
  await tabTo(page, "Text of the task");
  await page.keyboard.press("Control+Home");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => location.hash.startsWith("#/author/draft"));
  await page.keyboard.press("Control+Space");
  await page.waitForSelector(".cm-tooltip-autocomplete");
  await page.keyboard.press("Escape");
  const edited = await page.evaluate(() => localStorage.getItem("driftworld.draft"));
  assert.match(edited, /"name": "my_maze"/);
  assert.equal(await text(page, "nav .own"), "my_maze");
  await page.waitForSelector("a.button.main");
  await page.locator("a.button.main").click();
  await page.waitForFunction(() => location.hash.startsWith("#/play/draft"));
  await page.goBack();
  await page.waitForSelector(".editor");
  await page.waitForSelector(".note.good");
  assert.equal(await page.evaluate(() => localStorage.getItem("driftworld.draft")), edited);
});

task("13 measures: a part that counts for several elements is listed once, and some measures have no parts", "#/compare/maze?a=medium&b=tiny", async (page) => {
  const says = (pattern) => until(page, (source) => new RegExp(source).test(document.querySelector('section[aria-label="Distance"]')?.innerText), pattern.source);
  await says(/layout\s+State, Transition, Observation\s+layout \/ widest choice\s+100\.0\s%/);
  // Typed one after the other, the names of two measures would be one word.
  const measure = (by) => page.evaluate((name) => { location.hash = `#/compare/maze?a=medium&b=tiny&by=${name}`; }, by);
  await measure("dynamics:bisimulation");
  await says(/0\.054 apart[^]*worlds are compared as a whole: the number has no parts/);
  await measure("pictures");
  await says(/none of 16 places free/);
  assert.equal(await page.getByText("Try again").count(), 0);
  await tabTo(page, "Compare by worlds");
  await page.keyboard.press("Enter");
  await says(/3\.813 apart[^]*The total is the sum of the parts/);
});

task("14 addresses: unknown names and pages give a message", "#/play/nosuch", async (page) => {
  const says = async (address, sentence) => {
    await page.evaluate((to) => { location.hash = to; }, address);
    await until(page, (wanted) => document.querySelector(".note")?.innerText.includes(wanted), sentence);
    assert.equal(await page.getByText("Try again").count(), 0);
  };
  await says("#/play/nosuch", "There is no task called nosuch. The gallery shows all tasks.");
  await says("#/compare/draft", "There is no task of your own yet.");
  await says("#/foo/bar", "There is no page /foo/bar.");
  await page.waitForSelector(".gallery .card");
  await says("#/play/maze?variant=nope", "expected one of medium, tiny");
  assert.equal(await page.inputValue("label.field:nth-child(2) select"), "nope");
  await page.evaluate(() => { location.hash = "#/play/maze?variant=tiny"; });
  await page.waitForSelector(".seat");
  await until(page, () => document.querySelector(".head").innerText.includes("goal +100 · every step −0.05 · ends after 120 s"));
});

task("15 link: a shared task of your own is played and edited by the recipient", "#/author", async (page) => {
  const draft = () => page.evaluate(() => localStorage.getItem("driftworld.draft"));
  const begin = async (template) => {
    await page.waitForSelector(".editor");
    await choose(page, "New from", template);
    await page.waitForSelector(".note.good");
  };
  await begin("a park");
  await page.locator("a.button.main").click();
  await page.waitForSelector(".seat");
  await walk(page, "You", 5);
  await page.keyboard.press("KeyP");
  await page.waitForTimeout(500);
  await tabTo(page, "Share as a link");
  await page.keyboard.press("Enter");
  await page.waitForSelector('input[aria-label="The link"]');
  const [link, shared] = [await page.inputValue('input[aria-label="The link"]'), await draft()];
  await page.goto(`${server.address}#/author`);
  await begin("a map");
  const own = await draft();
  await page.goto(link);
  await page.waitForSelector(".timeline");
  assert.match(await text(page, ".head p"), /^my_park, a task of its own, world 0 under seed 0, \d+ steps/);
  await tabTo(page, "Play this world");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".pad-keys", { state: "attached" });
  assert.equal(await text(page, "h1"), "my_park");
  await page.goBack();
  await page.waitForSelector(".timeline");
  await tabTo(page, "Edit this task");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".note.good");
  assert.equal(await draft(), shared);
  await tabTo(page, "Undo");
  await page.keyboard.press("Enter");
  await until(page, (wanted) => localStorage.getItem("driftworld.draft") === wanted, own);
});
