"""Runs as pictures: for notebooks without any library, and by matplotlib."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._run import Array, Run

COLOURS = ("#2a6fbb", "#c8553d", "#3a8c5f", "#8457a6")
WIDTH, HEIGHT, EDGE = 300, 120, 4
MOST_POINTS, MOST_PICTURES = 400, 6
# a notebook keeps all that it shows
LARGEST_PAGE = 20_000_000


def by_unit(run: Run) -> dict[str, list[str]]:
    """Columns without the first, by their units."""
    groups: dict[str, list[str]] = {}
    for name in list(run)[1:]:
        groups.setdefault(run.units[name], []).append(name)
    return groups


def svg(t: Array, curves: list[Array]) -> str:
    """A small picture of some curves."""
    keep = slice(None, None, max(1, len(t) // MOST_POINTS))
    values = np.stack([c[keep] for c in curves])
    low, high = np.nanmin(values), np.nanmax(values)
    x = EDGE + (WIDTH - 2 * EDGE) * (t[keep] - t[0]) / (np.ptp(t) or 1.0)
    y = HEIGHT - EDGE - (HEIGHT - 2 * EDGE) * (values - low) / ((high - low) or 1.0)
    lines = []
    for curve, colour in zip(y, COLOURS):
        good = np.isfinite(curve)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x[good], curve[good]))
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.3"/>')
    return f'<svg width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}">{"".join(lines)}</svg>'


def html(run: Run) -> str:
    """The page of the run if its folder has one, or else the summary and small pictures, as a notebook shows them."""
    page = None if run.folder is None else run.folder / "report.html"
    if page is not None and page.is_file() and page.stat().st_size <= LARGEST_PAGE:
        text = escape(page.read_text(encoding="utf-8"), quote=True)
        frame = 'sandbox="allow-scripts" style="width:100%;height:640px;border:0"'
        return f'<iframe {frame} srcdoc="{text}"></iframe>'
    message = run.summary.get("message")
    about = f"{escape(run.status)}{': ' + escape(message) if message else ''}, {len(run.t)} rows"
    warnings = "".join(f"<li>{escape(w)}</li>" for w in run.warnings)
    pictures = []
    for unit, names in list(by_unit(run).items())[:MOST_PICTURES]:
        shown = [n for n in names if np.isfinite(run[n]).any()][: len(COLOURS)]
        if not shown or len(run.t) < 2:
            continue
        label = ", ".join(
            f'<span style="color:{c}">{escape(n)}</span> {run[n][-1]:.5g}' for n, c in zip(shown, COLOURS)
        )
        figure = svg(run.t, [run[n] for n in shown])
        pictures.append(f"<div><small>{label} {escape(unit)}</small><br>{figure}</div>")
    return (
        f"<div><b>{escape(run.title)}</b><br>{about}"
        f"{'<ul>' + warnings + '</ul>' if warnings else ''}"
        f'<div style="display:flex;flex-wrap:wrap;gap:1em">{"".join(pictures)}</div></div>'
    )


def pyplot() -> Any:
    """Matplotlib, or what to do without."""
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise ImportError("pictures need matplotlib: pip install matplotlib") from None
    return plt


def plot(run: Run, names: tuple[str, ...], ax: Any, options: dict[str, Any]) -> Any:
    """Columns over time, by matplotlib."""
    groups: dict[str, list[str]] = {}
    for name in names:
        columns = [name] if name in run.units else [c for c in run if c.startswith(f"{name}.")]
        if not columns:
            run[name]  # says what there is
        for column in columns:
            groups.setdefault(run.units[column], []).append(column)
    groups = groups or by_unit(run)
    if ax is None:
        _, ax = pyplot().subplots(len(groups), sharex=True, squeeze=False, layout="constrained")
    axes = np.atleast_1d(ax).ravel()
    if len(axes) < len(groups):
        raise ValueError(f"the columns have {len(groups)} units, but there are {len(axes)} axes to draw on")
    for one, (unit, columns) in zip(axes, groups.items()):
        for column in columns:
            one.plot(run.t, run[column], label=column, **options)
        one.set_ylabel(f"[{unit}]" if unit else "")
        one.legend()
    first = next(iter(run))
    axes[-1].set_xlabel(f"{first} [{run.units[first]}]" if run.units[first] else first)
    return ax
