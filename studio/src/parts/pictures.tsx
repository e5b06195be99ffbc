// Canvases that show an agent's view and the flat map of a world.

import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Frame, WorldMap } from "../engine.ts";
import type { Line } from "../difference.ts";
import { scaleOf, toMetres, toPixels, whatIsAt } from "../map_view.ts";

/** Shows a frame with lines drawn over it. */
export function Picture({ frame, label, lines }: { frame: Frame | null; label: string; lines?: Line[] }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!context || !frame) return;
    if (canvas.current!.width !== frame.width) canvas.current!.width = frame.width;
    if (canvas.current!.height !== frame.height) canvas.current!.height = frame.height;
    context.putImageData(new ImageData(frame.data, frame.width, frame.height), 0, 0);
    for (const [color, width] of lines?.length ? ([["#000", 3], ["#ffd84d", 1.5]] as const) : []) {
      context.strokeStyle = color;
      context.lineWidth = width;
      context.beginPath();
      for (const [ax, ay, bx, by] of lines!) {
        context.moveTo(ax, ay);
        context.lineTo(bx, by);
      }
      context.stroke();
    }
  }, [frame, lines]);
  return <canvas ref={canvas} width={320} height={240} {...(label ? { role: "img", "aria-label": label } : { "aria-hidden": true })} />;
}

const css = ([red, green, blue]: readonly [number, number, number], alpha = 1) =>
  `rgb(${Math.round(red * 255)} ${Math.round(green * 255)} ${Math.round(blue * 255)} / ${alpha})`;

/** Width of a map in pixels; the page scales it. */
const WIDTH = 640;

/** Position and heading of an agent. */
type Pose = Pick<WorldMap["agent"], "x" | "y" | "heading">;

/** Draws a map in the colours of the page, with other agents as hollow arrows. */
function draw(canvas: HTMLCanvasElement, map: WorldMap, trail: readonly (readonly [number, number])[], others: readonly Pose[]): void {
  const scale = scaleOf(map, WIDTH);
  canvas.width = WIDTH;
  canvas.height = scale.height;
  const context = canvas.getContext("2d");
  if (!context) return;
  const style = getComputedStyle(canvas);
  const [soft, ink, rim, link] = ["--soft", "--ink", "--strong", "--link"].map((name) => style.getPropertyValue(name));
  context.fillStyle = soft!;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.lineJoin = "round";
  context.lineCap = "round";
  const path = (points: readonly (readonly [number, number])[], isClosed: boolean) => {
    context.beginPath();
    points.forEach((point, index) => context[index ? "lineTo" : "moveTo"](...toPixels(scale, point)));
    if (isClosed) context.closePath();
  };
  for (const zone of map.zones) {
    path(zone.points, true);
    context.fillStyle = css(zone.color, zone.visible ? 0.45 : 0.15);
    context.fill();
  }
  const [halfWidth, halfDepth] = [map.width / 2, map.depth / 2];
  path([[-halfWidth, -halfDepth], [halfWidth, -halfDepth], [halfWidth, halfDepth], [-halfWidth, halfDepth]], true);
  context.strokeStyle = rim!;
  context.lineWidth = 3;
  context.stroke();
  for (const wall of map.walls) {
    path(wall.points, wall.closed);
    context.fillStyle = css(wall.color, 0.9);
    if (wall.closed) context.fill();
    context.strokeStyle = rim!;
    // An open line is one face of a wall: drawn wide enough to meet the opposite face.
    context.lineWidth = wall.closed ? 1 : Math.max(3, 0.35 * scale.pixelsPerMetre);
    context.stroke();
  }
  if (trail.length > 1) {
    path(trail, false);
    context.strokeStyle = link!;
    context.lineWidth = 2;
    context.stroke();
  }
  for (const object of map.objects) {
    if (!object.present) continue;
    const [x, y] = toPixels(scale, [object.x, object.y]);
    context.beginPath();
    context.arc(x, y, Math.max(6, object.radius * scale.pixelsPerMetre), 0, 2 * Math.PI);
    context.fillStyle = css(object.color, object.open ? 0.35 : 1);
    context.fill();
    context.strokeStyle = ink!;
    context.lineWidth = object.reward ? 2 : 0.75;
    context.stroke();
  }
  const size = Math.max(15, map.agent.radius * scale.pixelsPerMetre * 1.4);
  for (const [agent, fill, outline] of [...others.map((other) => [other, soft!, link!] as const), [map.agent, link!, soft!] as const]) {
    context.save();
    context.translate(...toPixels(scale, [agent.x, agent.y]));
    context.rotate((agent.heading * Math.PI) / 180);
    context.beginPath();
    for (const [ahead, right] of [[1, 0], [-0.8, 0.75], [-0.4, 0], [-0.8, -0.75]] as const) context.lineTo(right * size, -ahead * size);
    context.closePath();
    context.fillStyle = fill;
    context.fill();
    context.strokeStyle = outline;
    context.lineWidth = 2;
    context.stroke();
    context.restore();
  }
}

/** Whether a media query matches; re-renders when that changes. */
export function useMedia(media: string): boolean {
  const query = matchMedia(media);
  const [matches, setMatches] = useState(query.matches);
  useEffect(() => {
    const update = () => setMatches(query.matches);
    query.addEventListener("change", update);
    return () => query.removeEventListener("change", update);
  }, []);
  return matches;
}

/** A shared empty list: a new list at each render would redraw the map. */
const NONE: never[] = [];

/** A map that describes what is under the pointer; `click` gets the clicked point in metres, and the index of the object there. */
export function FlatMap({ map, trail = NONE, others = NONE, click }: {
  map: WorldMap | null;
  others?: readonly Pose[];
  trail?: readonly (readonly [number, number])[];
  click?: (point: [number, number], object: number | null) => void;
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [under, setUnder] = useState("");
  const isDark = useMedia("(prefers-color-scheme: dark)");
  useLayoutEffect(() => {
    if (canvas.current && map) draw(canvas.current, map, trail, others);
  }, [map, trail, others, isDark]);
  const pointAt = (event: MouseEvent): [number, number] => {
    const box = canvas.current!.getBoundingClientRect();
    const scale = scaleOf(map!, box.width);
    return toMetres(scale, [event.clientX - box.left, event.clientY - box.top]);
  };
  const count = map?.objects.filter((object) => object.present).length ?? 0;
  return (
    <div class="map">
      <canvas
        ref={canvas} width={WIDTH} height={WIDTH} role="img" class={click ? "clickable" : ""}
        aria-label={map ? `Map: ${Math.round(map.width)} by ${Math.round(map.depth)} metres, ${count} objects` : "Map"}
        onMouseMove={(event) => map && setUnder(whatIsAt(map, pointAt(event)).text)}
        onMouseLeave={() => setUnder("")}
        onClick={(event) => map && click?.(pointAt(event), whatIsAt(map, pointAt(event)).object)}
      />
      {under && <div class="tip"><span>{under}</span></div>}
    </div>
  );
}
