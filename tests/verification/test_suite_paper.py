"""The paper's suite: 20 records at four hazard levels, elastic and Bouc-Wen, coupled; 160 runs."""

import pytest

import railquake as rq
from suite_files import LEVELS, RECORDS, record_path, scale_factor

# Bars of the energy audit (at dt = 1e-5 s), relative to what is dissipated, and to what impact and
# creep lose; of the contact's residual, negative is a gain.
WHOLE = 1e-3
CONTACT_GAIN = 0.01
CONTACT = 0.03
MOMENTUM = 1e-4  # linear and angular, over the largest impulse


@pytest.mark.parametrize("record", RECORDS)
def test_eight_runs_of_a_record_end_well_balance_and_agree_in_lockstep(shared, record):
    scale = scale_factor(shared, record)
    rows, cases = [], []
    for hinge in ("elastic", "bouc-wen"):
        for level in LEVELS:
            case = rq.scenario(record=record_path(shared, record), scale=level * scale, hinge=hinge)
            row = rq.assess(rq.simulate(case))
            rows.append(row)
            cases.append(case)
            name = f"{record} x {level} {hinge}"
            assert row["status"] in ("safe", "onset", "derailed"), name
            assert abs(row["energy_residual"]) < WHOLE, name
            assert -CONTACT_GAIN < row["contact_energy_residual"] < CONTACT, name
            assert keeps_momentum(row), name
    # the lockstep engine takes shortcuts; at most one of the eight may differ by more than its bar
    together = dict(rq.simulate_many(cases, threads=1))
    assert sum(differs(row, together[k]) for k, row in enumerate(rows)) <= 1
    for row in together.values():
        assert abs(row["energy_residual"]) < WHOLE
        assert -CONTACT_GAIN < row["contact_energy_residual"] < CONTACT
        assert keeps_momentum(row)


def keeps_momentum(row):
    """Whether rails, ground and gravity explain the car's momentum in both directions, and roll."""
    return max(row["linear_momentum_residual"], row["angular_momentum_residual"]) < MOMENTUM


def differs(single, abreast):
    """Whether a row of the lockstep engine differs from the single run by more than its bar."""
    peaks = ("pbd_m", "pbv_m_s", "pba_m_s2", "hinge_rotation_peak_rad")
    worst = max(abs(abreast[key] / single[key] - 1.0) for key in peaks)
    uplift = abs(abreast["uplift_ratio"] / single["uplift_ratio"] - 1.0)
    return worst > 0.003 or uplift > 0.02 or abreast["status"] != single["status"]


# With uplift (an elastic hinge, factors on the record as it is, for RSN006 on the study's scale),
# and without.
UPLIFT = (("RSN182_IMPVALLH2", 2.5), ("RSN171_IMPVALLH1", 4.0), ("RSN006_IMPVALLH2", 2.0 * 3.49))
NO_UPLIFT = (("RSN020_NCALIFH1", 1.0), ("RSN181_IMPVALLH1", 1.0), ("RSN178_IMPVALLH1", 1.0))


@pytest.mark.parametrize(
    ("record", "scale", "lifts"),
    [(*case, True) for case in UPLIFT] + [(*case, False) for case in NO_UPLIFT],
)
def test_contact_neither_makes_nor_loses_energy_unaccounted(shared, record, scale, lifts):
    case = rq.scenario(record=record_path(shared, record), scale=scale, hinge="elastic")
    for row in (rq.assess(rq.simulate(case)), dict(rq.simulate_many([case], threads=1))[0]):
        assert (row["off_rail_time_s"] > 0.0) == lifts
        assert row["contact_energy_residual"] > -CONTACT_GAIN
        assert abs(row["contact_energy_residual"]) < CONTACT
        assert abs(row["energy_residual"]) < WHOLE
