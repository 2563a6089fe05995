"""The table of the hero scene: how many CPU seconds each renderer takes for how much noise, and what it leaves out.

Every renderer makes K pictures, its chunks, of about as many CPU seconds each from independent seeds, one renderer
after another on the same machine. Over the pixels that see more than the bare sky, V being the variance between the
chunks of a pixel, A and B the means of every other chunk, R the reference and R_1, R_2 its halves, all of them RGB
vectors and V summed over RGB:

    Cost   = V / (|R|^2 + 0.02^2) x CPU seconds of a chunk     the CPU seconds to a relative variance of 1
    relMSE = |I - R|^2 / (|R|^2 + 0.02^2)                      of one chunk I against the reference
    off^2  = (A - R_1) . (B - R_2) / (|R|^2 + 0.02^2)          what noise does not explain: bias and missing light

Cost and relMSE are means over pixels, means without the worst 1 % of them, and medians. Cost knows of the reference in
its denominator only: light that a renderer never finds costs it nothing, and single bright pixels are in V where a
chunk has met one. So `off` and the ratio of the means stand beside it. `off` is the mean without the 1 % of pixels with
most noise, and an upper bound (two standard errors) where it is not above noise; a reference that is given has no
halves, and its noise is in it. A median of variances of four chunks is 0.79 of the true one (chi-square), for all
renderers.

CPU seconds are user and system time. floe's are those of its whole process: start, reading, building and writing too.
Those of Mitsuba and LuxCore are without reading and compiling, those of Cycles without reading.
"""

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from chunks import read_exr
from scene import SUNS, Scene

FOLDER = Path(__file__).resolve().parent
# What is imported, and what to install; the versions are those of the published table.
PACKAGES = {
    "floe": ("OpenEXR", "OpenEXR==3.5.3"),
    "mitsuba": ("mitsuba", "mitsuba==3.9.1"),
    "cycles": ("bpy", "bpy==5.0.1 OpenEXR==3.5.3"),
    "luxcore": ("pyluxcore", "pyluxcore==2.11.2"),
}
TITLES = {"disc": "With the sun", "none": "Sky only", "wide": "With a sun 10 degrees wide"}
FLOOR = 0.02**2
# Seeds of chunks are small.
REFERENCE_SEED = 1000


@dataclass
class Run:
    """Chunks of one renderer and what it says of them."""

    name: str
    chunks: np.ndarray
    version: str
    samples: int
    seconds: np.ndarray
    load: float

    @staticmethod
    def read(name, folder, load):
        """From the folder that the renderer's script filled."""
        report = json.loads((folder / "report.json").read_text())
        chunks = [np.load(folder / f"chunk_{k}.npy").astype(np.float64) for k in range(len(report["seconds"]))]
        return Run(name, np.array(chunks), report["version"], report["samples"], np.array(report["seconds"]), load)


def main():
    arguments = read_arguments()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.folder or Path(temporary)
        print(f"{processor()}, {arguments.threads} thread(s), load average {os.getloadavg()[0]:.1f} at the start\n")
        for sun in arguments.suns.split(","):
            seconds = arguments.sky_seconds if sun == "none" else arguments.seconds
            halves = the_reference(arguments, sun, folder)
            runs = [rendered(arguments, name, sun, seconds, folder) for name in arguments.renderers.split(",")]
            runs = [run for run in runs if run]
            print(f"### {TITLES[sun]}\n\n{table(Scene(sun), runs, halves)}\n", flush=True)


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--renderers", default=",".join(PACKAGES), help="each with a mode if wanted: floe:path")
    parser.add_argument("--suns", default="disc,none", help=f"some of {', '.join(SUNS)}")
    parser.add_argument("--seconds", default=45.0, type=float, help="of CPU time, a chunk with the sun")
    parser.add_argument("--sky-seconds", default=15.0, type=float, help="the same without the sun")
    parser.add_argument("--chunks", default=4, type=int)
    parser.add_argument("--threads", default=1, type=int)
    parser.add_argument("--reference", type=Path, help="an EXR of the scene with the sun; floe renders one without it")
    parser.add_argument("--reference-mode", default="photon", help="floe's integrator for it, under the sun")
    parser.add_argument("--reference-seconds", default=240.0, type=float, help="a quarter of it without the sun")
    parser.add_argument("--folder", type=Path, help="keeps the pictures; what is there already is not rendered again")
    arguments = parser.parse_args()
    if arguments.chunks < 2:
        parser.error("--chunks: one picture has no variance")
    for entry in arguments.renderers.split(","):
        if entry.split(":")[0] not in PACKAGES:
            parser.error(f"--renderers: {entry} is none of {', '.join(PACKAGES)}")
    for sun in arguments.suns.split(","):
        if sun not in SUNS:
            parser.error(f"--suns: {sun} is none of {', '.join(SUNS)}")
    return arguments


def the_reference(arguments, sun, folder):
    """Two halves of the picture that others are held against: of another seed, and another estimator under the sun."""
    if arguments.reference and sun == "disc":
        return np.array([read_exr(arguments.reference)] * 2)
    seconds = arguments.reference_seconds / (4 if sun == "none" else 1) / 2
    mode = "path" if sun == "none" else arguments.reference_mode
    place = folder / sun / "reference"
    run = script("floe", mode, sun, seconds, arguments, place, chunks=2, seed=REFERENCE_SEED)
    if run is None:
        raise SystemExit("no reference, since floe does not run: give one by --reference")
    return run.chunks


