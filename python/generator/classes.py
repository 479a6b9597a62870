"""Python classes out of the keys of jobs."""

import keyword
import re
import textwrap
from collections import defaultdict

from job_page import Page, Row, quoted_default

# Module -> the types of the listing that it describes; those of a family (materials.lambert) follow their base.
MODULES = {
    "settings": ["frames", "film.filter", "film", "sampling", "render", "color"],
    "integrators": ["integrator"],
    "cameras": ["camera.exposure", "camera.aperture", "camera"],
    "transforms": ["transform.rotate", "transform"],
    "textures": ["textures.mapping", "textures"],
    "materials": ["materials.bump", "materials.normal_map", "materials.subsurface.body", "materials"],
    "media": ["media.density.noise", "media.density.shell", "media.density", "media.emission", "media"],
    "objects": ["objects.emit", "objects.mesh.displacement", "objects", "groups"],
    "lights": ["linking", "lights", "environment.sky", "environment"],
    "outputs": ["outputs"],
    "job_keys": ["job"],
}
# Families whose entries say what they are by one key, and the name of the class that all of them are.
FAMILIES = {
    "integrator": "Integrator",
    "camera": "Camera",
    "textures": "Texture",
    "materials": "Material",
    "objects": "Object",
    "lights": "Light",
    "outputs": "Output",
}
# Classes whose name does not follow from that of their type.
NAMES = {
    "color": "ColorManagement",
    "materials.subsurface.body": "Subsurface",
    "materials.null": "NullMaterial",
    "media": "Medium",
    "textures.mapping": "TextureMapping",
    "groups": "Group",
    "objects.group": "InPlaceGroup",
    "objects.gltf": "GltfScene",
    "objects.pbrt": "PbrtScene",
    "objects.obj": "ObjScene",
    "outputs.mp4": "Video",
    "transform": "Step",
    "transform.rotate": "Rotation",
    "job": "JobKeys",
}
# objects.group has no class of its own: what is written in place is a Group too.
MAPS = {"objects.group": "groups"}
# Keys that Python has in another way: by the class, or always the same.
OTHERWISE = {("job", "hyades"), ("integrator", "type"), ("camera", "type"), ("textures", "type"),
             ("materials", "type"), ("lights", "type"), ("objects", "shape")}  # fmt: skip
HINTS = {
    "number": "float",
    "whole number": "int",
    "switch": "bool",
    "text": "str",
    "texts": "Sequence[str]",
    "number, animated": "Number",
    "pair, animated": "Vector",
    "vector, animated": "Vector",
    "quaternion": "Vector",
    "scale, animated": "NumberOrVector",
    "colour, animated": "Color",
    "colour or texture": "ColorInput",
    "number or texture": "NumberInput",
    "number, animated, or an object's name": "Number",
    "texture": "TextureInput",
    "a material's name": "MaterialName",
    "a medium's name": "MediumName",
    "a group's name": "GroupName",
    "an object's name": "str",
    "list of steps": "Sequence[Step]",
    "overrides": "Mapping[str, str | Material | Mapping[str, Any]]",
    "stops": "Mapping[float, ColorInput]",
    "units": "str | float",
    "file": "File",
    "files": "File | Sequence[File]",
    "file or sequence": "FileOrSequence",
}
VALUES = ["Color", "ColorInput", "File", "FileOrSequence", "GroupName", "MaterialName", "MediumName", "Number",
          "NumberInput", "NumberOrVector", "FrameRange", "TextureInput", "Vector"]  # fmt: skip
HEAD = '"""Made by python/generator/generate of the reader\'s own list of keys and of docs/job.md. Do not edit."""\n'


def class_name(of_type: str) -> str:
    if of_type in FAMILIES:
        return FAMILIES[of_type]
    last = of_type.rpartition(".")[2]
    return NAMES.get(of_type, re.sub(r"(^|[-_])(\w)", lambda m: m[2].upper(), last))


def modules(listed: list, page: Page) -> dict[str, str]:
    """The text of each module by name."""
    by_type = defaultdict(list)
    for entry in listed:
        if (entry["type"], entry["key"]) not in OTHERWISE:
            by_type[entry["type"]].append(entry)
    texts = {name: module(name, by_type, page) for name in MODULES}
    texts["__init__"] = HEAD
    return texts


def types_of(name: str, by_type: dict) -> list[str]:
    """The types of a module, bases before what follows from them."""
    types = []
    for of_type in MODULES[name]:
        types.append(of_type)
        if of_type in FAMILIES:
            nested = {t for all_types in MODULES.values() for t in all_types}
            types += [t for t in by_type if t.startswith(of_type + ".") and t.count(".") == 1 and t not in nested]
    return types


def module(name: str, by_type: dict, page: Page) -> str:
    bodies = [one_class(of_type, by_type, page) for of_type in types_of(name, by_type)]
    text = "\n\n".join(bodies)
    return HEAD + imports(name, text) + "\n\n" + text


def imports(name: str, text: str) -> str:
    hints = "\n".join(re.findall(r"^    \w+: (.*?) = key\(", text, re.MULTILINE))

    def used(names: list, where: str = hints) -> str:
        return ", ".join(n for n in names if re.search(rf"\b{n}\b", where))

    lines = []
    for other in MODULES:
        if other != name and used(list(map(class_name, MODULES[other]))):
            lines.append(f"from .{other} import {used(sorted(map(class_name, MODULES[other])))}")
    if used(VALUES):
        lines.insert(0, f"from ..values import {used(VALUES)}")
    lines.insert(0, "from ..described import Described, key")
    standard = ["from dataclasses import dataclass"]
    if used(["Mapping", "Sequence"]):
        standard.insert(0, f"from collections.abc import {used(['Mapping', 'Sequence'])}")
    standard.append(f"from typing import {used(['Any', 'ClassVar', 'Literal'], hints + ' ClassVar')}")
    return "\n".join(["", "from __future__ import annotations", "", *standard, "", *lines, ""])


