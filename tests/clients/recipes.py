"""Runs the book's recipes in Python as they stand there, and looks at what they draw.

    python recipes.py BOOK

BOOK is the folder of the book's pages; the recipes run in the current folder, which has the run
that they name. Windows are drawn off screen, without axes and colour bar: a picture of which less
than a hundredth is not white is empty. Prints one line for each recipe.
"""

import pathlib
import re
import sys

import numpy as np
import pyvista

LEAST = 0.01


def recipes(book):
    """Page, line and text of each block of Python."""
    for page in sorted(pathlib.Path(book).rglob("*.md")):
        text = page.read_text(encoding="utf-8")
        for block in re.finditer(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
            line = text.count("\n", 0, block.start()) + 2
            yield f"{page.relative_to(book)}:{line}", block[1]


def record_pictures():
    """Lets pyvista draw off screen; returns the list that its pictures will be in."""
    pictures = []
    show = pyvista.Plotter.show

    def show_and_keep(plotter, *args, **kwargs):
        result = show(plotter, *args, **kwargs)
        pictures.append(np.asarray(plotter.last_image)[..., :3])
        return result

    pyvista.Plotter.show = show_and_keep
    pyvista.OFF_SCREEN = True
    pyvista.global_theme.background = "white"
    pyvista.global_theme.show_scalar_bar = False
    pyvista.global_theme.axes.show = False
    return pictures


def main(book):
    pictures = record_pictures()
    found = list(recipes(book))
    assert found, f"no recipe in {book}"
    for place, text in found:
        pictures.clear()
        exec(compile(text, place, "exec"), {"__name__": "__main__"})
        shares = [float((picture != 255).any(axis=-1).mean()) for picture in pictures]
        assert "pyvista" not in text or shares, f"{place}: draws nothing"
        assert all(share > LEAST for share in shares), f"{place}: an empty window, {shares}"
        print(place, *(f"{share:.1%} drawn" for share in shares))


if __name__ == "__main__":
    main(*sys.argv[1:])
