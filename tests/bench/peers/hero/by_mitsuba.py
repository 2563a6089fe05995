"""The hero scene by Mitsuba 3.

It takes interfaces as they are, with the media of both sides: nothing is left out or changed. The sun is a disc so far
away that its direction is the same all over the scene, since a directional emitter would never be met through water.
"""

import os

import numpy as np

from chunks import run

VARIANTS = ("llvm_ad_rgb", "scalar_rgb")
INTEGRATORS = ("volpathmis", "volpath")
# In metres: the 10 m of the scene are then 1e-4 of a radian wide.
SUN_DISTANCE = 1e5
# Samples a pixel rendered at once: a wave of 1e6 paths, whose state takes some 500 MB.
AT_ONCE = 16


def prepare(scene, arguments):
    """Version and renderer."""
    import drjit
    import mitsuba as mi

    variant, integrator = arguments.mode.split("/")
    if variant.startswith("llvm") and "DRJIT_LIBLLVM_PATH" not in os.environ:
        raise SystemExit("DRJIT_LIBLLVM_PATH is not set: llvm_ad_rgb needs the path of a libLLVM.so, 16 or later")
    drjit.set_thread_count(arguments.threads)
    mi.set_variant(variant)
    loaded = mi.load_dict(scene_of(mi, scene, integrator))

    def render(samples, seed):
        total, done = 0.0, 0
        for part in range(-(-samples // AT_ONCE)):
            count = min(AT_ONCE, samples - done)
            # Seeds of parts of one chunk never meet those of another.
            total = total + count * np.array(mi.render(loaded, spp=count, seed=seed * 100_000 + part), np.float64)
            done += count
        return total[..., :3] / samples

    render(1, 0)  # compiles, which no chunk counts
    return mi.__version__, render


def scene_of(mi, scene, integrator):
    """The scene in Mitsuba's terms. Normals point to the front, Mitsuba's exterior."""

    def rgb(value):
        return {"type": "rgb", "value": [float(v) for v in value]}

    def medium(name):
        absorption, scattering = scene.coefficients(name)
        extinction = absorption + scattering
        return {
            "type": "homogeneous",
            "sigma_t": rgb(extinction / extinction.max()),
            "scale": float(extinction.max()),
            "albedo": rgb(scattering / extinction),
            "phase": {"type": "hg", "g": scene.asymmetry(name)},
        }

    media = {name: mi.load_dict(medium(name)) for name in scene.media}

    def mesh(name):
        surface = scene.surface(name)
        shape = {"type": "ply", "filename": str(scene.file(name)), "face_normals": surface.get("normals") == "flat"}
        if surface["material"]["kind"] == "diffuse":
            diffuse = {"type": "diffuse", "reflectance": rgb(scene.reflectance(name))}
            return shape | {"bsdf": {"type": "twosided", "bsdf": diffuse}}
        front, back = surface["front"], surface["back"]
        shape["bsdf"] = {"type": "dielectric", "int_ior": scene.ior(back), "ext_ior": scene.ior(front)}
        sides = {"interior": media.get(back), "exterior": media.get(front)}
        return shape | {side: m for side, m in sides.items() if m is not None}

    film = {"type": "hdrfilm", "width": scene.width, "height": scene.height, "pixel_format": "rgb"}
    film |= {"component_format": "float32", "rfilter": {"type": "box"}}
    camera = scene.camera
    look = mi.ScalarTransform4f().look_at(origin=camera["eye"], target=camera["target"], up=camera["up"])
    described = {
        "type": "scene",
        # One more than interactions: it counts segments.
        "integrator": {"type": integrator, "max_depth": scene.depth + 1},
        "sensor": {
            "type": "perspective",
            "to_world": look,
            "fov": camera["horizontal_fov"],
            "fov_axis": "x",
            "near_clip": 1e-3,
            "film": film,
            "sampler": {"type": "independent"},
        },
        "sky": {"type": "constant", "radiance": rgb(scene.sky)},
    }
    described |= {name: mesh(name) for name in ("water_air", "ice_air", "ice_water", "sand", "walls")}
    if scene.sun:
        described["sun"] = sun_of(mi, scene, rgb)
    return described


def sun_of(mi, scene, rgb):
    """A disc that faces the scene."""
    place = SUN_DISTANCE * np.array(scene.sun["direction"]) / np.linalg.norm(scene.sun["direction"])
    turn = mi.ScalarTransform4f().look_at(origin=place.tolist(), target=[0, 0, 0], up=[0, 0, 1])
    radius = SUN_DISTANCE * np.tan(scene.half_angle)
    return {
        "type": "disk",
        "to_world": turn @ mi.ScalarTransform4f().scale([radius, radius, 1]),
        "bsdf": {"type": "diffuse", "reflectance": rgb([0, 0, 0])},
        "emitter": {"type": "area", "radiance": rgb(scene.sun_radiance)},
    }


if __name__ == "__main__":
    run("Mitsuba", [f"{v}/{i}" for v in VARIANTS for i in INTEGRATORS], prepare)
