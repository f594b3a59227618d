"""Fragility: known curves are found again, intervals cover, nothing is infinite."""

import csv
import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtr

import railquake as rq
from railquake.fragility import OUTCOMES, Fragility, compare_measures, outcome, write_csv
from railquake.fragility.fits import Fits, quantile

TRIALS = 500
COVERAGE = (0.92, 0.98)  # 95 +- 3 %


def simulated(rng, shape, theta, beta, median=0.7, spread=0.7):
    """Measures and outcomes of a known curve."""
    x = median * np.exp(spread * rng.standard_normal(shape))
    return x, rng.random(shape) < ndtr(np.log(x / theta) / beta)


def covered(x, y, truth, quantile, labels=None):
    """Share of the sets of data whose intervals hold the true theta and beta.

    All sets at once, by what `Fragility.fit` calls for one.
    """
    fits = Fits.of(x, y, np.ones(x.shape)).penalised()
    low, high, _ = fits.intervals(quantile, labels)
    assert np.isfinite(low).all() and np.isfinite(high).all()
    return ((low <= truth) & (truth <= high)).mean(axis=0)


@pytest.mark.parametrize(
    ("runs", "theta", "beta"),
    [(160, 0.8, 0.25), (200, 1.5, 0.45), (240, 1.5, 0.25)],
)
def test_intervals_of_95_percent_cover_known_parameters_in_95_percent_of_500_trials(
    runs, theta, beta
):
    rng = np.random.default_rng([runs, round(100 * theta), round(100 * beta)])
    x, y = simulated(rng, (TRIALS, runs), theta, beta)
    share = covered(x, y, np.array([theta, beta]), quantile(0.95, 0))
    assert np.all(share >= COVERAGE[0]) and np.all(share <= COVERAGE[1]), share


def test_intervals_cover_where_runs_of_a_record_depend_on_each_other():
    # each record shifts the median by its own normal deviate, of standard deviation 0.2: over all
    # records the curve is lognormal with beta = sqrt(0.35^2 + 0.2^2)
    records, runs, beta, shift = 20, 12, 0.35, 0.2
    rng = np.random.default_rng(20)
    own = shift * rng.standard_normal((TRIALS, records, 1))
    x = 0.7 * np.exp(
        0.6 * rng.standard_normal((TRIALS, records, 1))
        + 0.5 * rng.standard_normal((TRIALS, records, runs))
    )
    y = rng.random(x.shape) < ndtr((np.log(x) - own) / beta)
    x, y = x.reshape(TRIALS, -1), y.reshape(TRIALS, -1)
    labels = np.repeat(np.arange(records), runs)
    truth = np.array([1.0, math.hypot(beta, shift)])
    share = covered(x, y, truth, quantile(0.95, records), labels)
    assert np.all(share >= COVERAGE[0]) and np.all(share <= COVERAGE[1]), share
    # while intervals for independent runs would not
    assert covered(x, y, truth, quantile(0.95, 0))[0] < 0.90


def test_one_fit_gives_the_interval_of_the_trials():
    x, y = simulated(np.random.default_rng(4), 200, 1.0, 0.4)
    fits = Fits.of(x, y, np.ones((1, 200))).penalised()
    low, high, _ = fits.intervals(quantile(0.95, 0))
    found = Fragility.fit(x, y, replicates=0)
    assert found.theta_interval == pytest.approx((low[0, 0], high[0, 0]))
    assert found.beta_interval == pytest.approx((low[0, 1], high[0, 1]))
    assert found.flags == ()


def test_fit_is_the_maximum_of_the_likelihood():
    from scipy.optimize import minimize

    x, y = simulated(np.random.default_rng(5), 240, 1.2, 0.5)

    def minus(at):
        p = ndtr((np.log(x) - at[0]) / at[1])
        return -np.log(np.where(y, p, 1.0 - p)).sum()

    found = Fragility.fit(x, y, replicates=0)
    best = minimize(
        minus, [0.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12}
    )
    assert math.log(found.theta) == pytest.approx(best.x[0], abs=1e-6)
    assert found.beta == pytest.approx(best.x[1], rel=1e-6)
    assert found.log_likelihood == pytest.approx(-best.fun, rel=1e-10)
    assert found.aic == pytest.approx(4.0 + 2.0 * best.fun)


