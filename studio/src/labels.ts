// Places labels of points on a map without overlaps.

/** Left, top, right and bottom. */
type Box = [number, number, number, number];

/** Width and height of a character, in pixels of the map. */
const [CHARACTER_WIDTH, CHARACTER_HEIGHT] = [6.6, 12];

/**
 * Places each point's label above, below or beside it, without covering a point or another label. Uses the first of its texts that
 * fits; null if none fits. Earlier points choose first.
 */
export function placeLabels(points: { x: number; y: number; texts: string[] }[], width: number, height: number) {
  const occupied = points.map(({ x, y }): Box => [x - 5, y - 5, x + 5, y + 5]);
  const isFree = ([left, top, right, bottom]: Box) => left >= 0 && top >= 0 && right <= width && bottom <= height
    && occupied.every((other) => right <= other[0] || left >= other[2] || bottom <= other[1] || top >= other[3]);
  return points.map(({ x, y, texts }) => {
    for (const text of texts) {
      const half = (text.length * CHARACTER_WIDTH) / 2;
      for (const [across, down] of [[0, -9], [0, 18], [half + 8, 4], [-half - 8, 4]] as const) {
        const box: Box = [x + across - half, y + down - CHARACTER_HEIGHT + 3, x + across + half, y + down + 3];
        if (!isFree(box)) continue;
        occupied.push(box);
        return { text, x: x + across, y: y + down, box };
      }
    }
    return null;
  });
}
