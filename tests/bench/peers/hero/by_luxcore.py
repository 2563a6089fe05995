"""The hero scene by LuxCore.

Its media have priorities: the closed ice stands in the water, whose surface has a lid over the hole, and wins there.

What cannot be expressed is the phase function of the water. LuxCore has Schlick's approximation of Henyey-Greenstein's,
which at the same g is much narrower; the g here is the one with which the mean cosine is right:

    p = (1 - k^2) / (4 pi (1 - k cos)^2),    k = 1.55 g - 0.55 g^3
    mean cosine = 1 / k - (1 - k^2) / (2 k^2) ln((1 + k) / (1 - k))

Its engines take one number for where a ray scatters and which way it goes at the next interface. In a medium that is
`homogeneous` both then depend on each other, and a white body of ice in white light is 20 % too dark. One that is
`heterogeneous`, in a single step, is the same medium with numbers of its own, and right.

Vertex merging loses light: with a sun of 10 degrees a tenth of the picture's mean at the radius that LuxCore chooses, 1 %
at a sixth of it. Under the scene's own sun a third and more of the ice's is missing.

The sun is its `sun`, whose disc is met by paths through water (those of `distant` never are); its colour is that of a
sun in air, so its radiance is measured in one pixel first, and set.
"""

import math
import time

import numpy as np

from chunks import run
from scene import Mesh

# Bidirectional path tracing with vertex merging, from its own radius on and from a sixth of it, without; path tracing.
MODES = ("BIDIRVMCPU", "BIDIRVMCPU/0.0005", "BIDIRCPU", "PATHCPU")
# In metres, longer than any way through the scene.
ONE_STEP = 100.0
# Radius over distance of LuxCore's sun of relative size 1.
SUN_SINE = 695500 / 149600000


def prepare(scene, arguments):
    """Version and renderer."""
    import pyluxcore

    pyluxcore.Init()
    suns = [1.0, 1.0, 1.0]
    if scene.sun:
        suns = (scene.sun_radiance / radiance_of_the_sun(pyluxcore, scene, arguments)).tolist()
    built = pyluxcore.Scene()
    built.Parse(properties(pyluxcore, described(scene, suns)))
    define(built, scene, pyluxcore)

    def render(samples, seed):
        settings = engine(scene, arguments, seed) | {"batch.haltspp": samples}
        return picture_of(pyluxcore, built, settings, scene.width, scene.height)

    return pyluxcore.Version(), render


def properties(pyluxcore, values):
    """LuxCore's settings of a dictionary of them."""
    made = pyluxcore.Properties()
    for key, value in values.items():
        # Whole numbers in a list would be no coordinates to it.
        made.Set(pyluxcore.Property(key, [float(v) for v in value] if isinstance(value, list) else value))
    return made


def engine(scene, arguments, seed):
    """How it renders: a box of a pixel as the filter, and the film as it is."""
    kind, _, radius = arguments.mode.partition("/")
    values = {"bidirvm.startradius.scale": float(radius)} if radius else {}
    return values | {
        "renderengine.type": kind,
        "renderengine.seed": seed,
        "native.threads.count": arguments.threads,
        "sampler.type": "RANDOM" if kind == "BIDIRVMCPU" else "SOBOL",
        "film.width": scene.width,
        "film.height": scene.height,
        "film.filter.type": "NONE",
        "film.imagepipelines.0.0.type": "NOP",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr",
        "path.pathdepth.total": scene.depth,
        "path.pathdepth.diffuse": scene.depth,
        "path.pathdepth.glossy": scene.depth,
        "path.pathdepth.specular": scene.depth,
        "path.clamping.variance.maxvalue": 0,
        "path.maxdepth": scene.depth,
        "light.maxdepth": scene.depth,
    }


def picture_of(pyluxcore, built, settings, width, height):
    """The film when all samples are taken."""
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(pyluxcore, settings), built))
    session.Start()
    while not session.HasDone():
        time.sleep(0.02)
        session.UpdateStats()
    session.Stop()
    picture = np.zeros((height, width, 3), np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, picture, 0)
    # Its first row is the lowest.
    return picture[::-1]


