"""Writes a small log with l2logger, and its table with l2logger.aggregate: l2logger_aggregate/ and l2logger_aggregate.tsv here.

Usage: L2DATA=<empty folder> python l2logger_aggregate.py
Made with l2logger 1.8.2, pandas 2.3.3.
"""

import runpy
import shutil
import sys
import tempfile
from pathlib import Path

from l2logger import l2logger

here = Path(__file__).parent
target = here / "l2logger_aggregate"
shutil.rmtree(target, ignore_errors=True)

with tempfile.TemporaryDirectory() as base:
    info = {"metrics_columns": ["reward", "Steps"]}
    logger = l2logger.DataLogger(base, "small", info, {"complexity": "1-low", "difficulty": "1-easy", "scenario_type": "custom"})
    exp_num = 0
    for block_num, (block_type, subtype, task) in enumerate(
        [("test", "wake", "Find_Red"), ("train", "wake", "find_red"), ("train", "sleep", "find_red"), ("test", "wake", "find_blue")]
    ):
        for step in range(4):
            record = {
                "block_num": block_num,
                "block_type": block_type,
                "block_subtype": subtype,
                "exp_num": exp_num,
                "worker_id": f"worker-{exp_num % 2}",
                "task_name": task if step < 3 else "other_task",
                "task_params": {"size": 0.1 * step, "words": ['a "quoted" one', "tab\there"]} if step else {},
                "exp_status": "incomplete" if step == 1 else "complete",
                "reward": exp_num / 3 - 1,
                "Steps": 10 * exp_num,
                "debug": "hm, \"so\"" if step == 2 else "fine",
            }
            logger.log_record(record)
            exp_num += step != 1
    logger.close()
    shutil.copytree(logger.scenario_dir, target)

sys.argv = ["aggregate", str(target), "-o", str(here / "l2logger_aggregate")]
runpy.run_module("l2logger.aggregate", run_name="__main__")