def test_interval_ends_where_the_profile_has_fallen_by_half_a_squared_quantile():
    from scipy.optimize import minimize_scalar

    x, y = simulated(np.random.default_rng(6), 160, 1.0, 0.4)
    fits = Fits.of(x, y, np.ones((1, 160))).penalised()
    z, scale, centre = fits.z[0], fits.scale[0], fits.centre[0]

    def penalised(a, b):
        eta = a + b * z
        p, density = ndtr(eta), np.exp(-0.5 * eta**2) / math.sqrt(2.0 * math.pi)
        w = density**2 / (p * (1.0 - p))
        design = np.column_stack([np.ones_like(z), z])
        _, determinant = np.linalg.slogdet(design.T @ (w[:, None] * design))
        return np.log(np.where(y, p, 1.0 - p)).sum() + 0.5 * determinant

    best, slope = penalised(*fits.point[0]), fits.point[0, 1]
    for ln_theta in np.log(Fragility.fit(x, y, replicates=0).theta_interval):
        place = (ln_theta - centre) / scale
        profile = minimize_scalar(
            lambda b, at=place: -penalised(-b * at, b), bounds=(0.5 * slope, 2.0 * slope),
            method="bounded", options={"xatol": 1e-10},
        )  # fmt: skip
        assert 2.0 * (best + profile.fun) == pytest.approx(1.959964**2, rel=1e-3)


def test_another_unit_only_moves_theta():
    x, y = simulated(np.random.default_rng(7), 200, 1.0, 0.4)
    one, other = (Fragility.fit(x * f, y, replicates=50) for f in (1.0, 1000.0))
    assert other.theta == pytest.approx(1000.0 * one.theta)
    assert other.beta == pytest.approx(one.beta)
    assert other.beta_interval == pytest.approx(one.beta_interval)
    assert other.theta_interval == pytest.approx([1000.0 * v for v in one.theta_interval])
    assert other.band(800.0) == pytest.approx(one.band(0.8))


@pytest.mark.parametrize(
    ("reached", "flag"),
    [
        (lambda x: x < 0.0, "no events"),
        (lambda x: x > 0.0, "all events"),
        (lambda x: x > 1.0, "separated"),
        (lambda x: x >= x.max(), "separated"),
        (lambda x: x < 0.8, "no rise"),
    ],
)
def test_degenerate_outcomes_give_a_finite_flagged_curve(reached, flag):
    x = np.exp(0.6 * np.random.default_rng(8).standard_normal(200))
    found = Fragility.fit(x, reached(x), np.repeat(np.arange(20), 10), replicates=100)
    assert flag in found.flags
    for value in (found.theta, found.beta, *found.theta_interval, *found.beta_interval, found.aic):
        assert math.isfinite(value)
    assert found.theta > 0.0 and found.beta > 0.0
    assert found.theta_interval[0] <= found.theta <= found.theta_interval[1]
    curve = found.probability(np.linspace(0.0, 5.0, 50))
    assert np.isfinite(curve).all() and np.all(np.diff(curve) >= 0.0)
    assert np.isfinite(found.band(np.linspace(0.1, 5.0, 9))).all()


def test_separated_data_place_theta_in_the_gap():
    x = np.array([0.2, 0.4, 0.5, 0.9, 1.5, 2.0, 2.5, 3.0])
    found = Fragility.fit(x, x > 1.0, replicates=0)
    assert found.flags[0] == "separated"
    assert 0.9 < found.theta < 1.5


@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(1e-6, 1e6), st.booleans(), st.integers(0, 4)), min_size=2, max_size=40
    )
)
def test_whatever_the_runs_the_curve_is_finite(runs):
    x, y, records = (np.array(column) for column in zip(*runs, strict=True))
    if np.unique(x).size < 2:
        with pytest.raises(rq.InputError, match="two different"):
            Fragility.fit(x, y, records)
        return
    found = Fragility.fit(x, y, records, replicates=5)
    numbers = [found.beta, *found.beta_interval, found.log_likelihood, *found.replicates.ravel()]
    assert np.isfinite(numbers).all()
    assert 0.0 < found.theta_interval[0] <= found.theta_interval[1] < math.inf


def test_band_surrounds_the_curve_and_is_wider_where_runs_are_few():
    x, y = simulated(np.random.default_rng(9), 200, 1.0, 0.4)
    found = Fragility.fit(x, y)
    at = np.array([0.7, 1.0, 1.4])
    low, high = found.band(at)
    assert np.all(low < found.probability(at)) and np.all(found.probability(at) < high)
    few = Fragility.fit(x[:50], y[:50])
    narrow, wide = (np.diff(f.band(1.0))[0] for f in (found, few))
    assert wide > 1.4 * narrow


