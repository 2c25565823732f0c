"""Pictures of the demonstration: contact pressure on the surface, and force over displacement."""

from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import Triangulation

INK, MUTED, GRID = "#1f2430", "#6b7280", "#e3e6eb"
COLORS = {"overclosure run": "#1f5fa8", "daemon session": "#d9772b", "FMU in FMPy": "#3b8f5a"}
MAP = "viridis"


@dataclass
class Surface:
    """Contact surface for drawing: coordinates (n, 3) by row, quadrilaterals as rows, and a value per row."""

    coordinates: np.ndarray
    quads: np.ndarray
    pressure: np.ndarray


def style(axes, title, x, y):
    """Shared look."""
    axes.set_title(title, loc="left", fontsize=11, color=INK, pad=10)
    axes.set_xlabel(x, color=INK)
    axes.set_ylabel(y, color=INK)
    axes.tick_params(colors=MUTED)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(MUTED)


def triangles(quads):
    """Two triangles for each quadrilateral."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def punch_pressure(surface, path, force, area):
    """CPRESS under the punch, seen from above, and along its middle."""
    x, y = surface.coordinates[:, 0], surface.coordinates[:, 1]
    figure, (plan, cut) = plt.subplots(1, 2, figsize=(11, 4.6), width_ratios=[1, 1.15], layout="constrained")
    mesh = Triangulation(x, y, triangles(surface.quads))
    shown = plan.tripcolor(mesh, surface.pressure, shading="gouraud", cmap=MAP, vmin=0.0)
    for quad in surface.quads:
        ring = np.append(quad, quad[0])
        plan.plot(x[ring], y[ring], color="white", linewidth=0.25, alpha=0.5)
    plan.set_aspect("equal")
    style(plan, "CPRESS on the secondary surface", "x", "y")
    figure.colorbar(shown, ax=plan, shrink=0.9, label="CPRESS")
    middle = np.abs(y - np.median(np.unique(y.round(9)))) < 1e-9
    edge = np.abs(y - y.min()) < 1e-9
    diagonal = np.abs((x - x.min()) - (y - y.min())) < 1e-9
    length = np.hypot(x - x.min(), y - y.min())
    for chosen, label, marker, color in ((middle, "middle", "o", "#1f5fa8"), (edge, "edge", "s", "#d9772b")):
        order = np.argsort(x[chosen])
        cut.plot(
            x[chosen][order], surface.pressure[chosen][order], marker, ms=4, ls="-", lw=1.2, color=color, label=label
        )
    order = np.argsort(length[diagonal])
    scaled = x[diagonal][order]
    cut.plot(scaled, surface.pressure[diagonal][order], "^", ms=4, ls="-", lw=1.2, color="#3b8f5a", label="diagonal")
    cut.axhline(force / area, color=MUTED, lw=1, ls="--")
    middle_x = 0.5 * (x.min() + x.max())
    cut.annotate(
        "mean pressure", (middle_x, force / area), (0, 4), textcoords="offset points", ha="center", color=MUTED
    )
    cut.set_ylim(0.0, 1.15 * surface.pressure.max())
    cut.grid(color=GRID, lw=0.6)
    cut.legend(frameon=False, loc="upper center", ncols=3)
    style(cut, "CPRESS along lines of nodes", "x", "")
    figure.savefig(path, dpi=150)
    plt.close(figure)


def hertz_pressure(surface, path, theory):
    """CPRESS along the arc with the Hertz ellipse of the same force, and the strip of surface it stands on."""
    half_width, peak = theory
    x, z = surface.coordinates[:, 0], surface.coordinates[:, 2]
    shown = 2.2 * half_width
    figure, (curve, strip) = plt.subplots(
        2, 1, figsize=(8.4, 5.6), height_ratios=[4, 1], sharex=True, layout="constrained"
    )
    near = (np.abs(z - z.min()) < 1e-9) & (x <= shown)
    order = np.argsort(x[near])
    smooth = np.linspace(0.0, half_width, 400)
    curve.plot(
        smooth,
        peak * np.sqrt(1.0 - (smooth / half_width) ** 2),
        color=MUTED,
        lw=1.4,
        ls="--",
        label="Hertz, same force",
    )
    curve.plot(
        x[near][order],
        surface.pressure[near][order],
        "o-",
        ms=5,
        lw=1.2,
        color="#1f5fa8",
        label="CPRESS, secondary nodes",
        clip_on=False,
    )
    curve.set_ylim(bottom=0.0)
    curve.grid(color=GRID, lw=0.6)
    curve.legend(frameon=False)
    style(curve, "CPRESS of the cylinder on the block", "", "CPRESS")
    mesh = Triangulation(x, z, triangles(surface.quads))
    colored = strip.tripcolor(mesh, surface.pressure, shading="gouraud", cmap=MAP, vmin=0.0)
    for quad in surface.quads:
        ring = np.append(quad, quad[0])
        strip.plot(x[ring], z[ring], color="white", linewidth=0.5, alpha=0.7)
    strip.set_xlim(0.0, shown)
    style(strip, "The same on the secondary surface, seen from above", "distance from the symmetry plane x", "z")
    figure.colorbar(colored, ax=[curve, strip], shrink=0.8, label="CPRESS")
    figure.savefig(path, dpi=150)
    plt.close(figure)


def force_displacement(curves, path, title):
    """Force over displacement; one entry per way of solving: name -> (displacements, forces)."""
    figure, axes = plt.subplots(figsize=(7.2, 4.8), layout="constrained")
    looks = {
        "overclosure run": {"ls": "-", "lw": 1.6, "marker": ""},
        "daemon session": {"ls": "", "marker": "o", "ms": 9, "mfc": "none", "mew": 1.4},
        "FMU in FMPy": {"ls": "", "marker": "x", "ms": 6, "mew": 1.6},
    }
    for name, (displacement, force) in curves.items():
        if name == "overclosure run":
            displacement, force = [0.0, *displacement], [0.0, *force]
        axes.plot(displacement, force, label=name, color=COLORS[name], **looks[name])
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.grid(color=GRID, lw=0.6)
    axes.legend(frameon=False, loc="upper left")
    style(axes, title, "displacement of NTOP, downwards", "force on NTOP, downwards")
    figure.savefig(path, dpi=150)
    plt.close(figure)
