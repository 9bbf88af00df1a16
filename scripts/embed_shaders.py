#!/usr/bin/env python3
"""Turns a folder of GLSL into Shaders.h and Shaders.cpp.

    embed_shaders.py SHADERS OUT_CPP [WITHOUT...]

Every file is embedded once, in pieces between its includes; every .vert and .frag file becomes a list of pieces with all
includes in their places (each file once, paths relative to SHADERS). Comments and indentation are dropped, #version is
added later; line breaks stay, so that a driver's message can be translated back to file and line. A .frag file says in
lines of `#pragma variants` with which feature switches its program is compiled (src/gl/Variants.h). Shaders.h is written
beside OUT_CPP. Stages of the folders WITHOUT are left out. Exits 1 with "FILE:LINE: what was found; what was expected" for an unknown include or a cycle.
"""
import re
import sys
from pathlib import Path

HEADER = """#pragma once
/// The shaders, embedded. Written by scripts/embed_shaders.py from the files in shaders/.

#include <string_view>

namespace lucent::shaders {

/// A stretch of a file without includes; comments are blank.
struct Piece {
    const char* file; ///< relative to shaders/
    int line;         ///< of the first one in the file, from 1
    const char* source;
};

/// One shader stage: its source is that of its pieces one after the other, without #version.
struct Stage {
    const char* path; ///< "relief/light.frag"
    const Piece* const* pieces;
    int pieceCount;
    const char* variants = ""; ///< what follows each `#pragma variants` of the file, a line each
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


VARIANTS = re.compile(r"^\s*#\s*pragma\s+variants\s+(.*?)\s*$", re.MULTILINE)


def pieces_of(root: Path, name: str, asked_by: str) -> list[str | tuple[int, str]]:
    """A file as what it includes (names) and its own stretches between (first line, text)."""
    path = root / name
    if not path.is_file():
        raise ShaderError(f'{asked_by}: includes "{name}", which does not exist; the path is relative to shaders/')
    parts: list[str | tuple[int, str]] = []
    begin, text = 1, ""
    for number, line in enumerate(VARIANTS.sub("", strip_comments(path.read_text())).splitlines(), start=1):
        include = re.match(r'\s*#\s*include\s+"([^"]+)"\s*$', line)
        if not include and re.match(r"\s*#\s*(include|version)", line):
            raise ShaderError(f'{name}:{number}: found {line.strip()}; expected #include "FOLDER/FILE.glsl" '
                              "and no #version, which is added when the shader is compiled")
        if not include:
            if not text.strip():  # blank lines at the beginning count nothing
                begin, text = number, ""
            text += line.strip() + "\n"
            continue
        parts += [(begin, text), include.group(1)]
        begin, text = number + 1, ""
    parts.append((begin, text))
    return [part for part in parts if isinstance(part, str) or part[1].strip()]


def expand(root: Path, name: str, asked_by: str, open_files: list[str], done: set[str]) -> list[tuple[str, int, str]]:
    """Pieces of a file with its includes, each as (file, first line, text).

    `open_files` are the files on the way here, `done` those that stand in the source already.
    """
    if name in open_files:
        chain = " -> ".join([*open_files, name])
        raise ShaderError(f"{asked_by}: includes itself ({chain}); an include must not lead back")
    if name in done:
        return []
    parts = pieces_of(root, name, asked_by)
    done.add(name)
    pieces = []
    for part in parts:
        if isinstance(part, str):
            pieces += expand(root, part, name, [*open_files, name], done)
        else:
            pieces.append((name, part[0], part[1].rstrip() + "\n"))
    return pieces


def quote(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def identifier(name: str) -> str:
    return re.sub(r"\W", "_", name)


def piece_symbol(piece: tuple[str, int, str]) -> str:
    return f"piece_{identifier(piece[0])}_{piece[1]}"


def piece_code(piece: tuple[str, int, str]) -> str:
    file, line, text = piece
    source = "\n".join("    " + quote(row)[:-1] + '\\n"' for row in text.splitlines())
    return f"\nconst Piece {piece_symbol(piece)} = {{{quote(file)}, {line},\n{source}}};\n"


def stages_code(root: Path, without: list[str]) -> str:
    """The whole of Shaders.cpp."""
    found = (p.relative_to(root) for p in root.rglob("*") if p.suffix in (".vert", ".frag"))
    names = sorted(path.as_posix() for path in found if path.parts[0] not in without)
    if not names:
        raise ShaderError(f"{root}: holds no .vert and no .frag file; expected at least one")
    code = '#include "shaders/Shaders.h"\n\nnamespace lucent::shaders {\n\nnamespace {\n'
    written = set()
    for name in names:
        pieces = expand(root, name, name, [], set())
        if not pieces:
            raise ShaderError(f"{name}: holds no code; expected at least one line besides comments")
        for piece in pieces:
            if piece_symbol(piece) not in written:
                code += piece_code(piece)
                written.add(piece_symbol(piece))
        listed = ", ".join("&" + piece_symbol(piece) for piece in pieces)
        code += f"\nconst Piece* const stage_{identifier(name)}[] = {{{listed}}};\n"
    code += "\nconst Stage kStages[] = {\n"
    for name in names:
        symbol = f"stage_{identifier(name)}"
        variants = "\\n".join(VARIANTS.findall(strip_comments((root / name).read_text())))
        code += f'    {{{quote(name)}, {symbol}, int(sizeof {symbol} / sizeof(Piece*)), "{variants}"}},\n'
    return code + f"}};\nconst int kCount = {len(names)};\n" + FOOTER


def main() -> int:
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        return 1
    root, out = Path(sys.argv[1]), Path(sys.argv[2])
    try:
        code = stages_code(root, sys.argv[3:])
    except ShaderError as error:
        print(f"shaders/{error}", file=sys.stderr)
        return 1
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(code)
    out.with_suffix(".h").write_text(HEADER)
    return 0


if __name__ == "__main__":
    sys.exit(main())