def described(scene, suns):
    """Camera, lights, media and materials."""
    camera = scene.camera
    half = scene.height / scene.width
    # Its film is one row higher than its camera's.
    row = 2 / scene.width
    values = {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": camera["eye"],
        "scene.camera.lookat.target": camera["target"],
        "scene.camera.up": camera["up"],
        "scene.camera.screenwindow": [-1.0, 1.0, -half - row, half - row],
        "scene.camera.fieldofview": camera["horizontal_fov"],
        "scene.camera.autofocus.enable": False,
        "scene.lights.sky.type": "constantinfinite",
        "scene.lights.sky.color": scene.sky.tolist(),
    }
    if scene.sun:
        values |= sun(scene, suns)
    # The order of the media in the scene is that of their priorities. Media and materials share their names.
    for priority, name in enumerate(scene.media, 1):
        absorption, scattering = scene.coefficients(name)
        values |= {
            f"scene.volumes.{name}.type": "heterogeneous",
            f"scene.volumes.{name}.steps.size": ONE_STEP,
            f"scene.volumes.{name}.steps.maxcount": 1,
            f"scene.volumes.{name}.absorption": absorption.tolist(),
            f"scene.volumes.{name}.scattering": scattering.tolist(),
            f"scene.volumes.{name}.asymmetry": [schlick(scene.asymmetry(name))] * 3,
            f"scene.volumes.{name}.multiscattering": True,
            f"scene.volumes.{name}.ior": scene.ior(name),
            f"scene.volumes.{name}.priority": priority,
            f"scene.materials.{name}_glass.type": "glass",
            f"scene.materials.{name}_glass.kr": [1.0] * 3,
            f"scene.materials.{name}_glass.kt": [1.0] * 3,
            f"scene.materials.{name}_glass.volume.interior": name,
        }
    for name in ("sand", "walls"):
        values |= {
            f"scene.materials.{name}.type": "matte",
            f"scene.materials.{name}.kd": scene.reflectance(name).tolist(),
        }
    return values


def sun(scene, gains):
    """LuxCore's sun."""
    return {
        "scene.lights.sun.type": "sun",
        "scene.lights.sun.dir": scene.sun["direction"],
        "scene.lights.sun.relsize": math.sin(scene.half_angle) / SUN_SINE,
        "scene.lights.sun.gain": gains,
    }


def define(built, scene, pyluxcore):
    """Bodies: water with its lid, ice above it in priority, sand and walls."""
    ice, _ = scene.ice()
    bodies = {"surface": ("water_glass", scene.mesh("water_air")), "lid": ("water_glass", scene.lid())}
    bodies["ice"] = ("ice_glass", ice)
    bodies |= {name: (name, scene.mesh(name)) for name in ("sand", "walls")}
    for name, (material, mesh) in bodies.items():
        place(built, name, material, mesh, pyluxcore)


def place(built, name, material, mesh, pyluxcore):
    """A mesh of a material."""
    normals = None if mesh.normals is None else list(map(tuple, mesh.normals.tolist()))
    points, triangles = list(map(tuple, mesh.points.tolist())), list(map(tuple, mesh.triangles.tolist()))
    built.DefineMesh(name, points, triangles, normals, None, None, None)
    keys = {f"scene.objects.{name}.ply": name, f"scene.objects.{name}.material": material}
    built.Parse(properties(pyluxcore, keys))


def schlick(mean):
    """The g of LuxCore's phase function of this mean cosine, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        g = (low + high) / 2
        k = 1.55 * g - 0.55 * g**3
        cosine = 1 / k - (1 - k * k) / (2 * k * k) * math.log((1 + k) / (1 - k)) if k > 1e-2 else 2 * k / 3
        low, high = (g, high) if cosine < mean else (low, g)
    return low if mean else 0.0


def radiance_of_the_sun(pyluxcore, scene, arguments):
    """Of a gain of 1, from the middle of its disc, RGB."""
    direction = np.array(scene.sun["direction"])
    built = pyluxcore.Scene()
    looking = {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": [0.0, 0.0, 0.0],
        "scene.camera.lookat.target": direction.tolist(),
        "scene.camera.up": [0.0, 1.0, 0.0],
        # Degrees: well within the disc.
        "scene.camera.fieldofview": 0.01,
        "scene.camera.autofocus.enable": False,
        "scene.materials.black.type": "matte",
        "scene.materials.black.kd": [0.0] * 3,
    }
    built.Parse(properties(pyluxcore, looking | sun(scene, [1.0] * 3)))
    # Something must be there, and this is behind the eye.
    behind = -np.eye(3, dtype=np.float32) - direction.astype(np.float32)
    place(built, "behind", "black", Mesh(behind, np.array([[0, 1, 2]])), pyluxcore)
    settings = engine(scene, arguments, 1) | {"renderengine.type": "PATHCPU", "sampler.type": "RANDOM"}
    settings |= {"film.width": 8, "film.height": 8, "batch.haltspp": 4}
    return picture_of(pyluxcore, built, settings, 8, 8).mean(axis=(0, 1))


if __name__ == "__main__":
    run("LuxCore", MODES, prepare)
