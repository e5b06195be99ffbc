// The gallery: a card for each task with a picture of a world, in which the planner walks while the card is active.

import { useEffect, useRef, useState } from "preact/hooks";
import type { Frame, TaskCard } from "../engine.ts";
import { useClock } from "../clock.ts";
import { Session } from "../session.ts";
import { engine, trainedTasks, useAnswer } from "../simulator.ts";
import { hrefOf, type Route } from "../route.ts";
import { Choice } from "../parts/choices.tsx";
import { Picture } from "../parts/pictures.tsx";
import { ErrorNote } from "../parts/notes.tsx";
import { MEANINGS } from "../parts/seat.tsx";

const SIZE = { width: 280, height: 210 };
/** The planner takes this many steps before a card's picture is drawn, because many worlds start in front of a wall. */
const STEPS_BEFORE_PICTURE = 12;

/** The picture of a card: drawn once it scrolls into view, and animated while `isLive`. */
function Shot({ card, isLive }: { card: TaskCard; isLive: boolean }) {
  const container = useRef<HTMLSpanElement>(null);
  const session = useRef<Session | null>(null);
  const [frame, setFrame] = useState<Frame | null>(null);
  const [isLoaded, setLoaded] = useState(false);
  const variant = card.examples[0]?.variant;
  const request = { task: card.name, ...(variant ? { variant } : {}) };
  useEffect(() => {
    const observer = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      engine.open(request, SIZE)
        .then(async (episode) => {
          for (let step = 0; step < STEPS_BEFORE_PICTURE; step += 1) {
            const { terminated, truncated } = await episode.act("planner");
            if (terminated || truncated) break;
          }
          setFrame(await episode.frame("agent"));
          await episode.close();
        })
        .catch(() => undefined);
    }, { rootMargin: "200px" });
    if (container.current) observer.observe(container.current);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    if (!isLive) return undefined;
    let isOver = false;
    Session.open(request, "planner", SIZE).then((opened) => {
      if (isOver) void opened.episode.close().catch(() => undefined);
      else session.current = opened;
      setLoaded(!isOver);
    }, () => undefined);
    return () => {
      isOver = true;
      void session.current?.episode.close().catch(() => undefined);
      session.current = null;
      setLoaded(false);
    };
  }, [isLive]);
  useClock(isLive && isLoaded, 20, async () => {
    const current = session.current;
    if (!current || current.ended) return;
    await current.advance({ ahead: 0, turn: 0, interact: false });
    setFrame(current.frame);
  }, () => setLoaded(false));
  return <span ref={container}><Picture frame={frame} label="" /></span>;
}

function Card({ card, isTrained }: { card: TaskCard; isTrained: boolean }) {
  const [isActive, setActive] = useState(false);
  const isLive = isActive && !matchMedia("(prefers-reduced-motion: reduce)").matches;
  const variant = card.examples[0]?.variant;
  const linkTo = (companion?: string) => hrefOf("play", card.name, { variant, with: companion });
  return (
    <li>
      <article
        class="card" onMouseEnter={() => setActive(true)} onMouseLeave={() => setActive(false)}
        onFocusCapture={() => setActive(true)} onBlurCapture={() => setActive(false)}
      >
        <a class="shot" href={linkTo()} aria-label={`Play ${card.name}`}><Shot card={card} isLive={isLive} /></a>
        <div class="body">
          <h3>{card.name}</h3>
          <p>{card.description}</p>
        </div>
        <div class="foot">
          <a class="button quiet" href={linkTo()} tabIndex={-1} aria-hidden="true">Play</a>
          {isTrained && (
            <a class="button quiet" href={linkTo("policy")} title={MEANINGS.policy} aria-label={`Play ${card.name} beside the trained policy`}>Policy</a>
          )}
          <a class="button quiet" href={linkTo("planner")} title={MEANINGS.planner} aria-label={`Play ${card.name} beside the planner`}>Planner</a>
        </div>
      </article>
    </li>
  );
}

export function Gallery({ route }: { route: Route }) {
  const cards = useAnswer(() => engine.tasks(), []);
  const trained = useAnswer(trainedTasks, []).value ?? [];
  const [query, setQuery] = useState(route.options["q"] ?? "");
  const [group, setGroup] = useState("");
  const all = cards.value ?? [];
  const keywords = query.toLowerCase().split(/\s+/).filter(Boolean);
  const shown = all.filter((card) => (!group || card.group === group)
    && keywords.every((keyword) => `${card.name} ${card.group} ${card.description}`.toLowerCase().includes(keyword)));
  const groups = [...new Set(all.map((card) => card.group))];
  const variants = all.reduce((sum, card) => sum + card.variants.length, 0);
  return (
    <>
      <div class="head">
        <div>
          <h1>Gallery</h1>
          <p>
            {all.length ? `${all.length} tasks with ${variants} variants. ` : ""}
            Choose one to play it in first person. Its worlds are identical, bit for bit, to those used in training.
          </p>
        </div>
        <div class="row end">
          <label class="field">
            Search
            <input type="search" value={query} placeholder="maze, door, memory …" onInput={(event) => setQuery(event.currentTarget.value)} />
          </label>
          <Choice label="Group" value={group} entries={[["", "all"], ...groups]} pick={setGroup} />
        </div>
      </div>
      {cards.error && <ErrorNote error={cards.error} again={() => location.reload()} />}
      {all.length > 0 && shown.length === 0 && (
        <div class="empty">
          <h2>No task matches</h2>
          <p>None of {all.length} tasks has “{query}” in its name, group or description.</p>
          <button type="button" onClick={() => { setQuery(""); setGroup(""); }}>Show all</button>
        </div>
      )}
      {groups.filter((name) => shown.some((card) => card.group === name)).map((name) => (
        <section key={name} class="stack" aria-label={name}>
          <h2 class="group-name">{name}</h2>
          <ul class="gallery">
            {shown.filter((card) => card.group === name).map((card) => (
              <Card key={card.name} card={card} isTrained={trained.includes(card.name)} />
            ))}
          </ul>
        </section>
      ))}
    </>
  );
}
