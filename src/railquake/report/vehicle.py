"""Table 1: the vehicle's modes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from railquake.report.context import ReportSection, Table, Text

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

# Gomez & DeJong (2023), Table 1, Hz: this study, BART's reference, FEM model
PAPER = {
    "Carbody lower sway": ("0.29", "0.31", "0.33"),
    "Carbody upper sway": ("1.01", "0.96", "0.59"),
    "Carbody bounce": ("1.03", "1.28", "1.07"),
}


def section(context: Context) -> ReportSection:
    """Natural frequencies with the wheelset held, beside the paper's."""
    from railquake.assembly import vehicle_matrices
    from railquake.physics.vehicle import fixed_wheelset_modes
    from railquake.probe import mode_labels

    vehicle = context.first_vehicle
    if vehicle is None:
        return ReportSection("vehicle", "The vehicle (Table 1)", (_gone,))
    matrices = vehicle_matrices(vehicle)
    frequencies, _ = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    labels = mode_labels(vehicle, matrices)
    name = str(vehicle.name)
    ours = name.startswith("bart")
    rows = []
    for k, (label, frequency) in enumerate(zip(labels, frequencies, strict=True), 1):
        beside = PAPER.get(label, ("–", "–", "–")) if ours else ()
        rows.append((str(k), label, f"{frequency:.3f}", *beside))
    head: tuple[str, ...] = ("mode", "shape", "railquake, Hz")
    if ours:
        head = (*head, "paper, Hz", "BART reference, Hz", "FEM, Hz")
    varied = [a.column for a in context.results.study.axes if a.column.startswith("vehicle.")
              and a.column != "vehicle.speed"]  # fmt: skip
    remark = f" The study varies {', '.join(varied)}; this is its first run’s." if varied else ""
    caption = (
        f"Modes of the vehicle “{name}” with its wheelset held fixed"
        + (", beside Table 1 of the paper" if ours else "")
        + f".{remark}"
    )
    return ReportSection("vehicle", "The vehicle (Table 1)", (Table(head, tuple(rows), caption),))


_gone = Text("The vehicle cannot be made any more: a file that it names is missing.", "note")
