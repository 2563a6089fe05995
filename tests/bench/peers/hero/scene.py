"""The scene of `tests/bench/hero`, read from its own files: numbers by `scene.toml`, meshes by its PLY files.

Other renderers want closed bodies where floe has interfaces. They are made of the interfaces here:

    ice   = ice|air + ice|water                          welded at the waterline, closed
    water = water|air + a lid over the hole in it        the lid lies inside of the ice; walls and sand are opaque
"""

import math
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parents[2] / "hero"
# Of the sun: as in the scene, none, and 10 degrees wide with the same irradiance, which path tracers converge under.
SUNS = ("disc", "none", "wide")
WIDE = 10.0


@dataclass
class Mesh:
    """Vertices, triangles, and normals of the vertices where they are interpolated."""

    points: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None = None


class Scene:
    """What `scene.toml` says."""

    def __init__(self, sun):
        self.toml = tomllib.loads((FOLDER / "scene.toml").read_text())
        self.media = self.toml["media"]
        self.camera = self.toml["camera"]
        self.width, self.height = self.camera["resolution"]
        self.sky = np.array(self.toml["sky"]["radiance"])
        self.depth = self.toml["render"]["max_depth"]
        self.sun = None
        if sun != "none":
            self.sun = dict(self.toml["sun"])
            if sun == "wide":
                self.sun["angular_diameter"] = WIDE
            # Of a disc of even radiance, faced: L = E / (pi sin^2 of its half angle).
            self.half_angle = math.radians(self.sun["angular_diameter"] / 2)
            self.sun_radiance = np.array(self.sun["irradiance"]) / (math.pi * math.sin(self.half_angle) ** 2)

    def surface(self, name):
        """The surface with the mesh `name`.ply, as the scene describes it."""
        return next(s for s in self.toml["surfaces"] if s["mesh"] == f"{name}.ply")

    def reflectance(self, name):
        """Of a diffuse surface, RGB."""
        return np.broadcast_to(self.surface(name)["material"]["reflectance"], 3).astype(float)

    def coefficients(self, medium):
        """Absorption and scattering in 1/m, RGB."""
        medium = self.media[medium]
        return tuple(np.broadcast_to(medium[key], 3).astype(float) for key in ("absorption", "scattering"))

    def asymmetry(self, medium):
        """The g of its phase function."""
        phase = self.media[medium]["phase"]
        return phase["g"] if phase["kind"] == "henyey-greenstein" else 0.0

    def ior(self, medium):
        """Index of refraction; air has none in the scene."""
        return self.media.get(medium, {"ior": 1.0})["ior"]

    def mesh(self, name):
        """One of the meshes of the scene."""
        mesh = read_ply(FOLDER / f"{name}.ply")
        if self.surface(name).get("normals") == "flat":
            mesh.normals = None
        return mesh

    def file(self, name):
        """The name of one of the meshes."""
        return FOLDER / f"{name}.ply"

    def ice(self):
        """The closed ice; `water` tells which of its triangles lie in water."""
        above, below = self.mesh("ice_air"), self.mesh("ice_water")
        return weld(above, below), np.arange(len(above.triangles) + len(below.triangles)) >= len(above.triangles)

    def lid(self):
        """A fan over the hole that the ice makes in the surface of the water."""
        water, ice = self.mesh("water_air"), self.mesh("ice_air")
        common = set(map(bytes, ice.points))
        edges = [e for e in border(water.triangles) if all(bytes(water.points[i]) in common for i in e)]
        ring = sorted({i for e in edges for i in e})
        place = {i: k for k, i in enumerate(ring)}
        points = np.vstack([water.points[ring], water.points[ring].mean(axis=0)])
        # The fan's edge runs against the water's.
        return Mesh(points, np.array([[place[b], place[a], len(ring)] for a, b in edges], np.int32))


def read_ply(path):
    """A binary PLY of float vertices, maybe with normals, and triangles."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    head = head.decode()
    count = {name: int(n) for name, n in re.findall(r"element (\w+) (\d+)", head)}
    columns = re.findall(r"property float (\w+)", head)
    size = count["vertex"] * len(columns) * 4
    vertices = np.frombuffer(body[:size], "<f4").reshape(-1, len(columns))
    faces = np.frombuffer(body[size:], np.dtype([("n", "u1"), ("at", "<i4", 3)]), count["face"])
    if columns[:3] != ["x", "y", "z"] or (faces["n"] != 3).any():
        raise SystemExit(f"{path}: not the triangles that this expects")
    normals = vertices[:, 3:6].copy() if columns[3:6] == ["nx", "ny", "nz"] else None
    return Mesh(vertices[:, :3].copy(), faces["at"].copy(), normals)


def weld(*meshes):
    """One mesh, in which vertices at the same place are one."""
    points = np.vstack([m.points for m in meshes])
    starts = np.cumsum([0] + [len(m.points) for m in meshes])
    triangles = np.vstack([m.triangles + s for m, s in zip(meshes, starts)])
    points, place = np.unique(points, axis=0, return_inverse=True)
    return Mesh(points, place.reshape(-1)[triangles].astype(np.int32))


def border(triangles):
    """Edges with a triangle on one side only, in its direction."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    known = set(map(tuple, edges.tolist()))
    return [e for e in known if (e[1], e[0]) not in known]


def vertex_normals(mesh):
    """Means of the normals of the triangles around each vertex, by area."""
    a, b, c = (mesh.points[mesh.triangles[:, k]].astype(float) for k in range(3))
    normals = np.zeros((len(mesh.points), 3))
    for k in range(3):
        np.add.at(normals, mesh.triangles[:, k], np.cross(b - a, c - a))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)