def rendered(arguments, entry, sun, seconds, folder):
    """The chunks of a renderer, or nothing where it is not installed."""
    name, _, mode = entry.partition(":")
    if name == "mitsuba" and not mode and "DRJIT_LIBLLVM_PATH" not in os.environ:
        say("mitsuba: scalar_rgb, since DRJIT_LIBLLVM_PATH does not name a libLLVM.so of 16 or later")
        mode = "scalar_rgb/volpathmis"
    place = folder / sun / entry.replace(":", "_").replace("/", "_")
    return script(name, mode, sun, seconds, arguments, place, arguments.chunks, seed=1)


def script(name, mode, sun, seconds, arguments, place, chunks, seed):
    """Runs one of the scripts beside this one; nothing where that is not possible, which is told."""
    module, packages = PACKAGES[name]
    if importlib.util.find_spec(module) is None:
        say(f"{name} is left out: {module} is not installed, pip install {packages}")
        return None
    if not (place / "report.json").exists():
        command = [sys.executable, FOLDER / f"by_{name}.py", "--sun", sun, "--seconds", seconds, "--chunks", chunks]
        command += ["--threads", arguments.threads, "--seed", seed, "--output", place]
        command += ["--mode", mode] if mode else []
        say(f"{sun}: {name} {mode}")
        started = time.monotonic()
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
        if done.returncode:
            say(f"{name} {mode} is left out, it failed:\n{done.stdout[-1000:]}\n{done.stderr[-1000:]}")
            return None
        say(f"    {time.monotonic() - started:.0f} s, load average {os.getloadavg()[0]:.1f}")
    return Run.read(f"{name} {mode}".strip(), place, os.getloadavg()[0])


def table(scene, runs, halves):
    """Markdown."""
    reference = halves.mean(axis=0)
    seen = (np.abs(reference / scene.sky - 1) > 1e-4).any(axis=2)
    scale = 1 / ((reference**2).sum(axis=2) + FLOOR)
    columns = ["renderer", "samples", "CPU s", "Cost mean / trimmed / median", "relMSE mean / trimmed / median"]
    columns += ["off", "mean / reference", "load"]
    lines = [f"| {' | '.join(columns)} |", f"|{'---|' * len(columns)}"]
    for run in runs:
        variance = run.chunks.var(axis=0, ddof=1).sum(axis=2)
        costs = np.array(three((variance * scale)[seen])) * run.seconds.mean()
        errors = np.mean([three((((c - reference) ** 2).sum(axis=2) * scale)[seen]) for c in run.chunks], axis=0)
        cells = [f"{run.name} ({run.version})", f"{run.samples}", f"{run.seconds.mean():.1f}"]
        cells += [f"{joined(costs)} (+- {100 * spread(run, scale, seen):.0f} %)", joined(errors)]
        cells += [off(run, halves, scale, seen), ratio(run, reference, seen), f"{run.load:.1f}"]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def three(values):
    """Mean, mean without the worst 1 %, median."""
    ordered = np.sort(values)
    return ordered.mean(), ordered[: -(len(ordered) // 100)].mean(), np.median(ordered)


def spread(run, scale, seen):
    """The relative standard error of the trimmed cost, by leaving out one chunk at a time."""
    if len(run.chunks) < 3:
        return float("nan")
    left = [np.delete(run.chunks, k, 0).var(axis=0, ddof=1).sum(axis=2) for k in range(len(run.chunks))]
    left = np.array([three((variance * scale)[seen])[1] for variance in left])
    return np.sqrt((len(left) - 1) * left.var()) / left.mean()


def off(run, halves, scale, seen):
    """The root of what noise does not explain of the difference to the reference, in percent."""
    first, second = run.chunks[::2], run.chunks[1::2]
    if len(second) < 2:
        return "-"
    squares = ((first.mean(axis=0) - halves[0]) * (second.mean(axis=0) - halves[1])).sum(axis=2)
    # The noise within the halves says nothing of the sign of their errors: to leave pixels out by it favours nobody.
    noise = first.var(axis=0).sum(axis=2) + second.var(axis=0).sum(axis=2)
    kept = np.argsort((noise * scale)[seen])[: -(seen.sum() // 100)]
    squares = (squares * scale)[seen][kept]
    error = squares.std() / np.sqrt(len(squares))
    if squares.mean() < 2 * error:
        return f"< {100 * np.sqrt(max(squares.mean(), 0) + 2 * error):.1f} %"
    return f"{100 * np.sqrt(squares.mean()):.1f} %"


def ratio(run, reference, seen):
    """Of the means of the pixels that count, RGB, with the greatest of their standard errors."""
    means = run.chunks[:, seen].mean(axis=1) / reference[seen].mean(axis=0)
    error = means.std(axis=0, ddof=1).max() / np.sqrt(len(means))
    return f"{' '.join(f'{m:.3f}' for m in means.mean(axis=0))} (+- {error:.3f})"


def joined(values):
    """Three digits of each."""
    return " / ".join(f"{v:.3g}" for v in values)


def processor():
    """The processor's name."""
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown processor")


def say(text):
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
