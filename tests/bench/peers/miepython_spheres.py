"""Efficiencies of many spheres: floe against miepython, one thread each.

Both compute extinction, scattering, backscattering and asymmetry of 1000 radii at 40 wavelengths, as
`tests/bench/spheres` describes, in turns; the least user CPU seconds of some passes count. miepython is compiled by
numba, and what compiling takes is not counted. Extinction, scattering and asymmetry are compared by their sums: miepython
ends its series earlier, which leaves some 1e-6.

    python3 -m venv VENV && VENV/bin/pip install miepython==3.3.0 numba    # VENV: a folder outside of the repository
    VENV/bin/python tests/bench/peers/miepython_spheres.py
"""

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

os.environ["MIEPYTHON_USE_JIT"] = "1"

import miepython
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
RADII, WAVELENGTHS = 1000, 40
INDEX, HOST = 1.58 - 0.001j, 1.34


def of_miepython():
    """CPU seconds, and the sums."""
    radii = 0.01 * 1e4 ** ((np.arange(RADII) + 0.5) / RADII)
    started = time.process_time()
    sums = np.zeros(3)
    for i in range(WAVELENGTHS):
        sizes = 2 * np.pi * HOST * radii / (0.38 + 0.01 * i)
        extinction, scattering, _, asymmetry = miepython.efficiencies_mx(INDEX / HOST, sizes)
        sums += [extinction.sum(), scattering.sum(), asymmetry.sum()]
    return time.process_time() - started, sums


def of_floe():
    """The same, by the bench that stands beside this folder."""
    command = ["cargo", "bench", "--quiet", "--bench", "spheres"]
    printed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    words = next(line for line in printed.splitlines() if line.startswith("floe")).split()
    return float(words[1]), np.array([float(word) for word in words[2:]])


def main():
    miepython.efficiencies_mx(INDEX / HOST, np.array([1.0, 2.0]))
    of_floe()
    turns = [(of_miepython(), of_floe()) for _ in range(5)]
    for (_, theirs), (_, ours) in turns:
        if not np.allclose(theirs, ours, rtol=1e-5):
            sys.exit(f"other numbers: miepython {theirs}, floe {ours}")
    ratios = sorted(theirs[0] / ours[0] for theirs, ours in turns)
    print(f"miepython {min(t[0][0] for t in turns):.3f} s, floe {min(t[1][0] for t in turns):.3f} s")
    print(f"floe is {statistics.median(ratios):.1f} times as fast ({ratios[0]:.1f} to {ratios[-1]:.1f})")


if __name__ == "__main__":
    main()
