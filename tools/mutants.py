"""Mutation testing of physics and march: whether the tests are able to fail.

Every law of ``railquake.physics`` and every stage of ``railquake.march`` is changed in one place at
a time, by the operators of mutmut, and the quick tests that call it are run until one fails.
mutmut's own runner cannot be used: it puts a decorator around each function, and
`railquake.march.compiler.bind` binds functions by their code.  Here the code itself is exchanged,
in a forked process for each mutant: of the function, and of the copies of it that were bound while
the tests were collected.  What is bound later is bound anew in each process.

Everything runs uncompiled.  The contact table alone comes from the compiled, unchanged grid
method: the interpreter would need minutes for it, and the grid method has tests of its own.

    python tools/mutants.py                              all modules, about an hour: make mutants
    python tools/mutants.py --module physics.zhai        one
    python tools/mutants.py --function load_track        some functions
"""

from __future__ import annotations

import argparse
import difflib
import gc
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import Any

import pytest
from _pytest.runner import runtestprotocol

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "src" / "railquake"
ROOMS = ("physics", "march")
# Of the march: what declares rows and slots and makes functions out of them, and the compiler's
# plumbing, half of which an uncompiled run never enters.
LEFT_OUT = ("declaration", "packing", "rows", "rows_constant", "rows_state", "slots", "compiler")
# quick tests that need no compiled run
TESTS = ("tests/unit/physics", "tests/unit/assembly", "tests/verification/test_jolts.py")
WIDTH = 36  # of a module's name in the table
MEMORY = 6 * 2**30  # bytes of address space beyond which a mutant is ended


@dataclass(frozen=True)
class Mutant:
    """One changed function: its name, what became of its source, its code and defaults."""

    module: str
    function: str
    change: str
    code: CodeType
    defaults: tuple[Any, ...] | None


def module_name(path: Path) -> str:
    """Name of a source file's module, without ``railquake.``: ``physics.creep.carter``."""
    steps = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(steps[:-1] if steps[-1] == "__init__" else steps)


def source_files() -> dict[str, Path]:
    """Files that are changed, by the names of their modules."""
    paths = [path for room in ROOMS for path in sorted((PACKAGE / room).rglob("*.py"))]
    named = {module_name(path): path for path in paths}
    return {name: path for name, path in named.items() if not left_out(name)}


def left_out(module: str) -> bool:
    """Whether a module of the march holds no stage."""
    room, _, rest = module.partition(".")
    return room == "march" and rest.partition(".")[0] in LEFT_OUT


def is_placeholder(function: FunctionType) -> bool:
    """Whether a function is a slot that only refuses to run."""
    return "NotImplementedError" in function.__code__.co_names


def mutants_of(module: str) -> Iterator[Mutant]:
    """All mutants of a module by mutmut's operators; those that do not compile are left out."""
    import libcst
    from mutmut.mutation.file_mutation import create_mutations, deep_replace

    path = source_files()[module]
    source = path.read_text(encoding="utf-8")
    tree, mutations, _, _ = create_mutations(str(path), source)
    names = vars(import_module(f"railquake.{module}"))
    for mutation in mutations:
        function = mutation.contained_by_top_level_function
        if not isinstance(function, libcst.FunctionDef):
            continue
        original = names.get(function.name.value)
        if not isinstance(original, FunctionType) or is_placeholder(original):
            continue
        changed = deep_replace(function, mutation.original_node, mutation.mutated_node)
        before, after = (tree.code_for_node(node) for node in (function, changed))
        scratch = dict(names)
        try:
            exec(
                compile("from __future__ import annotations\n" + after, str(path), "exec"), scratch
            )
        except (SyntaxError, TypeError, ValueError):
            continue
        made = scratch[function.name.value]
        if not isinstance(made, FunctionType):
            continue
        diff = difflib.unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
        change = "\n".join(
            line for line in diff if line[:1] in "+-" and line[:3] not in ("+++", "---")
        )
        yield Mutant(module, function.name.value, change, made.__code__, made.__defaults__)


class Watch:
    """Notes which functions of physics and march run."""

    def __init__(self) -> None:
        self.seen: set[str] = set()
        self.modules = {str(path): name for name, path in source_files().items()}

    def __call__(self, frame: FrameType, event: str, argument: object) -> None:
        """Of `sys.setprofile`."""
        code = frame.f_code
        module = self.modules.get(code.co_filename)
        if event == "call" and module is not None:
            outer = code.co_qualname.partition(".")[0]
            self.seen.add(f"{module}.{outer}")


