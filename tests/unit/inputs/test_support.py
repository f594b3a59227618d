"""Supports: the pier, and the prescribed motion of a track."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.inputs.identity import fingerprint
from railquake.inputs.support import AtGrade, Pier, PrescribedTrack, read_track_motion


def periods(pier: Pier) -> np.ndarray:
    """Periods [s] with the hinge elastic and the base rotation condensed, from the column's
    stiffness in u, theta_1 (above the hinge), theta_2 (top): rigid rotation is u = -L theta."""
    length, bending = pier.length, pier.youngs_modulus * pier.second_moment_of_area
    column = (
        bending
        / length**3
        * np.array(
            [
                [12.0, 6.0 * length, 6.0 * length],
                [6.0 * length, 4.0 * length**2, 2.0 * length**2],
                [6.0 * length, 2.0 * length**2, 4.0 * length**2],
            ]
        )
    )
    column[1, 1] += pier.bouc_wen.k0
    keep = [0, 2]
    condensed = (
        column[np.ix_(keep, keep)] - np.outer(column[keep, 1], column[1, keep]) / column[1, 1]
    )
    mass = np.array([pier.mass, pier.rotational_inertia])
    eigenvalues = np.linalg.eigvalsh(condensed / np.sqrt(np.outer(mass, mass)))
    return 2.0 * np.pi / np.sqrt(eigenvalues)


def test_bart_berkeley_periods():
    np.testing.assert_allclose(
        periods(Pier.from_preset("bart-berkeley")), [0.411, 0.106], atol=6e-4
    )


def test_bart_berkeley_defaults():
    pier = Pier.from_preset("bart-berkeley")
    assert (pier.kind, pier.hinge, pier.coupled, pier.p_delta) == ("pier", "bouc-wen", True, False)
    assert (pier.damping_ratio, pier.track_offset, pier.track_height) == (0.02, 2.3, 1.8)
    assert pier.base_rotational_inertia == 1.0


def test_bart_berkeley_2023_runs_differs_in_damping_only():
    pier = Pier.from_preset("bart-berkeley")
    runs = Pier.from_preset("bart-berkeley-2023-runs")
    differing = {key for key in Pier.model_fields if getattr(pier, key) != getattr(runs, key)}
    assert differing == {"name", "summary", "source", "note", "damping_ratio"}
    assert runs.damping_ratio == 0.01


def test_damping_is_of_the_column_unless_said_and_of_the_initial_stiffness_in_the_papers_study():
    assert Pier.model_fields["damping_of"].default == "column"
    for name in ("bart-berkeley", "bart-berkeley-2023-runs"):
        assert Pier.from_preset(name).damping_of == "initial"


def test_piers_damped_as_all_were_before_there_was_a_choice_keep_their_hash():
    """Rows of older studies stay theirs; with another damping it is another pier."""
    pier = Pier.from_preset("bart-berkeley")
    column, tangent = (pier.model_copy(update={"damping_of": of}) for of in ("column", "tangent"))
    assert "damping_of" not in fingerprint(pier)
    assert len({fingerprint(one) for one in (pier, column, tangent)}) == 3


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"damping_of": "colum"}, ["damping_of", "column", "initial", "tangent"]),
        ({"length": "7 s"}, ["length", "(a time)", "6.0 m"]),
        ({"length": 0}, ["length", "positive"]),
        ({"lenght": 7}, ["lenght", 'did you mean "length"']),
        ({"damping_ratio": 1.0}, ["damping_ratio", "below 1"]),
        ({"damping_ratio": -0.01}, ["damping_ratio", "zero or positive"]),
        ({"hinge": "plastic"}, ["hinge", '"bouc-wen" or "elastic"']),
        ({"coupled": 1}, ["coupled", "true or false"]),
        ({"bouc_wen": {"n": 0.5}}, ["bouc_wen.n", "at least 1"]),
        ({"bouc_wen": 3}, ["bouc_wen", "must be a table"]),
    ],
)
def test_piers_that_make_no_sense(overrides, words):
    with pytest.raises(InputError) as caught:
        Pier.from_preset("bart-berkeley", overrides)
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_one_value_of_the_hinge_may_be_overridden():
    pier = Pier.from_preset("bart-berkeley", {"bouc_wen": {"m": 1.0}, "length": "7 m"})
    assert (pier.bouc_wen.m, pier.bouc_wen.n, pier.length) == (1.0, 1.28, 7.0)


def test_at_grade_takes_nothing():
    assert AtGrade().kind == "at-grade"
    with pytest.raises(InputError, match="unknown key"):
        AtGrade(length=3)


def test_track_motion_is_read(tmp_path):
    path = tmp_path / "track.csv"
    path.write_text("t_s, y_m, roll_rad\n0,0,0\n0.01,1e-3,2e-4\n\n0.02,2e-3,4e-4\n")
    motion = PrescribedTrack(file=str(path)).track_motion()
    assert motion.dt == pytest.approx(0.01)
    assert motion.y.tolist() == [0.0, 1e-3, 2e-3]
    assert motion.roll.tolist() == [0.0, 2e-4, 4e-4]
    assert motion.z.tolist() == [0.0, 0.0, 0.0]
    assert not any(values.flags.writeable for values in (motion.y, motion.z, motion.roll))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1: the first line must name"),
        ("0,1\n1,2\n", "line 1: the first line must name"),
        ("t_s,y_m,x_m\n0,0,0\n1,1,1\n", "line 1: the first line must name"),
        ("t_s,y_m\n0,0\n", "1 time steps"),
        ("t_s,y_m\n0,0\n1,1,1\n", "line 3: 3 values for 2 columns"),
        ("t_s,y_m\n0,0\n1,nan\n", "line 3: holds a value that is not finite"),
        ("t_s,y_m\n0,0\n1,x\n", "line 3: holds something that is no number"),
        ("t_s,y_m\n0,0\n1,1\n3,1\n", "line 3: the time step is 1 s"),
        ("t_s,y_m\n5,0\n6,1\n", "must begin at 0"),
        ("t_s,y_m\n0,0\n0,1\n", "must begin at 0 and grow"),
        ("t_s,y_m\n0,0\n-1,1\n", "must begin at 0 and grow"),
    ],
)
def test_bad_track_motions(tmp_path, text, words):
    path = tmp_path / "track.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words) as caught:
        read_track_motion(path)
    assert str(caught.value).startswith(str(path))


def test_a_missing_track_motion(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_track_motion(tmp_path / "none.csv")


@given(
    st.one_of(
        st.binary(max_size=200), st.from_regex(rb"t_s,y_m\n([0-9.,\n-]{0,40})", fullmatch=True)
    )
)
def test_any_bytes_give_a_motion_or_one_clear_line(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("track") / "track.csv"
    path.write_bytes(content)
    try:
        motion = read_track_motion(path)
    except InputError as error:
        message = str(error)
    else:
        message = ""
        assert motion.dt > 0.0
        assert np.isfinite(motion.y).all()
    assert "\n" not in message
