// The flat map of a world: converts between metres and pixels, and describes a point.

import type { WorldMap } from "./engine.ts";

/** Width of the margin that a map shows around the arena, in metres. */
const MARGIN = 0.5;

/** The scale of a map drawn at a given width, with north at the top. */
export interface Scale {
  pixelsPerMetre: number;
  width: number;
  height: number;
}

export function scaleOf(map: Pick<WorldMap, "width" | "depth">, width: number): Scale {
  const pixelsPerMetre = width / (map.width + 2 * MARGIN);
  return { pixelsPerMetre, width, height: Math.max(1, Math.round((map.depth + 2 * MARGIN) * pixelsPerMetre)) };
}

export const toPixels = (scale: Scale, [x, y]: readonly [number, number]): [number, number] =>
  [scale.width / 2 + x * scale.pixelsPerMetre, scale.height / 2 - y * scale.pixelsPerMetre];

export const toMetres = (scale: Scale, [x, y]: readonly [number, number]): [number, number] =>
  [(x - scale.width / 2) / scale.pixelsPerMetre, (scale.height / 2 - y) / scale.pixelsPerMetre];

/** Whether a point is within a polygon: a ray to the right crosses its border an odd number of times. */
function isWithin(points: [number, number][], [x, y]: readonly [number, number]): boolean {
  let inside = false;
  points.forEach(([ax, ay], index) => {
    const [bx, by] = points[(index + 1) % points.length]!;
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  });
  return inside;
}

/** Describes what is at a point: the nearest object, else the agent, a zone or a wall; `object` is the object's index. */
export function whatIsAt(map: WorldMap, point: readonly [number, number]): { text: string; object: number | null } {
  const place = `${point[0].toFixed(1)} m east, ${point[1].toFixed(1)} m north`;
  const tolerance = Math.max(map.width, map.depth) / 60;
  const near = map.objects
    .map((object) => ({ object, distance: Math.hypot(object.x - point[0], object.y - point[1]) - object.radius }))
    .filter(({ object, distance }) => object.present && distance <= tolerance)
    .sort((a, b) => a.distance - b.distance)[0]?.object;
  if (near) {
    const state = near.open ? ", open" : "";
    const pays = near.reward ? `, pays ${near.reward}` : "";
    return { text: `${near.tag ?? near.class}${near.tag && near.tag !== near.class ? ` (${near.class})` : ""}${state}${pays}`, object: near.index };
  }
  if (Math.hypot(map.agent.x - point[0], map.agent.y - point[1]) <= map.agent.radius + tolerance) return { text: "the agent", object: null };
  const zone = map.zones.find(({ points }) => isWithin(points, point));
  if (zone) return { text: `zone ${zone.name ?? ""} · ${place}`, object: null };
  if (map.walls.some((wall) => wall.closed && isWithin(wall.points, point))) return { text: `wall · ${place}`, object: null };
  return { text: place, object: null };
}
