"""Words of errors."""

import pytest

from railquake.errors import InputError
from railquake.messages import (
    csv_cell,
    did_you_mean,
    first_line,
    no_folder,
    on_one_line,
    reason,
    refuse_unknown,
    shell_word,
    shown,
    unreadable,
)


def test_the_nearest_word_is_named_or_all_are():
    assert (
        did_you_mean("Lenght", ("length", "mass")) == 'did you mean "length"? (known: length, mass)'
    )
    assert did_you_mean("xyz", ["length", "mass"]) == "known: length, mass"
    assert did_you_mean(3, {"length": 1}) == "known: length"


def test_a_key_without_a_meaning_is_refused_with_its_place():
    refuse_unknown({"length": 1}, ("length",), "case.toml: ")
    with pytest.raises(InputError, match=r"^case.toml: support\.lenght: unknown key; did you mean"):
        refuse_unknown({"length": 1, "lenght": 2}, ("length",), "case.toml: support.")


def test_errors_of_others_take_one_line():
    assert on_one_line(ValueError("a\n  b")) == "ValueError: a b"
    assert first_line(ValueError("a\nb")) == "a"
    assert first_line(ValueError()) == ""
    assert reason(OSError(28, "No space left on device")) == "No space left on device"
    assert reason(OSError("of a\nlibrary")) == "of a library"


def test_files_that_cannot_be_read_say_why(tmp_path):
    with pytest.raises(FileNotFoundError) as missing:
        (tmp_path / "none").read_text()
    assert str(unreadable("none", missing.value)) == (
        "none: cannot be read: No such file or directory"
    )
    (tmp_path / "binary").write_bytes(b"\xff\xfe\xff")
    with pytest.raises(UnicodeDecodeError) as binary:
        (tmp_path / "binary").read_text(encoding="utf-8")
    assert str(unreadable("binary", binary.value)) == "binary: cannot be read: is not text (UTF-8)"
    assert "is no folder; x" in str(no_folder(tmp_path / "binary", "x"))
    assert "there is no such folder; x" in str(no_folder(tmp_path / "none", "x"))


def test_values_are_shown_in_one_short_line():
    assert shown("a\nb") == '"a b"'
    assert len(shown(list(range(100)))) == 60
    assert shown(10**70) == "a number of more than 60 digits"


def test_no_message_is_obeyed_by_a_terminal():
    error = InputError("a.toml: \x1b[31m\x07\u202e\nkey\udce9")
    assert str(error) == r"a.toml: \x1b[31m\x07\u202e\nkey\udce9"


@pytest.mark.parametrize(
    ("text", "cell"),
    [
        ("=1+1", "'=1+1"), ("+cmd", "'+cmd"), ("-x", "'-x"), ("@SUM", "'@SUM"), (" =1", "' =1"),
        ("\tx", "'\tx"), ("-5%", "'-5%"),
        ("-1.5", "-1.5"), ("+2e-3", "+2e-3"), ("plain", "plain"), ("a=b", "a=b"), ("", ""),
    ],
)  # fmt: skip
def test_no_cell_is_a_formula_and_numbers_stay_numbers(text, cell):
    assert csv_cell(text) == cell


@pytest.mark.parametrize(
    ("path", "word"), [("-x", "./-x"), ("a b", "'a b'"), ("-a b", "'./-a b'"), ("plain", "plain")]
)
def test_a_path_in_a_command_is_no_option(path, word):
    assert shell_word(path) == word
