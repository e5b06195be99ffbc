// Editor for a text layout, as a grid of cells: a click, a drag or a key sets a letter.

import { useState } from "preact/hooks";
import type { TextLayout } from "../layouts.ts";

const MOVES: Record<string, [number, number]> = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

export function Cells({ layout, put }: { layout: TextLayout; put: (row: number, column: number, letter: string) => void }) {
  const [letter, setLetter] = useState("#");
  const [place, setPlace] = useState<[number, number]>([0, 0]);
  const rows = layout.rows.map((row) => [...row]);
  const columns = Math.max(...rows.map((row) => row.length));
  const meaning = (sign: string) => layout.letters.find((known) => known.letter === sign)?.meaning ?? sign;
  const walk = (event: KeyboardEvent, row: number, column: number) => {
    const move = MOVES[event.key];
    if (move) {
      event.preventDefault();
      const next: [number, number] = [Math.min(Math.max(row + move[0], 0), rows.length - 1), Math.min(Math.max(column + move[1], 0), columns - 1)];
      setPlace(next);
      (event.currentTarget as HTMLElement).parentElement?.querySelector<HTMLElement>(`[data-cell="${next.join(" ")}"]`)?.focus();
    } else if (layout.letters.some((known) => known.letter === event.key)) {
      put(row, column, event.key);
    }
  };
  return (
    <div class="stack">
      <div class="row" role="group" aria-label="What a click puts">
        {layout.letters.map((known) => (
          <button key={known.letter} type="button" aria-pressed={letter === known.letter} onClick={() => setLetter(known.letter)}>
            <code aria-hidden="true">{known.letter}</code> {known.meaning}
          </button>
        ))}
      </div>
      <div
        class="cells" role="group" aria-label="Cells of the map: arrow keys move, a letter or Enter puts"
        style={{ gridTemplateColumns: `repeat(${columns}, minmax(0, 1fr))`, maxWidth: `${columns * 1.75}rem` }}
      >
        {rows.flatMap((row, r) => row.map((sign, c) => (
          <button
            key={`${r} ${c}`} type="button" data-cell={`${r} ${c}`}
            class={meaning(sign) === "wall" ? "wall" : ""} tabIndex={place[0] === r && place[1] === c ? 0 : -1}
            aria-label={`row ${r + 1}, column ${c + 1}: ${meaning(sign)}`}
            onClick={() => { setPlace([r, c]); put(r, c, letter); }}
            onPointerEnter={(event) => event.buttons === 1 && event.pointerType === "mouse" && sign !== letter && put(r, c, letter)}
            onKeyDown={(event) => walk(event, r, c)}
          >{["wall", "floor"].includes(meaning(sign)) ? "" : sign}</button>
        )))}
      </div>
    </div>
  );
}
