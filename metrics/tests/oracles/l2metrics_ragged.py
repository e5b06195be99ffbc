"""Scores random ragged lifetimes with l2metrics; writes l2metrics_ragged.json.gz beside this file.

Usage: L2DATA=<empty folder> python l2metrics_ragged.py [NUMBER OF LIFETIMES [FILE TO WRITE]]
Made with l2metrics 3.1.0 and l2logger 1.8.2 under the versions that the JSON names; pandas below 3, which the package was written for.

Unlike the lifetimes of `l2metrics_lifetimes.py`, ragged lifetimes have gaps in the numbers of experiences, interrupted experiences, a
different worker for each block, cells with tabs, quotes and line breaks, words for missing numbers, tasks without a variant among
tasks with one, experts of several variants of a task with several runs each, and expert logs that are ragged themselves.

The reference takes the experts of a task's variants in the order in which the file system lists them, so lists with one value per expert
must be compared as sets. Data files are listed by name here, because their order determines which of two workers' rows with one number
comes first.
"""

import csv
import gzip
import io
import json
import math
import os
import random
import shutil
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import scipy

np.NaN = np.nan  # l2metrics 3.1 uses this name, which numpy 2 removed.
warnings.simplefilter("ignore")

from l2metrics import util
from l2metrics.report import MetricsReport

listed = Path.rglob
Path.rglob = lambda self, pattern: sorted(listed(self, pattern))

HEADER = ["block_num", "exp_num", "worker_id", "block_type", "block_subtype", "task_name", "task_params", "exp_status",
          "timestamp", "comment", "pay", "score"]
POOL = ["ferry", "ferry_red", "ferry_blue", "dock_old", "dock", "Mast_Tall", "mast_low", "buoy", "kite_1"]
PARAMS = ["{}", '{"note": "a\\tb"}', '{"say": "\\"hi\\""}', "", '{"line": "one\\ntwo"}', '{"wide": "\u00c6\u2003\u00df"}', '{\n"deep":\t{"a": [1, null]}}']
COMMENTS = ["", "plain", "a\tb", 'say "hi"', '"', "one\ntwo", "\u2003", "nan", "'"]
NO_NUMBER = ["nan", "", "NA", "null", "None", "N/A", "NaN", "<NA>"]


def number_text(chance, value):
    """A number in a random notation."""
    way = chance.random()
    if way < 0.8:
        return f"{value:.2f}"
    if way < 0.9:
        return f"{value:.1e}"
    return f"{round(value)}"


def draw_segment(chance, state, ragged, block, task, longest, level, slope):
    """Consecutive rows of one task in one block, as columns of numbers, statuses and scores."""
    segment = {"block": block, "task": task, "params": chance.randrange(len(PARAMS)),
               "exp": [], "status": "", "score": [], "pay": [], "comment": []}

    def row(status, score):
        segment["exp"].append(state["exp"])
        segment["status"] += status
        segment["score"].append(score)
        pay = round(chance.gauss(level - 4, 3))
        segment["pay"].append(str(pay) if chance.random() < 0.95 else chance.choice(NO_NUMBER))
        segment["comment"].append(chance.randrange(len(COMMENTS)) if chance.random() < 0.2 else 0)

    for k in range(chance.randint(1, longest)):
        value = level + slope * k + chance.uniform(-1, 1)
        if ragged and chance.random() < 0.08:
            row("i", number_text(chance, value - 1))
            if chance.random() < 0.5:  # The experience is never completed.
                state["exp"] += chance.randint(1, 3)
                continue
        none = ragged and chance.random() < 0.06
        row("c", chance.choice(NO_NUMBER) if none else number_text(chance, value))
        state["exp"] += chance.randint(2, 40) if ragged and chance.random() < 0.1 else 1
    return segment


