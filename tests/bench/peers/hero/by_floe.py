"""The hero scene by floe's command line, one process a chunk; the mode is the integrator."""

import re
import subprocess
import tempfile
from pathlib import Path

from chunks import read_exr, run
from scene import FOLDER, WIDE, Scene

FLOE = Path(__file__).resolve().parents[4] / "target/release/floe"
OWN = Scene("none").toml["render"]["integrator"]
MODES = [OWN] + [i for i in ("beams", "photon", "path") if i != OWN]


def prepare(scene, arguments):
    """Version and renderer."""
    if not FLOE.exists():
        raise SystemExit(f"{FLOE} is not there: cargo build --release")
    temporary = tempfile.TemporaryDirectory(prefix="floe_hero_")
    folder = Path(temporary.name)
    for mesh in FOLDER.glob("*.ply"):
        (folder / mesh.name).symlink_to(mesh)
    (folder / "scene.toml").write_text(described(arguments))
    version = subprocess.run([FLOE, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]

    def render(samples, seed):
        # Named by its owner here, so that the folder lives as long as this function.
        picture = Path(temporary.name) / "picture.exr"
        command = [FLOE, "render", folder / "scene.toml", "--quiet", "--output", picture]
        command += ["--samples", str(samples), "--seed", str(seed), "--threads", str(arguments.threads)]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        # Warnings that its meshes are open are no news here.
        if done.returncode:
            raise SystemExit(done.stderr)
        return read_exr(picture)

    return version, render


def described(arguments):
    """The text of `scene.toml` with the integrator and the sun asked for."""
    text = (FOLDER / "scene.toml").read_text()
    text = replaced(text, r'integrator = "[^"]*"', f'integrator = "{arguments.mode}"')
    if arguments.sun == "none":
        text = replaced(text, r"\[sun\]\n(?:[^\[\n].*\n)*", "")
    elif arguments.sun == "wide":
        text = replaced(text, r"angular_diameter = .*", f"angular_diameter = {WIDE}")
    return text


def replaced(text, pattern, by):
    """What is there once, replaced."""
    text, count = re.subn(pattern, by, text)
    if count != 1:
        raise SystemExit(f"scene.toml has {count} times {pattern}, not once")
    return text


if __name__ == "__main__":
    run("floe", MODES, prepare)
