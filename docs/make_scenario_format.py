#!/usr/bin/env python3
"""Writes the key tables of scenario-format.md from the JSON Schema, which the parser's own table makes.

    docs/make_scenario_format.py [SCHEMA]      rewrites what stands below the marker
"""

import json
import pathlib
import sys

FOLDER = pathlib.Path(__file__).parent
DOCUMENT = FOLDER / "scenario-format.md"
MARKER = "<!-- Below: made by make_scenario_format.py. -->\n"


def kind_of(spec):
    """Type, unit and range of a value, in words."""
    if "$ref" in spec:
        name = spec["$ref"].split("/")[-1]
        return f"[{name}](#{name.lower()})"
    if "const" in spec:
        return f"`{spec['const']}`"
    if "enum" in spec:
        return ", ".join(f"`{choice}`" for choice in spec["enum"])
    if spec["type"] == "array":
        few, most = spec["minItems"], spec["maxItems"]
        return ("list" if few != most else f"list of {few}") + " of " + kind_of(spec["items"])
    if spec["type"] == "string":
        return "UTC time" if spec.get("format") == "date-time" else "text"
    text = "whole number" if spec["type"] == "integer" else "number"
    if "x-unit" in spec:
        text += f", {spec['x-unit']}"
    lowest = spec.get("minimum", spec.get("exclusiveMinimum"))
    highest = spec.get("maximum")
    if lowest is not None and highest is not None:
        text += f", {'>' if 'exclusiveMinimum' in spec else ''}{number(lowest)} .. {number(highest)}"
    return text


def number(value):
    return f"{value:g}" if abs(value) >= 1e5 else str(value)


def rows_of(definition):
    """(key, kind, default, description), each key once; keys of some variants only name them."""
    variants = definition["oneOf"] if "properties" not in definition else [definition]
    rows = {}
    for variant in variants:
        properties = variant["properties"]
        choice = next((spec["const"] for spec in properties.values() if "const" in spec), None)
        for key, spec in properties.items():
            default = "required" if key in variant.get("required", []) else ""
            if "default" in spec:
                default = f"`{json.dumps(spec['default'])}`"
            row = (key, kind_of(spec) if "const" not in spec else None, default, spec.get("description", ""))
            rows.setdefault(row, []).append((choice, spec.get("const")))
    merged = {}
    for (key, kind, default, description), uses in rows.items():
        if kind is None:
            kind = ", ".join(f"`{const}`" for _, const in uses)
            choices = []
        else:
            choices = [choice for choice, _ in uses if choice]
        if kind and choices and len(choices) < len(variants):
            description = f"{', '.join(f'`{choice}`' for choice in choices)}: {description}"
        merged[(key, kind, default, description)] = None
    return merged


def table(definition):
    lines = ["| key | value | default | meaning |", "|---|---|---|---|"]
    lines += [f"| `{key}` | {kind} | {default} | {description} |" for key, kind, default, description in rows_of(definition)]
    return "\n".join(lines) + "\n"


def main():
    schema_file = sys.argv[1] if len(sys.argv) > 1 else FOLDER.parent / "scenarios" / "schema" / "emscape-scenario.schema.json"
    schema = json.loads(pathlib.Path(schema_file).read_text())
    parts = ["## scenario\n\n" + table(schema)]
    parts += [f"## {name}\n\n" + table(definition) for name, definition in schema["$defs"].items()]
    head = DOCUMENT.read_text().split(MARKER)[0]
    DOCUMENT.write_text(head + MARKER + "\n" + "\n".join(parts))


if __name__ == "__main__":
    main()
