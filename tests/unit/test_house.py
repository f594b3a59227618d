"""The house itself: what would make it harder to find one's way in fails here.

A rule that some place breaks for now names that place; a place that no longer does is to be taken
off the list.
"""

import ast
from functools import cache
from pathlib import Path

import pytest

import railquake

ROOT = Path(railquake.__file__).parent


@cache
def modules():
    """Trees of all modules by their names."""
    found = {}
    for path in sorted(ROOT.rglob("*.py")):
        steps = path.relative_to(ROOT.parent).with_suffix("").parts
        name = ".".join(steps[:-1] if steps[-1] == "__init__" else steps)
        found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


def offenders(breaks):
    """Names of the modules for which something is true."""
    return {name for name, tree in modules().items() if any(map(breaks, ast.walk(tree)))}


# --- one place for one thing ---------------------------------------------------------------


def moves_a_file(node):
    """Whether something is written under another name first, or moved."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value.endswith((".part", ".tmp"))
    if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
        return False
    of, method = node.func.value, node.func.attr
    if isinstance(of, ast.Name) and of.id in ("os", "shutil", "tempfile", "uuid"):
        return method in (
            "replace", "rename", "renames", "link", "fsync", "move", "mkstemp", "uuid1", "uuid4",
            "NamedTemporaryFile",
        )  # fmt: skip
    # as of a path: a text's has two arguments, that of a table of data has named ones
    return method in ("replace", "rename") and len(node.args) == 1 and not node.keywords


FILES_ELSEWHERE = {"railquake.assembly.geometry"}


def test_only_files_writes_under_another_name():
    assert offenders(moves_a_file) - {"railquake.files"} == FILES_ELSEWHERE


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("os.replace(a, b)", True),
        ("part.rename(folder)", True),
        ("path.with_name('a').replace(path)", True),
        ("f'.{name}.part'", True),
        ("shutil.move(a, b)", True),
        ("text.replace('a', 'b')", False),
        ("frame.rename(columns=names)", False),
        ("replace(scenario, solver=solver)", False),
    ],
)
def test_moving_a_file_is_seen(code, found):
    assert any(map(moves_a_file, ast.walk(ast.parse(code)))) == found


def keeps_by_hand(node):
    """Whether a dictionary is made to forget: a store of its own."""
    return isinstance(node, ast.Name) and node.id == "OrderedDict"


STORES_ELSEWHERE = {"railquake.assembly.system", "railquake.run.gpu"}


def test_only_memory_keeps_a_bounded_store():
    assert offenders(keeps_by_hand) - {"railquake.memory"} == STORES_ELSEWHERE
