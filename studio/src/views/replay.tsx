// The replay view: shows an episode from a link or from a dropped log on a timeline, and the learning curve of the log.

import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import type { DroppedFile, EngineError, Episode, Frame, Log, Step, WorldMap } from "../engine.ts";
import * as commands from "../commands.ts";
import { useClock } from "../clock.ts";
import { draft, nameIn } from "../draft.ts";
import { droppedFiles, pickedFiles } from "../files.ts";
import { amount } from "../pay.ts";
import { hrefOf, type Route } from "../route.ts";
import { VIEW } from "../session.ts";
import { asError, engine } from "../simulator.ts";
import { nextMoment, type Loop, moveLoopEnd, marks } from "../timeline.ts";
import { Curves } from "../parts/curves.tsx";
import { ErrorNote, Recipes } from "../parts/notes.tsx";
import { FlatMap, Picture } from "../parts/pictures.tsx";
import { Timeline } from "../parts/timeline.tsx";

/** A replayed episode with all its steps. */
interface Replayed {
  episode: Episode;
  title: string;
  /** The state before the first step, and the state after each step. */
  steps: Step[];
}

async function replayed(episode: Episode, title: string): Promise<Replayed> {
  const actions = await episode.actions();
  const first = await episode.seek(0);
  return { episode, title, steps: [first, ...(await episode.steps(actions))] };
}

async function fromLink(fragment: string): Promise<Replayed> {
  const { request, looks, actions } = await engine.decodeLink(fragment);
  const episode = await engine.open(request, { ...VIEW, ...(looks ? { looks } : {}) });
  const first = await episode.now();
  const task = "task" in request ? request.task : "a world";
  const variant = "variant" in request && request.variant ? `#${request.variant}` : "";
  const name = task.startsWith("{") ? `${nameIn(task)}${variant}, a task of its own` : `${task}${variant}`;
  const where = "task" in request ? `, world ${request.index ?? 0} under seed ${request.seed ?? 0}` : "";
  return { episode, title: `${name}${where}`, steps: [first, ...(await episode.steps(actions))] };
}

/** The options of an address that select a world. */
const worldOptions = ({ variant, seed, index }: commands.Subject) => ({ variant, seed: seed || undefined, index: index || undefined });

