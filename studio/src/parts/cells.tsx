// Shows a text layout as a grid of cells that can be edited: a click, a drag or a key sets a letter.

import { useState } from "preact/hooks";
import type { TextLayout } from "../layouts.ts";

const MOVES: Record<string, [number, number]> = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

export function Cells({ layout, put }: { layout: TextLayout; put: (row: number, column: number, letter: string) => void }) {
  const [letter, setLetter] = useState("#");
  const [focused, setFocused] = useState<[number, number]>([0, 0]);
  const rows = layout.rows.map((row) => [...row]);
  const columns = Math.max(...rows.map((row) => row.length));
  const meaning = (character: string) => layout.letters.find((known) => known.letter === character)?.meaning ?? character;
  const handleKey = (event: KeyboardEvent, row: number, column: number) => {
    const move = MOVES[event.key];
    if (move) {
      event.preventDefault();
      const next: [number, number] = [Math.min(Math.max(row + move[0], 0), rows.length - 1), Math.min(Math.max(column + move[1], 0), columns - 1)];
      setFocused(next);
      (event.currentTarget as HTMLElement).parentElement?.querySelector<HTMLElement>(`[data-cell="${next.join(" ")}"]`)?.focus();
    } else if (layout.letters.some((known) => known.letter === event.key)) {
      put(row, column, event.key);
    }
  };
  return (
    <div class="stack">
      <div class="row" role="group" aria-label="Letter that a click sets">
        {layout.letters.map((known) => (
          <button key={known.letter} type="button" aria-pressed={letter === known.letter} onClick={() => setLetter(known.letter)}>
            <code aria-hidden="true">{known.letter}</code> {known.meaning}
          </button>
        ))}
      </div>
      <div
        class="cells" role="group" aria-label="Cells of the map: arrow keys move, a letter or Enter sets"
        style={{ gridTemplateColumns: `repeat(${columns}, minmax(0, 1fr))`, maxWidth: `${columns * 1.75}rem` }}
      >
        {rows.flatMap((row, r) => row.map((character, c) => (
          <button
            key={`${r} ${c}`} type="button" data-cell={`${r} ${c}`}
            class={meaning(character) === "wall" ? "wall" : ""} tabIndex={focused[0] === r && focused[1] === c ? 0 : -1}
            aria-label={`row ${r + 1}, column ${c + 1}: ${meaning(character)}`}
            onClick={() => { setFocused([r, c]); put(r, c, letter); }}
            onPointerEnter={(event) => event.buttons === 1 && event.pointerType === "mouse" && character !== letter && put(r, c, letter)}
            onKeyDown={(event) => handleKey(event, r, c)}
          >{["wall", "floor"].includes(meaning(character)) ? "" : character}</button>
        )))}
      </div>
    </div>
  );
}
