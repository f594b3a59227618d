"""The wheel-rail section at its worst moment, and the car above it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.physics.profiles import zone_extremum
from railquake.plots.events import run_title
from railquake.plots.outline import Outline, body_colours, box, outlines, placed, turned
from railquake.plots.style import (
    BLACK,
    BLUE,
    GREY,
    RED,
    blank,
    dress,
    filled,
    heading,
    label,
    legend,
    plain,
    save,
    signed,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.inputs.profile import Profile
    from railquake.inputs.wheelrail import WheelRail
    from railquake.run.response import Response

__all__ = ["write_section"]

Array = np.ndarray[Any, np.dtype[np.float64]]

# inches
WIDTH, HEIGHT = 11.0, 6.65
CAR, WHOLE, CLOSE = (4.4, 5.2), (5.1, 2.2), (2.3, 2.2)
SIDES = {"left": -1.0, "right": 1.0}
STEEL, EDGE = "#d4d4d4", "#555555"


@dataclass(frozen=True)
class _Place:
    """Where the wheelset stands in track axes at one moment; m and rad."""

    shift: float
    height: float
    roll: float


@dataclass(frozen=True)
class _Contact:
    """A point of contact in track axes, m, and the slope dz/dy of its plane."""

    zone: str
    y: float
    z: float
    slope: float


def write_section(response: Response, path: Path) -> Path:
    """Draw the section at `Response.worst_frame`: the car, the wheelset, both contacts."""
    frame = response.worst_frame
    pair = response.system.scenario.wheelrail
    wheel = pair.wheel_profile()
    rail = pair.rail_profile()
    centre = pair.rail_half_distance(rail)

    def at(name: str) -> float:
        return float(response.channel(name)[frame])

    place = _Place(at("lateral_shift_m"), at("wheelset_height_m"), at("relative_roll_rad"))
    contacts = {side: _contacts(response, frame, side, place) for side in SIDES}

    made = blank(WIDTH, HEIGHT)

    def axes(left: float, bottom: float, width: float, height: float) -> Axes:
        return made.add_axes((left / WIDTH, bottom / HEIGHT, width / WIDTH, height / HEIGHT))

    car, whole = axes(0.6, 0.5, *CAR), axes(5.75, 3.5, *WHOLE)
    close = {"left": axes(5.75, 0.5, *CLOSE), "right": axes(8.55, 0.5, *CLOSE)}
    for ax in (car, whole, *close.values()):
        dress(ax).set_aspect("equal", adjustable="box", anchor="C")
    _draw_car(car, response, frame, centre)
    for ax in (whole, *close.values()):
        for sign in SIDES.values():
            _draw_rail(ax, rail, sign, centre)
        _draw_wheelset(ax, pair, wheel, place)
    _frame_whole(whole, pair, centre, place)
    windows = {side: _window(pair, wheel, rail, centre, place, side) for side in SIDES}
    half_width = max(window[2] for window in windows.values())
    half_height = max(window[3] for window in windows.values())
    half_width = max(half_width, half_height * CLOSE[0] / CLOSE[1])
    half_height = half_width * CLOSE[1] / CLOSE[0]
    for side, ax in close.items():
        y, z, _, _ = windows[side]
        ax.set_xlim(1e3 * (y - half_width), 1e3 * (y + half_width))
        ax.set_ylim(1e3 * (z + half_height), 1e3 * (z - half_height))
        ax.axhline(0.0, color=GREY, linewidth=0.6, linestyle=":", zorder=0.9)
        _draw_contacts(ax, contacts[side], half_width)
        load = 1e-3 * at(f"wheel_load_{side}_n")
        label(ax, "to the right in the track, mm", "down, mm" if side == "left" else "",
              _state_of(side, contacts[side], load))  # fmt: skip
        corner, size = (y - half_width, z - half_height), (2 * half_width, 2 * half_height)
        _mark_window(whole, side, corner, size)

    moment = float(response.times[frame])
    onset = float(np.degrees(response.reference_roll))
    way = "right" if place.shift > 0.0 else "left"
    heading(
        made,
        f"The worst moment, {moment:.3f} s: wheelset {1e3 * abs(place.shift):.1f} mm to the {way}, "
        f"rolled {signed(float(np.degrees(place.roll)))}° on the track",
        run_title(response),
        f"roll: right side down; slide-off begins at ±{onset:.3f}°",
    )
    return save(made, path)


def _contacts(response: Response, frame: int, side: str, place: _Place) -> list[_Contact]:
    """Points where a wheel touches, found by the grid method."""
    geometry = response.system.geometry
    sign = SIDES[side]
    zones = {
        "tread": (geometry.flange_points, len(geometry.wheel_y)),
        "flange": (0, geometry.flange_points),
    }
    found = []
    for zone, (first, last) in zones.items():
        if not response.channel(f"penetration_{side}_{zone}_m")[frame] > 0.0:
            continue
        _, slope, _, y, z, *_ = zone_extremum(
            sign * place.shift, sign * place.roll, first, last, geometry
        )
        found.append(_Contact(zone, sign * y, z, sign * slope))
    return found


def _state_of(side: str, contacts: list[_Contact], load: float) -> str:
    name = side.capitalize()
    if not contacts:
        return f"{name}: off its rail"
    touching = " and ".join(contact.zone for contact in contacts)
    return f"{name}: {touching}, {load:.0f} kN"


def _draw_rail(ax: Axes, rail: Profile, sign: float, centre: float) -> None:
    """The profile as it is; web and foot below it are sketched."""
    y, z = rail.y, rail.z - rail.z.min()
    middle, half = 0.5 * (y[0] + y[-1]), 0.5 * (y[-1] - y[0])
    foot = 0.165
    low = max(float(z[0]), float(z[-1]))
    if low < 0.1:  # a head alone
        neck = low + 0.015
        under_y = np.array([0.3 * half, 0.25 * half, 0.25 * half, 2.0 * half, 2.0 * half])
        under_z = np.array([neck, neck + 0.02, foot - 0.025, foot - 0.012, foot])
        y = np.concatenate([y, middle + under_y, middle - under_y[::-1]])
        z = np.concatenate([z, under_z, under_z[::-1]])
    filled(ax, 1e3 * sign * (centre + y), 1e3 * z, facecolor=STEEL, zorder=1)
    drawn = 1e3 * sign * (centre + rail.y), 1e3 * (rail.z - rail.z.min())
    ax.plot(*drawn, color=EDGE, linewidth=1.1, zorder=2)


def _wheel_outline(pair: WheelRail, wheel: Profile) -> Outline:
    """Right-hand wheel in section, above and below the axle, in the wheelset's axes."""
    rim = pair.running_circle + wheel.y
    tread = pair.rolling_radius + wheel.z
    inner, outer = float(rim[0]), float(rim[-1])
    under = 0.78 * pair.rolling_radius
    hub = 0.32 * pair.rolling_radius
    web = inner + np.array([0.62, 0.38]) * (outer - inner)
    y = np.concatenate([rim, [outer, web[0], web[0], outer, outer, inner, inner, web[1],
                              web[1], inner]])  # fmt: skip
    z = np.concatenate([tread, [under, under, hub, hub, 0.0, 0.0, hub, hub, under, under]])
    return Outline(np.append(y, y[0]), np.append(z, z[0]))