def test_bootstrap_draws_records_and_repeats_itself():
    rng = np.random.default_rng(10)
    x, y = simulated(rng, 80, 1.0, 0.4)
    # five equal runs of each record hold no more than one
    five = [np.repeat(column, 5) for column in (x, y, np.arange(x.size))]
    wide = Fragility.fit(*five).band(1.0)
    assert np.ptp(wide) == pytest.approx(np.ptp(Fragility.fit(x, y).band(1.0)), rel=0.05)
    assert np.ptp(wide) > 1.5 * np.ptp(Fragility.fit(*five[:2]).band(1.0))
    assert wide == Fragility.fit(*five).band(1.0)


def table():
    """Twenty records at four levels; onset and derailment grow with PBV, PGA is noise."""
    rng = np.random.default_rng(11)
    records, levels = 20, np.array([0.3, 0.7, 1.0, 1.4])
    pbv = (np.exp(0.3 * rng.standard_normal((records, 1))) * levels).ravel()
    noise = np.exp(0.5 * rng.standard_normal(pbv.size))
    roll = pbv * np.exp(0.2 * rng.standard_normal(pbv.size))
    status = np.select([roll > 1.4, roll > 0.9], ["derailed", "onset"], "safe")
    return pd.DataFrame(
        {
            "record": np.repeat([f"R{k}" for k in range(records)], 4),
            "status": status,
            "onset_first_s": np.where(roll > 0.9, 3.0, np.nan),
            "pbv_m_s": pbv,
            "pga_m_s2": noise,
            "pbd_m": 0.0,
        }
    )


def test_onset_counts_every_run_that_reached_it_and_derailed_those_that_left():
    runs = pd.DataFrame(
        {
            "status": ["safe", "onset", "derailed", "safe", "diverged"],
            "onset_first_s": [None, 1.0, None, 2.0, None],
        }
    )
    assert outcome(runs, "onset").tolist() == [False, True, True, True, False]
    assert outcome(runs, "derailed").tolist() == [False, False, True, False, False]
    with pytest.raises(rq.InputError, match="onset or derailed"):
        outcome(runs, "overturned")


def test_curve_of_a_study_leaves_failed_runs_aside_and_counts_runs_without_measure():
    runs = table()
    runs.loc[0, "status"] = "failed"
    runs.loc[1, "pbv_m_s"] = 0.0
    found = Fragility.from_table(runs, "onset", "pbv", replicates=10)
    assert (found.runs, found.left_out, found.records) == (78, 1, 20)
    assert found.measure == "pbv" and found == Fragility.from_table(
        runs, "onset", "pbv_m_s", replicates=10
    )


def test_aic_prefers_the_measure_that_the_outcome_depends_on():
    found = compare_measures(table(), "onset", replicates=0)
    assert [curve.measure for curve in found] == ["pbv", "pga"]  # PBD is zero throughout
    assert found[1].aic - found[0].aic > 10.0
    assert found[0].runs == found[1].runs == 80


def test_probability_is_asked_for_by_the_measure_s_name():
    found = Fragility.from_table(table(), "derailed", "pbv", replicates=0)
    assert found.probability(pbv=1.2) == found.probability(1.2) == found.probability(pbv_m_s=1.2)
    assert found.probability(pbv=found.theta) == pytest.approx(0.5)
    assert found.probability(pbv=0.0) == 0.0
    assert found.probability(pbv=[0.5, 1.0]).shape == (2,)
    for wrong in ({"pga": 1.0}, {}, {"pbv": -1.0}, {"pbv": 1.0, "pga": 2.0}):
        with pytest.raises(rq.InputError):
            found.probability(**wrong)
    with pytest.raises(rq.InputError, match="without a bootstrap"):
        found.band(pbv=1.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"values": [1.0, 1.0]}, "two different"),
        ({"reached": [True]}, "as many"),
        ({"records": ["a"]}, "as many"),
        ({"confidence": 1.0}, "confidence"),
    ],
)
def test_input_that_cannot_be_fitted_is_refused_in_one_line(change, message):
    given = {"values": [1.0, 2.0], "reached": [False, True]} | change
    with pytest.raises(rq.InputError, match=message) as raised:
        Fragility.fit(**given)
    assert "\n" not in str(raised.value)


def test_unknown_measure_is_refused():
    with pytest.raises(rq.InputError, match="known are pbv, pbd, pga"):
        Fragility.from_table(table(), "onset", "sa")