def draw_lifetime(chance, tasks, style):
    segments, state = [], {"exp": chance.choice([0, 0, 17])}
    block = chance.choice([0, 0, 3])
    for number in range(chance.randint(4, 8)):
        kind = ["train", "test"][number % 2] if chance.random() < 0.7 else chance.choice(["train", "test"])
        subtype = "sleep" if style["sleeps"] and chance.random() < 0.4 else "wake"
        worker = {"one": "w0", "each": f"rig-{number}.b", "numbers": str(number)}[style["workers"]]
        for task in chance.sample(tasks, chance.randint(1, len(tasks))):
            longest = chance.choice([3, 6, 12, 30])
            segment = draw_segment(chance, state, True, block, task, longest, chance.uniform(-2, 8), chance.uniform(-0.1, 0.4))
            segments.append({"kind": kind, "subtype": subtype, "worker": worker, **segment})
        block += chance.choice([1, 1, 1, 4])
        state["exp"] += chance.choice([0, 0, 25])
    return segments


def draw_expert(chance, task, style):
    segments, state, level = [], {"exp": 0}, chance.uniform(-1, 8)
    for block in range(chance.randint(1, 3)):
        kind = "test" if block == 1 else "train"
        segment = draw_segment(chance, state, style["ragged_experts"], block, task, chance.choice([8, 20]), level, 0.1)
        segments.append({"kind": kind, "subtype": "wake", "worker": "w0", **segment})
    if style["flat_experts"]:  # Scores that sum to 0, so that ratios are undefined.
        for segment in segments:
            segment["score"] = ["0" for _ in segment["score"]]
    return segments


def files_of(segments):
    """The rows of each data file of a log, by the file's path."""
    files = {}
    for segment in segments:
        path = f"{segment['worker']}/{segment['block']}-{segment['kind']}/data-log.tsv"
        rows = files.setdefault(path, [])
        for k, exp in enumerate(segment["exp"]):
            rows.append([segment["block"], exp, segment["worker"], segment["kind"], segment["subtype"], segment["task"],
                         PARAMS[segment["params"]], "complete" if segment["status"][k] == "c" else "incomplete",
                         f"20200913T122640.{exp:06d}", COMMENTS[segment["comment"][k]], segment["pay"][k], segment["score"][k]])
    return files


def write_log(folder, segments):
    folder.mkdir(parents=True)
    (folder / "logger_info.json").write_text('{"metrics_columns": ["score", "pay"], "log_format_version": "1.1"}')
    (folder / "scenario_info.json").write_text("{}")
    for path, rows in files_of(segments).items():
        text = io.StringIO()
        writer = csv.writer(text, delimiter="\t", lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows(rows)
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text.getvalue().encode())


def plain(value):
    """The value in JSON's types, to twelve digits. Numbers that are not finite are None in a list and left out elsewhere."""
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items() if plain(entry) is not None}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(entry) for entry in value]
    if isinstance(value, (np.integer, int)):
        return int(value)
    if isinstance(value, (np.floating, float)):
        return float(f"{value:.12g}") if math.isfinite(value) else None
    return value


def options_of(chance, tasks, number):
    options = {
        "perf_measure": chance.choice(["score", "score", "score", "pay"]),
        "maintenance_method": chance.choice(["mrlep", "mrtlp", "both"]),
        "transfer_method": chance.choice(["ratio", "contrast", "both"]),
        "aggregation_method": chance.choice(["mean", "mean", "median"]),
        "normalization_method": chance.choice(["task", "task", "run", "none"]),
        "smoothing_method": chance.choice(["flat", "flat", "none", "none", "hanning", "hamming", "bartlett", "blackman"]),
        "ste_averaging_method": chance.choice(["metrics", "metrics", "time"]),
        "variant_mode": chance.choice(["aware", "aware", "agnostic"]),
        "clamp_outliers": chance.random() < 0.5,
        "smooth_eval_data": chance.random() < 0.2,
        "window_length": chance.choice([None, None, 3, 4, 7]),
    }
    if chance.random() < 0.15:
        options["data_range"] = {task.lower(): {"min": chance.randint(-5, 0), "max": chance.randint(5, 12)} for task in tasks}
    # These cases are always included, whatever else is drawn.
    if number % 5 == 0:
        options.update(smoothing_method="none", clamp_outliers=True)
    if number % 7 == 0:
        options = {"perf_measure": "score"}
    return options


