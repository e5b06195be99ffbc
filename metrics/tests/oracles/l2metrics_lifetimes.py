"""Scores random lifetimes with l2metrics; writes l2metrics_lifetimes.json beside this file.

Usage: L2DATA=<empty folder> python l2metrics_lifetimes.py
Made with l2metrics 3.1.0 and l2logger 1.8.2 under the versions that the JSON names.

The lifetimes contain cases that the published example lacks: sleep, several workers, rows without a number, incomplete rows, tasks
that are never trained or never evaluated, several tasks learned between two evaluations, regimes of one row.
"""

import json
import math
import os
import random
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import scipy

np.NaN = np.nan  # l2metrics 3.1 uses this name, which numpy 2 removed.

from l2metrics import util
from l2metrics.report import MetricsReport

COLUMNS = ["block_num", "exp_num", "worker_id", "block_type", "block_subtype", "task_name", "exp_status", "score"]
HEADER = COLUMNS[:6] + ["task_params", "exp_status", "timestamp", "score"]
TASKS = ["a_1", "a_2", "b_1", "c_1"]


def draw_rows(chance, tasks, num_blocks, longest, sleeps=False, workers=1, holes=False):
    rows, exp_num = [], 0
    for block_num in range(num_blocks):
        block_type = chance.choice(["train", "test"])
        subtype = "sleep" if sleeps and chance.random() < 0.4 else "wake"
        regimes = chance.sample(tasks, chance.randint(1, len(tasks)))
        for task in regimes:
            level = chance.uniform(0, 8)
            for k in range(chance.randint(1, longest)):
                for worker in range(workers if chance.random() < 0.3 else 1):
                    score = round(level + k * chance.uniform(0, 0.3) + chance.uniform(-1, 1), 2)
                    status = "complete"
                    if holes and chance.random() < 0.1:
                        score = None
                    if holes and chance.random() < 0.1:
                        status = "incomplete"
                    rows.append([block_num, exp_num, f"w{worker}", block_type, subtype, task, status, score])
                exp_num += 1
    return rows


def write_log(folder, rows):
    folder.mkdir(parents=True)
    (folder / "logger_info.json").write_text('{"metrics_columns": ["score"], "log_format_version": "1.1"}')
    (folder / "scenario_info.json").write_text("{}")
    for key in sorted({(row[2], row[0], row[3]) for row in rows}):
        worker, block_num, block_type = key
        block = folder / worker / f"{block_num}-{block_type}"
        block.mkdir(parents=True)
        with open(block / "data-log.tsv", "w", newline="\n") as file:
            print(*HEADER, sep="\t", file=file)
            for row in rows:
                if (row[2], row[0], row[3]) == key:
                    score = "nan" if row[7] is None else row[7]
                    stamp = f"20200913T122640.{row[1]:06d}"
                    print(*row[:6], "{}", row[6], stamp, score, sep="\t", file=file)


def plain(value):
    """The value in JSON's types; NaN becomes None, and entries that are None are left out."""
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items() if plain(entry) is not None}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(entry) for entry in value]
    if isinstance(value, (np.integer, int)):
        return int(value)
    if isinstance(value, (np.floating, float)):
        return None if math.isnan(value) else float(value)
    return value


def options_of(chance):
    options = {
        "maintenance_method": "both",
        "transfer_method": "both",
        "aggregation_method": chance.choice(["mean", "mean", "median"]),
        "normalization_method": chance.choice(["task", "task", "run", "none"]),
        "smoothing_method": chance.choice(["flat", "flat", "hamming", "none"]),
        "ste_averaging_method": chance.choice(["metrics", "time"]),
        "variant_mode": chance.choice(["aware", "aware", "agnostic"]),
        "clamp_outliers": chance.random() < 0.2,
        "smooth_eval_data": chance.random() < 0.2,
    }
    return options


def case(seed, base):
    chance = random.Random(seed)
    tasks = TASKS[: chance.randint(2, 4)]
    sleeps, holes, workers = seed % 4 == 1, seed % 3 == 2, 2 if seed % 5 == 3 else 1
    rows = draw_rows(chance, tasks, chance.randint(4, 8), 13, sleeps, workers, holes)
    experts = []
    for task in tasks[: chance.randint(0, len(tasks))]:
        for _ in range(chance.randint(1, 2)):
            level = chance.uniform(0, 8)
            learning = [[0, k, "w0", "train", "wake", task, "complete", round(level + k * 0.1 + chance.uniform(-1, 1), 2)]
                        for k in range(chance.randint(3, 40))]
            experts.append(learning)
    options = options_of(chance)
    # The reference stores an expert under its task and variant, and finds none for a task without a variant.
    shutil.rmtree(Path(os.environ["L2DATA"]) / "taskinfo", ignore_errors=True)
    if options["variant_mode"] == "agnostic":
        experts = []
    stored = set()
    for number, expert in enumerate(experts):
        folder = base / f"expert{number}"
        write_log(folder, expert)
        util.store_ste_data(folder, "a" if expert[0][5] in stored else "w")
        stored.add(expert[0][5])
    write_log(base / "life", rows)
    arguments = dict(options)
    arguments["do_smooth_eval_data"] = arguments.pop("smooth_eval_data")
    report = MetricsReport(log_dir=base / "life", perf_measure="score", **arguments)
    report.calculate()
    found = plain({key: value for key, value in report.ll_metrics_dict.items()})
    lifetime = {name: found[name] for name in report.task_metrics if name in found}
    regimes = report.regime_metrics_df.reset_index(drop=True)
    names = ["regime_num", "block_num", "task_name", "saturation", "exp_to_sat", "term_perf", "exp_to_term_perf", "avg_perf"]
    table = [[plain(row.get(name)) for name in names] for row in regimes.to_dict("records")]
    return {
        "seed": seed, "options": options, "rows": rows, "experts": experts, "lifetime": lifetime,
        "tasks": {task: {name: value for name, value in values.items() if name not in ("run_id",)}
                  for task, values in found["task_metrics"].items()},
        "regimes": table,
    }


cases, refused = [], []
for seed in range(30):
    with tempfile.TemporaryDirectory() as base:
        try:
            cases.append(case(seed, Path(base)))
        except Exception as error:  # The reference fails for some lifetimes, which are left out.
            refused.append([seed, f"{type(error).__name__}: {error}"])

made_with = f"numpy {np.__version__}, pandas {pd.__version__}, scipy {scipy.__version__}"
lines = ",\n  ".join(json.dumps(entry, separators=(",", ":")) for entry in cases)
refused = json.dumps(refused)
target = Path(__file__).with_suffix(".json")
target.write_text(f'{{\n "made_with": "{made_with}",\n "stumbled": {refused},\n "cases": [\n  {lines}\n ]\n}}\n')
print(len(cases), "cases,", refused, target.stat().st_size, "bytes")
