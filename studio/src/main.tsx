// The page: shows the view that the address names, with a bar above it and a stop button for the simulator.

import { render } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { draft } from "./draft.ts";
import { engine, useAnswer } from "./simulator.ts";
import { hrefOf, parseRoute, type Route, type ViewName, VIEWS } from "./route.ts";
import { ErrorNote } from "./parts/notes.tsx";
import { Gallery } from "./views/gallery.tsx";
import { Play } from "./views/play.tsx";
import { Author } from "./views/author.tsx";
import { Compare } from "./views/compare.tsx";
import { Order } from "./views/order.tsx";
import { Replay } from "./views/replay.tsx";

const COMPONENTS: Record<ViewName, (props: { route: Route }) => preact.JSX.Element> = {
  gallery: Gallery, play: Play, author: Author, compare: Compare, order: Order, replay: Replay,
};
const TITLES: Record<ViewName, string> = {
  gallery: "Gallery", play: "Play", author: "Author", compare: "Compare", order: "Order", replay: "Replay",
};
/** Calls that take no longer than this show no busy indicator. */
const BUSY_DELAY_MS = 400;

/** A busy indicator for long calls, with a stop button. */
function Busy() {
  const [isShown, setShown] = useState(false);
  useEffect(() => {
    let timer = 0;
    engine.onbusy = (busy) => {
      clearTimeout(timer);
      if (busy) timer = window.setTimeout(() => setShown(true), BUSY_DELAY_MS);
      else setShown(false);
    };
    return () => {
      engine.onbusy = null;
    };
  }, []);
  return (
    <div class="busy" role="status">
      {isShown && (
        <>
          <span class="dot" /><span>Working …</span>
          <button type="button" onClick={() => engine.stop()}>Stop</button>
        </>
      )}
    </div>
  );
}

/** Shown for an address that matches nothing. */
function NotFound({ message }: { message: string }) {
  return <p class="note warn" role="alert"><span>{message} <a href={hrefOf("gallery")}>The gallery</a> shows all tasks.</span></p>;
}

function App() {
  const [route, setRoute] = useState(() => parseRoute(location.hash));
  const main = useRef<HTMLElement>(null);
  const started = useAnswer(() => engine.ready(), []);
  const tasks = useAnswer(() => engine.tasks(), []);
  const [draftName, setDraftName] = useState(draft.name);
  const isKnown = route.task === "draft" ? draftName || route.view === "author" : !tasks.value || tasks.value.some(({ name }) => name === route.task);
  const isUnknown = route.task && !isKnown;
  useEffect(() => {
    draft.onname = setDraftName;
  }, []);
  useEffect(() => {
    const go = () => {
      const next = parseRoute(location.hash);
      setRoute((last) => {
        if (last.view !== next.view) {
          requestAnimationFrame(() => {
            scrollTo(0, 0);
            main.current?.focus({ preventScroll: true });
          });
        }
        return next;
      });
    };
    window.addEventListener("hashchange", go);
    return () => window.removeEventListener("hashchange", go);
  }, []);
  useEffect(() => {
    document.title = `${route.task ? `${route.task} · ` : ""}${TITLES[route.view]} · Driftworld`;
  }, [route]);
  const View = COMPONENTS[route.view];
  return (
    <>
      <a class="skip" href="#main" onClick={(event) => { event.preventDefault(); main.current?.focus(); }}>Skip to the content</a>
      <header class="bar">
        <div>
          <a class="brand" href={hrefOf("gallery")}><img src="icon.svg" alt="" />Driftworld</a>
          <nav aria-label="Views">
            {VIEWS.map((view) => (
              <a
                key={view} href={hrefOf(view, view === "gallery" || view === "replay" ? "" : view === "author" && draftName ? "draft" : route.task)}
                {...(view === route.view ? { "aria-current": "page" as const } : {})}
              >
                {TITLES[view]}{view === "author" && draftName && <span class="own">{draftName}</span>}
              </a>
            ))}
          </nav>
          <Busy />
        </div>
      </header>
      <main id="main" ref={main} tabIndex={-1}>
        {started.error && <ErrorNote error={started.error} again={() => location.reload()} />}
        {route.unknown && <NotFound message={`There is no page ${route.unknown}.`} />}
        {isUnknown && <NotFound message={route.task === "draft" ? "There is no task of your own yet." : `There is no task called ${route.task}.`} />}
        {started.value && !tasks.pending && !isUnknown && <View key={route.view} route={route} />}
        {started.pending && <p class="loading">Loading the simulator …</p>}
      </main>
    </>
  );
}

const root = document.getElementById("app");
if (root) {
  root.replaceChildren();
  render(<App />, root);
}