def one_class(of_type: str, by_type: dict, page: Page) -> str:
    family = of_type.partition(".")[0]
    derived = of_type != family and family in FAMILIES and of_type.count(".") == 1 and not is_nested(of_type)
    shared = shared_keys(family, by_type)
    if derived:
        entries = [e for e in by_type[of_type] if e["key"] not in shared]
    else:
        entries = by_type[of_type] + (list(shared.values()) if of_type in FAMILIES else [])
    base = class_name(family) if derived else "Described"
    title = page.titles.get(of_type, "").rstrip(".") or class_name(of_type)
    lines = ["@dataclass(kw_only=True, eq=False, repr=False)", f"class {class_name(of_type)}({base}):"]
    lines += [f'    """{title}."""', ""]
    if derived and family != "outputs":
        lines.append(f'    TYPE: ClassVar[str] = "{of_type.partition(".")[2]}"')
    sections = dict.fromkeys([of_type] + [e["section"] for e in entries])
    lines.append(f"    SECTIONS: ClassVar[tuple[str, ...]] = {tuple(sections)!r}".replace("'", '"'))
    for entry in entries:
        lines += one_key(entry, page.rows[entry["section"], entry["key"]])
    return "\n".join(lines) + "\n"


def is_nested(of_type: str) -> bool:
    return any(of_type in types for types in MODULES.values())


def shared_keys(family: str, by_type: dict) -> dict:
    """Keys of the family's own section that all its types list, and list alike."""
    members = [by_type[t] for t in by_type if t.startswith(family + ".") and t.count(".") == 1 and not is_nested(t)]
    if family not in FAMILIES or not members:
        return {}
    own = [e for e in members[0] if e["section"] == family]
    same = lambda a, b: {**a, "type": ""} == {**b, "type": ""}
    return {e["key"]: e for e in own if all(any(same(e, o) for o in others) for others in members)}


def one_key(entry: dict, row: Row) -> list[str]:
    hint, names = hint_of(entry)
    default = default_of(entry, row, names)
    arguments = [quoted(entry["takes"])]
    if default is not None:
        arguments.append(literal(default))
    for fact in ("low", "high"):
        if fact in entry:
            arguments.append(f"{fact}={literal(entry[fact])}")
    arguments += [f"{fact}=True" for fact in ("above", "below", "required") if entry.get(fact)]
    if names:
        arguments.append(f"names={literal(names)}")
    optional = "" if default is not None or entry.get("required") else " | None"
    if entry["takes"] in ("entries", "list"):
        optional = ""
    start = f"    {attribute(entry['key'])}: {hint}{optional} = key("
    line = start + ", ".join(arguments) + ")"
    if len(line) > 100:
        line = textwrap.fill(", ".join(arguments), 96, initial_indent=" " * 8, subsequent_indent=" " * 8,
                             break_on_hyphens=False)
        line = f"{start}\n{line},\n    )"
    return [line, *docstring(row, default, bool(names))]


def attribute(name: str) -> str:
    """What a key is called in Python, where some names are the language's own."""
    return name + "_" if keyword.iskeyword(name) else name


def hint_of(entry: dict) -> tuple[str, list]:
    """The type hint, and what a choice may be."""
    takes = entry["takes"]
    names = [python_name(n) for n in entry.get("names", [])]
    below = entry.get("map", "")
    map_class = class_name(MAPS.get(below, below))
    if takes == "entries":
        return f"dict[str, {map_class}]", []
    if takes in ("list", "map"):
        return (f"list[{map_class}]" if takes == "list" else map_class), []
    if takes == "frames":
        return "FrameRange", []
    if takes == "frames or map":
        return f"FrameRange | {map_class}", []
    if takes == "colour or map":
        return f"Color | {map_class}", []
    choices = f"Literal[{', '.join(literal(n) for n in names)}]"
    if takes == "type or map":
        return f"{choices} | {map_class}", names
    if takes == "one or two choices":
        return f"{choices} | Sequence[{choices}]", names
    if takes == "choice":
        return choices, names
    if takes.endswith(("0 numbers", "6 numbers", " whole numbers")):
        return ("Sequence[int]" if "whole" in takes else "Vector"), []
    return HINTS[takes], names


def python_name(name: str):
    """A choice as Python writes it: switches and numbers are no texts."""
    if name in ("true", "false"):
        return name == "true"
    return int(name) if name.isdigit() else name


def default_of(entry: dict, row: Row, names: list):
    """What holds without the key; None where that is no value of it."""
    if entry.get("required") or quoted_default(row) is None or "default" not in entry:
        return None
    return python_name(entry["default"]) if names else entry["default"]


def docstring(row: Row, default, is_choice: bool) -> list[str]:
    text = row.what[:1].upper() + row.what[1:].rstrip(".").replace("see below", "see docs/job.md")
    facts = []
    if row.unit:
        facts.append(f"Unit: {row.unit}.")
    if row.range and not is_choice:
        facts.append(f"Range: {row.range}.")
    if default is None:
        facts.append({"required": "Required."}.get(row.default, f"Default: {row.default}."))
    full = " ".join([text + "." if text else "", *facts]).strip()
    return textwrap.fill(f'"""{full}"""', 100, initial_indent="    ", subsequent_indent="    ").splitlines()


def quoted(text: str) -> str:
    return f'"{text}"'


def literal(value) -> str:
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, list):
        return "(" + ", ".join(literal(v) for v in value) + ("," if len(value) == 1 else "") + ")"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return repr(value)
