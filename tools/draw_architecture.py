#!/usr/bin/env python3
"""Draws docs/pictures/architecture.svg: the rooms in the layers that tools/layers.txt gives them, and the way of the data.

    tools/draw_architecture.py            the picture on standard output
    tools/draw_architecture.py --check    exit code 1 when the picture in docs is not this one

A room stands one row above the highest room that it may include, so a row never includes itself or a row above it. Rooms of
one district have one colour.
"""
import html
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = ROOT / "docs/pictures/architecture.svg"
# Districts in the order of the data, with their colours.
PARTS = [("motion", "path"), ("world", "signal"), ("receiver", "fix"), ("firmware-host", "firmware"), ("wire", "wire")]
COLOURS = {**dict(PARTS), "base": "ground", "study": "watch", "run": "whole", "campaigns": "watch"}
# What flows between them, and back.
FLOW = ["TruthState", "Arrivals", "Epoch", "bytes"]
WIDTH, BOX, GAP, ROW, LEFT, TOP = 1180, 96, 9, 50, 20, 190
STYLE = """
text { font: 13px system-ui, sans-serif; fill: #1b1f24 }
.small { font-size: 11.5px; fill: #57606a }
.title { font-weight: 600 }
rect { stroke: #57606a; stroke-width: 1 }
path { stroke: #57606a; stroke-width: 1.5; fill: none; marker-end: url(#tip) }
marker path { fill: #57606a; stroke: none; marker-end: none }
.path { fill: #d7e8ff } .signal { fill: #d9f2dd } .fix { fill: #fff1c9 } .firmware { fill: #ffe0cc }
.wire { fill: #f9d7e3 } .watch { fill: #e6dcfa } .whole { fill: #d5eef0 } .ground { fill: #eceff2 }
@media (prefers-color-scheme: dark) {
  text { fill: #e6edf3 } .small { fill: #9da7b3 } rect, path { stroke: #9da7b3 } marker path { fill: #9da7b3 }
  .path { fill: #17375e } .signal { fill: #1c4427 } .fix { fill: #4d3d0f } .firmware { fill: #5a3216 }
  .wire { fill: #571f38 } .watch { fill: #3b2a63 } .whole { fill: #154a50 } .ground { fill: #2d333b }
}
"""


def read_layers(text):
    """Rooms with what each may include, from rows `name : names !exceptions`, and with their districts."""
    layers, districts, district = {}, {}, None
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        name, _, rest = line.partition(":")
        if line.startswith("["):
            district = name.strip("[ ")
        elif line:
            layers[name.strip()] = [word for word in rest.split() if not word.startswith("!")]
            districts[name.strip()] = district
    return layers, districts


def rows_of(layers):
    """Rooms by height: 0 includes nothing."""
    height = {}
    for name, below in layers.items():  # a row names only rows above it
        height[name] = 1 + max((height[other] for other in below), default=-1)
    return [[name for name in layers if height[name] == level] for level in range(max(height.values()) + 1)]


def box(place, size, kind, lines):
    """A box with lines of text in its middle; the first one is a title when there are more."""
    (x, y), (wide, high) = place, size
    drawn = [f'<rect class="{kind}" x="{x}" y="{y}" width="{wide}" height="{high}" rx="5"/>']
    first = y + high / 2 - (len(lines) - 1) * 8 + 4.5
    for i, line in enumerate(lines):
        style = ' class="title"' if len(lines) > 1 and i == 0 else ' class="small"' if i else ""
        drawn.append(f'<text{style} x="{x + wide / 2:g}" y="{first + 16 * i:g}" text-anchor="middle">{html.escape(line)}</text>')
    return drawn


def draw_flow(districts):
    """Districts from left to right, with what flows between them."""
    wide, gap, drawn = 168, 75, []
    for i, (district, kind) in enumerate(PARTS):
        x = LEFT + i * (wide + gap)
        words = [room for room, of in districts.items() if of == district]
        half = len(words) if len(" ".join(words)) < 24 else (len(words) + 1) // 2
        drawn += box((x, 40), (wide, 78), kind, [line for line in (district, " ".join(words[:half]), " ".join(words[half:])) if line])
        if i:
            drawn.append(f'<path d="M{x - gap + 4} 70 H{x - 5}"/>')
            drawn.append(f'<text class="small" x="{x - gap / 2:g}" y="62" text-anchor="middle">{FLOW[i - 1]}</text>')
    back, front = LEFT + 2 * (wide + gap) + wide / 2, LEFT + 3 * (wide + gap) + wide / 2
    drawn.append(f'<path d="M{front:g} 122 V136 H{back:g} V122"/>')
    drawn.append(f'<text class="small" x="{(back + front) / 2:g}" y="150" text-anchor="middle">ReceiverSettings</text>')
    right = LEFT + 4 * (wide + gap)
    drawn.append(f'<path d="M{right - 5} 96 H{right - gap + 4}"/>')
    return drawn


def draw_layers(rows, districts):
    """The rooms, the highest row at the top."""
    drawn = [f'<text class="title" x="{LEFT}" y="{TOP - 10}">Layers: a room includes only rooms below it</text>']
    for i, row in enumerate(reversed(rows)):
        y = TOP + i * ROW
        wide = min(BOX, (WIDTH - 2 * LEFT) // len(row) - GAP)
        begin = (WIDTH - len(row) * (wide + GAP) + GAP) / 2
        for k, folder in enumerate(row):
            drawn += box((begin + k * (wide + GAP), y), (wide, ROW - 16), COLOURS.get(districts[folder], "whole"), [folder])
    return drawn


def draw_key(y):
    """The colours by district."""
    drawn, x = [], LEFT
    for district, colour in COLOURS.items():
        drawn.append(f'<rect class="{colour}" x="{x}" y="{y}" width="14" height="14" rx="3"/>')
        drawn.append(f'<text class="small" x="{x + 20}" y="{y + 11.5:g}">{district}</text>')
        x += 125
    return drawn


def picture(layers, districts):
    """The whole svg; the same for the same layers."""
    rows = rows_of(layers)
    key = TOP + len(rows) * ROW + 4
    height = key + 30
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" '
        'aria-label="The way of the data through skyloop, and its rooms in layers">',
        f"<style>{STYLE}</style>",
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="6" refY="4" markerWidth="6" markerHeight="6" orient="auto">'
        '<path d="M0 0 L8 4 L0 8 z"/></marker></defs>',
        f'<text class="title" x="{LEFT}" y="24">The way of the data</text>',
        *draw_flow(districts), *draw_layers(rows, districts), *draw_key(key), "</svg>"]) + "\n"


def main():
    drawn = picture(*read_layers((ROOT / "tools/layers.txt").read_text(encoding="utf-8")))
    if "--check" not in sys.argv:
        sys.stdout.write(drawn)
        return 0
    if PICTURE.read_text(encoding="utf-8") == drawn:
        return 0
    print("docs/pictures/architecture.svg is old: tools/draw_architecture.py > docs/pictures/architecture.svg")
    return 1


if __name__ == "__main__":
    sys.exit(main())