def _draw_wheelset(ax: Axes, pair: WheelRail, wheel: Profile, place: _Place) -> None:
    outline = _wheel_outline(pair, wheel)

    def put(y: Array, z: Array) -> tuple[Array, Array]:
        y, z = turned(y, z, place.roll)
        return 1e3 * (place.shift + y), 1e3 * (place.height + z)

    axle = 0.19 * pair.rolling_radius
    beam = box(-pair.running_circle - 0.09, pair.running_circle + 0.09, -axle, axle)
    filled(ax, *put(beam.y, beam.z), facecolor="#dbe9f4", edgecolor=BLUE, linewidth=0.7, zorder=3)
    for sign in SIDES.values():
        for up in (1.0, -1.0):
            filled(ax, *put(sign * outline.y, up * outline.z), facecolor="#c3dbed", zorder=4)
        ax.plot(*put(sign * (pair.running_circle + wheel.y), pair.rolling_radius + wheel.z),
                color=BLUE, linewidth=1.3, zorder=5)  # fmt: skip


def _frame_whole(ax: Axes, pair: WheelRail, centre: float, place: _Place) -> None:
    reach = max(centre, abs(place.shift) + pair.running_circle) + 0.16
    bottom = 0.185
    top = place.height - pair.rolling_radius - abs(np.sin(place.roll)) * centre - 0.06
    height = max(bottom - top, 2.0 * reach * WHOLE[1] / WHOLE[0])
    reach = 0.5 * height * WHOLE[0] / WHOLE[1]
    ax.set_xlim(-1e3 * reach, 1e3 * reach)
    ax.set_ylim(1e3 * bottom, 1e3 * (bottom - height))
    ax.axhline(0.0, color=GREY, linewidth=0.6, linestyle=":", zorder=0.9)
    title = "The wheelset on its rails, in the track's axes, to scale"
    label(ax, "to the right, mm", "down, mm", title)


def _window(
    pair: WheelRail, wheel: Profile, rail: Profile, centre: float, place: _Place, side: str
) -> tuple[float, float, float, float]:
    """Centre and half sizes of what shows a rail's head and its wheel, m."""
    sign = SIDES[side]
    wheel_y, wheel_z = turned(
        sign * (pair.running_circle + wheel.y), pair.rolling_radius + wheel.z, place.roll
    )
    low = wheel.z > wheel.z.max() - 0.045  # flange and tread; not the back's upper end
    y = np.concatenate([place.shift + wheel_y[low], sign * (centre + rail.y)])
    z = np.concatenate([place.height + wheel_z[low], [-0.025, 0.045]])
    return (
        0.5 * float(y.min() + y.max()),
        0.5 * float(z.min() + z.max()),
        0.5 * float(np.ptp(y)) + 0.008,
        0.5 * float(np.ptp(z)) + 0.008,
    )