export function Replay({ route }: { route: Route }) {
  const [shown, setShown] = useState<Replayed | null>(null);
  const [error, setError] = useState<EngineError | null>(null);
  const [log, setLog] = useState<Log | null>(null);
  const [folder, setFolder] = useState("");
  const [experience, setExperience] = useState<number | null>(null);
  const [moment, setMoment] = useState(0);
  const [picture, setPicture] = useState<{ frame: Frame; map: WorldMap } | null>(null);
  const [isPlaying, setPlaying] = useState(false);
  const [loop, setLoop] = useState<Loop | null>(null);
  const [isOver, setOver] = useState(false);
  const [isReading, setReading] = useState(false);
  /** The moment requested last; drawing catches up with it. */
  const wanted = useRef(0);

  const show = async (opening: Promise<Replayed>) => {
    setError(null);
    setReading(true);
    try {
      const next = await opening;
      setShown((last) => {
        void last?.episode.close().catch(() => undefined);
        return next;
      });
      wanted.current = 0;
      setMoment(0);
      setLoop(null);
      setPlaying(false);
    } catch (reason) {
      setShown(null);
      setError(asError(reason));
    } finally {
      setReading(false);
    }
  };
  useEffect(() => {
    if (route.link) void show(fromLink(route.link));
  }, [route.link]);

  const read = async (files: Promise<DroppedFile[]>) => {
    setError(null);
    setReading(true);
    try {
      const dropped = await files;
      const next = await engine.log(dropped);
      setLog(next);
      setFolder(dropped[0]?.path.split("/")[0] ?? "log");
      setShown(null);
      const first = next.episodes.find(({ recorded }) => recorded);
      if (first) open(first.experience);
    } catch (reason) {
      setError(asError(reason));
    } finally {
      setReading(false);
    }
  };
  const open = (number: number) => {
    setExperience(number);
    void show(engine.openLogged(number, VIEW).then((episode) => replayed(episode, `Episode ${number}`)));
  };

  // Only one picture is drawn at a time, always for the latest requested moment.
  const source = useRef<Episode | null>(null);
  const isDrawing = useRef(false);
  source.current = shown?.episode ?? null;
  useEffect(() => {
    const draw = async () => {
      let drawnMoment = -1;
      let episode = source.current;
      while (episode && (episode !== source.current || drawnMoment !== wanted.current)) {
        episode = source.current;
        drawnMoment = wanted.current;
        if (!episode) break;
        await episode.seek(drawnMoment);
        setPicture({ frame: await episode.frame("agent"), map: await episode.map() });
      }
    };
    if (isDrawing.current) return;
    isDrawing.current = true;
    draw().catch((reason: unknown) => {
      setError(asError(reason));
      setShown(null);
    }).finally(() => {
      isDrawing.current = false;
    });
  }, [shown, moment]);

  const last = shown ? shown.steps.length - 1 : 0;
  const seek = (to: number) => {
    wanted.current = Math.min(Math.max(0, to), last);
    setMoment(wanted.current);
  };
  useClock(isPlaying && shown !== null, 1 / (shown?.episode.actionSpace.step_seconds ?? 0.1), async () => {
    const next = nextMoment(wanted.current, last, loop);
    if (next === null) setPlaying(false);
    else seek(next);
  }, () => setPlaying(false));

  useLayoutEffect(() => {
    if (!shown) return undefined;
    const press = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target instanceof Element && event.target.closest("select, textarea, input[type=text], input[type=number]")) return;
      const isButton = event.target instanceof Element && event.target.closest("button, a, summary") !== null;
      const stride = event.shiftKey ? 10 : 1;
      if (event.code === "ArrowLeft") seek(wanted.current - stride);
      else if (event.code === "ArrowRight") seek(wanted.current + stride);
      else if (event.code === "Home") seek(0);
      else if (event.code === "End") seek(last);
      else if (event.code === "Space" && !isButton) play();
      else if (event.code === "KeyI") setLoop(moveLoopEnd(loop, "from", wanted.current, last));
      else if (event.code === "KeyO") setLoop(moveLoopEnd(loop, "to", wanted.current, last));
      else if (event.code === "KeyL") setLoop(null);
      else return;
      event.preventDefault();
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  });

  const play = () => {
    if (moment === last && !loop) seek(0);
    setPlaying(!isPlaying);
  };
  const step = shown?.steps[moment];
  const trail = useMemo(() => shown?.steps.slice(0, moment + 1).map(({ agent }): [number, number] => [agent.x, agent.y]) ?? [], [shown, moment]);
  const moments = useMemo(() => (shown ? marks(shown.steps.slice(1)) : []), [shown]);
  const request = shown?.episode.request;
  const isOwn = request !== undefined && "task" in request && request.task.startsWith("{");
  const subject = request && "task" in request
    ? { task: isOwn ? "draft" : request.task, variant: request.variant ?? "", seed: request.seed ?? 0, index: request.index ?? 0 }
    : null;
  const go = (view: "play" | "author") => {
    if (isOwn) draft.take(request.task);
    location.hash = hrefOf(view, subject!.task, worldOptions(subject!));
  };
  const actions = shown?.steps.slice(1).flatMap(({ action }) => (action === null ? [] : [action])) ?? [];
  const recipe = log && experience !== null
    ? commands.replayLog(folder, experience)
    : subject && shown && !isOwn ? commands.episode(subject, shown.episode.actionSpace, actions) : null;
  return (
    <div
      class="stack drop" onDragOver={(event) => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
      onDrop={(event) => { event.preventDefault(); setOver(false); if (event.dataTransfer) void read(droppedFiles(event.dataTransfer)); }}
    >
      <div class="head">
        <div>
          <h1>Replay</h1>
          <p>{shown ? `${shown.title}, ${last} steps` : "An episode from a link, or a log of a lifetime."}</p>
        </div>
        <div class="row">
          {subject && <button type="button" onClick={() => go("play")}>Play this world</button>}
          {subject && (
            <button type="button" title={isOwn ? "Undo in Author brings your own text back" : ""} onClick={() => go("author")}>Edit this task</button>
          )}
          <label class="button">
            Open a log folder
            <input class="hidden" type="file" multiple {...{ webkitdirectory: true }} onChange={(event) => void read(pickedFiles(event.currentTarget.files))} />
          </label>
        </div>
      </div>
      {error && <ErrorNote error={error} />}
      {isReading && <p class="faint">Reading …</p>}
      {!shown && !log && !isReading && (
        <div class={`empty ${isOver ? "over" : ""}`}>
          <h2>Drop a log folder here</h2>
          <p>Any folder that <code>driftworld run --record</code> or a learner in Python wrote. Nothing is uploaded: the page itself reads the files.</p>
          <p>Or play a world and choose <b>Replay</b>, or open a link that someone shared.</p>
        </div>
      )}
      {shown && step && (
        <>
          <div class="stage">
            <section class="card seat" aria-label="What the agent sees">
              <div class="frame"><Picture frame={picture?.frame ?? null} label="What the agent sees" /></div>
              <footer class="number">
                <span>Reward <b>{amount(step.total)}</b></span>
                <span class="faint">step {moment} of {last} · {step.seconds.toFixed(1)} s</span>
              </footer>
            </section>
            <section class="card pad" aria-label="Map"><FlatMap map={picture?.map ?? null} trail={trail} /></section>
            <section class="card pad stack" aria-label="Moments">
              <h2>Moments</h2>
              {moments.length
                ? (
                  <ul class="events picks">
                    {moments.map((mark) => (
                      <li key={mark.step}>
                        <button type="button" {...(mark.step === moment ? { "aria-current": "step" as const } : {})} onClick={() => seek(mark.step)}>
                          <span>step {mark.step}{mark.text && `: ${mark.text}`}</span><span class="number">{amount(mark.reward)}</span>
                        </button>
                      </li>
                    ))}
                  </ul>
                )
                : <p class="faint small">Nothing was encountered, and every step gave the same reward.</p>}
            </section>
          </div>
          <section class="card pad stack" aria-label="Timeline">
            <Timeline steps={shown.steps} moment={moment} loop={loop} seek={seek} />
            <div class="row spread">
              <div class="row">
                <button type="button" class="main" onClick={play}>{isPlaying ? "Pause" : "Play"}</button>
                <button type="button" onClick={() => setLoop(moveLoopEnd(loop, "from", moment, last))}>Loop in</button>
                <button type="button" onClick={() => setLoop(moveLoopEnd(loop, "to", moment, last))}>Loop out</button>
                <button type="button" disabled={!loop} onClick={() => setLoop(null)}>No loop</button>
              </div>
              <p class="small faint key-list">
                <kbd>space</kbd> plays, <kbd>←</kbd> <kbd>→</kbd> step, with <kbd>shift</kbd> ten, <kbd>I</kbd> <kbd>O</kbd> loop, <kbd>L</kbd> no loop
              </p>
            </div>
            {recipe && <Recipes of={{ "This episode": recipe }} />}
          </section>
        </>
      )}
      {log && (
        <div class="stage wide">
          <section class="card pad stack" aria-label="Learning curve">
            <h2>Learning curve</h2>
            <Curves log={log} now={experience} pick={open} />
            {log.warnings.map((warning) => <p key={warning} class="note warn"><span>{warning}</span></p>)}
          </section>
          <section class="card pad stack" aria-label="Episodes">
            <h2>{log.episodes.length} episodes</h2>
            <div class="picks">
              {log.episodes.slice(0, 2000).map((episode) => (
                <button
                  key={episode.experience} type="button" disabled={!episode.recorded}
                  {...(episode.experience === experience ? { "aria-current": "true" as const } : {})}
                  onClick={() => open(episode.experience)}
                >
                  <span>{episode.experience} · {episode.task}{episode.block_type === "test" ? " · evaluation" : ""}</span>
                  <span class="number">{amount(episode.reward)}</span>
                </button>
              ))}
            </div>
            {!log.episodes.some(({ recorded }) => recorded) && (
              <p class="note warn">
                <span>No episode of this log was recorded. <code>run --record</code> or <code>record=True</code> keeps them.</span>
              </p>
            )}
          </section>
        </div>
      )}
    </div>
  );
}
