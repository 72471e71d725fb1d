"""Checks that the example documents fit the schemas, that the format pages show them word for word, and that
the schemas refuse what the readers refuse: python3 check_examples.py REPOSITORY"""

import copy
import json
import re
import sys
from pathlib import Path

import jsonschema

repository = Path(sys.argv[1])
schemas = repository / "tests/schema"
examples = repository / "tests/data/examples"


def validator(name):
    schema = json.loads((schemas / f"{name}.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    paths = json.loads((schemas / "paths.schema.json").read_text())
    resolver = jsonschema.RefResolver.from_schema(schema, store={"paths.schema.json": paths})
    return jsonschema.Draft202012Validator(schema, resolver=resolver)


def changed(document, *pointer, value):
    """A copy with the member that the pointer leads to set to a value."""
    out = copy.deepcopy(document)
    at = out
    for key in pointer[:-1]:
        at = at[key]
    at[pointer[-1]] = value
    return out


def check(name, example, page, bad_changes):
    text = (examples / example).read_text()
    document = json.loads(text)
    checker = validator(name)
    checker.validate(document)
    shown = re.findall(r"```json\n(.*?)```", (repository / "docs" / page).read_text(), re.DOTALL)
    assert shown and shown[0] == text, f"docs/{page} does not show {example} as it is"
    for pointer, value in bad_changes:
        assert not checker.is_valid(changed(document, *pointer, value=value)), f"{pointer} = {value} accepted"


check("scene", "study.json", "scene-format.md", [
    (("afterglow",), 2),
    (("colour",), "red"),
    (("units",), "mile"),
    (("frames_per_second",), 0),
    (("materials", 0, "reflectance"), [0.1, 0.2]),
    (("materials", 0, "emission"), -1),
    (("nodes", 0, "geometry"), {}),
    (("nodes", 0, "geometry"), {"file": "a.obj", "material": "wall"}),
    (("nodes", 0, "geometry", "box", "size"), [1, 0, 1]),
    (("nodes", 0, "rotation"), [0, 1, 0]),
    (("cameras", 0), {"name": "camera"}),
    (("lights", 0, "kind"), "area"),
    (("tracks", 0), {"node": "screen"}),
])
check("paths", "study-paths.json", "paths-format.md", [
    (("afterglow_paths",), "1"),
    (("time_unit",), "hour"),
    (("tracks", 0, "scale"), [[0, 1, 1, 1]]),
    (("tracks", 0, "material"), "lamp"),
    (("tracks", 0, "translation"), []),
    (("tracks", 0, "translation", 0), [0, 1, 2]),
    (("tracks", 0, "translation", 0, 0), -1),
    (("tracks", 1, "interpolation"), "cubic"),
    (("tracks", 1, "emission_scale", 0, 1), -1),
    (("tracks", 3), {"camera": "camera"}),
])
print("examples and schemas agree")
