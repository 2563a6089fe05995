"""Time to equal error on turbid wavy water: floe against Mitsuba 3 (`volpathmis`).

Both render the reference scene `s06_turbid_wavy` some K times from independent seeds, in turns. The pictures of one
renderer give the variance V of the luminance of every pixel, those of all together its mean L, and from these

    e^2 = mean over pixels of V / (L^2 + 0.02^2),      Cost = e^2 x CPU seconds

(the relative error of floe's ledger, squared). Cost does not depend on the number of samples where variance falls as
1 / n; the time to an error e is Cost / e^2. The mean is what single bright pixels rule, so it stands beside the mean
without the worst 1 % of the pixels, and the median. L is not that of the same few pictures: where a bright sample makes
a pixel's V great it would make L great as well, and hide itself.

CPU seconds are user and system time. Mitsuba's are those of its render call after a first one of the same size, which
compiles and builds: neither is counted. floe's are those of its whole process: start, reading, building and writing too.

Both pictures' block means are held against the reference's (`s06_turbid_wavy.json`) before anything is printed.
"""

import argparse
import json
import multiprocessing
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
NAME = "s06_turbid_wavy"
REC_709 = np.array([0.2126, 0.7152, 0.0722])
FLOOR = 0.02**2
WIDTH, HEIGHT = 96, 72


