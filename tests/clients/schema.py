"""schema.py SCHEMA ROOT: the schema takes all cases below ROOT, and refuses what is no case."""

import copy
import json
import sys
import tomllib
from pathlib import Path

from jsonschema import Draft7Validator

schema = json.loads(Path(sys.argv[1]).read_text())
Draft7Validator.check_schema(schema)
validator = Draft7Validator(schema)
root = Path(sys.argv[2])

cases = sorted([*root.glob("inputs/*/*.toml"), *root.glob("tests/common/*.toml")])
assert len(cases) > 25, cases
for path in cases:
    case = tomllib.loads(path.read_text())
    if "dimension" not in case:
        continue
    for error in validator.iter_errors(case):
        raise AssertionError(f"{path}: {list(error.absolute_path)}: {error.message}")

sound = tomllib.loads((root / "inputs/quarter-impact/case.toml").read_text())
wrong = {
    "a key that is none": lambda case: case.update(spaceing="1 mm"),
    "a key that is none in a body": lambda case: case["body"][0].update(colour="red"),
    "a number without a unit": lambda case: case["run"].update(end_time=2),
    "a word that is none": lambda case: case["contact"].update(mode="ovelap"),
    "no end": lambda case: case["run"].pop("end_time"),
    "a list in place of a table": lambda case: case.update(run=[1]),
}
for what, spoil in wrong.items():
    case = copy.deepcopy(sound)
    spoil(case)
    assert not validator.is_valid(case), what
described = schema["definitions"]["RunParams"]["properties"]["end_time"]
assert described["description"] and described["examples"], described
print(f"{len(cases)} cases")
