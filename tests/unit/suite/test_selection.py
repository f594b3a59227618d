"""Selection of records: scale factors in closed form, a local optimum, the folder's files."""

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.suite import load_hazard, load_suite, manifest_text, select_records, suite_spectra
from railquake.suite.selection import choose, scale_factors
from record_folders import write_records

TARGET = load_hazard("berkeley", 0.05)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_records(tmp_path_factory.mktemp("records"), 14)


def objective(residuals: np.ndarray, chosen: tuple[int, ...], scatter: float | None) -> float:
    """The objective as the documentation states it, without running sums."""
    rows = residuals[list(chosen)]
    value = float(np.mean(rows.mean(axis=0) ** 2))
    if scatter is not None and len(rows) > 1:
        value += float(np.mean((rows.std(axis=0, ddof=1) - scatter) ** 2))
    return value


@settings(max_examples=60, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.integers(2, 9), st.integers(1, 6), st.sampled_from([None, 0.4])
)
def test_no_single_exchange_improves_the_choice(
    seed: int, size: int, points: int, scatter: float | None
) -> None:
    residuals = np.random.default_rng(seed).normal(0.1, 0.5, (size, points))
    count = 1 + seed % size
    choice = choose(residuals, count, scatter)
    assert len(set(choice.chosen)) == count
    assert choice.final == pytest.approx(objective(residuals, choice.chosen, scatter), abs=1e-12)
    assert choice.final <= choice.greedy
    for out in choice.chosen:
        for new in set(range(size)) - set(choice.chosen):
            other = tuple(new if row == out else row for row in choice.chosen)
            assert objective(residuals, other, scatter) >= choice.final * (1.0 - 1e-9) - 1e-12


def test_exchanges_find_the_best_of_all_choices_where_greedy_does_not() -> None:
    """Greedy takes the 0 first and can then only err by 1/2; the pair +1, -1 is exact."""
    residuals = np.array([[0.0], [1.0], [-1.0]])
    assert choose(residuals, 2, exchange=False).final > 0.0
    choice = choose(residuals, 2)
    assert choice.chosen == (1, 2) and choice.final == 0.0 and choice.exchanges == 1
    best = min(objective(residuals, pair, None) for pair in itertools.combinations(range(3), 2))
    assert choice.final == best


def test_scale_factors_minimise_each_records_own_misfit_within_their_bounds() -> None:
    wanted = np.array([0.0, 0.2, -0.1])
    logs = wanted - np.log([[2.0], [20.0], [0.01]]) + np.array([-0.1, 0.0, 0.1])
    np.testing.assert_allclose(scale_factors(logs, wanted, 5.0), [2.0, 5.0, 0.2], rtol=1e-12)


def test_a_folder_gives_a_suite_near_the_target(folder: Path) -> None:
    made = select_records(folder, TARGET, 6, period_range=(0.1, 1.5), largest_scale=8.0)
    assert made.considered == 14 and len(made.suite.members) == 6
    assert made.misfit <= made.misfit_greedy < made.misfit_before
    # Against the suite's spectra computed anew, by the documented formula.
    anew = suite_spectra(made.suite, made.periods)
    ratio = np.log(anew["mean"] / TARGET.at(made.periods))
    assert made.misfit == pytest.approx(np.sqrt(np.mean(ratio**2)), rel=1e-9)
    np.testing.assert_allclose(made.deviation, np.exp(ratio) - 1.0, atol=1e-9)
    np.testing.assert_allclose(made.spectra, anew["spectra"], rtol=1e-9)


def test_a_scatter_can_be_aimed_at(folder: Path) -> None:
    def scatter(wanted: float | None) -> float:
        made = select_records(folder, TARGET, 6, period_range=(0.1, 1.5), scatter=wanted)
        return float(np.mean(suite_spectra(made.suite, made.periods)["scatter"]))

    assert scatter(0.05) < scatter(0.5)


def test_the_same_folder_gives_the_same_suite(folder: Path) -> None:
    first, second = (select_records(folder, TARGET, 5) for _ in range(2))
    assert first.suite == second.suite
    assert manifest_text(first) == manifest_text(second)


def test_the_largest_scale_factor_is_kept(folder: Path) -> None:
    made = select_records(folder, TARGET, 5, largest_scale=1.25)
    factors = [member.scale_factor for member in made.suite.members]
    assert max(factors) <= 1.25 and min(factors) >= 1.0 / 1.25


def test_the_manifest_gives_the_suite_again(folder: Path, tmp_path: Path) -> None:
    made = select_records(folder, TARGET, 5)
    path = tmp_path / "suite.csv"
    path.write_text(manifest_text(made))
    assert load_suite(path, folder).members == made.suite.members


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"count": 15}, "holds 14 usable components, 15 are wanted"),
        ({"count": 0}, "count: must be 1 or more"),
        ({"period_range": (2.0, 0.1)}, "period range: two increasing periods"),
        ({"period_range": (0.0, 1.0)}, "period range: two increasing periods"),
        ({"period_range": (0.1, float("nan"))}, "period range: two increasing periods"),
        ({"period_range": (0.1, 20.0)}, "20 s is outside"),
        ({"largest_scale": 0.5}, "largest scale: must be finite and 1 or more"),
        ({"largest_scale": float("inf")}, "largest scale: must be finite and 1 or more"),
        ({"scatter": -0.1}, "scatter: a standard deviation"),
    ],
)
def test_wrong_arguments_are_refused_in_one_line(
    folder: Path, options: dict[str, object], told: str
) -> None:
    with pytest.raises(InputError) as caught:
        select_records(folder, TARGET, **{"count": 3, **options})
    assert told in str(caught.value) and "\n" not in str(caught.value)


def test_real_records_meet_the_target_closely(shared: Path) -> None:
    """Ten of the paper's twenty: within 10 % at every period from 0.05 to 2 s."""
    made = select_records(shared / "records" / "paper_suite", TARGET, 10)
    assert made.misfit < 0.05 < made.misfit_before
    assert np.max(np.abs(made.deviation)) < 0.10
