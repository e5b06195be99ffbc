"""Validates the documents beside this file against the committed JSON Schemas alone, with an independent validator.

Every file in `bad/<kind>/` must be refused by `schemas/<kind>.schema.json`, every file in `good/<kind>/` accepted.
Prints the files for which this is not so and exits with 1. `spec/tests/documents.rs` tests the messages.
"""

import json
import sys
from pathlib import Path

from jsonschema import Draft202012Validator

DOCUMENTS = Path(__file__).resolve().parent
KINDS = ("world", "task", "scenario", "maps")


def read(path: Path) -> object:
    """The JSON value in a file."""
    return json.loads(path.read_text(encoding="utf-8"))


def validator(kind: str) -> Draft202012Validator:
    """The validator of one kind of document. Fails if its schema is not a valid JSON Schema."""
    schema = read(DOCUMENTS.parents[1] / "schemas" / f"{kind}.schema.json")
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def judge(verdict: str, expect_valid: bool) -> tuple[int, list[str]]:
    """The number of files in the folder `verdict` that are judged as expected, and a line for each of the others."""
    agreed, surprises = 0, []
    for kind in KINDS:
        schema = validator(kind)
        paths = sorted((DOCUMENTS / verdict / kind).glob("*.json"))
        if not paths:
            surprises.append(f"{verdict}/{kind}: no documents, expected some")
        for path in paths:
            error = next(schema.iter_errors(read(path)), None)
            if (error is None) == expect_valid:
                agreed += 1
                continue
            reason = "accepted, expected to be refused" if error is None else f"{error.json_path}: {error.message}"
            surprises.append(f"{verdict}/{kind}/{path.name}: {reason}")
    return agreed, surprises


def main() -> int:
    """Validates all documents, prints the unexpected results and a summary, and returns the exit code."""
    refused, accepted_by_mistake = judge("bad", expect_valid=False)
    accepted, refused_by_mistake = judge("good", expect_valid=True)
    for surprise in accepted_by_mistake + refused_by_mistake:
        print(surprise, file=sys.stderr)
    print(f"documents: {refused} bad refused, {accepted} good accepted")
    return 1 if accepted_by_mistake or refused_by_mistake else 0


if __name__ == "__main__":
    sys.exit(main())
