"""The house itself: what would make it harder to find one's way in fails here.

A rule that some place breaks for now names that place; a place that no longer does is to be taken
off the list.
"""

import ast
import io
import tokenize
from functools import cache
from pathlib import Path

import pytest

import railquake

ROOT = Path(railquake.__file__).parent


@cache
def sources():
    """Files of all modules by their names."""
    found = {}
    for path in sorted(ROOT.rglob("*.py")):
        steps = path.relative_to(ROOT.parent).with_suffix("").parts
        found[".".join(steps[:-1] if steps[-1] == "__init__" else steps)] = path
    return found


@cache
def modules():
    """Trees of all modules by their names."""
    return {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in sources().items()}


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


def test_only_files_and_its_parts_write_under_another_name():
    assert offenders(moves_a_file) == {"railquake.files", "railquake.parts"}


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


def test_only_memory_keeps_a_bounded_store():
    assert offenders(keeps_by_hand) == {"railquake.memory"}


# --- physics holds laws only ----------------------------------------------------------------

MOST_ARGUMENTS = 8  # of a law


def physics():
    """Trees of the physics' modules by their names."""
    return {name: tree for name, tree in modules().items() if name.startswith("railquake.physics")}


def test_physics_knows_no_rows_and_no_lanes():
    """``S[row, lane]`` and ``Q[row, lane]`` are the march's."""
    names = {
        (name, node.id if isinstance(node, ast.Name) else node.arg)
        for name, tree in physics().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Name | ast.arg)
    }
    assert {found for found in names if found[1] in ("S", "Q", "lane", "lanes")} == set()


def test_no_law_takes_many_arguments():
    many = {
        f"{name}.{node.name}"
        for name, tree in physics().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        and len(node.args.posonlyargs + node.args.args + node.args.kwonlyargs) > MOST_ARGUMENTS
    }
    assert many == set()


def by_a_literal(node):
    """Whether a number of a row is a literal, or one row's number and a literal."""
    if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name):
        row = node.slice.elts[0] if isinstance(node.slice, ast.Tuple) else None
        return node.value.id in ("S", "Q") and isinstance(row, ast.Constant)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        sides = (node.left, node.right)
        rows = any(
            isinstance(side, ast.Attribute)
            and side.attr.isupper()
            and ast.unparse(side.value).split(".")[-1] in ("state", "constant")
            for side in sides
        )
        return rows and any(isinstance(side, ast.Constant) for side in sides)
    return False


def test_rows_are_addressed_by_their_own_names():
    assert offenders(by_a_literal) == set()


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("S[3, lane]", True),
        ("S[state.U + 2, lane]", True),
        ("end[layout.state.U - 1]", True),
        ("S[state.U, lane]", False),
        ("S[state.TRACK + k, lane]", False),
    ],
)
def test_a_literal_row_is_seen(code, found):
    assert any(map(by_a_literal, ast.walk(ast.parse(code)))) == found


# --- sizes ---------------------------------------------------------------------------------

MOST_LINES = 500  # of a module
MOST_CODE = 60  # lines of a function
MOST_LOOSE = 9  # modules beside the packages

# Functions that are longer for a reason: at most three.
LONG_FOR_A_REASON = {
    "railquake.physics.hinge.bouc_wen.solve": "one Newton iteration of one equation, and what of "
    "its derivatives the consistent tangent needs",
}

SILENT = (
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT,
    tokenize.ENDMARKER,
)  # fmt: skip


def lines_of_code(text):
    """Lengths of a module's functions: lines but for docstrings, comments and blank ones."""
    code = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in SILENT:
            code |= set(range(token.start[0], token.end[0] + 1))
    nodes = [
        node
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
    ]
    for node in nodes:
        if ast.get_docstring(node) is not None:
            code -= set(range(node.body[0].lineno, node.body[0].end_lineno + 1))
    found = {}
    for node in nodes:
        if not isinstance(node, ast.ClassDef):
            length = len(code & set(range(node.lineno, node.end_lineno + 1)))
            found[node.name] = max(length, found.get(node.name, 0))
    return found


def test_no_module_is_too_long():
    long = {
        name
        for name, path in sources().items()
        if len(path.read_text(encoding="utf-8").splitlines()) > MOST_LINES
    }
    assert long == set()


def test_no_function_is_too_long():
    assert len(LONG_FOR_A_REASON) <= 3
    long = {
        f"{name}.{function}"
        for name, path in sources().items()
        for function, length in lines_of_code(path.read_text(encoding="utf-8")).items()
        if length > MOST_CODE
    }
    assert long == set(LONG_FOR_A_REASON)


def test_lines_of_code_are_counted_without_words():
    code = '''
def function(a,
             b):
    """Words.

    More words.
    """
    # a comment

    if a:
        text = """one

        two"""
    else:  # a comment
        def inner():
            """Words."""
            return 1
    return [
        a,
    ]
'''
    assert lines_of_code(code) == {"function": 12, "inner": 2}


def test_few_modules_stand_beside_the_packages():
    loose = {path.name for path in ROOT.glob("*.py")}
    assert len(loose) <= MOST_LOOSE, sorted(loose)


# --- who knows whom ------------------------------------------------------------------------


def imported(tree):
    """Modules of the package that another imports, anywhere in it and for whatever purpose."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            # a name in a package may be a module of it
            below = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if name in modules() else node.module for name in below]
        else:
            continue
        yield from (name for name in names if name in modules())


def circles(graph):
    """Groups of more than one that all reach each other."""
    reached = {}
    for start in graph:
        reached[start], ahead = set(), [start]
        while ahead:
            for name in graph[ahead.pop()] - reached[start]:
                reached[start].add(name)
                ahead.append(name)
    found = {frozenset(b for b in reached[a] if a in reached[b]) for a in graph if a in reached[a]}
    return [set(group) for group in found if len(group) > 1]


def test_no_module_knows_one_that_knows_it():
    graph = {name: set(imported(tree)) - {name} for name, tree in modules().items()}
    assert sum(map(len, graph.values())) > 500  # imports are seen
    assert circles(graph) == []


def test_circles_are_found():
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}, "e": set()}
    assert circles(graph) == [{"a", "b", "c"}]
