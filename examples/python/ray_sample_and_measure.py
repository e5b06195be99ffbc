"""Ray Data draws a million variants in shards, measures the distance of each from the first, and samples a world of each.

Variant number i and its world are pure functions of the seed and i. Shards have a fixed size, whichever worker runs them,
and are merged in order, so the numbers and the digest are the same on one worker and on a thousand.

    python examples/python/ray_sample_and_measure.py --variants 1000000            # on this machine's processors
    python examples/python/ray_sample_and_measure.py --variants 1000000 --address auto    # on the cluster that this machine is in
    python examples/python/ray_sample_and_measure.py --quick                       # only checks that it runs

Needs `pip install "./python[ray]"`, on every machine of the cluster. A cluster with token authentication (see Ray's
documentation) also needs the token here.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import logging
import os
import time
from functools import partial
from typing import Any

import driftworld
import numpy as np
import ray
import ray.data
from record import Record, Watch, result_folder

TASK = "find_objects"
# The parameters that vary, with their full ranges. The others keep the first variant's values.
RANGES = {
    "light": (0.2, 4.0),
    "spread": (2.0, 40.0),
    "target_reward": (-100.0, 100.0),
    "speed": (1.0, 10.0),
    "turn_rate": (15.0, 180.0),
}
COLOURS = ("blue", "red", "green")
ELEMENTS = ("S", "A", "T", "R", "O")
BINS = 20
# The largest distance: the full range of each parameter counts 1, and so does the colour.
MAX_DISTANCE = float(len(RANGES) + 1)


def variant_of(task: driftworld.TaskSpec, seed: int, number: int) -> driftworld.Variant:
    """Variant number `number` of a seed."""
    generator = np.random.Generator(np.random.Philox(key=[seed, number]))
    changes: dict[str, Any] = {name: float(generator.uniform(low, high)) for name, (low, high) in RANGES.items()}
    changes["target_color"] = COLOURS[int(generator.integers(len(COLOURS)))]
    return task.variant("blue").with_values(f"drawn_{number}", **changes)


def measure(batch: dict[str, np.ndarray], seed: int, shard_size: int, variants: int) -> dict[str, list[Any]]:
    """Measures some shards; returns sums, counts and a digest for each."""
    task = driftworld.TaskSpec.load(TASK)
    first = task.variant("blue")
    rows = []
    for shard in batch["id"].tolist():
        digest = hashlib.sha256()
        totals, elements, objects = [], [], []
        for number in range(shard * shard_size, min((shard + 1) * shard_size, variants)):
            drawn = variant_of(task, seed, number)
            distance = driftworld.distance(first, drawn)
            world = drawn.sample_json(seed, number)
            totals.append(distance.total)
            elements.append([distance.elements[letter] or 0.0 for letter in ELEMENTS])
            objects.append(len(json.loads(world)["objects"]))
            digest.update(f"{drawn.hash} {distance.total!r} {hashlib.sha256(world.encode()).hexdigest()}\n".encode())
        rows.append({
            "shard": shard,
            "count": len(totals),
            "sum": float(np.sum(totals)),
            "least": min(totals),
            "most": max(totals),
            "elements": np.sum(elements, axis=0),
            "objects": int(np.sum(objects)),
            "histogram": np.histogram(np.minimum(totals, MAX_DISTANCE), bins=BINS, range=(0.0, MAX_DISTANCE))[0],
            "digest": digest.hexdigest(),
        })  # fmt: skip
    return {name: [row[name] for row in rows] for name in rows[0]}


def merge_shards(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Merges all shards, in the order of their numbers."""
    rows = sorted(rows, key=lambda row: row["shard"])
    count = sum(int(row["count"]) for row in rows)
    elements = np.sum([row["elements"] for row in rows], axis=0) / count
    return {
        "variants": count,
        "distance": {
            "mean": float(np.sum([row["sum"] for row in rows])) / count,
            "least": min(row["least"] for row in rows),
            "most": max(row["most"] for row in rows),
            "mean_by_element": dict(zip(ELEMENTS, elements.tolist(), strict=True)),
            "histogram": np.sum([row["histogram"] for row in rows], axis=0).tolist(),
        },
        "objects_per_world": sum(int(row["objects"]) for row in rows) / count,
        "digest": hashlib.sha256("".join(row["digest"] for row in rows).encode()).hexdigest(),
    }


