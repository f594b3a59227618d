"""PEER's report of a search as a manifest, as delivered and as a spreadsheet saves it."""

from pathlib import Path

import pytest

from railquake.errors import InputError
from railquake.suite import read_manifest
from railquake.suite.peer import search_rows
from record_folders import short_motion, write_at2

HEADER = (
    "Result ID, Spectral Ordinate, Record Sequence Number, Mean Squared Error, Scale Factor, "
    "Earthquake Name, Year, Station Name, Horizontal-1 Acc. Filename, Horizontal-2 Acc. Filename, "
    "Vertical Acc. Filename"
)
TOP = "\n PEER Ground Motion Database, Time Series Search Report\n\nScale Factor Min:, 0.0\n\n"
MARK = " -- Summary of Metadata of Selected Records --"


def delivered(factor: str = "1.8125", number: str = "6") -> str:
    return (
        f"{TOP}{MARK}\n{HEADER}\n"
        f'1, SRSS, {number}, 0.47, {factor}, "Imperial Valley", 1940, "El Centro, Array 9", '
        "RSN6_A-180.AT2, RSN6_A-270.AT2 , RSN6_A-UP.AT2  \n"
        '2, SRSS, 14, 2.63, 0.5, "Kern", 1952, "B", RSN14_B1.AT2, RSN14_B2.AT2 , RSN14_B-V.AT2\n'
        "\n These records are UNSCALED\n -- Scaled Spectra --\nPeriod,Sa\n0.1,0.2\n"
    )


def saved_by_a_spreadsheet() -> str:
    return (
        f"{TOP}{MARK},,,,,,,,,,,\n{HEADER},\n"
        '1, SRSS,6,0.47,1.8125," ""Imperial Valley""",1940," ""El Centro"," Array 9""",'
        " RSN6_A-180.AT2, RSN6_A-270.AT2 , RSN6_A-UP.AT2  \n"
        '2, SRSS,14,2.63,0.5," ""Kern""",1952," ""B""", RSN14_B1.AT2, RSN14_B2.AT2 , '
        "RSN14_B-V.AT2,\n,,,,,,,,,,,\n These records are UNSCALED,,,,,,,,,,,\n"
    )


@pytest.mark.parametrize("text", [delivered(), saved_by_a_spreadsheet()])
def test_both_horizontal_components_with_their_scale_factor(tmp_path: Path, text: str) -> None:
    for seed, name in enumerate(("RSN6_A-180", "RSN6_A-270", "RSN14_B1", "RSN14_B2"), 1):
        write_at2(tmp_path / f"{name}.AT2", short_motion(seed))
    report = tmp_path / "_SearchResults.csv"
    report.write_text(text)
    suite = read_manifest(report, None)
    found = [(member.name, member.scale_factor) for member in suite.members]
    assert found == [
        ("RSN6_A-180", 1.8125),
        ("RSN6_A-270", 1.8125),
        ("RSN14_B1", 0.5),
        ("RSN14_B2", 0.5),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (delivered(factor="-"), "line 8: scale factor: must be a number, found '-'"),
        (delivered(factor="0"), "line 8: scale factor: must be finite and over zero"),
        (delivered(number="7"), "line 8: record sequence number: is 7, but the file is called"),
        (delivered().replace("RSN14_B2.AT2", "-"), "line 9: should end in the names of three"),
        (delivered().replace("Scale Factor, ", ""), "column 'scale factor' is missing"),
        (f"{TOP}{MARK}\n{HEADER}\n\n", "lists no records"),
        (f"{TOP}{MARK}\n", "ends behind its criteria"),
    ],
)
def test_faults_name_the_line(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        search_rows(text, "report.csv")


def test_the_delivered_report_is_read_whole(shared: Path) -> None:
    path = shared / "records" / "formats" / "agencies" / "peer" / "_SearchResults_2025.csv"
    rows = search_rows(path.read_text(), str(path))
    assert len(rows) == 60
    assert rows[0].file == "RSN6_IMPVALL.I_I-ELC180.AT2" and rows[0].scale_factor == 1.0
