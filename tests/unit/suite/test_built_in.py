"""The suites that are built in: the paper's records, and synthetic motions for demonstrations."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import synthetic_motion
from railquake.inputs.scenario import load_scenario, scenario
from railquake.suite import load_hazard, load_suite, suite_spectra
from railquake.suite.built_in import _data
from railquake.suite.synthetic import PERIOD_RANGE, synthetic_table

PERIODS = np.geomspace(*PERIOD_RANGE, 120)
"""Three times as dense as where the synthetic suite was matched."""


def refused(name: str, records: Path | None) -> str:
    with pytest.raises(InputError) as caught:
        load_suite(name, records)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_the_papers_suite_finds_its_records(shared: Path) -> None:
    suite = load_suite("paper-suite", shared / "records" / "paper_suite")
    assert len(suite.members) == 20
    factors = {member.name: member.scale_factor for member in suite.members}
    assert factors["RSN181_IMPVALLH1"] == 1.81 and factors["RSN161_IMPVALLH2"] == 4.25


def test_the_papers_suite_finds_records_under_the_names_peer_gives_them(
    shared: Path, tmp_path: Path
) -> None:
    source = shared / "records" / "paper_suite"
    # The two components of RSN 182 under names that do not tell which is H1.
    for file in source.glob("*.AT2"):
        shutil.copy(file, tmp_path / file.name)
    (tmp_path / "RSN182_IMPVALLH1.AT2").rename(tmp_path / "RSN182_IMPVALL.H_H-E07140.AT2")
    (tmp_path / "RSN182_IMPVALLH2.AT2").rename(tmp_path / "RSN182_IMPVALL.H_H-E07230.AT2")
    members = {m.name: m.motion["record"] for m in load_suite("paper-suite", tmp_path).members}
    assert members["RSN182_IMPVALLH1"].endswith("E07140.AT2")
    assert members["RSN182_IMPVALLH2"].endswith("E07230.AT2")


def test_a_missing_record_of_the_paper_is_named_with_where_to_get_it(tmp_path: Path) -> None:
    told = refused("paper-suite", tmp_path)
    assert "RSN 6, Imperial Valley-02 5/19/1940, El Centro Array #9" in told
    assert "(20 of 20 are missing)" in told and "PEER NGA-West2" in told


def test_the_papers_suite_needs_a_folder() -> None:
    assert "give the folder that holds them with --records" in refused("paper-suite", None)


def test_the_papers_suite_is_nearer_to_the_soil_spectrum_than_to_rock(shared: Path) -> None:
    """Why the synthetic suite is matched to the former."""
    spectra = suite_spectra(load_suite("paper-suite", shared / "records" / "paper_suite"), PERIODS)

    def misfit(hazard: str) -> float:
        return float(
            np.sqrt(np.mean(np.log(spectra["mean"] / load_hazard(hazard, 0.05).at(PERIODS)) ** 2))
        )

    assert misfit("berkeley") < 0.15
    assert misfit("berkeley-rock") > 3.0 * misfit("berkeley")


def test_the_synthetic_suite_meets_its_target_in_the_mean() -> None:
    spectra = suite_spectra(load_suite("synthetic-berkeley"), PERIODS)
    deviation = spectra["mean"] / load_hazard("berkeley", 0.05).at(PERIODS) - 1.0
    assert np.sqrt(np.mean(deviation**2)) < 0.04
    assert np.max(np.abs(deviation)) < 0.11
    assert np.max(np.abs(deviation[PERIODS > 0.08])) < 0.085


def test_the_synthetic_suite_keeps_the_scatter_of_the_papers(shared: Path) -> None:
    synthetic = suite_spectra(load_suite("synthetic-berkeley"), PERIODS)["scatter"]
    recorded = suite_spectra(
        load_suite("paper-suite", shared / "records" / "paper_suite"), PERIODS
    )["scatter"]
    assert np.mean(synthetic) == pytest.approx(np.mean(recorded), abs=0.02)
    assert np.min(synthetic) > 0.25 and np.max(synthetic) < 0.45


def test_the_synthetic_suite_is_as_strong_as_the_papers(shared: Path) -> None:
    """PGA and PGV, geometric means, within 10 %; shorter in strong shaking, by a third."""

    def means(name: str, records: Path | None) -> np.ndarray:
        motions = [member.ground_motion() for member in load_suite(name, records).members]
        return np.exp(
            np.mean(np.log([(m.pga, m.pgv, m.significant_duration()) for m in motions]), axis=0)
        )

    synthetic = means("synthetic-berkeley", None)
    ratio = synthetic / means("paper-suite", shared / "records" / "paper_suite")
    np.testing.assert_allclose(ratio, [0.93, 1.08, 0.64], atol=0.02)


def test_the_synthetic_suite_is_made_anew_the_same() -> None:
    assert synthetic_table() == _data("synthetic_berkeley.csv")


def test_a_case_file_names_a_synthetic_motion_bit_for_bit(tmp_path: Path) -> None:
    member = load_suite("synthetic-berkeley").members[3]
    path = tmp_path / "case.toml"
    path.write_text(scenario(motion=member.motion, scale=member.scale_factor).to_toml())
    np.testing.assert_array_equal(
        load_scenario(path).ground_motion().acceleration, member.ground_motion().acceleration
    )
    np.testing.assert_array_equal(
        synthetic_motion(member.motion["synthetic"]).acceleration,
        member.ground_motion().acceleration,
    )


def test_the_synthetic_suite_has_twenty_motions_quick_to_run() -> None:
    suite = load_suite("synthetic-berkeley")
    assert len({member.name for member in suite.members}) == 20
    assert all(member.scale_factor == 1.0 for member in suite.members)
    for member in suite.members:
        motion = member.ground_motion()
        assert motion.duration == pytest.approx(22.0) and motion.dt == 0.01
        assert motion.baseline_check() == ()