def test_csv_has_the_layout_of_pelicun_s_damage_parameters(tmp_path):
    curves = [Fragility.from_table(table(), e, "pbv", replicates=0) for e in OUTCOMES]
    write_csv(tmp_path / "two.csv", {"train-elastic": curves})
    with open(tmp_path / "two.csv", newline="") as file:
        (row,) = csv.DictReader(file)
    # columns of pelicun 3.10, tried with its Assessment.damage.load_model_parameters
    assert list(row) == [
        "ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional",
        "LS1-Family", "LS1-Theta_0", "LS1-Theta_1", "LS1-DamageStateWeights",
        "LS2-Family", "LS2-Theta_0", "LS2-Theta_1", "LS2-DamageStateWeights",
    ]  # fmt: skip
    assert (row["ID"], row["Demand-Type"], row["Demand-Unit"]) == (
        "train.elastic", "Peak Floor Velocity", "mps"
    )  # fmt: skip
    assert (row["Incomplete"], row["LS2-Family"]) == ("0", "lognormal")
    assert float(row["LS1-Theta_0"]) == pytest.approx(curves[0].theta, rel=1e-5)
    assert float(row["LS2-Theta_1"]) == pytest.approx(curves[1].beta, rel=1e-5)
    curves[0].to_csv(tmp_path / "one.csv")
    assert (tmp_path / "one.csv").read_text().splitlines()[1].startswith("railquake.onset.pbv,0,")


def test_csv_names_the_period_of_a_spectral_acceleration(tmp_path):
    runs = table().rename(columns={"pga_m_s2": "sa_t1_m_s2"})
    curve = Fragility.from_table(runs, "onset", "sa_t1", replicates=0)
    with pytest.raises(rq.InputError, match="period"):
        curve.to_csv(tmp_path / "sa.csv")
    write_csv(tmp_path / "sa.csv", {"train": [curve]}, first_period_s=0.411)
    assert "Peak Spectral Acceleration|0.411,mps2" in (tmp_path / "sa.csv").read_text()


def test_csv_refuses_what_pelicun_cannot_name_and_a_folder_that_is_not_there(tmp_path):
    x, y = simulated(np.random.default_rng(12), 50, 1.0, 0.4)
    other = Fragility.fit(x, y, measure="snow", replicates=0)
    with pytest.raises(rq.InputError, match="snow"):
        other.to_csv(tmp_path / "x.csv")
    good = Fragility.fit(x, y, measure="pga", replicates=0)
    with pytest.raises(rq.InputError, match="cannot be written"):
        good.to_csv(tmp_path / "nowhere" / "x.csv")


# --- what counts as an outcome -------------------------------------------------------------

MEASURED = np.linspace(0.1, 2.0, 40)
REACHED = MEASURED + 0.3 * np.sin(40.0 * MEASURED) > 1.0


def fitted(reached, values=MEASURED, **options):
    return Fragility.fit(values, reached, replicates=0, **options)


@pytest.mark.parametrize(
    "written",
    [
        list(REACHED), REACHED.astype(int), REACHED.astype(float), REACHED.astype(object),
        pd.Series(REACHED, dtype="boolean"), pd.Series(REACHED.astype(int), dtype="Int64"),
    ],
)  # fmt: skip
def test_booleans_and_zeros_and_ones_are_the_same_outcomes(written):
    assert fitted(written) == fitted(REACHED)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (["safe", "derailed"] * 20, 'found "safe"'),
        (["False", "True"] * 20, 'found "False"'),
        (REACHED.astype("U5"), 'found "False"'),
        (np.where(REACHED, 2, 0), "found 2"),
        (np.where(REACHED, 0.7, 0.0), "found 0.7"),
        (np.where(REACHED, np.inf, 0.0), "found inf"),
        (REACHED * np.timedelta64(1, "s"), "must be true or false"),
        ([[True], [True, False]], "no plain list"),
    ],
)
def test_anything_else_is_no_outcome(wrong, said):
    with pytest.raises(rq.InputError, match=said) as error:
        fitted(wrong)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("missing", [None, math.nan, pd.NA])
def test_missing_outcomes_are_left_out_and_counted(missing):
    reached = list(REACHED)
    reached[3] = reached[30] = missing
    there = [k for k in range(40) if k not in (3, 30)]
    without = fitted(REACHED[there], MEASURED[there])
    found = fitted(reached)
    assert (found.left_out, found.runs) == (2, 38)
    assert (found.theta, found.beta) == (without.theta, without.beta)


def test_missing_measures_are_left_out_and_texts_refused():
    values = pd.Series(MEASURED, dtype="Float64")
    values[5] = pd.NA
    assert fitted(REACHED, values).left_out == 1
    with pytest.raises(rq.InputError, match='measure must be a number, found "0.1"'):
        fitted(REACHED, [str(value) for value in MEASURED.round(2)])


def test_runs_without_a_record_are_not_guessed():
    with pytest.raises(rq.InputError, match="some runs have no record"):
        fitted(REACHED, records=[None, *"abc" * 13])