class Campaign:
    """Plugin of pytest that runs the collected tests once for each mutant."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.rows: list[dict[str, Any]] = []
        self.bound: dict[int, list[FunctionType]] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Find out what each test calls, then look which mutants the tests kill."""
        uncompiled()
        self.bound = functions_by_code()
        items = {item.nodeid: item for item in session.items}
        found = in_fork(lambda: profile(list(items.values()), self.options.seconds), is_heard=True)
        if not isinstance(found, dict):
            raise SystemExit(f"the tests could not be profiled: {found}")
        times, calls, dropped = found["times"], found["calls"], found["dropped"]
        for name, why in dropped.items():
            print(f"left out: {name}: {why}")
        print(f"{len(times)} tests, {sum(times.values()):.0f} s when watched\n")
        for module in self.options.module:
            self.run_module(module, items, times, calls)
            if self.options.out:
                self.options.out.write_text(json.dumps(self.rows, indent=1), encoding="utf-8")
        return True

    def run_module(
        self,
        module: str,
        items: dict[str, pytest.Item],
        times: dict[str, float],
        calls: dict[str, list[str]],
    ) -> None:
        """All mutants of a module."""
        begin = time.perf_counter()
        count: dict[str, int] = defaultdict(int)
        for number, mutant in enumerate(mutants_of(module)):
            if self.options.function and mutant.function not in self.options.function:
                continue
            if number % self.options.every:
                continue
            name = f"{mutant.module}.{mutant.function}"
            chosen = [t for t in times if name in calls[t]]
            # the killers of this function's last mutants first, then tests of little else
            chosen.sort(key=lambda t: (len(calls[t]), times[t]))
            recent = self.recent.setdefault(name, [])
            chosen = [*recent, *(t for t in chosen if t not in recent)]
            fate, by = "untested", ""
            if chosen:
                todo = [(items[t], 5.0 + 5.0 * times[t]) for t in chosen]
                result = in_fork(lambda m=mutant, i=todo: attack(m, i, self.bound))
                fate, by = result if isinstance(result, list) else (str(result), "")
            if by and by in items:
                self.recent[name] = [by, *(t for t in recent if t != by)][:4]
            count[fate] += 1
            row = {"module": module, "function": mutant.function, "fate": fate, "by": by}
            self.rows.append({**row, "change": mutant.change})
            if fate in ("survived", "untested"):
                print(f"{fate}: {name}\n{mutant.change}\n", flush=True)
        seconds = time.perf_counter() - begin
        print(f"{module}: {dict(count)} in {seconds:.0f} s\n", flush=True)

    recent: dict[str, list[str]] = {}  # noqa: RUF012


def uncompiled() -> None:
    """Bind every kernel for the interpreter, but that which fills the contact table.

    And bind it whenever it is asked for: one that were kept would hold the code of before.
    """
    from railquake.assembly.geometry import build_geometry, with_table
    from railquake.inputs.wheelrail import WheelRail
    from railquake.march.compiler import PYTHON, SCALAR, Kernel
    from railquake.physics.contact_table import fill_table

    # the package passes on the function of the same name
    binding = import_module("railquake.march.compiler.bind")
    table = binding.bind(fill_table, SCALAR)
    for pair in ("bart", "s1002-60e1"):  # made here once, and known to all forks
        with_table(build_geometry(WheelRail.from_preset(pair)))

    def bound(entry: Any, target: Any, key: str, laws: Any, held: Any) -> Any:
        if entry is fill_table:
            return table
        return Kernel(binding._rebuild(entry, PYTHON, laws, held.layout, {}), None)

    binding._bind_cached = bound


def functions_by_code() -> dict[int, list[FunctionType]]:
    """All functions that are there, by their code's identity: each with its bound copies."""
    found: dict[int, list[FunctionType]] = defaultdict(list)
    for thing in gc.get_objects():
        if isinstance(thing, FunctionType):
            found[id(thing.__code__)].append(thing)
    return found


def in_fork(work: Any, is_heard: bool = False) -> Any:
    """What ``work`` returns, in a process of its own; ``"crashed"`` or ``"timeout"`` otherwise.

    Its errors are seen where it ``is_heard``.
    """
    sys.stdout.flush()
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        silent = os.open(os.devnull, os.O_WRONLY)
        errors = os.fdopen(os.dup(2), "w")
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        status = 1
        try:
            with os.fdopen(writing, "w") as pipe:
                json.dump(work(), pipe)
            status = 0
        except BaseException:
            if is_heard:
                traceback.print_exc(file=errors)
                errors.flush()
        finally:
            os._exit(status)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return "timeout" if os.WTERMSIG(status) == signal.SIGALRM else "crashed"
    return json.loads(text) if text else "crashed"


