#!/usr/bin/env python3
"""Writes the uniform blocks of shaders as C++.

    shader_blocks.py SHADERS OUT

OUT/FOLDER/Blocks.h holds what the files of SHADERS/FOLDER declare, in namespace lucent::FOLDER: a struct for each
`layout(std140) uniform NAME {...}`, a struct XBlock for each `struct X` that such a block has as a member, and each
`const int` by which an array of theirs is sized. Members lie where std140 puts them: what it spaces out (arrays of less
than a vec4, columns of small matrices) is an array of whole vec4s. A header is only written when it changes. Exits 1 with
"FILE: what was found; what was expected".
"""
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

from embed_shaders import ShaderError, strip_comments

# Bytes of a type and what its offset is a multiple of.
BASE = {"float": (4, 4), "int": (4, 4), "uint": (4, 4)}
BASE |= {f"{kind}vec{n}": (4 * n, 8 if n == 2 else 16) for kind in ("", "i", "u") for n in (2, 3, 4)}
CPP = {"uint": "std::uint32_t", "uvec2": "glm::uvec2", "uvec3": "glm::uvec3", "uvec4": "glm::uvec4",
       "ivec3": "glm::ivec3"}
ROW = 16  # bytes of a vec4


@dataclass
class Member:
    type: str
    name: str
    count: str = ""  # of an array: a number or the name of a constant


@dataclass
class Struct:
    name: str
    file: str
    is_block: bool
    members: list[Member]

    @property
    def folder(self) -> str:
        return self.file.split("/")[0]

    @property
    def cpp(self) -> str:
        return self.name if self.is_block else self.name + "Block"


@dataclass
class Shaders:
    structs: dict[tuple[str, str], Struct] = field(default_factory=dict)  # by file and name
    constants: dict[tuple[str, str], int] = field(default_factory=dict)
    includes: dict[str, list[str]] = field(default_factory=dict)

    def seen_from(self, file: str) -> list[str]:
        """The file and all that it includes."""
        files = [file]
        for one in files:
            files += [name for name in self.includes.get(one, []) if name not in files]
        return files

    def find(self, table: dict, file: str, name: str):
        """Where a name that a file uses is declared: (file, value), or None."""
        return next(((one, table[one, name]) for one in self.seen_from(file) if (one, name) in table), None)


def members_of(file: str, body: str) -> list[Member]:
    members = []
    for line in filter(None, (part.strip() for part in body.split(";"))):
        match = re.fullmatch(r"(?:highp )?(\w+)\s+(.+)", line, re.DOTALL)
        for declared in match.group(2).split(",") if match else [""]:
            name = re.fullmatch(r"(\w+)(?:\s*\[(\w+)\])?", declared.strip())
            if not name:
                raise ShaderError(f'{file}: found "{line}" in a block; expected TYPE NAME or TYPE NAME[COUNT]')
            members.append(Member(match.group(1), name.group(1), name.group(2) or ""))
    return members


def read(root: Path) -> Shaders:
    shaders = Shaders()
    for path in sorted(p for p in root.rglob("*") if p.suffix in (".glsl", ".vert", ".frag")):
        file = path.relative_to(root).as_posix()
        text = strip_comments(path.read_text())
        shaders.includes[file] = re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.MULTILINE)
        for name, value in re.findall(r"\bconst\s+int\s+(\w+)\s*=\s*(\d+)\s*;", text):
            shaders.constants[file, name] = int(value)
        for head, name, body in re.findall(r"(layout\(std140\)\s*uniform|\bstruct)\s+(\w+)\s*\{(.*?)\}", text, re.DOTALL):
            shaders.structs[file, name] = Struct(name, file, head != "struct", members_of(file, body))
    return shaders


def up(size: int, multiple: int) -> int:
    return (size + multiple - 1) // multiple * multiple


