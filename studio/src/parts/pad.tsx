// On-screen buttons for players without a keyboard.

const PAD: [code: string, sign: string, word: string][] = [
  ["", "", ""], ["ArrowUp", "↑", "Ahead"], ["Space", "● use", "Use what is ahead"],
  ["ArrowLeft", "←", "Left"], ["ArrowDown", "↓", "Back"], ["ArrowRight", "→", "Right"],
];

export function Pad({ set }: { set: (code: string, isDown: boolean) => void }) {
  return (
    <div class="pad-keys">
      {PAD.map(([code, sign, word], place) => code
        ? (
          <button
            key={place} type="button" aria-label={word}
            onPointerDown={() => set(code, true)} onPointerUp={() => set(code, false)} onPointerLeave={() => set(code, false)}
          >{sign}</button>
        )
        : <span key={place} />)}
    </div>
  );
}
