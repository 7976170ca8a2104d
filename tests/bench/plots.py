# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots, and linear pictures side by side with captions, as PNG.

Matplotlib draws them. Where it is missing, a sentence says so, once: then pictures have no captions and there are no
plots. The files are written by images.py and hold pixels alone, so that the same figure is the same bytes.
"""

import functools
import os
from pathlib import Path

import images
import numpy as np

# Where matplotlib keeps its list of fonts, instead of in the user's own configuration.
os.environ.setdefault("MPLCONFIGDIR", str(Path(__file__).resolve().parents[2] / "build" / "matplotlib"))

# Pixels an inch, by which a font of 9 points is 12 pixels high.
DPI = 96
FONT = {"fontsize": 9}
CAPTION_PIXELS, GAP_PIXELS = 22, 4
# Width and height in pixels of each diagram of a plot.
DIAGRAM = (440, 300)
MISSING = "Pictures have no captions and plots are left out, for matplotlib is missing: apt-get install python3-matplotlib.\n"


@functools.lru_cache(1)
def _say_what_is_missing():
    print(MISSING, flush=True)


def _figure(width, height):
    """An empty figure of so many pixels; None where there is nothing to draw with."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        _say_what_is_missing()
        return None
    figure = Figure((width / DPI, height / DPI), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def _write(figure, folder, name):
    figure.canvas.draw()
    drawn = np.asarray(figure.canvas.buffer_rgba())[:, :, :3] / 255.0
    images.write_png(Path(folder) / f"{name}.png", images.srgb_to_linear(drawn))


def strip(folder, name, pictures, gain=1.0):
    """Writes pictures of one size, {caption: linear float[height, width, 3], rows from the bottom}, side by side.

    gain: what they are multiplied by, so that they are as bright as they are looked at best.
    """
    if not folder:
        return
    pictures = {caption: gain * picture for caption, picture in pictures.items()}
    height, width = next(iter(pictures.values())).shape[:2]
    figure = _figure(len(pictures) * (width + GAP_PIXELS) - GAP_PIXELS, height + CAPTION_PIXELS)
    if figure is None:
        images.write_png(Path(folder) / f"{name}.png", np.concatenate(list(pictures.values()), axis=1)[::-1])
        return
    for place, (caption, picture) in enumerate(pictures.items()):
        left = place * (width + GAP_PIXELS)
        # Pixels stay what they are: an image of a figure is not scaled, and bytes are not rounded down.
        figure.figimage(np.rint(images.linear_to_srgb(picture) * 255.0).astype(np.uint8), left, CAPTION_PIXELS, origin="lower")
        figure.text((left + width / 2) / figure.bbox.width, CAPTION_PIXELS / 2 / figure.bbox.height, caption, ha="center", va="center", **FONT)
    _write(figure, folder, name)


def _diagrams(title, count):
    """A figure and its `count` axes side by side, empty; None and nothing where there is nothing to draw with."""
    figure = _figure(count * DIAGRAM[0], DIAGRAM[1])
    if figure is None:
        return None, ()
    figure.set_layout_engine("constrained")
    figure.suptitle(title, **FONT)
    every = figure.subplots(1, count, squeeze=False)[0]
    for axes in every:
        axes.tick_params(labelsize=8)
        axes.spines[["top", "right"]].set_visible(False)
    return figure, every


def lines(folder, name, title, along, places, diagrams):
    """Writes diagrams side by side over the same places.

    along: what the places are, with their unit; places: numbers; diagrams: {what is shown: {line: a number a place}}.
    """
    figure, every = _diagrams(title, len(diagrams)) if folder else (None, ())
    if figure is None:
        return
    for axes, (what, drawn) in zip(every, diagrams.items()):
        for line, values in drawn.items():
            axes.plot(places, values, marker="o", markersize=4, label=line)
        axes.set_xlabel(along, **FONT)
        axes.set_ylabel(what, **FONT)
        axes.set_ylim(bottom=0.0)
        axes.grid(axis="y", alpha=0.3)
        axes.legend(**FONT)
    _write(figure, folder, name)


def stacks(folder, name, title, along, what, columns, layers):
    """Writes a diagram of columns, each of layers that lie on each other, the first one lowest.

    along, what: of the columns and of their heights; columns: {name: a word above it}; layers: {name: a number a column}.
    """
    figure, every = _diagrams(title, 1) if folder else (None, ())
    if figure is None:
        return
    axes, = every
    top = np.zeros(len(columns))
    for layer, values in layers.items():
        axes.bar(list(columns), values, bottom=top, label=layer, width=0.7)
        top = top + values
    for place, (height, word) in enumerate(zip(top, columns.values())):
        axes.annotate(word, (place, height), (0, 3), textcoords="offset points", ha="center", **FONT)
    axes.set_xlabel(along, **FONT)
    axes.set_ylabel(what, **FONT)
    # In the order in which they lie.
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], loc="upper left", **FONT)
    _write(figure, folder, name)
