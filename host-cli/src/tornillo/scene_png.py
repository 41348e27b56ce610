# SPDX-License-Identifier: Apache-2.0
"""Paint a scene as PNG with matplotlib, which is the optional extra `draw`."""

from pathlib import Path

from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.scene import Area, Line, Scene

MM_PER_INCH = 25.4
POINTS_PER_MM = 72 / MM_PER_INCH
DPI = 200
ALIGNMENT = {"start": "left", "middle": "center", "end": "right"}


def save_png(scene: Scene, path: Path) -> None:
    """Write `scene` to `path`.

    Raises TornilloError when matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.lines import Line2D
        from matplotlib.patches import Polygon
    except ImportError as error:
        raise TornilloError(
            _("PNG pictures need matplotlib"),
            _('install it with `pip install "tornillo[draw]"`, or write an .svg'),
        ) from error
    figure = Figure(figsize=(scene.width / MM_PER_INCH, scene.height / MM_PER_INCH), dpi=DPI)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(0, scene.width)
    axes.set_ylim(0, scene.height)
    axes.set_axis_off()
    for order, thing in enumerate(scene.things, start=1):
        if isinstance(thing, Area):
            axes.add_patch(Polygon(thing.points, color=thing.fill, linewidth=0, zorder=order))
        elif isinstance(thing, Line):
            xs, ys = zip(*thing.points, strict=True)
            width = thing.pen.width * POINTS_PER_MM
            dashes = tuple(dash * POINTS_PER_MM / width for dash in thing.pen.dashes)
            line = Line2D(xs, ys, linewidth=width, color=thing.pen.color, zorder=order)
            line.set_linestyle((0, dashes) if dashes else "-")
            axes.add_line(line)
        else:
            axes.text(
                *thing.at,
                thing.text,
                fontsize=thing.size * POINTS_PER_MM,
                horizontalalignment=ALIGNMENT[thing.anchor],
                verticalalignment="center_baseline" if not thing.turn else "center",
                rotation=thing.turn,
                rotation_mode="anchor",
                fontweight="bold" if thing.bold else "normal",
                color=thing.color,
                zorder=order,
            )
    figure.savefig(path)
