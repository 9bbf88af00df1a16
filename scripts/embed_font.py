#!/usr/bin/python3
"""Cuts a font down to the characters that the panel shows and writes it as FontData.h and FontData.cpp.

    embed_font.py FONT.otf OUT_CPP

Only the tables that Dear ImGui's stb_truetype reads stay: it draws CFF outlines as they are, and uses neither hints
nor kerning. FontData.h is written beside OUT_CPP. Needs fontTools.
"""
import io
import sys
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

CHARACTERS = "".join(chr(code) for code in range(0x20, 0x7F)) + "°µ×·–—…²³→←↑↓↺πλσ"
UNREAD_TABLES = ["BASE", "GDEF", "GPOS", "GSUB", "OS/2", "STAT", "VORG", "name", "post"]

HEADER = """#pragma once
/// The panel's typeface, cut down to the characters that it shows. Written by scripts/embed_font.py.

namespace lucent::viewer {

extern const unsigned char kFontData[]; ///< an OpenType font
extern const unsigned kFontSize;        ///< its bytes

} // namespace lucent::viewer
"""


def cut(font: TTFont) -> bytes:
    """The font with our characters only; those that it lacks are left out."""
    options = subset.Options(hinting=False, layout_features=[], desubroutinize=True, notdef_outline=True,
                             drop_tables=UNREAD_TABLES)
    subsetter = subset.Subsetter(options)
    subsetter.populate(text=CHARACTERS)
    subsetter.subset(font)
    # The source date of the package, not the time of the run, so that two builds are the same to the byte.
    font.recalcTimestamp = False
    data = io.BytesIO()
    font.save(data)
    return data.getvalue()


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 1
    source, out = Path(sys.argv[1]), Path(sys.argv[2])
    data = cut(TTFont(source))
    rows = "\n".join("    " + ", ".join(map(str, data[i:i + 20])) + "," for i in range(0, len(data), 20))
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text('#include "viewer/FontData.h"\n\nnamespace lucent::viewer {\n\n'
                   f"const unsigned char kFontData[] = {{\n{rows}\n}};\n"
                   "const unsigned kFontSize = sizeof kFontData;\n\n} // namespace lucent::viewer\n")
    out.with_suffix(".h").write_text(HEADER)
    return 0


if __name__ == "__main__":
    sys.exit(main())
