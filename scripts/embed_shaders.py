#!/usr/bin/env python3
"""Turns a folder of GLSL into Shaders.h and Shaders.cpp.

    embed_shaders.py SHADERS OUT_CPP

Every .vert and .frag file becomes one string: includes expanded (each file once, paths relative to SHADERS),
comments, indentation and blank lines dropped, no #version. Beside it stands a table that says from which file and
line each of its lines came, so that a driver's message can be translated back. Shaders.h is written beside OUT_CPP.
Exits 1 with "FILE:LINE: what was found; what was expected" for an unknown include or a cycle.
"""
import re
import sys
from pathlib import Path

HEADER = """#pragma once
/// The shaders, embedded. Written by scripts/embed_shaders.py from the files in shaders/.

#include <string_view>

namespace lucent::shaders {

/// Where a line of a stage's source was written.
struct Line {
    const char* file; ///< relative to shaders/
    int line;         ///< from 1
};

/// One shader stage: includes expanded, comments and blank lines dropped, without #version.
struct Stage {
    const char* path; ///< "relief/light.frag"
    const char* source;
    const Line* lines; ///< one entry for each line of the source
    int lineCount;
};

/// The stage at a path, or nullptr.
const Stage* find(std::string_view path);

/// All stages, in the order of their paths.
const Stage* begin();
const Stage* end();

} // namespace lucent::shaders
"""

FOOTER = """
} // namespace

const Stage* begin() { return kStages; }
const Stage* end() { return kStages + kCount; }

const Stage* find(std::string_view path) {
    for (const Stage* stage = begin(); stage != end(); ++stage)
        if (path == stage->path) return stage;
    return nullptr;
}

} // namespace lucent::shaders
"""


class ShaderError(Exception):
    """A mistake in a shader file; its text is the message to print."""


def strip_comments(text: str) -> str:
    """Removes comments and keeps every line break, so that line numbers stay true."""
    def blank(match: re.Match) -> str:
        return "\n" * match.group().count("\n") or " "
    return re.sub(r"//[^\n]*|/\*.*?\*/", blank, text, flags=re.DOTALL)


def expand(root: Path, name: str, asked_by: str, open_files: list[str], done: set[str]) -> list[tuple[str, str, int]]:
    """Lines of a file with its includes, each as (text, file, line number).

    `open_files` are the files on the way here, `done` those that stand in the source already.
    """
    if name in open_files:
        chain = " -> ".join([*open_files, name])
        raise ShaderError(f"{asked_by}: includes itself ({chain}); an include must not lead back")
    if name in done:
        return []
    path = root / name
    if not path.is_file():
        raise ShaderError(f'{asked_by}: includes "{name}", which does not exist; the path is relative to shaders/')
    done.add(name)
    lines = []
    for number, line in enumerate(strip_comments(path.read_text()).splitlines(), start=1):
        include = re.match(r'\s*#\s*include\s+"([^"]+)"\s*$', line)
        if include:
            lines += expand(root, include.group(1), f"{name}:{number}", [*open_files, name], done)
        elif re.match(r"\s*#\s*(include|version)", line):
            raise ShaderError(f'{name}:{number}: found {line.strip()}; expected #include "FOLDER/FILE.glsl" '
                              "and no #version, which is added when the shader is compiled")
        elif line.strip():
            lines.append((line.strip(), name, number))
    return lines


def quote(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def identifier(name: str) -> str:
    return re.sub(r"\W", "_", name)


def stage_code(name: str, lines: list[tuple[str, str, int]]) -> str:
    table = ", ".join(f"{{{quote(file)}, {number}}}" for _, file, number in lines)
    source = "\n".join("    " + quote(text)[:-1] + '\\n"' for text, _, _ in lines)
    symbol = identifier(name)
    return f"\nconst Line lines_{symbol}[] = {{{table}}};\nconst char source_{symbol}[] =\n{source};\n"


def stages_code(root: Path) -> str:
    """The whole of Shaders.cpp."""
    names = sorted(p.relative_to(root).as_posix() for p in root.rglob("*") if p.suffix in (".vert", ".frag"))
    if not names:
        raise ShaderError(f"{root}: holds no .vert and no .frag file; expected at least one")
    code = '#include "shaders/Shaders.h"\n\nnamespace lucent::shaders {\n\nnamespace {\n'
    for name in names:
        lines = expand(root, name, name, [], set())
        if not lines:
            raise ShaderError(f"{name}: holds no code; expected at least one line besides comments")
        code += stage_code(name, lines)
    code += "\nconst Stage kStages[] = {\n"
    for name in names:
        symbol = identifier(name)
        code += f"    {{{quote(name)}, source_{symbol}, lines_{symbol}, int(sizeof lines_{symbol} / sizeof(Line))}},\n"
    return code + f"}};\nconst int kCount = {len(names)};\n" + FOOTER


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 1
    root, out = Path(sys.argv[1]), Path(sys.argv[2])
    try:
        code = stages_code(root)
    except ShaderError as error:
        print(f"shaders/{error}", file=sys.stderr)
        return 1
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(code)
    out.with_suffix(".h").write_text(HEADER)
    return 0


if __name__ == "__main__":
    sys.exit(main())
