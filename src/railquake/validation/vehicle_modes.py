"""The car's natural modes against the published ones."""

from __future__ import annotations

from pathlib import Path

from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "The car: natural modes"
SOURCE = """Gomez and DeJong (2023), Table 1: frequencies and names of the first three modes of the
BART car, wheelset fixed. The next three, and the six of the set `bart-2023-runs`, come from a trial
implementation of the same masses and springs that shares no code with this one."""
WHAT = "The eigenvalues of the assembled mass and stiffness matrices, wheelset fixed."
WHY = """The references have three decimals: 0.5 mHz is 0.17 % of the lowest. The printed parameters
are rounded too, hence 0.2 % for all."""

TOLERANCE = 2e-3
TABLE_1 = ("Carbody lower sway", "Carbody upper sway", "Carbody bounce")
FREQUENCIES = {  # Hz
    "bart": (0.292, 1.009, 1.034, 2.578, 4.453, 4.791),
    "bart-2023-runs": (0.316, 1.142, 1.252, 2.649, 5.390, 7.356),
}


def compare(data: Path | None) -> Outcome:
    """Compare the frequencies of both sets."""
    from railquake.assembly import vehicle_matrices
    from railquake.inputs.vehicle import Vehicle
    from railquake.physics.vehicle import fixed_wheelset_modes
    from railquake.plots.modes import write_modes_picture
    from railquake.probe import mode_labels

    results = []
    for preset, expected in FREQUENCIES.items():
        car = Vehicle.from_preset(preset)
        matrices = vehicle_matrices(car)
        found, _ = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
        labels = mode_labels(car, matrices)
        if preset == "bart" and tuple(labels[:3]) != TABLE_1:
            raise ValueError(f"modes are called {labels[:3]}, Table 1 has {TABLE_1}")
        results += [
            relative(
                f"{preset}, mode {k}: {label}", "Hz",
                reference=reference, ours=float(ours), tolerance=TOLERANCE,
            )
            for k, (label, reference, ours) in enumerate(
                zip(labels, expected, found, strict=False), 1
            )
        ]  # fmt: skip
    car = Vehicle.from_preset("bart")
    labels = mode_labels(car, vehicle_matrices(car))
    return Outcome(
        tuple(results),
        (
            Picture(
                "modes",
                "The first six modes of `bart`, wheelset fixed.",
                lambda path: write_modes_picture(car, labels, path),
            ),
        ),
    )
