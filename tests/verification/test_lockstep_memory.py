"""However many scenarios there are, no more than a few are held at a time."""

import importlib.util
from pathlib import Path

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "lockstep_memory.py"


def test_memory_does_not_grow_with_the_number_of_scenarios():
    """A thousand against a hundred; the benchmark does ten thousand against a thousand."""
    spec = importlib.util.spec_from_file_location("lockstep_memory", BENCHMARK)
    benchmark = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(benchmark)
    few, _ = benchmark.peak_of(100)
    many, _ = benchmark.peak_of(1000)
    assert many < 1.1 * few
