"""Records as agencies write them: read with the values and the peak that each file states."""

import gzip
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import read_motion, record_contents

FILES = runpy.run_path(str(Path(__file__).with_name("agency_files.py")))
WAVE, N, fields = FILES["WAVE"] * 0.01, FILES["N"], FILES["fields"]  # m/s2
cosmos, smc_wide, dyna, nsmn = (FILES[name] for name in ("cosmos", "smc_wide", "dyna", "nsmn"))
geonet, knet_csv, jma_csv = (FILES[name] for name in ("geonet", "knet_csv", "jma_csv"))
renadic = FILES["renadic"]


def write(folder: Path, content: str | bytes, name: str = "record.txt") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


MADE_UP: list[tuple[str, str | bytes, Any, float]] = [
    ("COSMOS", cosmos(), None, 1e-6),
    ("USGS SMC", smc_wide(), None, 1e-6),
    ("ESM/AFAD DYNA", dyna(), None, 1e-8),
    ("AFAD three columns", nsmn(), "N-S", 1e-8),
    ("GeoNet V1A/V2A", geonet(), 1, 6e-5),
    ("GeoNet V1A/V2A", geonet(corrected=False), "N28W", 6e-5),
    ("K-NET CSV", knet_csv(), "NS", 1e-6),
    ("JMA CSV", jma_csv(), "NS", 1e-6),
    ("RENADIC Volume 1", renadic(), "EW", 6e-4),
]


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize(("kind", "content", "channel", "tolerance"), MADE_UP)
def test_each_agencys_format_gives_its_values(
    tmp_path: Path,
    kind: str,
    content: str | bytes,
    channel: int | str | None,
    tolerance: float,
    compressed: bool,
) -> None:
    data = content.encode() if isinstance(content, str) else content
    path = write(tmp_path, gzip.compress(data) if compressed else data, "record.x.gz")
    motion = read_motion(path, channel=channel)
    assert f"format: {kind}" in motion.notes
    assert motion.dt == pytest.approx(0.01, rel=1e-9)
    np.testing.assert_allclose(motion.acceleration, WAVE, rtol=0, atol=tolerance)
    assert not any("peak" in note for note in motion.notes)
    with pytest.raises(InputError, match=r"states a time step of 0\.01 s but dt = 0\.02"):
        read_motion(path, channel=channel, dt=0.02)


@pytest.mark.parametrize("cut", [0.995, 0.9, 0.7])
@pytest.mark.parametrize(
    ("content", "channel", "tolerance"),
    # the two CSV formats state no number of values; a row cut off is refused, see below
    [case[1:] for case in MADE_UP if "CSV" not in case[0]],
)
def test_a_file_cut_off_never_gives_fewer_values_in_silence(
    tmp_path: Path, content: str | bytes, channel: int | str | None, tolerance: float, cut: float
) -> None:
    data = content.encode() if isinstance(content, str) else content
    path = write(tmp_path, data[: int(cut * len(data))])
    try:
        motion = read_motion(path, channel=channel)
    except InputError as error:
        assert "\n" not in str(error)
    else:  # cut behind the values wanted
        np.testing.assert_allclose(motion.acceleration, WAVE, rtol=0, atol=tolerance)


@pytest.mark.parametrize("content", [jma_csv(), knet_csv().encode()])
def test_a_row_cut_off_is_refused(tmp_path: Path, content: bytes) -> None:
    row = content.rstrip(b"\n,").rfind(b",")
    with pytest.raises(InputError, match="damaged or cut off"):
        read_motion(write(tmp_path, content[:row]), channel="NS")


DATA = "acceleration pts, approx   0 secs, units=cm/sec2(04),Format=(8F10.4)"


