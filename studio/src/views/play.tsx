// The play view: you walk in a world, alone or beside the trained policy and the planner, and can share the episode as a link.

import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import type { EngineError } from "../engine.ts";
import * as commands from "../commands.ts";
import { useClock } from "../clock.ts";
import { draft } from "../draft.ts";
import { CONTROL_KEYS, hasInput, useHeldKeys } from "../keys.ts";
import { amount, describeRewards } from "../pay.ts";
import { hrefOf, type Route, wholeNumber } from "../route.ts";
import { Session } from "../session.ts";
import { asError, engine, requestOf, trainedAgent, trainedTasks, useAnswer } from "../simulator.ts";
import { NumberPicker, TaskPicker, VariantPicker } from "../parts/choices.tsx";
import { copyText, ErrorNote, Recipes, saveText } from "../parts/notes.tsx";
import { Pad } from "../parts/pad.tsx";
import { FlatMap } from "../parts/pictures.tsx";
import { type Companion, MEANINGS, NAMES, Seat } from "../parts/seat.tsx";

const SPEEDS = [1, 2, 6];
/** Maximum number of worlds searched for one in which an agent fails. */
const MAX_WORLDS_SEARCHED = 50;

export function Play({ route }: { route: Route }) {
  const task = route.task || "find_objects";
  const { variant = "", seed: seedText, index: indexText, with: withText = "" } = route.options;
  const [seed, index] = [wholeNumber(seedText), wholeNumber(indexText)];
  const companions = (Object.keys(NAMES) as Companion[]).filter((name) => withText.split(",").includes(name));
  const go = (change: Record<string, string | number | undefined>, to = task) => {
    location.hash = hrefOf("play", to, { variant, seed: seed || undefined, index: index || undefined, with: withText, ...change });
  };

  const about = useAnswer(() => engine.task(task === "draft" ? draft.text : task), [task]);
  const isTrained = (useAnswer(trainedTasks, []).value ?? []).includes(task);
  const [seats, setSeats] = useState<{ name: string; session: Session }[]>([]);
  const [error, setError] = useState<EngineError | null>(null);
  const [round, setRound] = useState(0);
  const [state, setState] = useState<"waiting" | "running" | "paused">("waiting");
  const [speed, setSpeed] = useState(1);
  const [shareStatus, setShareStatus] = useState("");
  const [link, setLink] = useState("");
  const [, redraw] = useState(0);
  const trail = useRef<[number, number][]>([]);

  const again = useCallback(() => setRound((last) => last + 1), []);
  useEffect(() => {
    let isOver = false;
    let opened: Session[] = [];
    const request = requestOf(task, variant, seed, index);
    const open = async () => {
      const you = await Session.open(request, null);
      opened = [you];
      const next = [{ name: "You", session: you }];
      for (const name of companions) {
        const agent = name === "planner" ? "planner" : await trainedAgent(task);
        const session = await Session.open(request, agent);
        opened.push(session);
        next.push({ name: NAMES[name], session });
      }
      if (isOver) return;
      trail.current = [];
      setSeats(next);
      setError(null);
      setState("waiting");
      setShareStatus("");
      setLink("");
    };
    open().catch((reason: unknown) => {
      if (isOver) return;
      setSeats([]);
      setError(asError(reason));
    });
    return () => {
      isOver = true;
      for (const session of opened) void session.episode.close().catch(() => undefined);
    };
  }, [task, variant, seed, index, withText, round]);

  const keys = useHeldKeys((code) => {
    if (code === "KeyR") again();
    else if (code === "KeyN") go({ index: index + 1 });
    else if (code === "KeyP" || code === "Escape") setState((last) => (last === "running" ? "paused" : "running"));
    else if (CONTROL_KEYS.includes(code)) setState("running");
  });
  const you = seats[0]?.session;
  const isPaused = state === "paused" || (you?.ended ?? false);
  const isAllOver = seats.every(({ session }) => session.ended);
  const rate = speed / (you?.episode.actionSpace.step_seconds ?? 0.1);
  useClock(state === "running" && seats.length > 0 && !isAllOver, rate, async () => {
    const input = keys.read();
    if (you && !you.ended && !you.canWait && !hasInput(input)) return;
    for (const { session } of seats) await session.advance(input);
    if (you) trail.current = [...trail.current, [you.step.agent.x, you.step.agent.y]];
    redraw((last) => last + 1);
  }, (reason) => {
    setError(asError(reason));
    setSeats([]);
  });

  const fragment = async () => {
    const { episode, actions } = you!;
    return { text: await engine.encodeLink({ request: episode.request, actions }), steps: actions.length };
  };
  const share = async () => {
    setState((last) => (last === "running" ? "paused" : last));
    const { text, steps } = await fragment();
    const address = `${location.href.split("#")[0]}#${text}`;
    setLink(address);
    setShareStatus(`${(await copyText(address)) ? "Copied" : "Ready to copy"}: ${text.length} characters for ${steps} step${steps === 1 ? "" : "s"}`);
  };
  const watch = async () => {
    location.hash = (await fragment()).text;
  };
  const save = async () => saveText(commands.RECORDING, await you!.episode.recording());
  const searched = `${task} ${variant} ${seed}`;
  const [search, setSearch] = useState({ of: "", text: "" });
  const findFailure = async () => {
    const tested = isTrained ? "policy" : "planner";
    const report = (text: string) => setSearch({ of: searched, text });
    // If the agent already plays beside you, you can see how it does in this world, so start from the next one.
    const from = index + (companions.includes(tested) ? 1 : 0);
    report(`Trying up to ${MAX_WORLDS_SEARCHED} worlds …`);
    try {
      const failure = await engine.findFailure(requestOf(task, variant, seed, from), isTrained ? await trainedAgent(task) : "planner", { worlds: MAX_WORLDS_SEARCHED });
      const found = failure && "index" in failure.request ? failure.request.index : undefined;
      report(found === undefined ? `It succeeds in worlds ${from} to ${from + MAX_WORLDS_SEARCHED - 1}.` : `It fails in world ${found}. Press Go to watch.`);
      if (found !== undefined) go({ index: found, with: tested });
    } catch (reason) {
      report(asError(reason).message);
    }
  };
  const guarded = (action: () => Promise<void>) => () => void action().catch((reason: unknown) => setError(asError(reason)));

  const subject = { task: task === "draft" ? draft.file : task, variant, seed, index };
  const network = `examples/networks/${task}.safetensors`;
  const recipes: Record<string, commands.Recipe> = { "Play this world": commands.play(subject) };
  if (you && isPaused) {
    recipes["This episode"] = commands.episode(subject, you.episode.actionSpace, you.actions);
    recipes["This episode, once it is saved"] = commands.replayLog(commands.RECORDING, 0);
  }
  for (const name of companions) recipes[`A film of the ${name}`] = commands.film(subject, name === "planner" ? "onrails" : { network });
  recipes["Draw this world"] = commands.sample(subject);
  // Keys are ignored while a button has focus, so give the focus back to the view.
  const thenFocusView = (action: () => void) => {
    action();
    document.querySelector<HTMLElement>(".seat .frame[tabindex]")?.focus({ preventScroll: true });
  };
  const toggle = (name: Companion) =>
    go({ with: (companions.includes(name) ? companions.filter((other) => other !== name) : [...companions, name]).join(",") });
  const description = about.value?.variants.find((known) => known.name === variant)?.description ?? "";
  return (
    <>
      <div class="head">
        <div>
          <h1>{task === "draft" ? draft.name : task}</h1>
          <p>{about.value?.description} {description}</p>
          {you && <p class="small">{describeRewards(you.episode.world, you.episode.actionSpace.step_seconds)}</p>}
        </div>
      </div>
      <div class="tools stack">
        <div class="row end">
          <TaskPicker task={task} pick={(to) => go({ variant: undefined, index: undefined, with: undefined }, to)} />
          <VariantPicker variants={about.value?.variants.map(({ name }) => name) ?? []} variant={variant} pick={(to) => go({ variant: to })} />
          <NumberPicker label="Seed" value={seed} pick={(to) => go({ seed: to || undefined })} />
          <NumberPicker label="World" value={index} pick={(to) => go({ index: to || undefined })} />
        </div>
      <div class="row spread">
        <div class="row" role="group" aria-label="Who plays beside you">
          {(Object.keys(NAMES) as Companion[]).map((name) => (
            <button
              key={name} type="button" aria-pressed={companions.includes(name)} onClick={() => toggle(name)} disabled={name === "policy" && !isTrained}
              title={name === "policy" && !isTrained ? "No trained network for this task is available on this page" : MEANINGS[name]}
            >{NAMES[name]}</button>
          ))}
          {!isTrained && <span class="faint small">(none for this task)</span>}
          <button type="button" onClick={guarded(findFailure)}>Show me where {isTrained ? "the policy" : "the planner"} fails</button>
          <span class="faint small" role="status">{search.of === searched && search.text}</span>
        </div>
        <div class="row">
          <div class="group" role="group" aria-label="Speed">
            {SPEEDS.map((factor) => (
              <button
                key={factor} type="button" aria-pressed={speed === factor} aria-label={`${factor} times real time`}
                onClick={() => thenFocusView(() => setSpeed(factor))}
              >{factor}×</button>
            ))}
          </div>
          <button type="button" title="Start the clock (so does any movement key)" onClick={() => thenFocusView(() => setState(state === "running" ? "paused" : "running"))}>
            {state === "running" ? "Pause" : "Go"}
          </button>
          <button type="button" onClick={again}>Again</button>
          <button type="button" onClick={() => go({ index: index + 1 })}>Next world</button>
        </div>
      </div>
      </div>
      {error && <ErrorNote error={error} again={again} />}
      {!seats.length && !error && <p class="loading">Drawing the world …</p>}
      {seats.length > 0 && (
        <div class={`stage ${seats.length === 1 ? "solo" : ""}`}>
          {seats.map(({ name, session }, place) => (
            <Seat key={name} name={name} session={session} isYours={place === 0} below={place === 0 ? <Pad set={keys.set} /> : null}>
              {state !== "running" && <span class="tag">{state === "paused" ? "paused" : "tap or press a key to begin"}</span>}
            </Seat>
          ))}
          <section class="card pad stack" aria-label="Map">
            <h2>Map</h2>
            <FlatMap map={you?.map ?? null} trail={trail.current} others={seats.slice(1).map(({ session }) => session.step.agent)} />
          </section>
          <section class={`card pad episode ${seats.length > 1 ? "span" : ""}`} aria-label="Episode">
            <div class="stack">
            <h2>Episode</h2>
            <p class="small key-list">
              <kbd>↑</kbd> <kbd>↓</kbd> <kbd>←</kbd> <kbd>→</kbd> or <kbd>W</kbd> <kbd>A</kbd> <kbd>S</kbd> <kbd>D</kbd> walk and turn,{" "}
              <kbd>space</kbd> uses what is ahead, <kbd>P</kbd> pauses, <kbd>R</kbd> starts over, <kbd>N</kbd> goes to the next world.
            </p>
            </div>
            {you && you.log.length > 0
              ? (
                <ul class="events" aria-label="What happened">
                  {you.log.map((line) => (
                    <li key={`${line.step} ${line.text}`}>
                      <span>{line.text}</span>
                      <span class="number faint">{line.reward ? `${amount(line.reward)} · ` : ""}step {line.step}</span>
                    </li>
                  ))}
                </ul>
              )
              : <p class="faint small">Things you encounter will be listed here.</p>}
            <div class="stack">
            <div class="row">
              <button type="button" class="main" onClick={guarded(share)}>Share as a link</button>
              <button type="button" disabled={!you || you.step.step === 0} onClick={guarded(watch)}>Replay</button>
              <button type="button" disabled={!you || you.step.step === 0} onClick={guarded(save)}>Save</button>
              <a class="button quiet" href={hrefOf("author", task === "draft" ? "" : task, { variant })}>Edit the task</a>
            </div>
            <p class="small faint" role="status">{shareStatus || (you?.step.step === 0 && "Take at least one step to enable Replay and Save.")}</p>
            {link && <input type="text" readOnly value={link} aria-label="The link" onFocus={(event) => event.currentTarget.select()} />}
            <Recipes of={recipes} />
            </div>
          </section>
        </div>
      )}
    </>
  );
}
