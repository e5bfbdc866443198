"""Reads a painting: how much of each paint lies on the canvas, wet and dry.

    python3 read_painting.py FILE.maul          (pip install numpy zstandard)
"""
import json
import sqlite3
import sys

import numpy
import zstandard

CELLS = 64 * 64
QUANTUM_M = 0.025 / 2**24


def page(db, number):
    """Counts by slot, 64×64, row 0 at the bottom."""
    base, slots, data = db.execute("SELECT base, slots, data FROM page WHERE id = ?", (number,)).fetchone()
    under = page(db, base) if base else None
    here = [slot for slot in range(16) if slots >> slot & 1]
    raw = zstandard.ZstdDecompressor().decompress(data, max_output_size=4 * CELLS * len(here))
    planes = {}
    for place, slot in enumerate(here):
        shuffled = numpy.frombuffer(raw, numpy.uint8, 4 * CELLS, 4 * CELLS * place).reshape(4, CELLS)
        code = shuffled.astype(numpy.int64).T @ (1 << numpy.arange(0, 32, 8))
        difference = (code >> 1) ^ -(code & 1)
        if under is not None:
            planes[slot] = difference.reshape(64, 64) + under.get(slot, 0)
        else:
            rows = difference.reshape(64, 64).copy()
            rows[:, 0] = numpy.cumsum(rows[:, 0])
            planes[slot] = numpy.cumsum(rows, axis=1)
    return planes


def main(path):
    # A painting that nobody has open; mode=ro leaves it as it is.
    db = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    assert db.execute("PRAGMA application_id").fetchone() == (0x4D61756C,), "no painting"
    state = json.loads(db.execute("SELECT value FROM state WHERE key = 'painting'").fetchone()[0])
    scene = state["scene"]
    canvas = scene["surfaces"][0]
    volume_ml = QUANTUM_M * canvas["cell_m"] ** 2 * 1e6
    names = [paint["name"] for paint in scene["paints"]]
    wet, dry = [0] * len(names), [0] * len(names)
    for place, wet_page, layer in db.execute("SELECT place, page, dry FROM tile"):
        if place >> 40 != 0:
            continue
        if wet_page:
            for slot, plane in page(db, wet_page).items():
                wet[slot] += int(plane.sum())
        while layer:
            layer, number = db.execute("SELECT below, page FROM dry WHERE id = ?", (layer,)).fetchone()
            for slot, plane in page(db, number).items():
                dry[slot] += int(plane.sum())
    print(f"{canvas['cells'][0]} × {canvas['cells'][1]} cells")
    for name, w, d in zip(names, wet, dry):
        print(f"{name}: {w * volume_ml:.6f} ml wet, {d * volume_ml:.6f} ml dry")


if __name__ == "__main__":
    main(sys.argv[1])