@pytest.mark.parametrize(
    ("change", "values"),
    [
        ({"data": DATA.replace(",Format", "Format")}, None),
        ({"data": DATA.replace("cm/sec2(04),", "cm/sec2. (04)")}, None),
        ({"end": "End-of-data for Chan  1 acceleration\n"}, None),
        ({"end": "\n\nEnd of data for channel 1\n"}, None),
        ({"data": DATA.replace("acceleration", "uncor. accel."), "values": None}, "{:.4f}"),
        ({"data": DATA.replace("(8F10.4)", "(1E14.6)")}, "{:14.6E}"),
    ],
)
def test_dialects_of_cosmos(tmp_path: Path, change: dict[str, Any], values: str | None) -> None:
    if values is not None:
        change = change | {"values": fields(FILES["WAVE"], values, 1)}
    motion = read_motion(write(tmp_path, cosmos(**change)))
    np.testing.assert_allclose(motion.acceleration, WAVE, rtol=0, atol=1e-6)


def test_parts_of_cosmos_behind_one_header_are_told_apart(tmp_path: Path) -> None:
    more = f"      {N} velocity pts, approx 0 secs, units=cm/sec(05),Format=(8F10.4)\n"
    more += fields(np.zeros(N), "{:10.4f}", 8) + "End-of-data for Chan  1 velocity\n"
    motion = read_motion(write(tmp_path, cosmos(end="End-of-data for Chan 1 accel\n" + more)))
    np.testing.assert_allclose(motion.acceleration, WAVE, rtol=0, atol=1e-6)


def test_raw_counts_of_cosmos_are_called_so(tmp_path: Path) -> None:
    text = cosmos(data="raw accel.   pts, approx  0 secs, units=counts (50),Format=(8F10.4)")
    with pytest.raises(InputError, match=r"raw, in 'counts'"):
        read_motion(write(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (cosmos(flag=1), "which it has fixed"),
        (cosmos(flag=2), "NOT fixed"),
        (smc_wide(flag=1), "flags a problem"),
        (cosmos(), None),
        (smc_wide(flag=0), None),
    ],
)
def test_flags_of_agencies_become_notes(tmp_path: Path, text: str, told: str | None) -> None:
    notes = " ".join(read_motion(write(tmp_path, text)).notes)
    assert "flag" not in notes if told is None else told in notes


@pytest.mark.parametrize(
    ("text", "channel"),
    [(dyna(**{"PGA_CM/S^2": "1.0"}), None), (nsmn(), "U-D"), (renadic(), "EW")],
)
def test_a_peak_that_the_data_do_not_have_is_told(
    tmp_path: Path, text: str, channel: str | None
) -> None:
    text = text.replace("MAX  =  0.1", "MAX  =  0.5")
    notes = read_motion(write(tmp_path, text), channel=channel).notes
    assert any("header gives a peak" in note for note in notes)


@pytest.mark.parametrize(
    ("text", "begin"),
    [
        (cosmos(flag=2), "the agency flags"),
        (dyna(**{"PGA_CM/S^2": "1.0"}), "the header gives a peak"),
        ("t_s,a_g\n0,0.1\n0.01,0.2\n0.02,0.1\n", "unit g taken"),
        (dyna(), None),
    ],
)
def test_doubts_about_a_record_are_told_apart_from_its_notes(
    tmp_path: Path, text: str, begin: str | None
) -> None:
    doubts = read_motion(write(tmp_path, text)).scaled(0.5).doubts()
    assert not doubts if begin is None else (len(doubts) == 1 and doubts[0].startswith(begin))


@pytest.mark.parametrize(
    ("text", "channel", "message"),
    [
        (dyna(NDATA="41"), None, "NDATA is 41 and the file has 40"),
        (dyna(DATA_TYPE="VELOCITY"), None, "holds 'velocity', not acceleration"),
        (dyna(SAMPLING_INTERVAL_S=""), None, "SAMPLING_INTERVAL_S"),
        (nsmn(41), 1, "NUMBER OF DATA is 41 and the file has 40 rows"),
        (knet_csv("200"), "NS", "a gap, or a wrong sampling frequency"),
        (knet_csv().replace("23:59:59.20", "23:59:59.70"), "NS", "time stamp of sample 21"),
        (smc_wide("0 UNKNOWN"), None, "SMC file of type 0"),
        (geonet().replace("Duration 0.39", "Duration 3.90"), 1, "contradicts itself"),
        (renadic(uneven=True), 1, "unevenly sampled; give dt"),
        (dyna().replace(f"{WAVE[7] * 100:.6f}", "-999.000000"), None, "mark of a missing value"),
    ],
)
def test_contradictions_are_refused(
    tmp_path: Path, text: str, channel: int | str | None, message: str
) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read_motion(write(tmp_path, text), channel=channel)
    assert "damaged" not in str(caught.value)


