"""What is to be done, in batches whose runs share a kernel and are of similar length."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from railquake.assembly import critical_time_step
from railquake.errors import InputError
from railquake.march.compiler import lockstep_target
from railquake.run.many import failed_row

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.study.design import Design

__all__ = ["Work", "hardest", "kernel_key", "parse_shard", "plan"]

STEPS_A_BATCH = 40e6  # about eight seconds of one processor
LEAST_BATCH, LARGEST_BATCH = 16, 256  # runs; every processor's number of lanes divides them
BLOCK = 32  # assemblies of car, support and track that are worked on at a time
MOST_HARDEST = 12  # runs that choose the time step


def parse_shard(shard: tuple[int, int] | str | None) -> tuple[int, int]:
    """Number of a shard, from 1, and of all shards.

    Parameters
    ----------
    shard : (int, int), str or None
        ``(3, 8)`` or ``"3/8"``; None is the whole.

    Raises
    ------
    InputError
        If it is none.
    """
    if shard is None:
        return 1, 1
    text = shard if isinstance(shard, str) else "/".join(map(str, shard))
    match = re.fullmatch(r"\s*(\d{1,9})\s*/\s*(\d{1,9})\s*", text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise InputError(f'--shard: must be I/N with I from 1 to N, such as 3/8, found "{text}"')
    return int(match[1]), int(match[2])


@dataclass
class Work:
    """Rows that are to be run, and how they go together."""

    hashes: list[str | None]  # of the shard's rows
    rows: range  # of the shard
    twins: dict[int, list[int]]  # rows with the scenario of another
    batches: list[tuple[int, ...]]
    steps: dict[int, float]  # of each row that is run
    failed: dict[int, str]  # rows of which no scenario can be made, and why


def plan(design: Design, rows: range, done: set[tuple[int, str | None]], workers: int) -> Work:
    """Group what is left into batches whose runs share a kernel and are of similar length."""
    hashes: list[str | None] = []
    first: dict[str, int] = {}
    twins: dict[int, list[int]] = {}
    steps: dict[int, float] = {}
    failed: dict[int, str] = {}
    kernels: dict[Any, int] = {}
    assemblies: dict[tuple[str, ...], tuple[int, int]] = {}  # kernel, number
    found: list[tuple[int, int, int]] = []  # kernel, assembly, row
    for row in rows:
        try:
            scenario, key, parts = design.identified(design.point(row))
            length = _steps(scenario)
        except Exception as error:  # whatever it is, the other rows shall not suffer
            hashes.append(None)
            failed[row] = str(failed_row(error)["error"])
            continue
        hashes.append(key)
        if (row, key) in done:
            continue
        if key in first:
            twins.setdefault(first[key], []).append(row)
            continue
        first[key] = row
        steps[row] = length
        if parts not in assemblies:
            kernel = kernels.setdefault(kernel_key(scenario), len(kernels))
            assemblies[parts] = kernel, len(assemblies)
        found.append((*assemblies[parts], row))
    # similar assemblies are worked on together, so that each is made once
    place = {number: at for at, (_, number) in enumerate(sorted(assemblies.values()))}
    block = {row: place[number] // BLOCK for _, number, row in found}
    found.sort(key=lambda f: (f[0], block[f[2]], -steps[f[2]], f[1], f[2]))
    batches: list[tuple[int, ...]] = []
    lanes = lockstep_target().lanes
    share = lanes * math.ceil(len(found) / max(4 * workers, 1) / lanes)
    here: list[int] = []
    former: tuple[int, int] | None = None
    for kernel, _, row in found:
        size = int(min(max(STEPS_A_BATCH / steps[row], LEAST_BATCH), LARGEST_BATCH, share))
        group = (kernel, block[row])
        if here and (group != former or len(here) >= size // lanes * lanes):
            batches.append(tuple(here))
            here = []
        here.append(row)
        former = group
    if here:
        batches.append(tuple(here))
    # the longest first, so that all processors end together
    batches.sort(key=lambda batch: (block[batch[0]], -sum(steps[row] for row in batch)))
    return Work(hashes, rows, twins, batches, steps, failed)


def _steps(scenario: Scenario) -> float:
    """Time steps of a run, about."""
    motion = scenario.motion
    if motion is not None and motion.synthetic is not None:
        duration = float(motion.synthetic["duration"])
    else:
        duration = scenario.ground_motion().duration
    return max(1.0, duration / scenario.solver.step)


def kernel_key(scenario: Scenario) -> tuple[Any, ...]:
    """What scenarios must share to go abreast, as far as inputs tell; see `lockstep`."""
    support, track, solver = scenario.support, scenario.wheelrail, scenario.solver
    return (
        support.needs_motion,
        getattr(support, "hinge", "elastic"),
        len(scenario.vehicle.bodies),
        track.wheel, track.rail, track.running_circle, track.rail_centre, track.gauge,
        track.rolling_radius, track.youngs_modulus, track.poisson_ratio, track.creep_law,
        track.flange_creep_law,
        solver.dt, solver.history_step, solver.contact, solver.hinge_solve,
    )  # fmt: skip


def hardest(design: Design) -> list[Scenario]:
    """Some runs that ask most of the time step.

    Of every kind of support, hinge and speed the one with the largest ground velocity; those with
    the largest of these.
    """
    worst: dict[Any, tuple[float, int]] = {}
    velocities: dict[Any, float] = {}
    for row in range(design.size):
        point = design.point(row)
        motion = (point.member, point.motion_key)
        try:
            scenario = design.scenario(point)
            if motion not in velocities:
                unit = scenario.ground_motion()
                velocities[motion] = unit.pgv / abs(point.scale) if point.scale else 0.0
            critical_time_step(scenario)
        except Exception:  # such a row fails later, and says why
            continue
        support = scenario.support
        key = (
            support.kind,
            getattr(support, "hinge", None),
            getattr(support, "coupled", None),
            scenario.vehicle.name,
            scenario.vehicle.speed,
        )
        size = velocities[motion] * abs(point.scale)
        if key not in worst or size > worst[key][0]:
            worst[key] = (size, row)
    order = sorted(worst.values(), key=lambda item: (-item[0], item[1]))
    return [design.scenario(design.point(row)) for _, row in order[:MOST_HARDEST]]