def measure_all(variants: int, seed: int, shard_size: int, workers: int) -> dict[str, Any]:
    """Distributes the shards among the Ray cluster's workers, and merges their results."""
    shards = -(-variants // shard_size)
    work = partial(measure, seed=seed, shard_size=shard_size, variants=variants)
    dataset = ray.data.range(shards, override_num_blocks=min(shards, 4 * workers)).map_batches(
        work, batch_size=1, compute=ray.data.TaskPoolStrategy(size=workers)
    )
    return merge_shards(dataset.take_all())


def connect(address: str | None, workers: int) -> None:
    """Starts a cluster on this machine, or joins one."""
    logging.getLogger("ray.data").setLevel(logging.ERROR)
    if address is not None:
        ray.init(address=address, log_to_driver=False, logging_level=logging.ERROR)
        return
    ray.init("local", num_cpus=workers, include_dashboard=False, log_to_driver=False, logging_level=logging.ERROR)


def parse_arguments() -> argparse.Namespace:
    """Parses the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variants", type=int, default=20_000, help="number of variants to draw (default: 20000)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--shard-size", type=int, default=500, help="number of variants in a shard; affects the digest"
    )
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, help="number of parallel workers")
    parser.add_argument("--address", help="address of a running Ray cluster, such as auto or ray://HOST:10001")
    parser.add_argument(
        "--results", nargs="?", const=result_folder(__file__), metavar="FOLDER", help="record the result"
    )
    parser.add_argument("--quick", action="store_true", help="measure a few variants, to check that it works")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.variants, arguments.shard_size = 60, 10
    return arguments


def main() -> None:
    """Measures, and prints the result as JSON."""
    arguments = parse_arguments()
    watch = Watch()
    connect(arguments.address, arguments.workers)
    ray.data.DataContext.get_current().enable_progress_bars = False
    start = time.perf_counter()
    answer = measure_all(arguments.variants, arguments.seed, arguments.shard_size, arguments.workers)
    seconds = time.perf_counter() - start
    ray.shutdown()
    print(json.dumps(answer, indent=2))
    print(f"{arguments.variants / seconds:,.0f} variants a second with {arguments.workers} workers")
    if arguments.results:
        histogram = answer["distance"]["histogram"]
        Record(
            title="A million variants, by shard" if arguments.variants == 1_000_000 else f"{arguments.variants:,} variants, by shard",
            text="Variants of `find_objects` drawn over the whole ranges of six parameters, each compared with `blue`, and one world "
            f"sampled from each. The digest, `{answer['digest']}`, is the same whatever the number of workers.",
            settings={**vars(arguments), "ranges": RANGES, "answer": answer},
            variants=[f"{TASK}#blue"], seeds=[arguments.seed],
            # Empty bins are left out.
            curve=[{"distance": MAX_DISTANCE * (bin + 0.5) / BINS, "variants": count} for bin, count in enumerate(histogram) if count],
            seconds=watch.seconds, load_before=watch.load, axes=("distance", "variants"), labels=("distance from blue", f"variants in {MAX_DISTANCE / BINS:.1f} of distance"),
            table=[{
                "variants": answer["variants"], "seconds": round(seconds, 1), "variants a second": round(answer["variants"] / seconds),
                "mean distance": round(answer["distance"]["mean"], 4), "least": round(answer["distance"]["least"], 4),
                "most": round(answer["distance"]["most"], 4), "objects in a world": round(answer["objects_per_world"], 2),
            }],
        ).write(arguments.results)  # fmt: skip


if __name__ == "__main__":
    main()