def test_uneven_pairs_of_renadic_are_resampled_when_told(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, renadic(uneven=True)), channel=1, dt=0.01)
    assert any("resampled from 40 uneven samples" in note for note in motion.notes)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (gzip.compress(dyna().encode())[:-30], "cut off"),
        (gzip.compress(dyna().encode())[:40] + b"xxxxxxxxxxxxxxxx", "damaged|cut off"),
        (gzip.compress(dyna().encode()) + b"more", "bytes follow"),
        (b"PK\x03\x04\x00\x00abc", "zip archive"),
        (b"000001D STA  00HNZBK" + bytes(40), "miniSEED"),
        (bytes(304) + b"\x06\x00\x00\x00" + bytes(400), "SAC file"),
        (b"<?xml version='1.0'?><FDSNStationXML>", "StationXML"),
        (b"Response and Fourier amplitude spectra (78 periods)\n1 2\n", "spectra"),
        (b"time,acc\n2001-01-01T00:00:00.00,1\n2001-01-01T00:00:00.01,2\n", "dates or times"),
        (b"t;a\n0,00;0,1\n0,01;0,2\n", "decimal commas"),
    ],
)
def test_what_is_not_read_is_called_by_its_name(tmp_path: Path, data: bytes, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_motion(write(tmp_path, data))


@pytest.mark.parametrize(
    ("content", "vertical"),
    [
        (dyna(), (False,)),
        (dyna(STREAM="HNZ"), (True,)),
        (nsmn(), (False, False, True)),
        (geonet(), (False, True)),
        (knet_csv(), (False, False, True)),
        (jma_csv(), (False, False, True)),
        (renadic(), (False, True)),
        (cosmos(azimuth=400), (True,)),
        (cosmos(azimuth=402, label="Hall V"), (True,)),
        (cosmos(azimuth=90, label="UP"), (False,)),
        (cosmos(azimuth=-999, label="Up"), (True,)),
        (cosmos(azimuth=-999, label="Hall"), (None,)),
        (smc_wide(angle=0), (True,)),
        (smc_wide(angle=90), (False,)),
    ],
)
def test_the_header_tells_what_is_vertical(
    tmp_path: Path, content: str | bytes, vertical: tuple[bool | None, ...]
) -> None:
    assert record_contents(write(tmp_path, content)).vertical == vertical


AGENCIES = [
    ("afad_nsmn/20101114230825_3104_ap_RawAcc_E.asc", None, 1.632e-2, 0.01, 5600),
    ("afad_nsmn/20170720223109_0921.txt.gz", "N-S", 0.13200332, 0.01, 28683),
    ("afad_nsmn/20170720223109_0921.txt.gz", "E-W", 0.12163827, 0.01, 28683),
    ("cosmos/Cosmos12TimeSeriesTest.v1", None, 1.61962, 0.01, 7000),
    ("esm/HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC", None, 2.27973e-3, 0.005, 13876),
    ("geonet/20180212_211557_WPWS_20.V2A", 1, 0.0416, 0.02, 5800),
    ("kiknet/AICH040010061330.NS2", None, 0.05605, 0.005, 28600),
    ("kiknet/NGNH311106302345.UD2", None, 0.00672, 0.01, 12000),
    ("renadic_chile/altohospicio0911131.v1", "NS", 0.0838 * 9.80665, 0.01, 3500),
    ("smc/0111a.smc", None, 1.044078, 0.005, 6001),
]


@pytest.mark.parametrize(("file", "channel", "peak", "dt", "count"), AGENCIES)
def test_the_agencies_files_have_the_peaks_that_they_state(
    shared: Path, file: str, channel: Any, peak: float, dt: float, count: int
) -> None:
    motion = read_motion(shared / "records" / "formats" / "agencies" / file, channel=channel)
    assert motion.pga == pytest.approx(peak, rel=2e-3)
    assert (motion.dt, motion.npts) == (pytest.approx(dt, rel=1e-9), count)
    assert not any("peak" in note for note in motion.notes)
