"""Draws docs/images/speed.svg and prints its table, with steps per second of Driftworld and its peers from one run.

    taskset -c 0 target/release/driftworld bench env --json | python scripts/speed.py PEERS

PEERS is a file with a line for each peer: its name, its observations and its steps per second, separated by tabs.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

IMAGE = Path(__file__).parents[1] / "docs/images/speed.svg"
#: Driftworld's rows: keys of `driftworld bench env --json`.
OURS = {
    "steps_per_second_per_core_160x120_natural": "160 × 120, colour, depth, classes",
    "steps_per_second_per_core_160x120": "the same, plain",
    "steps_per_second_per_core_84_natural": "84 × 84, colour, depth, classes",
    "steps_per_second_per_core_84": "the same, plain",
    "steps_per_second_per_core_maze_64_rgb_natural": "64 × 64, colour, maze",
    "steps_per_second_per_core_maze_64_rgb": "the same, plain",
}
LEFT, WIDTH, ROW = 330, 860, 30


def main() -> None:
    """Reads the figures of Driftworld and its peers, prints the table, and draws the image."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    peers = [line.split("\t") for line in Path(sys.argv[1]).read_text(encoding="utf-8").splitlines() if line]
    figures = json.load(sys.stdin)
    bars = [(who, what, float(steps)) for who, what, steps in peers]
    bars += [("Driftworld", what, figures[key]) for key, what in OURS.items() if key in figures]
    print("| environment | observation | steps a second on one core |\n|---|---|---|")
    fastest = max(steps for _, _, steps in bars)
    shapes = []
    for row, (who, what, steps) in enumerate(bars):
        print(f"| {who} | {what} | {steps:,.0f} |")
        top, length = 38 + ROW * row, max(steps / fastest * (WIDTH - LEFT - 90), 1)
        color = "#2a6f97" if who == "Driftworld" else "#a5a58d"
        shapes += [
            f'<text x="{LEFT - 8}" y="{top + 17}" text-anchor="end" fill="#222222">{who}: {what}</text>',
            f'<rect x="{LEFT}" y="{top + 3}" width="{length:.1f}" height="20" fill="{color}"/>',
            f'<text x="{LEFT + length + 6:.1f}" y="{top + 17}" fill="#222222">{steps:,.0f}</text>',
        ]
    size = f'width="{WIDTH}" height="{ROW * len(bars) + 46}" font-family="sans-serif" font-size="13"'
    title = "Steps a second on one core, measured in one run"
    head = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>',
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        f'<text x="14" y="24" font-size="15" font-weight="bold" fill="#222222">{title}</text>',
    ]
    IMAGE.write_text("\n".join([*head, *shapes, "</svg>"]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