class Writer:
    """Headers of all folders: structs in the order in which they need each other."""

    def __init__(self, shaders: Shaders):
        self.shaders = shaders
        self.code: dict[str, list[str]] = {}
        self.needs: dict[str, set[str]] = {}
        self.sizes: dict[tuple[str, str], int] = {}
        self.owners: dict[tuple[str, str], str] = {}
        self.constants: set[tuple[str, str]] = set()

    def add(self, struct: Struct) -> int:
        """Writes a struct, once, after what it needs. Returns its size."""
        key = (struct.file, struct.name)
        if key in self.sizes:
            return self.sizes[key]
        owner = self.owners.setdefault((struct.folder, struct.cpp), struct.file)
        if owner != struct.file:
            raise ShaderError(f"{struct.file}: declares {struct.name} as {owner} does; expected one declaration "
                              "that both include")
        lines, checks, offset, gaps = [], [], 0, 0

        def fill(to: int) -> None:
            nonlocal offset, gaps
            if to > offset:
                lines.append(f"    float gap{gaps}[{(to - offset) // 4}] = {{}};")
                gaps, offset = gaps + 1, to

        for member in struct.members:
            cpp, size, align = self.place(struct, member)
            fill(up(offset, align))
            lines.append(f"    {cpp} {member.name}{{}};")
            checks.append(f"static_assert(offsetof({struct.cpp}, {member.name}) == {offset});")
            offset += size
        fill(up(offset, ROW))
        self.sizes[key] = offset
        name = [f'    static constexpr std::string_view kName = "{struct.name}";'] if struct.is_block else []
        checks.append(f"static_assert(sizeof({struct.cpp}) == {offset});")
        self.write(struct.folder, [f"/// shaders/{struct.file}", f"struct {struct.cpp} {{", *name, *lines, "};",
                                   *checks, ""])
        return offset

    def place(self, struct: Struct, member: Member) -> tuple[str, int, int]:
        """C++ type, bytes and alignment of a member."""
        matrix = re.fullmatch(r"mat([234])", member.type)
        found = self.shaders.find(self.shaders.structs, struct.file, member.type)
        if matrix:
            columns = int(matrix.group(1))
            cpp, size, align = ("mat4" if columns == 4 else f"std::array<vec4, {columns}>"), columns * ROW, ROW
        elif found:
            cpp, size, align = self.name_in(struct.folder, found[1].folder, found[1].cpp), self.add(found[1]), ROW
        elif member.type in BASE:
            size, align = BASE[member.type]
            cpp = CPP.get(member.type, member.type)
        else:
            raise ShaderError(f"{struct.file}: {struct.name}.{member.name} is a {member.type}; expected a number, "
                              "vector, matrix or struct")
        if not member.count:
            return cpp, size, align
        if size % ROW:  # each element begins a row
            cpp, size = {"i": "ivec4", "u": "glm::uvec4"}.get(member.type[0], "vec4"), ROW
        if member.count.isdigit():
            return f"std::array<{cpp}, {member.count}>", int(member.count) * size, ROW
        name, number = self.constant(struct, member.count)
        return f"std::array<{cpp}, {name}>", number * size, ROW

    def constant(self, struct: Struct, name: str) -> tuple[str, int]:
        """A constant as the struct's folder calls it, and its value."""
        found = self.shaders.find(self.shaders.constants, struct.file, name)
        if not found:
            raise ShaderError(f"{struct.file}: {struct.name} has an array of {name}; expected a const int of a number")
        folder = found[0].split("/")[0]
        if (folder, name) not in self.constants:
            self.constants.add((folder, name))
            self.write(folder, [f"/// shaders/{found[0]}", f"inline constexpr int {name} = {found[1]};", ""])
        return self.name_in(struct.folder, folder, name), found[1]

    def name_in(self, here: str, folder: str, name: str) -> str:
        if here == folder:
            return name
        self.needs.setdefault(here, set()).add(folder)
        return f"{folder}::{name}"

    def write(self, folder: str, lines: list[str]) -> None:
        self.code.setdefault(folder, []).extend(lines)

    def header(self, folder: str) -> str:
        others = "".join(f'#include "shaders/{name}/Blocks.h"\n' for name in sorted(self.needs.get(folder, [])))
        return (f"#pragma once\n/// Uniform blocks of shaders/{folder}, written by scripts/shader_blocks.py.\n\n"
                f'#include "base/Math.h"\n{others}\n#include <array>\n#include <cstddef>\n#include <cstdint>\n'
                f"#include <string_view>\n\nnamespace lucent::{folder} {{\n\n"
                + "\n".join(self.code.get(folder, [])) + f"\n}} // namespace lucent::{folder}\n")


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 1
    root, out = Path(sys.argv[1]), Path(sys.argv[2])
    try:
        shaders = read(root)
        writer = Writer(shaders)
        for struct in shaders.structs.values():
            if struct.is_block:
                writer.add(struct)
    except ShaderError as error:
        print(f"shaders/{error}", file=sys.stderr)
        return 1
    for folder in sorted(p.name for p in root.iterdir() if p.is_dir()):
        path = out / folder / "Blocks.h"
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.is_file() or path.read_text() != writer.header(folder):
            path.write_text(writer.header(folder))
    return 0


if __name__ == "__main__":
    sys.exit(main())
