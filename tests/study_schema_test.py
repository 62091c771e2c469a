"""Holds models/study.schema.json and the reader together, as scene_schema_test.py does for scenes: the cases, with the
reader's messages, are in study_schema_test.json; cases_study_test.cpp gives them to the reader."""

import json
import pathlib
import sys

import jsonschema

from scene_schema_test import build


def main():
    root = pathlib.Path(sys.argv[1])
    schema = json.loads((root / "models/study.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    table = json.loads((root / "tests/study_schema_test.json").read_text())
    wrong = []
    for case in table["cases"]:
        expected = "error" not in case or case.get("schema") == "accepts"
        if validator.is_valid(build(table["base"], case)) != expected:
            wrong.append(f"{case['what']}: the schema should {'accept' if expected else 'refuse'} this")
    texts = {path: path.read_text() for path in sorted((root / "bench/studies").glob("*.json"))}
    studies = {path: json.loads(text) for path, text in texts.items() if '"study":' in text}  # others are scenes
    for path, document in studies.items():
        for error in validator.iter_errors(document):
            wrong.append(f"{path.name}: {error.message}")
    print(f"{len(table['cases'])} cases, {len(studies)} studies")
    print("\n".join(wrong))
    return 1 if wrong or not studies else 0


if __name__ == "__main__":
    sys.exit(main())
