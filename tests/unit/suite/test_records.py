"""Which files of a folder are taken for horizontal components of records."""

from pathlib import Path

import pytest

from railquake.errors import InputError
from railquake.suite.records import find_components
from record_folders import short_motion, write_at2


def kinds(folder: Path) -> tuple[list[str], dict[str, str]]:
    components, skipped = find_components(folder)
    return [one.file for one in components], {one.file: one.kind for one in skipped}


def test_files_that_are_no_records_are_skipped_and_told(tmp_path: Path) -> None:
    motion = short_motion(1)
    write_at2(tmp_path / "b.AT2", motion)
    write_at2(tmp_path / "deep" / "a.AT2", short_motion(2))
    write_at2(tmp_path / "copy.AT2", motion)
    write_at2(tmp_path / ".hidden.AT2", short_motion(3))
    text = (tmp_path / "b.AT2").read_text()
    (tmp_path / "cut.AT2").write_text(text[: len(text) // 2])
    (tmp_path / "readme.txt").write_text("nothing of note\n")
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00")
    (tmp_path / "uhs.csv").write_text("period_s,sa_g\n0.1,0.5\n0.2,0.6\n0.3,0.4\n")
    (tmp_path / "empty.AT2").write_text("")
    zero = "".join("0.0\n" for _ in range(motion.npts))
    head = "\n".join(text.splitlines()[:4])
    (tmp_path / "zero.AT2").write_text(f"{head}\n{zero}")
    taken, skipped = kinds(tmp_path)
    assert taken == ["b.AT2", "deep/a.AT2"]
    assert skipped == {
        "copy.AT2": "copy of another",
        "cut.AT2": "damaged or incomplete",
        "empty.AT2": "no record",
        "picture.png": "no record",
        "readme.txt": "no record",
        "uhs.csv": "plain columns of numbers",
        "zero.AT2": "all zero",
    }


@pytest.mark.parametrize(
    ("name", "vertical"),
    [
        ("RSN6_IMPVALL.I_I-ELC-UP.AT2", True),
        ("RSN802_LOMAP_STG-UP.AT2", True),
        ("RSN1182_CHICHI_CHY006-V.AT2", True),
        ("RSN182_IMPVALL.H_H-E07DWN.AT2", True),
        ("RSN6_IMPVALL.I_I-ELC180.AT2", False),
        ("RSN1182_CHICHI_CHY006-E.AT2", False),
        ("RSN1106_KOBE_KJM000.AT2", False),
        ("cup.AT2", False),
        ("RSN139_TABAS_DAY-V1.AT2", True),
        ("RSN139_TABAS_DAY-T1.AT2", False),
        ("HL.DLFA..HNZ.D.AT2", True),
        ("HL.DLFA..HNE.D.AT2", False),
        ("BK.CMB.BHZ.00", True),
        ("BK.CMB.BHN.00", False),
        ("acc_vertical.AT2", True),
        ("NGNH31.UD2", True),
        ("NGNH31.EW2", False),
        ("station_UP.txt", True),
        ("group.AT2", False),
        ("STATION V.AT2", False),
        ("RSN1_V_A-090.AT2", False),
        ("LEV.AT2", False),
        ("record.V1", False),
    ],
)
def test_vertical_components_are_told_by_the_files_name(
    tmp_path: Path, name: str, vertical: bool
) -> None:
    write_at2(tmp_path / name, short_motion(1))
    write_at2(tmp_path / "other.AT2", short_motion(2))
    taken, skipped = kinds(tmp_path)
    assert (name in taken) is not vertical
    assert skipped == ({name: "vertical component"} if vertical else {})


@pytest.mark.parametrize(
    ("component", "name", "vertical"),
    [
        ("UP", "RSN6_ELC180.AT2", True),
        ("DWN", "RSN6_ELC180.AT2", True),
        ("V", "RSN6_ELC180.AT2", True),
        ("180", "RSN6_ELC-UP.AT2", False),
        ("N90E", "station-V.AT2", False),
        ("El Centro V", "ELC.AT2", False),
    ],
)
def test_the_header_goes_before_the_files_name(
    tmp_path: Path, component: str, name: str, vertical: bool
) -> None:
    path = write_at2(tmp_path / name, short_motion(1))
    text = path.read_text().replace("made for a test", f"Imperial Valley, 1/1/1940, X, {component}")
    path.write_text(text)
    write_at2(tmp_path / "other.AT2", short_motion(2))
    taken, _ = kinds(tmp_path)
    assert (name in taken) is not vertical


def test_no_vertical_of_the_agencies_files_is_offered(shared: Path) -> None:
    components, skipped = find_components(shared / "records" / "formats" / "agencies")
    vertical = {one.file.rpartition("/")[2] for one in skipped if one.kind == "vertical component"}
    assert vertical == {
        "20170720223109_0921.txt.gz",
        "20180212_211557_WPWS_20.V2A",
        "NGNH311106302345.UD2",
        "altohospicio0911131.v1",
    }
    several = sorted(
        (one.file.rpartition("/")[2], one.channel) for one in components if one.channel
    )
    assert several == [
        ("20170720223109_0921.txt.gz", 1),
        ("20170720223109_0921.txt.gz", 2),
        ("20180212_211557_WPWS_20.V2A", 1),
        ("20180212_211557_WPWS_20.V2A", 2),
        ("altohospicio0911131.v1", 1),
        ("altohospicio0911131.v1", 2),
    ]


def test_a_file_of_three_channels_gives_its_two_horizontal_ones(shared: Path) -> None:
    components, skipped = find_components(shared / "records" / "formats")
    channels = [
        (one.file, one.channel)
        for one in components
        if one.channel is not None and "/" not in one.file
    ]
    assert channels == [("csmip_ce36456p.V2", 1), ("csmip_ce36456p.V2", 3)]
    # of this folder; those below it hold verticals of their own
    vertical = [one.file for one in skipped if one.kind == "vertical component"]
    assert [file for file in vertical if "/" not in file] == ["csmip_ce36456p.V2"]


def test_every_damaged_file_of_the_reference_data_is_skipped(shared: Path) -> None:
    _, skipped = find_components(shared / "records" / "formats")
    bad = {path.name for path in (shared / "records" / "formats" / "bad").iterdir()}
    assert bad == {Path(one.file).name for one in skipped if one.file.startswith("bad/")}


def test_a_folder_without_records_is_refused_in_one_line(tmp_path: Path) -> None:
    for told in ("it is empty", "1 x no record"):
        with pytest.raises(InputError) as caught:
            find_components(tmp_path)
        assert "holds no usable record" in str(caught.value) and told in str(caught.value)
        assert "\n" not in str(caught.value)
        (tmp_path / "readme.txt").write_text("nothing\n")


def test_a_folder_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such folder"):
        find_components(tmp_path / "not")


def test_progress_is_told_file_by_file(tmp_path: Path) -> None:
    for seed in (1, 2):
        write_at2(tmp_path / f"{seed}.AT2", short_motion(seed))
    calls: list[tuple[int, int]] = []
    find_components(tmp_path, lambda done, total: calls.append((done, total)))
    assert calls == [(1, 2), (2, 2)]
