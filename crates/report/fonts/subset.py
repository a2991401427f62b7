"""Makes the two embedded faces from Liberation Sans 2.1.5.

Usage: python3 subset.py DIRECTORY_WITH_LIBERATION_SANS

Needs fonttools. Keeps Latin, Greek, punctuation, super- and subscripts and the mathematical symbols
that labels and units use; drops hinting. Liberation Sans lacks the superscript zero and signs that
powers of ten need, so they are composed from its own glyphs. The Open Font License reserves the name
"Liberation" for the original, hence the new name.
"""

import sys
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphComponent

FAMILY = "Apportion Sans"
RANGES = [
    (0x0020, 0x007E), (0x00A0, 0x017F), (0x0192, 0x0192), (0x0218, 0x021B), (0x02C6, 0x02C7),
    (0x02D8, 0x02DD), (0x0370, 0x03FF), (0x1E80, 0x1E85), (0x2009, 0x2015), (0x2018, 0x201E),
    (0x2020, 0x2022), (0x2026, 0x2026), (0x202F, 0x202F), (0x2030, 0x2030), (0x2032, 0x2033),
    (0x2039, 0x203A), (0x2044, 0x2044), (0x2070, 0x208E), (0x20AC, 0x20AC), (0x2113, 0x2113),
    (0x2122, 0x2122), (0x2126, 0x2126), (0x212B, 0x212B), (0x2190, 0x2195), (0x21D2, 0x21D4),
    (0x2200, 0x22FF), (0x25A0, 0x25CF),
]


def compose(font, code, source, reference, shift_to=None):
    """Adds `code` as `source` scaled by `reference` (small glyph, full glyph), or merely raised."""
    glyf, metrics, cmap = font["glyf"], font["hmtx"], font.getBestCmap()
    if code in cmap:
        return
    small, full = (glyf[name] for name in reference)
    scale = (small.yMax - small.yMin) / (full.yMax - full.yMin)
    component = GlyphComponent()
    component.glyphName = source
    component.flags = 0x0004 | 0x0002  # offsets are x, y; rounded to the grid
    component.x = 0
    if shift_to is None:
        component.y = round(small.yMin - full.yMin * scale)
        component.transform = [[scale, 0], [0, scale]]
    else:
        scale = 1.0
        component.y = shift_to
    glyph = Glyph()
    glyph.numberOfContours = -1
    glyph.components = [component]
    name = f"uni{code:04X}"
    font.setGlyphOrder(font.getGlyphOrder() + [name])
    glyf.glyphs[name] = glyph
    glyf.glyphOrder = font.getGlyphOrder()
    advance, bearing = metrics[source]
    metrics[name] = (round(advance * scale), round(bearing * scale))
    glyph.recalcBounds(glyf)
    for table in font["cmap"].tables:
        if table.isUnicode():
            table.cmap[code] = name


def alias(font, code, existing):
    for table in font["cmap"].tables:
        if table.isUnicode() and existing in table.cmap:
            table.cmap.setdefault(code, table.cmap[existing])


def make(source, target, style):
    font = TTFont(source)
    glyf, cmap = font["glyf"], font.getBestCmap()
    sup, sub, four = cmap[0x2074], cmap[0x2084], cmap[ord("4")]
    raised = glyf[sup].yMin - glyf[sub].yMin
    compose(font, 0x2070, cmap[0x2080], (sup, four), shift_to=raised)
    for code, sign in [(0x207A, "+"), (0x207B, "\u2212")]:
        compose(font, code, cmap[ord(sign)], (sup, four))
    for code, sign in [(0x208A, "+"), (0x208B, "\u2212")]:
        compose(font, code, cmap[ord(sign)], (sub, four))
    alias(font, 0x22C5, 0x00B7)  # dot operator
    alias(font, 0x2011, 0x002D)  # non-breaking hyphen
    alias(font, 0x2009, 0x0020)  # thin space, if missing

    options = subset.Options()
    options.hinting = False
    options.layout_features = ["kern", "mark", "mkmk", "ccmp"]
    options.name_IDs = ["*"]
    options.notdef_outline = True
    options.drop_tables += ["FFTM", "kern"]
    worker = subset.Subsetter(options)
    worker.populate(unicodes=[c for low, high in RANGES for c in range(low, high + 1)])
    worker.subset(font)

    names = {1: FAMILY, 2: style, 3: f"{FAMILY} {style}", 4: f"{FAMILY} {style}",
             6: f"{FAMILY}-{style}".replace(" ", "")}
    for record in list(font["name"].names):
        if record.nameID in names:
            record.string = names[record.nameID]
        elif record.nameID not in (0, 13, 14):
            font["name"].removeNames(nameID=record.nameID)
    font["head"].modified = font["head"].created  # same bytes every time
    font.recalcTimestamp = False
    font.save(target)


if __name__ == "__main__":
    here = Path(__file__).parent
    for style in ("Regular", "Bold"):
        make(Path(sys.argv[1]) / f"LiberationSans-{style}.ttf", here / f"ApportionSans-{style}.ttf", style)
