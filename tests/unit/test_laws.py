"""Families of laws: filled by lying in a folder, joined from outside."""

import sys
import textwrap
import threading
from types import SimpleNamespace

import pytest

from railquake.errors import InputError
from railquake.laws import Family


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A folder with laws: two, and a module that holds none."""
    folder = tmp_path / "toy_laws"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    law = "from types import SimpleNamespace\nLAW = SimpleNamespace(name={!r}, factor={})\n"
    (folder / "linear.py").write_text(law.format("linear", 1.0))
    (folder / "doubled.py").write_text(law.format("twice-linear", 2.0))
    (folder / "table.py").write_text("NUMBERS = (1, 2)\n")
    monkeypatch.syspath_prepend(tmp_path)
    yield "toy_laws"
    for name in [name for name in sys.modules if name.split(".")[0] == "toy_laws"]:
        del sys.modules[name]


def test_a_law_is_found_by_lying_in_the_folder(package):
    family = Family("toy law", package)
    assert package not in sys.modules  # until one is asked for
    assert family.names() == family.built_in() == ("twice-linear", "linear")
    assert family["twice-linear"].factor == 2.0
    assert "linear" in family and "cubic" not in family and 3 not in family
    assert list(family) == list(family.names()) and len(family) == 2


def test_a_law_joins_from_outside(package):
    family = Family("toy law", package)
    law = SimpleNamespace(name="cubic")
    assert family.add(law) is law is family["cubic"]
    assert family.names() == ("twice-linear", "linear", "cubic")
    assert family.built_in() == ("twice-linear", "linear")
    assert family.add(law) is law  # the same once more does no harm


def test_a_name_that_is_taken_is_refused(package):
    family = Family("toy law", package)
    with pytest.raises(InputError, match=r'there is a toy law "linear" already'):
        family.add(SimpleNamespace(name="linear"))


def test_an_unknown_name_lists_the_known_ones(package):
    family = Family("toy law", package)
    message = r'^there is no toy law "cubic"; known: "twice-linear" or "linear"$'
    with pytest.raises(InputError, match=message):
        family["cubic"]
    with pytest.raises(InputError, match="known: none"):
        Family("empty law")["any"]


def test_a_law_may_ask_for_others_while_it_is_imported(package, tmp_path):
    (tmp_path / "toy_laws" / "__init__.py").write_text(
        textwrap.dedent("""
            from railquake.laws import Family
            FAMILY = Family("toy law", "toy_laws")
        """)
    )
    (tmp_path / "toy_laws" / "zeta.py").write_text(
        "from types import SimpleNamespace\nfrom toy_laws import FAMILY\n"
        "LAW = SimpleNamespace(name='zeta', others=FAMILY.names())\n"
    )
    from toy_laws import FAMILY

    assert FAMILY["zeta"].others == ("twice-linear", "linear")
    assert FAMILY.names() == ("twice-linear", "linear", "zeta")


def test_a_folder_that_cannot_be_imported_is_looked_at_again(package, tmp_path):
    (tmp_path / "toy_laws" / "broken.py").write_text("raise OSError('not now')\n")
    family = Family("toy law", package)
    with pytest.raises(OSError, match="not now"):
        family.names()
    (tmp_path / "toy_laws" / "broken.py").write_text("")
    assert family.names() == ("twice-linear", "linear")


def test_threads_see_all_laws_or_wait(package, tmp_path):
    (tmp_path / "toy_laws" / "slow.py").write_text(
        "import time\ntime.sleep(0.05)\nfrom types import SimpleNamespace\n"
        "LAW = SimpleNamespace(name='slow')\n"
    )
    family, seen = Family("toy law", package), []
    threads = [threading.Thread(target=lambda: seen.append(family.names())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert set(seen) == {("twice-linear", "linear", "slow")}