def score(life, options):
    arguments = dict(options)
    if "smooth_eval_data" in arguments:
        arguments["do_smooth_eval_data"] = arguments.pop("smooth_eval_data")
    report = MetricsReport(log_dir=life, **arguments)
    report.calculate()
    found = plain(dict(report.ll_metrics_dict))
    regimes = report.regime_metrics_df.reset_index(drop=True)
    names = ["regime_num", "block_num", "task_name", "saturation", "exp_to_sat", "term_perf", "exp_to_term_perf", "avg_perf"]
    return {
        "options": options,
        "lifetime": {name: found[name] for name in report.task_metrics if name in found},
        "whole": {name: found[name] for name in ["min", "max", "num_lx", "num_ex", "runtime"]},
        "range": found.get("normalization_data_range"),
        "tasks": {task: {name: value for name, value in values.items() if name != "run_id"}
                  for task, values in found["task_metrics"].items()},
        "regimes": [[plain(row.get(name)) for name in names] for row in regimes.to_dict("records")],
    }


def case(seed, base):
    chance = random.Random(seed)
    tasks = chance.sample(POOL, chance.randint(2, 5))
    if seed % 3 == 0:  # A task without a variant, with experts of its variants (added below).
        tasks = ["ferry"] + [task for task in tasks if task != "ferry"][:3]
    style = {"sleeps": seed % 6 == 1, "workers": chance.choice(["one", "each", "each", "numbers"]),
             "ragged_experts": chance.random() < 0.6, "flat_experts": seed % 10 == 4}
    life = draw_lifetime(chance, tasks, style)
    trained = [task for task in POOL if task != "ferry" or seed % 4 == 1]
    experts = [draw_expert(chance, task, style) for task in chance.sample(trained, chance.randint(1, 5)) for _ in range(chance.randint(1, 2))]
    if seed % 3 == 0:
        experts += [draw_expert(chance, task, style) for task in ["ferry_red", "ferry_blue"]]
    shutil.rmtree(Path(os.environ["L2DATA"]) / "taskinfo", ignore_errors=True)
    stored = set()
    for number, expert in enumerate(experts):
        folder = base / f"expert{number}"
        write_log(folder, expert)
        task = expert[0]["task"].lower()
        util.store_ste_data(folder, "a" if task in stored else "w")
        stored.add(task)
    write_log(base / "life", life)
    scored = [score(base / "life", options_of(chance, tasks, number)) for number in [seed, seed + 1]]
    return {"seed": seed, "life": life, "experts": experts, "scored": scored}


if __name__ == "__main__":
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    cases, refused, seed = [], [], 0
    while len(cases) < wanted:
        with tempfile.TemporaryDirectory() as base:
            try:
                cases.append(case(seed, Path(base)))
            except Exception as error:  # The reference fails for some lifetimes, which are left out.
                refused.append([seed, f"{type(error).__name__}: {error}"[:200]])
        seed += 1

    made_with = f"numpy {np.__version__}, pandas {pd.__version__}, scipy {scipy.__version__}"
    oracle = {"made_with": made_with, "stumbled": refused, "header": HEADER, "params": PARAMS, "comments": COMMENTS, "cases": cases}
    text = json.dumps(oracle, separators=(",", ":"))
    target = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).with_suffix(".json.gz")
    target.write_bytes(gzip.compress(text.encode(), 9, mtime=0))
    print(len(cases), "cases,", len(refused), "refused,", len(text), "characters,", target.stat().st_size, "bytes")
    for entry in refused:
        print(entry)