class Floe:
    """The floe binary, one process a picture."""

    def __init__(self, arguments, folder):
        self.name = "floe"
        self.samples = arguments.floe_samples
        self.command = [arguments.floe, "render", arguments.scenes / f"{NAME}.toml", "--quiet"]
        self.command += ["--samples", str(self.samples), "--threads", str(arguments.threads)]
        self.picture = folder / "floe.exr"

    def render(self, seed):
        """Picture and CPU seconds."""
        started = children_seconds()
        command = [*self.command, "--seed", str(seed), "--output", self.picture]
        subprocess.run(command, check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        return read_exr(self.picture), children_seconds() - started

    def stop(self):
        """Nothing is left running."""


class Mitsuba:
    """One variant of Mitsuba, in a process of its own: two variants in one may wait for each other for ever."""

    def __init__(self, variant, samples, arguments):
        self.name, self.samples = variant, samples
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        work = (other, variant, samples, arguments.scenes, arguments.threads)
        context.Process(target=serve_mitsuba, args=work, daemon=True).start()
        # With this end closed here, a variant that dies is an error instead of a wait.
        other.close()
        self.render(0)

    def render(self, seed):
        """Picture and CPU seconds."""
        self.pipe.send(seed)
        return self.pipe.recv()

    def stop(self):
        """Lets the process end."""
        self.pipe.send(None)


def serve_mitsuba(pipe, variant, samples, folder, threads):
    """Renders the seeds that come through the pipe."""
    import drjit
    import mitsuba as mi

    drjit.set_thread_count(threads)
    mi.set_variant(variant)
    scene = mi.load_dict(scene_of(mi, folder))
    while (seed := pipe.recv()) is not None:
        started = time.process_time()
        picture = np.array(mi.render(scene, spp=samples, seed=seed), dtype=np.float64)
        pipe.send((picture[..., :3], time.process_time() - started))


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def read_exr(path):
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    picture = mi.Bitmap(str(path))
    names = [field.name for field in picture.struct_()]
    return np.array(picture, dtype=np.float64)[..., [names.index(c) for c in "RGB"]]


def scene_of(mi, folder):
    """`s06_turbid_wavy.toml` in Mitsuba's terms. Normals point into the exterior."""

    def rgb(*value):
        return {"type": "rgb", "value": list(value)}

    def mesh(name, **rest):
        return {"type": "ply", "filename": str(folder / f"{NAME}__{name}.ply"), "face_normals": True, **rest}

    def diffuse(*reflectance):
        return {"type": "diffuse", "reflectance": rgb(*reflectance)}

    scattering = np.array([0.5, 0.7, 1.0])
    extinction = scattering + [1.5, 0.3, 0.15]
    water = {
        "type": "homogeneous",
        # Colours above 1 are not allowed: the greatest is the scale.
        "sigma_t": rgb(*(extinction / extinction.max())),
        "scale": extinction.max(),
        "albedo": rgb(*(scattering / extinction)),
        "phase": {"type": "hg", "g": 0.85},
    }
    interface = {"type": "dielectric", "int_ior": 1.33, "ext_ior": 1.0}
    look = mi.ScalarTransform4f().look_at(origin=[1.5, 2.9, 2.5], target=[0, 0.75, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "pixel_format": "rgb"}
    film |= {"component_format": "float32", "rfilter": {"type": "box"}}
    return {
        "type": "scene",
        # Its roulette keeps at most 0.95 of the paths a bounce from the fifth on: unbiased.
        "integrator": {"type": "volpathmis", "max_depth": -1, "rr_depth": 5},
        "sensor": {
            "type": "perspective",
            "to_world": look,
            "fov": 46,
            "fov_axis": "x",
            "near_clip": 1e-3,
            "film": film,
            "sampler": {"type": "independent"},
        },
        "sky": {"type": "constant", "radiance": rgb(0.4, 0.5, 0.7)},
        "floor": mesh("floor", bsdf=diffuse(0.7, 0.6, 0.5)),
        "walls": mesh("walls", bsdf=diffuse(0.5, 0.5, 0.5)),
        "surface": mesh("surface", bsdf=interface, interior=water),
        "sun": mesh("sun", bsdf=diffuse(0, 0, 0), emitter={"type": "area", "radiance": rgb(40, 36, 30)}),
    }


def block_means(pictures):
    return pictures.reshape(-1, 3, HEIGHT // 3, 4, WIDTH // 4, 3).mean(axis=(2, 4))


def check(name, pictures, folder):
    """Block means against the reference's: the root mean square of their z, and the picture's ratio."""
    reference = json.loads((folder / f"{NAME}.json").read_text())
    reference = reference.get("reference", reference)
    blocks = block_means(pictures)
    own = blocks.var(axis=0, ddof=1) / len(blocks)
    off = blocks.mean(axis=0) - np.array(reference["blocks_mean"])
    z = off / np.sqrt(own + np.array(reference["blocks_se"]) ** 2)
    ratio = pictures.mean(axis=(0, 1, 2)) / np.array(reference["mean_rgb"])
    print(f"{name:14} mean / reference {ratio.round(4)}, blocks' z: rms {np.sqrt((z**2).mean()):.2f}")
    # Each z is Student's with K - 1 degrees of freedom; 1.8 is far above any root mean square of 36 of them by chance.
    if np.sqrt((z**2).mean()) > 1.8:
        sys.exit(f"{name} renders another scene")


def errors(pictures, luminance):
    """e^2 of one picture: mean, mean without the worst 1 %, median."""
    relative = (pictures @ REC_709).var(axis=0, ddof=1) / (luminance**2 + FLOOR)
    ordered = np.sort(relative.ravel())
    return np.array([ordered.mean(), ordered[: -len(ordered) // 100].mean(), np.median(ordered)])


def spread(pictures, luminance, seconds):
    """Costs and their standard errors, by leaving out one picture at a time."""
    costs = errors(pictures, luminance) * np.mean(seconds)
    left = np.array([errors(np.delete(pictures, k, 0), luminance) for k in range(len(pictures))])
    left *= np.array([[np.delete(seconds, k).mean()] for k in range(len(pictures))])
    return costs, np.sqrt((len(left) - 1) * left.var(axis=0))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--floe", default=ROOT / "target/release/floe", type=Path)
    parser.add_argument("--scenes", default=ROOT / "tests/data/reference", type=Path)
    parser.add_argument("--samples", default=64, type=int, help="a pixel, of Mitsuba")
    parser.add_argument("--floe-samples", type=int, help="a pixel, of floe; --samples without it")
    parser.add_argument("--seeds", default=16, type=int, help="pictures of each renderer, at least 8")
    parser.add_argument("--threads", default=1, type=int)
    parser.add_argument("--variants", default="llvm_ad_rgb,scalar_rgb")
    arguments = parser.parse_args()
    arguments.floe_samples = arguments.floe_samples or arguments.samples
    if arguments.seeds < 8:
        parser.error("--seeds: a variance of fewer than 8 pictures says too little")

    renderers = [Mitsuba(v, arguments.samples, arguments) for v in arguments.variants.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        renderers.insert(0, Floe(arguments, Path(folder)))
        runs = {r.name: ([], []) for r in renderers}
        for seed in range(1, arguments.seeds + 1):
            for renderer in renderers:
                picture, seconds = renderer.render(seed)
                runs[renderer.name][0].append(picture)
                runs[renderer.name][1].append(seconds)

    for renderer in renderers:
        renderer.stop()
    runs = {name: (np.array(p), np.array(s)) for name, (p, s) in runs.items()}
    for name, (pictures, _) in runs.items():
        check(name, pictures, arguments.scenes)
    report(arguments, renderers, runs)


def report(arguments, renderers, runs):
    """The costs, and how many times as long as floe the others take for the same error."""
    threads = f"{arguments.threads} thread{'s' if arguments.threads > 1 else ''}"
    print(f"\n{arguments.seeds} seeds, {threads}; cost = e^2 x CPU seconds; +- one standard error")
    print(f"{'':22} {'samples':>8} {'CPU s':>7} {'e':>7}{'cost: mean':>20}{'trimmed 1 %':>20}{'median':>20}")
    luminance = np.mean([p.mean(axis=0) for p, _ in runs.values()], axis=0) @ REC_709
    costs = {}
    for renderer in renderers:
        pictures, seconds = runs[renderer.name]
        cost, error = spread(pictures, luminance, seconds)
        costs[renderer.name] = cost, error / cost
        cells = "".join(f"{c:12.3g} +- {100 * e:2.0f} %" for c, e in zip(cost, error / cost))
        e = np.sqrt(errors(pictures, luminance)[0])
        print(f"{renderer.name:22} {renderer.samples:8} {seconds.mean():7.3f} {e:7.4f}{cells}")
    own, own_error = costs.pop("floe")
    for name, (cost, error) in costs.items():
        uncertain = 100 * np.hypot(error, own_error)
        cells = "".join(f"{r:12.2f} +- {e:2.0f} %" for r, e in zip(cost / own, uncertain))
        print(f"{name + ' / floe':47}{cells}")


if __name__ == "__main__":
    main()
