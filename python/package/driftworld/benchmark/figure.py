"""Draws the figure for a table: each learner's performance over its lifetime."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np

from driftworld.benchmark.measures import interquartile_mean

if TYPE_CHECKING:
    from driftworld.benchmark.table import Results

_WIDTH, _HEIGHT, _GAP, _ROW = 220, 120, 34, 3
_STYLE = (
    "svg{background:#fff}text{font:12px sans-serif;fill:#333}.grid{stroke:#ddd}.seed{stroke:#8ab4d8;stroke-width:1}.mean{stroke:#0b5394;stroke-width:2.5}"
    ".other{stroke:#bbb;stroke-width:2}path{fill:none}"
)


def figure(results: Results, reference: str = "finetuning") -> str:
    """An SVG with a panel for each learner: the mean of all tasks after each task, with sampled actions.

    Bold lines are interquartile means over seeds, thin lines single seeds, and grey lines the ``reference``.
    """
    curves = {label: np.array([run.sampled.values.mean(axis=1) for run in runs]) for label, runs in results.runs.items()}
    means = {label: np.apply_along_axis(interquartile_mean, 0, each) for label, each in curves.items()}
    order = sorted(means, key=lambda label: -means[label][-1])
    rows = -(-len(order) // _ROW)
    parts = []
    for place, label in enumerate(order):
        left, top = _GAP + place % _ROW * (_WIDTH + _GAP), 26 + place // _ROW * (_HEIGHT + 46)
        parts.append(f'<g transform="translate({left} {top})"><text y="-8" font-weight="bold">{escape(label)}</text>')
        for share in (0, 0.5, 1):
            y = _HEIGHT * (1 - share)
            parts.append(f'<path class="grid" d="M0 {y:g}H{_WIDTH}"/><text x="-6" y="{y + 4:g}" text-anchor="end">{share * 100:.0f}</text>')
        last = curves[label].shape[1] - 1
        parts += [f'<text x="{_WIDTH * task / last:.1f}" y="{_HEIGHT + 16}" text-anchor="middle">{task}</text>' for task in range(last + 1)]
        lines = [("other", means[reference])] if reference in means and label != reference else []
        lines += [*(("seed", curve) for curve in curves[label]), ("mean", means[label])]
        for kind, curve in lines:
            points = " ".join(f"{_WIDTH * task / last:.1f} {_HEIGHT * (1 - value):.1f}" for task, value in enumerate(curve))
            parts.append(f'<path class="{kind}" d="M{points}"/>')
        parts.append("</g>")
    width, height = _GAP + _ROW * (_WIDTH + _GAP), 26 + rows * (_HEIGHT + 46)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">'
    title = f"<title>Mean of all tasks of {escape(results.sequence.name)} after each task</title>"
    return f"{head}{title}<style>{_STYLE}</style>{''.join(parts)}</svg>\n"
