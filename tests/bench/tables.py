# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain tables, and pictures side by side."""

from pathlib import Path

import images
import numpy as np

_NAME_WIDTH = 16


def show(title, rows, formats):
    """Prints a line for each row. rows: {name: {column: value}}; formats: {column: format}; what is not there is "-"."""
    print(title)
    width = max([_NAME_WIDTH, *(len(name) + 2 for name in rows)])
    columns = {name: max(10, len(name) + 2) for name in formats}
    print(" " * width + "".join(f"{name:>{wide}}" for name, wide in columns.items()))
    for name, row in rows.items():
        cells = ("-" if row.get(column) is None else format(row[column], formats[column]) for column in columns)
        print(f"{name:{width}}" + "".join(f"{cell:>{wide}}" for cell, wide in zip(cells, columns.values())), flush=True)
    print(flush=True)


def write(folder, name, pictures):
    """Writes grey pictures, float[height, width], rows from the bottom, 0 to 1 as shown on the screen, side by side as a PNG."""
    if folder:
        row = np.concatenate(list(pictures), axis=1)[::-1]
        images.write_png(Path(folder) / f"{name}.png", images.srgb_to_linear(np.repeat(np.clip(row, 0.0, 1.0)[:, :, None], 3, axis=2)))
