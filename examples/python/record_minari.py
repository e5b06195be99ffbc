"""Records episodes of two variants as a Minari data set, and reads them back with their variants.

    python examples/python/record_minari.py --episodes 20

Needs `pip install "./python[minari]"`. Minari keeps data sets in ~/.minari, or in the folder that MINARI_DATASETS_PATH names.
"""

from __future__ import annotations

import argparse
import os
import tempfile

import driftworld  # noqa: F401 - registers the environments
import gymnasium


def main() -> None:
    """Records, reads back, and prints one line for each episode."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--dataset",
        default="driftworld/find-objects/random-v0",
        help="id of the data set (default: %(default)s)",
    )
    parser.add_argument("--episodes", type=int, default=10, help="number of episodes (default: %(default)s)")
    parser.add_argument(
        "--seed",
        type=int,
        default=0,
        help="seed of worlds and actions (default: %(default)s)",
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="record 4 short episodes into a temporary folder",
    )
    arguments = parser.parse_args()
    if arguments.quick:
        with tempfile.TemporaryDirectory() as folder:
            os.environ["MINARI_DATASETS_PATH"] = folder
            record(arguments.dataset, episodes=4, seed=arguments.seed, max_steps=20)
    else:
        record(arguments.dataset, episodes=arguments.episodes, seed=arguments.seed, max_steps=200)


def record(dataset_id: str, *, episodes: int, seed: int, max_steps: int) -> None:
    """Writes a data set of random actions and prints the metadata of its episodes."""
    # Minari reads MINARI_DATASETS_PATH when it is imported.
    import minari
    from driftworld.adapters.minari import collect

    env = gymnasium.make(
        "driftworld/FindObjects-v0",
        modalities=["rgb", "state"],
        size=64,
        max_steps=max_steps,
    )
    collect(
        env,
        dataset_id,
        episodes=episodes,
        seed=seed,
        queue=["red", "blue"],
        description="Random actions, two colours.",
    )
    dataset = minari.load_dataset(dataset_id)
    numbers = range(dataset.total_episodes)
    for episode, metadata in zip(
        dataset.iterate_episodes(),
        dataset.storage.get_episode_metadata(numbers),
        strict=True,
    ):
        variant, world = metadata["variant_id"], metadata["world_index"]
        print(
            f"episode {episode.id}: {variant}, world {world}: {len(episode)} steps, return {sum(episode.rewards):.1f}"
        )
    print(f"{dataset.total_steps} steps in {dataset_id}")


if __name__ == "__main__":
    main()
