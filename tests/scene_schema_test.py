"""Holds models/scene.schema.json and the reader together: what the reader accepts the schema accepts, and the schema
refuses what the reader refuses, except where a case says that the schema cannot know better. The cases, with the
reader's messages, are in scene_schema_test.json; scene_reader_test.cpp gives the same cases to the reader."""

import copy
import json
import pathlib
import sys

import jsonschema


def place(document, pointer):
    """The container and the key that a JSON pointer leads to."""
    tokens = [token.replace("~1", "/").replace("~0", "~") for token in pointer.split("/")[1:]]
    for token in tokens[:-1]:
        document = document[int(token) if isinstance(document, list) else token]
    return document, int(tokens[-1]) if isinstance(document, list) else tokens[-1]


def build(base, case):
    document = copy.deepcopy(base)
    for pointer, value in case.get("set", {}).items():
        if pointer == "":
            return value
        container, key = place(document, pointer)
        container[key] = value
    for pointer in case.get("remove", []):
        container, key = place(document, pointer)
        del container[key]
    return document


def main():
    root = pathlib.Path(sys.argv[1])
    schema = json.loads((root / "models/scene.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    table = json.loads((root / "tests/scene_schema_test.json").read_text())
    wrong = []
    for case in table["cases"]:
        expected = "error" not in case or case.get("schema") == "accepts"
        if validator.is_valid(build(table["base"], case)) != expected:
            wrong.append(f"{case['what']}: the schema should {'accept' if expected else 'refuse'} this")
    models = [path for path in sorted((root / "models").glob("*.json")) if not path.name.endswith(".schema.json")]
    for path in models:
        for error in validator.iter_errors(json.loads(path.read_text())):
            wrong.append(f"{path.name}: {error.message}")
    print(f"{len(table['cases'])} cases, {len(models)} models")
    print("\n".join(wrong))
    return 1 if wrong or not models else 0


if __name__ == "__main__":
    sys.exit(main())
