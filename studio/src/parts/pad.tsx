// On-screen buttons for players without a keyboard.

const PAD: [code: string, symbol: string, label: string][] = [
  ["", "", ""], ["ArrowUp", "↑", "Ahead"], ["Space", "● use", "Use what is ahead"],
  ["ArrowLeft", "←", "Left"], ["ArrowDown", "↓", "Back"], ["ArrowRight", "→", "Right"],
];

export function Pad({ set }: { set: (code: string, isDown: boolean) => void }) {
  return (
    <div class="pad-keys">
      {PAD.map(([code, symbol, label], index) => code
        ? (
          <button
            key={index} type="button" aria-label={label}
            onPointerDown={() => set(code, true)} onPointerUp={() => set(code, false)} onPointerLeave={() => set(code, false)}
          >{symbol}</button>
        )
        : <span key={index} />)}
    </div>
  );
}