def _draw_contacts(ax: Axes, contacts: list[_Contact], half_width: float) -> None:
    """Contact points, their planes and the direction of the normal force on the wheel."""
    for contact in contacts:
        y, z = 1e3 * contact.y, 1e3 * contact.z
        angle = np.arctan(contact.slope)
        along = 0.16e3 * half_width * np.array([np.cos(angle), np.sin(angle)])
        normal = 0.34e3 * half_width * np.array([np.sin(angle), -np.cos(angle)])
        ax.plot(
            [y - along[0], y + along[0]], [z - along[1], z + along[1]], color=RED, linewidth=1.2,
            zorder=7,
        )  # fmt: skip
        ax.annotate(
            "", (y + normal[0], z + normal[1]), xytext=(y, z), zorder=7,
            arrowprops={"arrowstyle": "-|>", "color": RED, "linewidth": 1.3, "shrinkA": 0.0},
        )  # fmt: skip
        ax.plot(y, z, "o", color=RED, markeredgecolor="white", markersize=6.5, zorder=8)
        ax.annotate(
            f"{contact.zone}, {abs(np.degrees(angle)):.0f}°", (y + normal[0], z + normal[1]),
            xytext=(0, 4), textcoords="offset points", fontsize=8, color=RED, zorder=9,
            ha="center", va="bottom",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1.0},
        )  # fmt: skip


def _mark_window(
    ax: Axes, side: str, corner: tuple[float, float], size: tuple[float, float]
) -> None:
    from matplotlib.patches import Rectangle

    ax.add_patch(
        Rectangle(
            (1e3 * corner[0], 1e3 * corner[1]), 1e3 * size[0], 1e3 * size[1], fill=False,
            edgecolor=BLACK, linewidth=0.8, linestyle="--", zorder=6,
        )
    )  # fmt: skip


def _draw_car(ax: Axes, response: Response, frame: int, centre: float) -> None:
    """The whole car on the tilted track, in the ground's axes about the track's origin."""
    vehicle = response.system.scenario.vehicle
    shapes, colours = outlines(vehicle), body_colours(vehicle)
    tilt = float(response.channel("track_roll_rad")[frame])
    origin = tuple(
        float(response.channel(f"track_{way}_m")[frame]) for way in ("lateral", "vertical")
    )
    masses, moved = 0.0, 0.0
    reach = [-2.0, 2.0]
    for body in sorted(vehicle.bodies, key=lambda body: -body.height):
        name = body.name.replace(" ", "_").replace("-", "_")
        y = float(response.channel(f"{name}_lateral_m")[frame]) - origin[0]
        z = float(response.channel(f"{name}_vertical_m")[frame]) - origin[1] - body.height
        roll = float(response.channel(f"{name}_roll_rad")[frame])
        outline = shapes[body.name]
        placed(ax, outline, (y, z), roll, colour=colours[body.name])
        ax.plot([], [], color=colours[body.name], label=plain(body.name))
        corners = y + turned(outline.y, outline.z, roll)[0]
        reach = [min(reach[0], corners.min() - 0.15), max(reach[1], corners.max() + 0.15)]
        masses += body.mass
        moved += body.mass * y
    for sign in SIDES.values():
        rail = box(sign * centre - 0.035, sign * centre + 0.035, 0.0, 0.17)
        filled(ax, *turned(rail.y, rail.z, tilt), facecolor=EDGE, zorder=3)
    deck = box(-1.75, 1.75, 0.17, 0.42)
    filled(
        ax, *turned(deck.y, deck.z, tilt), facecolor="#e4e0da", edgecolor="#a09a90", linewidth=0.9
    )
    ax.axvline(0.0, color=GREY, linewidth=0.7, linestyle=":", zorder=0.9)
    over = moved / masses
    ax.plot(over, 0.58, "^", color=BLACK, markersize=6)
    ax.annotate(
        "all bodies' c.g.", (over, 0.58), xytext=(-6 if over < 0.0 else 6, 0), fontsize=8,
        textcoords="offset points", ha="right" if over < 0.0 else "left", va="center",
    )  # fmt: skip
    bottom = 0.75
    width = max(reach[1] - reach[0], (bottom + 3.7) * CAR[0] / CAR[1])
    middle = 0.5 * (reach[0] + reach[1])
    ax.set_xlim(middle - 0.5 * width, middle + 0.5 * width)
    ax.set_ylim(bottom, bottom - width * CAR[1] / CAR[0])
    legend(ax, loc="upper right", ncols=len(vehicle.bodies), borderaxespad=0.2)
    rolled = f", track rolled {signed(float(np.degrees(tilt)))}°" if tilt != 0.0 else ""
    label(ax, "to the right, m", "down, m", f"The car (sketch){rolled}")
