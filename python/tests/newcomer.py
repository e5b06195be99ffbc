"""Runs a new user's first steps, in an environment with nothing but `pip install ./python`.

Runs the first Python block of docs/python.md unchanged, then the command. `cargo xtask test` starts it and shows its output.
The blocks of all pages, README.md among them, are run by `test_readme.py`.
"""

from __future__ import annotations

import importlib.metadata
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "docs/python.md"


def run(arguments: list[str], folder: Path) -> None:
    """Runs a program in a folder; exits if it fails."""
    print("$", " ".join("…" if "\n" in argument else argument for argument in arguments), flush=True)
    subprocess.run(arguments, cwd=folder, check=True, timeout=300)


def check_optional_features(command: str, folder: Path) -> None:
    """Checks that each feature with a long build works in wheels that include it, and that other wheels refuse it with the
    name of the feature.
    """
    report = json.loads(subprocess.run([command, "doctor", "--json"], capture_output=True, check=True, timeout=300).stdout)
    lighthouse = ROOT / "examples" / "assets" / "lighthouse.gltf"
    for feature, arguments in {
        "gltf": ["assets", "pack", str(lighthouse), "-o", "lighthouse.assets"],
        "gpu": ["render", "find_objects", "--renderer", "gpu", "-o", "gpu.png"],
    }.items():
        done = subprocess.run([command, *arguments], cwd=folder, capture_output=True, text=True, check=False, timeout=300)
        if report["features"][feature]:
            # Drawing on a graphics card also needs a card.
            is_as_expected = done.returncode == 0 or feature == "gpu"
        else:
            is_as_expected = done.returncode == 1 and f"--features {feature}" in done.stderr
        print("$ driftworld", *arguments, "->", done.returncode, flush=True)
        if not is_as_expected:
            sys.exit(f"newcomer: {feature}: found exit code {done.returncode} and {done.stderr!r}")


def main() -> None:
    """Runs all steps."""
    installed = {distribution.metadata["Name"].lower() for distribution in importlib.metadata.distributions()}
    unexpected = installed & {"torch", "pandas", "pygame", "pytest", "scipy", "matplotlib"}
    if "driftworld" not in installed or unexpected:
        sys.exit(f"newcomer: found {sorted(installed)}, expected driftworld and little more: make an empty environment")
    block = re.search(r"^```python\n(.*?)^```", GUIDE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    if not block:
        sys.exit(f"newcomer: found no Python block in {GUIDE}, expected the first example for users")
    command = str(Path(sys.executable).with_name("driftworld"))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run([sys.executable, "-W", "error", "-c", block[1]], folder)
        run([command, "--version"], folder)
        run([sys.executable, "-m", "driftworld", "--version"], folder)
        check_optional_features(command, folder)
        run([command, "demo"], folder)
        if not any(folder.iterdir()):
            sys.exit("newcomer: `driftworld demo` wrote nothing, expected its folder")


if __name__ == "__main__":
    main()
