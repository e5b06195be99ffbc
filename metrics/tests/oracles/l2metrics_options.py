"""Scores the published example under many options with l2metrics; writes l2metrics_options.json beside this file.

Usage: L2DATA=<empty folder> python l2metrics_options.py <reference folder, which holds l2metrics/>
Made with l2metrics 3.1.0 and l2logger 1.8.0 under the versions that the JSON names.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import scipy

np.NaN = np.nan  # l2metrics 3.1 uses this name, which numpy 2 removed.

from l2metrics import util
from l2metrics.report import MetricsReport

RANGE = {"task1_1": {"min": 0, "max": 50}, "task2_1": {"min": 1, "max": 90}, "task3_1": {"min": -5, "max": 120}}
CASES = [
    {"maintenance_method": "both", "transfer_method": "both"},
    {"normalization_method": "run", "aggregation_method": "median", "transfer_method": "contrast"},
    {"normalization_method": "none", "smoothing_method": "none"},
    {"smoothing_method": "hanning", "window_length": 11},
    {"smoothing_method": "hamming", "window_length": 12, "smooth_eval_data": True},
    {"smoothing_method": "bartlett"},
    {"smoothing_method": "blackman", "window_length": 9},
    {"window_length": 3},
    {"clamp_outliers": True},
    {"clamp_outliers": True, "normalization_method": "none", "smoothing_method": "none"},
    {"data_range": RANGE},
    {"data_range": RANGE, "clamp_outliers": True},
    {"ste_averaging_method": "time"},
    {"variant_mode": "agnostic", "transfer_method": "both"},
]

base = Path(sys.argv[1]) / "l2metrics"
for run in ["task1_1_run1", "task2_1_run1", "task3_1_run1", "task3_1_run2"]:
    util.store_ste_data(base / "ste_logs" / f"ste_{run}", "a" if run.endswith("run2") else "w")

cases = []
for options in CASES:
    arguments = dict(options)
    arguments["do_smooth_eval_data"] = arguments.pop("smooth_eval_data", False)
    report = MetricsReport(log_dir=base / "ll_logs" / "multi_task", perf_measure="performance", **arguments)
    report.calculate()
    lifetime = {name: report.ll_metrics_dict[name] for name in report.task_metrics}
    lifetime = {name: value for name, value in lifetime.items() if value is not None}
    cases.append({"options": options, "lifetime": lifetime})

made_with = f"numpy {np.__version__}, pandas {pd.__version__}, scipy {scipy.__version__}"
target = Path(__file__).with_suffix(".json")
target.write_text(json.dumps({"made_with": made_with, "cases": cases}) + "\n")
