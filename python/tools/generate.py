"""Writes ropewalk/_parts.py: a method for each type and section of a scene, from the schemas that `describe` shows.

    python tools/generate.py            writes it
    python tools/generate.py --check    says whether it is as it should be
"""

from __future__ import annotations

import keyword
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

import ropewalk

TARGET = Path(__file__).parents[1] / "ropewalk" / "_parts.py"
WIDTH = 118

HEAD = '''"""Methods that add parts to a scene, one for each type. Made by generate.py from the schemas: don't edit."""

# ruff: noqa: A002, E501
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Union

from ._part import Part

Number = Union[float, str]
"""A number in SI units, a text that brings its unit ("2 kn"), or a parameter ("$speed")."""
Integer = Union[int, str]
"""A whole number, or a parameter."""
Boolean = Union[bool, str]
"""True or False, or a parameter."""


class Parts:
    """A method for each type of part, `set_...` for each section, `add_...` for lists without types."""

    def _add(self, list: str, type: str, fields: Mapping[str, Any]) -> Part:
        raise NotImplementedError

    def _append(self, list: str, fields: Mapping[str, Any]) -> Part:
        raise NotImplementedError

    def _set(self, section: str, fields: Mapping[str, Any]) -> None:
        raise NotImplementedError
'''


class Writer:
    """The schema of one type."""

    def __init__(self, root: dict[str, Any]) -> None:
        self.root = root

    def resolved(self, s: Any) -> Any:
        while isinstance(s, dict) and "$ref" in s:
            s = self.root["$defs"][s["$ref"].rsplit("/", 1)[-1]]
        return s

    def type_of(self, s: Any, depth: int = 0) -> str:
        """A schema as a type of Python."""
        return union(sorted(self.types(s, depth)))

    def types(self, s: Any, depth: int = 0) -> set[str]:
        s = self.resolved(s)
        if not isinstance(s, dict) or depth > 4:
            return {"Any"}
        if "const" in s:
            return {f"Literal[{s['const']!r}]"}
        if "enum" in s:
            return {f"Literal[{e!r}]" for e in s["enum"] if e is not None}
        for key in ("anyOf", "oneOf"):
            if key in s:
                return set().union(*(self.types(one, depth + 1) for one in s[key]))
        if "allOf" in s:
            return self.types(s["allOf"][0], depth)
        given = s.get("type", [])
        given = {given} if isinstance(given, str) else set(given)
        if s.get("format") == "function":
            return {"str", "Callable[..., Any]"}
        if "number" in given:
            # with or without a unit, it may be a parameter
            return {"Number"}
        simple = {"integer": "Integer", "boolean": "Boolean", "string": "str", "object": "Mapping[str, Any]"}
        kinds = {simple[t] for t in given if t in simple}
        if "array" in given:
            items = s.get("items") or (s.get("prefixItems") or [True])[0]
            kinds.add(f"Sequence[{self.type_of(items, depth + 1)}]")
        return kinds or (set() if given == {"null"} else {"Any"})

    def fields(self, s: Any) -> list[tuple[str, dict[str, Any], bool]]:
        """Fields with their schemas, required ones first."""
        need = set(s.get("required", []))
        all = [(k, v, k in need) for k, v in s.get("properties", {}).items() if k != "type"]
        return sorted(all, key=lambda field: not field[2])

    def docs(self, s: Any, indent: str, depth: int = 0) -> list[str]:
        lines = []
        for name, field, required in self.fields(s):
            inner = self.resolved(field)
            for one in inner.get("anyOf", []) if isinstance(inner, dict) else []:
                if isinstance(one, dict) and "$ref" in one:
                    inner = self.resolved(one)
            text = clean(field.get("description") or (inner.get("description") if isinstance(inner, dict) else "") or "")
            default = field.get("default")
            if required and depth > 0:
                text += " Required."
            elif default not in (None, [], {}):
                text += f" Default {default}."
            lines += textwrap.wrap(f"{name}: {text}", WIDTH, initial_indent=indent, subsequent_indent=indent + "    ")
            if depth < 1 and isinstance(inner, dict) and inner.get("properties"):
                lines += self.docs(inner, indent + "    ", depth + 1)
        return lines


def union(kinds: list[str]) -> str:
    literals = [k[8:-1] for k in kinds if k.startswith("Literal[")]
    others = [k for k in kinds if not k.startswith("Literal[")]
    if "Any" in others:
        return "Any"
    if literals and "Number" not in others and "str" not in others:
        others.insert(0, f"Literal[{', '.join(literals)}]")
    return others[0] if len(others) == 1 else f"Union[{', '.join(others)}]" if others else "Any"


def clean(text: str) -> str:
    """A doc comment without links of Rust."""
    text = re.sub(r"\[(`[^`]+`)\](\([^)]*\))?", r"\1", text)
    return " ".join(text.split()).replace("\\", "\\\\").replace('"""', "'''")


def argument(name: str) -> str:
    return name + "_" if keyword.iskeyword(name) or name == "self" else name


def method(name: str, call: str, result: str, schema: dict[str, Any]) -> str:
    w = Writer(schema)
    arguments, entries = [], []
    for field, s, required in w.fields(schema):
        kind = w.type_of(s)
        arguments.append(f"{argument(field)}: {kind}" + ("" if required else f" | None = None"))
        entries.append(f'"{field}": {argument(field)}')
    head = f"    def {argument(name)}(\n        self,\n" + ("        *,\n" if arguments else "")
    head += "".join(f"        {a},\n" for a in arguments) + f"    ) -> {result}:\n"
    about = [
        line
        for paragraph in re.sub(r"\s*```.*?```", "", schema.get("description", ""), flags=re.DOTALL).split("\n\n")
        for line in [*textwrap.wrap(clean(paragraph), WIDTH, initial_indent=" " * 8, subsequent_indent=" " * 8), ""]
    ]
    doc = "\n".join([*about, *w.docs(schema, " " * 8)]).strip()
    body = "{\n" + "".join(f"            {e},\n" for e in entries) + "        }" if entries else "{}"
    back = "return " if result != "None" else ""
    quotes = f'        """{doc}\n        """\n' if doc else ""
    return f"\n{head}{quotes}        {back}{call}, {body})\n"


def generated() -> str:
    out, taken = HEAD, set()
    sections = []
    for key, schema in ropewalk.schemas().items():
        list, _, type = key.partition(".")
        if not type:
            sections.append((list, schema))
            continue
        name = type.replace("-", "_")
        # two types of one name are told apart by their lists
        name = f"{name}_{list[:-1]}" if name in taken else name
        taken.add(name)
        out += method(name, f'self._add("{list}", "{type}"', "Part", schema)
    for section, schema in sections:
        if section.endswith("[]"):
            out += method(f"add_{section[:-3]}", f'self._append("{section[:-2]}"', "Part", schema)
            continue
        out += method(f"set_{section}", f'self._set("{section}"', "None", schema)
    return out


def main() -> int:
    text = generated()
    if "--check" in sys.argv[1:]:
        same = TARGET.exists() and TARGET.read_text(encoding="utf-8") == text
        if not same:
            print(f"{TARGET} is not what generate.py writes: run it", file=sys.stderr)
        return int(not same)
    TARGET.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
