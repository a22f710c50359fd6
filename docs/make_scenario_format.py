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
    """Type, unit and range of a value as text."""
    if "$ref" in spec:
        name = spec["$ref"].split("/")[-1]
        return f"[{name}](#{name.lower()})"
    if "anyOf" in spec:
        return " or ".join(kind_of(choice) for choice in spec["anyOf"])
    if "enum" in spec:
        return ", ".join(f"`{choice}`" for choice in spec["enum"])
    if spec["type"] == "array":
        few, most = spec["minItems"], spec["maxItems"]
        return ("list" if few != most else f"list of {few}") + " of " + kind_of(spec["items"])
    if spec["type"] == "string":
        return "UTC time" if spec.get("format") == "date-time" else "text"
    if spec["type"] == "boolean":
        return "`true`, `false`"
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


def variants_of(definition):
    """(choice, properties, required keys) of each variant; a single one without a choice if there are no variants."""
    for condition in definition.get("allOf", []):
        (choice,) = (spec["const"] for spec in condition["if"]["properties"].values())
        yield choice, condition["then"]["properties"], condition["then"].get("required", [])
    if "allOf" not in definition:
        yield None, definition["properties"], definition.get("required", [])


def rows_of(definition):
    """(key, kind, default, description), each once; keys of only some variants name these."""
    uses = {}
    variants = list(variants_of(definition))
    for choice, properties, required in variants:
        for key, spec in properties.items():
            default = f"`{json.dumps(spec['default'])}`" if "default" in spec else "required" if key in required else ""
            uses.setdefault((key, kind_of(spec), default, spec.get("description", "")), []).append(choice)
    for (key, kind, default, description), choices in uses.items():
        if len(choices) < len(variants):
            description = f"{', '.join(f'`{choice}`' for choice in choices)}: {description}"
        yield key, kind, default, description


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
