"""The rows of state and constants, as they are declared."""

import ast
from collections import Counter
from pathlib import Path

import pytest

from railquake import march
from railquake.march.rows import USUAL, hinge_parts
from railquake.march.rows_constant import CONSTANT_ROWS
from railquake.march.rows_state import STATE_ROWS
from railquake.measures import MEASURES, StateRow, StateTime
from railquake.physics.hinge import HINGE_LAWS

STAGES = [
    path for path in Path(march.__file__).parent.glob("*.py") if not path.stem.startswith("rows")
]


def names(rows):
    """Of all declarations and their parts; a row by itself is its own part."""
    own = [row.name for row in rows]
    return own + [part.name for row in rows for part in row.parts if part.name != row.name]


@pytest.mark.parametrize("law", list(HINGE_LAWS))
def test_no_name_stands_twice(law):
    own = HINGE_LAWS[law]
    for rows, fields in ((STATE_ROWS, type(own.virgin)), (CONSTANT_ROWS, own.parameter_fields)):
        every = names((*rows, hinge_parts("HINGE", fields)))
        assert [name for name, count in Counter(every).items() if count > 1] == []


def test_every_row_says_what_it_is():
    for row in (*STATE_ROWS, *CONSTANT_ROWS):
        assert row.unit and row.meaning, row.name
        assert all(part.unit and part.meaning for part in row.parts), row.name


def stored():
    """Names of the state's rows to which a stage stores, or which it hands on to be stored."""
    found = set()
    for path in STAGES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "raise_peak":
                found.add(ast.unparse(node.args[1]))
            elif isinstance(node, ast.Assign | ast.AugAssign):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                found |= {
                    ast.unparse(part.slice.elts[0])
                    for target in targets
                    for part in ast.walk(target)
                    if isinstance(part, ast.Subscript) and isinstance(part.slice, ast.Tuple)
                }
    return found


def test_every_measure_of_the_state_has_a_row_and_a_stage_that_fills_it():
    """A measure declares its row; a slip in its name would make another one, for ever zero."""
    places = [m.place.name for m in MEASURES if isinstance(m.place, StateRow | StateTime)]
    assert len(places) > 10
    for name in places:
        assert USUAL.state_blocks[name].stop - USUAL.state_blocks[name].start == 1
        assert f"state.{name}" in stored(), name
