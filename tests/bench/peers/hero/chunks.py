"""What the scripts of all renderers share: their command line, and pictures of about so many CPU seconds each.

Each picture, a chunk, is independent of the others: another seed, nothing kept. A trial finds how many samples a pixel
take the time; then every chunk has as many. CPU seconds are user and system time of all threads while a chunk renders,
those of child processes included.
"""

import argparse
import json
import resource
import time
from pathlib import Path

import numpy as np

from scene import SUNS, Scene


def run(name, modes, prepare):
    """Renders the chunks. `prepare(scene, arguments)` is a renderer's version and its function of samples and seed."""
    parser = argparse.ArgumentParser(description=f"The hero scene by {name}.")
    parser.add_argument("--mode", default=modes[0], help=f"one of {', '.join(modes)}")
    parser.add_argument("--sun", default="disc", choices=SUNS)
    parser.add_argument("--chunks", default=4, type=int)
    parser.add_argument("--seconds", default=60.0, type=float, help="of CPU time, a chunk")
    parser.add_argument("--samples", type=int, help="a pixel, instead of --seconds")
    parser.add_argument("--seed", default=1, type=int, help="of the first chunk")
    parser.add_argument("--threads", default=1, type=int)
    parser.add_argument("--output", default=Path("."), type=Path, help="the folder of the chunks and report.json")
    arguments = parser.parse_args()
    if arguments.mode not in modes:
        parser.error(f"--mode {arguments.mode}: {name} has {', '.join(modes)}")
    arguments.output.mkdir(parents=True, exist_ok=True)

    scene = Scene(arguments.sun)
    version, render = prepare(scene, arguments)
    samples = arguments.samples or trial(render, arguments)
    times = []
    for chunk in range(arguments.chunks):
        picture, seconds = timed(render, samples, arguments.seed + chunk)
        np.save(arguments.output / f"chunk_{chunk}.npy", picture.astype(np.float32))
        times.append(seconds)
        print(f"{name} {arguments.mode} {chunk}: {seconds:.1f} CPU s, mean {mean(picture)}", flush=True)
    report = {"version": version, "samples": samples, "seconds": times}
    (arguments.output / "report.json").write_text(json.dumps(report))


def trial(render, arguments):
    """Samples a pixel that take the CPU seconds wanted, found from ever longer runs, the last an eighth of them or more."""
    samples, fewer, sooner = 1, 0, 0.0
    while True:
        # A seed that no chunk has.
        seconds = timed(render, samples, arguments.seed + arguments.chunks)[1]
        more = arguments.seconds / max(seconds, 1e-3)
        if more <= 8:
            # What is made ready before the first sample takes no longer for more of them.
            each = (seconds - sooner) / (samples - fewer) if seconds > 1.5 * sooner else seconds / samples
            return max(1, round(samples + (arguments.seconds - seconds) / each))
        fewer, sooner = samples, seconds
        # A step is never as long as it seems to allow.
        samples = max(samples + 1, round(samples * min(more / 4, 16)))
        if samples > 1_000_000:
            raise SystemExit(f"{samples} samples would take no time: it does not render")


def timed(render, samples, seed):
    """Picture and CPU seconds."""
    started = cpu_seconds()
    picture = render(samples, seed)
    return np.asarray(picture, dtype=np.float64), cpu_seconds() - started


def cpu_seconds():
    """Of this process and its children that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def mean(picture):
    """Mean RGB as text."""
    return " ".join(f"{c:.4f}" for c in picture.mean(axis=(0, 1)))


def read_exr(path):
    """RGB of an OpenEXR file."""
    import OpenEXR

    channels = OpenEXR.File(str(path)).channels()
    packed = next((channels[c].pixels for c in ("RGBA", "RGB") if c in channels), None)
    if packed is None:
        packed = np.stack([channels[c].pixels for c in "RGB"], axis=-1)
    return packed[..., :3].astype(np.float64)
