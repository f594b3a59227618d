"""Peak memory of ``simulate_many`` over 1,000 and over 10,000 scenarios of 1 s: it must not grow.

    python benchmarks/lockstep_memory.py [FEW MANY]

Each count runs in a process of its own; prints both peaks, their ratio and what each run costs.
"""

import resource
import subprocess
import sys
import time

MOTION = {"duration": "1 s", "dt": "0.01 s", "pga": "0.6 g", "highpass_frequency": "1 Hz"}


def run(count):
    """Run ``count`` scenarios, drawn as they are needed; peak memory (MiB) and seconds."""
    import railquake as rq

    def scenarios(first, count):
        for k in range(first, first + count):
            hinge = ("bouc-wen", "elastic")[k % 2]
            yield rq.scenario(synthetic={**MOTION, "seed": k}, hinge=hinge, dt="1e-4 s")

    for _ in rq.simulate_many(scenarios(0, 100)):
        pass  # kernels and tables are there from now on
    begin = time.perf_counter()
    rows = sum(1 for _ in rq.simulate_many(scenarios(100, count)))
    spent = time.perf_counter() - begin
    assert rows == count
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0, spent


def peak_of(count):
    """`run` in a process of its own."""
    command = [sys.executable, __file__, "--one", str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    memory, spent = map(float, done.stdout.split())
    return memory, spent


def main():
    if sys.argv[1:2] == ["--one"]:
        print(*run(int(sys.argv[2])))
        return
    few, many = map(int, sys.argv[1:3] or (1_000, 10_000))
    (small, small_s), (large, large_s) = peak_of(few), peak_of(many)
    print(f"{few:6} scenarios: {small:7.1f} MiB, {1e3 * small_s / few:.2f} ms each")
    print(f"{many:6} scenarios: {large:7.1f} MiB, {1e3 * large_s / many:.2f} ms each")
    print(f"memory, ratio: {large / small:.3f}")


if __name__ == "__main__":
    main()