def outcome(item: pytest.Item, following: pytest.Item | None) -> str:
    """Run one test: ``passed``, ``failed`` or ``skipped``."""
    reports = runtestprotocol(item, nextitem=following, log=False)
    for report in reports:
        if report.outcome != "passed":
            return str(report.outcome)
    return "passed"


def profile(items: list[pytest.Item], seconds: float) -> dict[str, Any]:
    """Time of each test, and what it calls; those that fail, skip or take too long are dropped."""

    class TooLong(BaseException):
        pass

    def ring(number: int, frame: object) -> None:
        raise TooLong

    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, ring)
    times: dict[str, float] = {}
    calls: dict[str, list[str]] = {}
    dropped: dict[str, str] = {}
    for item in items:
        watch = Watch()
        sys.setprofile(watch)
        signal.setitimer(signal.ITIMER_REAL, seconds)
        begin = time.perf_counter()
        try:
            # each test by itself, as if it were the last: what it sets up it tears down
            result = outcome(item, None)
        except TooLong:
            result = f"takes more than {seconds:g} s"
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            sys.setprofile(None)
        if result == "passed":
            times[item.nodeid] = time.perf_counter() - begin
            calls[item.nodeid] = sorted(watch.seen)
        else:
            dropped[item.nodeid] = result
    return {"times": times, "calls": calls, "dropped": dropped}


def attack(
    mutant: Mutant,
    items: list[tuple[pytest.Item, float]],
    bound: dict[int, list[FunctionType]],
) -> tuple[str, str]:
    """Whether one of the tests kills the mutant, and which; each has its own time limit."""
    original = getattr(import_module(f"railquake.{mutant.module}"), mutant.function)
    for function in bound[id(original.__code__)]:
        function.__code__ = mutant.code
        function.__defaults__ = mutant.defaults
    order = [item for item, _ in items]
    for (item, limit), following in zip(items, [*order[1:], None], strict=True):
        signal.setitimer(signal.ITIMER_REAL, limit)  # its default action ends the process
        if outcome(item, following) != "passed":
            return "killed", item.nodeid
    return "survived", ""


def table(rows: list[dict[str, Any]]) -> tuple[str, float]:
    """Figures of each module, and the share killed of all, in percent."""
    lines = [
        f"{'module':<{WIDTH}}{'mutants':>8}{'killed':>8}{'survived':>10}{'untested':>10}{'share':>9}"
    ]
    groups = {
        module: [r for r in rows if r["module"] == module]
        for module in {r["module"]: 0 for r in rows}
    }
    share = 100.0
    for module, group in [*groups.items(), ("all", rows)]:
        survived = sum(r["fate"] == "survived" for r in group)
        untested = sum(r["fate"] == "untested" for r in group)
        killed = len(group) - survived - untested
        share = 100.0 * killed / max(len(group), 1)
        lines.append(
            f"{module:<{WIDTH}}{len(group):>8}{killed:>8}{survived:>10}{untested:>10}{share:>8.1f}%"
        )
    return "\n".join(lines), share


def main() -> int:
    """Command line."""
    modules = list(source_files())
    parser = argparse.ArgumentParser(description="Mutation testing of physics and march.")
    parser.add_argument("--module", action="append", choices=modules, help="only these modules")
    parser.add_argument("--function", action="append", help="only these functions")
    parser.add_argument("--every", type=int, default=1, help="only every n-th mutant: a sample")
    parser.add_argument("--seconds", type=float, default=8.0, help="longest test that is used")
    parser.add_argument("--least", type=float, default=85.0, help="share to be killed, percent")
    parser.add_argument("--out", type=Path, help="JSON file of all mutants and their fates")
    parser.add_argument("--tests", action="append", help="only these tests")
    options = parser.parse_args()
    options.module = options.module or modules
    # caches of its own: a mutant's contact table must not be found again later
    cache = tempfile.mkdtemp(prefix="railquake-mutants-")
    os.environ["RAILQUAKE_CACHE_DIR"] = cache
    os.chdir(ROOT)
    sys.path.insert(0, str(ROOT / "src"))
    from hypothesis import Phase, settings

    settings.register_profile(
        "mutants",
        derandomize=True,
        database=None,
        max_examples=40,
        phases=(Phase.explicit, Phase.generate),
    )
    settings.load_profile("mutants")
    campaign = Campaign(options)
    try:
        pytest.main(
            ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--no-header", "--capture=no",
             *(options.tests or TESTS)],
            plugins=[campaign],
        )  # fmt: skip
    finally:
        shutil.rmtree(cache, ignore_errors=True)
    figures, share = table(campaign.rows)
    print(figures)
    return 0 if share >= options.least else 1


if __name__ == "__main__":
    raise SystemExit(main())
