"""Whatever bytes a file holds, `read_motion` gives a valid motion or one clear line."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.inputs.ground_motion import GroundMotion, read_motion

FILES = runpy.run_path(str(Path(__file__).with_name("motion_files.py")))
TEXTS = (*FILES["SAMPLES"].values(), FILES["csmip"](2), FILES["cosmos"](2), FILES["usc"]())
AGENCIES = runpy.run_path(str(Path(__file__).with_name("agency_files.py")))
COUNTED = [
    *(AGENCIES[name]().encode() for name in ("cosmos", "smc_wide", "dyna", "nsmn", "geonet")),
    AGENCIES["renadic"]().encode(),
    AGENCIES["geonet"](corrected=False).encode(),
    b"a sample\n40 0.01\n" + AGENCIES["fields"](AGENCIES["WAVE"], "{:.6f}", 1).encode(),
]
UNCOUNTED = [AGENCIES["knet_csv"]().encode(), AGENCIES["jma_csv"]()]
VALID = [*(text.encode() for text in TEXTS), *COUNTED]
PIECES = [
    *(b"nan", b"inf", b"-", b".", b"E", b"1e999", b"9" * 50, b"*" * 15, b"\x00", b"\xff", b"\n"),
    *(b"\r", b" ", b",", b";", b"(", b"[", b"NPTS= 999999999, DT= 1e-300\n", b"units of g\n"),
    *(b"/&\n", b"|\n", b"CHAN 1: UP\n", b"0 POINTS OF ACCEL DATA EQUALLY SPACED AT 0 SEC\n"),
]

QUICK = settings(
    max_examples=150,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def check(path: Path, content: bytes, dt: float | None, channel: int | None) -> None:
    path.write_bytes(content)
    try:
        motion = read_motion(path, dt=dt, channel=channel)
    except InputError as error:
        message = str(error)
    else:
        check_motion(motion)
        return
    assert message.startswith(str(path))
    assert message.isprintable()


def check_motion(motion: GroundMotion) -> None:
    assert isinstance(motion, GroundMotion)
    assert motion.npts >= 2
    assert 0.0 < motion.dt < 1.0
    assert np.all(np.isfinite(motion.acceleration))
    assert not motion.acceleration.flags.writeable
    assert np.isfinite([motion.pga, motion.pgv, motion.arias_intensity]).all()
    motion.baseline_check()


DT = st.sampled_from([None, 0.01])
CHANNEL = st.sampled_from([None, 1, 2])


@QUICK
@given(content=st.binary(max_size=400), dt=DT, channel=CHANNEL)
@example(content=b"t_s,a_g\n0, 1D-1 2\n0.01,1\n", dt=None, channel=None)
@example(content=b"t_s,a_g\n0E999,0\n0.01,1\n", dt=None, channel=None)
@example(content=b"t_s,a_g\n0,1e308\n0.01,-1e308\n", dt=None, channel=None)
@example(content=b"0 0\n1e-3 0", dt=None, channel=None)
@example(content=b"\xef\xbb\xbf", dt=None, channel=None)
def test_arbitrary_bytes(tmp_path: Path, content: bytes, dt: float | None, channel: int) -> None:
    check(tmp_path / "any", content, dt, channel)


@QUICK
@given(
    content=st.text(alphabet="0123456789.eE+-, \n\t;#ga_ts(/)", max_size=300),
    dt=DT,
    channel=CHANNEL,
)
def test_arbitrary_columns(tmp_path: Path, content: str, dt: float | None, channel: int) -> None:
    check(tmp_path / "columns", content.encode(), dt, channel)


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """A valid file with pieces overwritten, inserted, cut out, or its end cut off."""
    content = draw(st.sampled_from([*VALID, *UNCOUNTED]))
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(content)))
        how = draw(st.sampled_from(["insert", "overwrite", "cut", "truncate"]))
        piece = draw(st.sampled_from(PIECES) | st.binary(min_size=1, max_size=4))
        if how == "insert":
            content = content[:at] + piece + content[at:]
        elif how == "overwrite":
            content = content[:at] + piece + content[at + len(piece) :]
        elif how == "cut":
            content = content[:at] + content[at + draw(st.integers(1, 100)) :]
        else:
            content = content[:at]
    return content


@settings(QUICK, max_examples=600)
@given(content=mutated(), dt=DT, channel=CHANNEL)
def test_mutated_records(
    tmp_path: Path, content: bytes, dt: float | None, channel: int | None
) -> None:
    check(tmp_path / "mutated", content, dt, channel)


@pytest.mark.parametrize("content", VALID)
def test_every_truncation(tmp_path: Path, content: bytes) -> None:
    """A file cut anywhere is refused, or what it lost was not a number."""
    whole = None
    listed = content.startswith(b"a sample")
    for length in (*range(len(content), len(content) - 30, -1), *range(len(content), 0, -23)):
        path = tmp_path / "cut"
        path.write_bytes(content[:length])
        try:
            motion = read_motion(path, channel=1, dt=0.01, units="gal" if listed else None)
        except InputError:
            continue
        whole = whole or motion.npts
        assert motion.npts == whole or b"t_s" in content
