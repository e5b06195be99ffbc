// Outlines the squares in which two images differ.

import type { Frame } from "./engine.ts";

/** A line from one point to another, in pixels. */
export type Line = [number, number, number, number];

/** Divides two images into squares of `side` pixels, and outlines those in which a channel differs by more than `threshold`. */
export function outlines(a: Frame, b: Frame, side = 8, threshold = 24): Line[] {
  if (a.width !== b.width || a.height !== b.height) return [];
  const [columns, rows] = [Math.ceil(a.width / side), Math.ceil(a.height / side)];
  const differs = new Uint8Array(columns * rows);
  for (let pixel = 0; pixel < a.width * a.height; pixel += 1) {
    const square = Math.floor(Math.floor(pixel / a.width) / side) * columns + Math.floor((pixel % a.width) / side);
    if (differs[square]) continue;
    for (let channel = 0; channel < 3; channel += 1) {
      if (Math.abs(a.data[4 * pixel + channel]! - b.data[4 * pixel + channel]!) > threshold) differs[square] = 1;
    }
  }
  const at = (column: number, row: number) => (column < 0 || row < 0 || column >= columns || row >= rows ? 0 : differs[row * columns + column]!);
  const lines: Line[] = [];
  for (let row = 0; row <= rows; row += 1) {
    for (let column = 0; column <= columns; column += 1) {
      const [x, y, right, below] = [column * side, row * side, Math.min((column + 1) * side, a.width), Math.min((row + 1) * side, a.height)];
      if (at(column, row) !== at(column - 1, row)) lines.push([Math.min(x, a.width), y, Math.min(x, a.width), below]);
      if (at(column, row) !== at(column, row - 1)) lines.push([x, Math.min(y, a.height), right, Math.min(y, a.height)]);
    }
  }
  return lines;
}
