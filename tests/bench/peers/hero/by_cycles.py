"""The hero scene by Cycles, from Blender as a Python module.

Cycles has no priorities of media: where bodies overlap their media add up. So no two do here. The ice is a closed body,
the water is its surface and a skin around the ice below, a tenth of a millimetre off it, through which light passes
straight: there the water ends. Which triangles are skin, and the index across each triangle of the ice, are attributes
of its faces; Cycles leaves and enters a medium where the object *and* the material are the same.

Paths end after as many bounces of any kind; those through the skin do not count. Nothing else is left out or changed.
"""

import math
import tempfile
from pathlib import Path

import numpy as np

from chunks import read_exr, run
from scene import vertex_normals

# `guided` learns directions on surfaces and in media, `mnee` looks for the sun through refracting surfaces.
MODES = ("path", "guided", "mnee")
# In metres; at 10 m from the eye single precision resolves 1e-6.
SKIN = 1e-4


def prepare(scene, arguments):
    """Version and renderer."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    Blender(bpy, scene, arguments).build()
    settings = bpy.context.scene
    temporary = tempfile.TemporaryDirectory(prefix="cycles_hero_")
    settings.render.filepath = str(Path(temporary.name) / "picture.exr")

    def render(samples, seed):
        settings.cycles.samples, settings.cycles.seed = samples, seed
        bpy.ops.render.render(write_still=True)
        # Named by its owner here, so that the folder lives as long as this function.
        return read_exr(Path(temporary.name) / "picture.exr")

    return bpy.app.version_string, render


class Blender:
    """The scene in Blender's terms."""

    def __init__(self, bpy, scene, arguments):
        self.bpy, self.scene, self.arguments = bpy, scene, arguments

    def build(self):
        """Everything."""
        self.settings()
        self.camera()
        self.lights()
        self.water()
        self.ice()
        for name in ("sand", "walls"):
            mesh = self.scene.mesh(name)
            material, nodes, output = self.material(name)
            diffuse = nodes.new("ShaderNodeBsdfDiffuse")
            diffuse.inputs["Color"].default_value = (*self.scene.reflectance(name), 1)
            material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
            self.object(name, mesh.points, mesh.triangles, material)

    def settings(self):
        """Plain path tracing to the scene's depth: no clamping, denoising, or adaptive sampling."""
        settings, scene = self.bpy.context.scene, self.scene
        settings.render.engine = "CYCLES"
        settings.render.resolution_x, settings.render.resolution_y = scene.width, scene.height
        settings.render.resolution_percentage = 100
        settings.render.threads_mode, settings.render.threads = "FIXED", self.arguments.threads
        settings.render.image_settings.file_format = "OPEN_EXR"
        settings.render.image_settings.color_depth = "32"
        cycles = settings.cycles
        for kind in ("", "diffuse_", "glossy_", "transmission_", "volume_"):
            setattr(cycles, f"{kind}{'max_' if not kind else ''}bounces", scene.depth)
        cycles.transparent_max_bounces = 1024
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
        cycles.blur_glossy = cycles.light_sampling_threshold = 0
        cycles.caustics_reflective = cycles.caustics_refractive = True
        cycles.pixel_filter_type = "BOX"
        cycles.use_guiding = self.arguments.mode == "guided"
        cycles.use_surface_guiding = cycles.use_volume_guiding = cycles.use_guiding

    def camera(self):
        """A pinhole; Blender's look along -z."""
        camera, mathutils = self.scene.camera, __import__("mathutils")
        data = self.bpy.data.cameras.new("camera")
        data.sensor_fit, data.angle = "HORIZONTAL", math.radians(camera["horizontal_fov"])
        data.clip_start, data.clip_end = 1e-3, 1e3
        back = np.array(camera["eye"]) - camera["target"]
        back /= np.linalg.norm(back)
        right = np.cross(camera["up"], back)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3] = np.column_stack([right, np.cross(back, right), back, camera["eye"]])
        made = self.link("camera", data)
        made.matrix_world = mathutils.Matrix(matrix.tolist())
        self.bpy.context.scene.camera = made

    def lights(self):
        """The sky, and the sun as a light with an angle: it shines along -z."""
        world = self.bpy.data.worlds.new("sky")
        world.use_nodes = True
        background = world.node_tree.nodes["Background"]
        background.inputs["Color"].default_value = (*self.scene.sky, 1)
        self.bpy.context.scene.world = world
        if self.scene.sun:
            sun = self.bpy.data.lights.new("sun", "SUN")
            sun.angle = 2 * self.scene.half_angle
            sun.energy, sun.color = 1, self.scene.sun["irradiance"]
            sun.cycles.use_multiple_importance_sampling = True
            sun.cycles.is_caustics_light = self.arguments.mode == "mnee"
            direction = __import__("mathutils").Vector(self.scene.sun["direction"])
            self.link("sun", sun).rotation_euler = direction.to_track_quat("Z", "Y").to_euler()

    def water(self):
        """Surface and skin."""
        surface, ice = self.scene.mesh("water_air"), self.scene.mesh("ice_water")
        out = vertex_normals(ice)
        shore = set(map(bytes, surface.points))
        inner = np.array([bytes(p) not in shore for p in ice.points])
        skin = ice.points + SKIN * inner[:, None] * out
        # Seen from the water, the skin's back is in front.
        triangles = np.vstack([surface.triangles, ice.triangles[:, ::-1] + len(surface.points)])
        is_skin = np.arange(len(triangles)) >= len(surface.triangles)
        material = self.dielectric("water", "skin")
        made = self.object("water", np.vstack([surface.points, skin]), triangles, material)
        self.face_values(made, "index", np.full(len(triangles), self.scene.ior("water")))
        self.face_values(made, "skin", is_skin)
        normals = np.vstack([surface.normals, -out])
        made.data.polygons.foreach_set("use_smooth", np.ones(len(triangles), bool))
        made.data.normals_split_custom_set_from_vertices(normals.tolist())

    def ice(self):
        """Closed; the index across a face is relative to what is outside of it."""
        mesh, in_water = self.scene.ice()
        made = self.object("ice", mesh.points, mesh.triangles, self.dielectric("ice"))
        index = self.scene.ior("ice") / np.where(in_water, self.scene.ior("water"), 1.0)
        self.face_values(made, "index", index)

    def dielectric(self, medium, straight=None):
        """An interface with a medium behind it; light passes straight where the attribute `straight` is 1."""
        material, nodes, output = self.material(medium)
        link = material.node_tree.links.new
        glass = nodes.new("ShaderNodeBsdfGlass")
        glass.inputs["Roughness"].default_value = 0
        link(self.attribute(nodes, "index"), glass.inputs["IOR"])
        surface = glass.outputs[0]
        if straight:
            mix = nodes.new("ShaderNodeMixShader")
            link(self.attribute(nodes, straight), mix.inputs[0])
            link(surface, mix.inputs[1])
            link(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[2])
            surface = mix.outputs[0]
        link(surface, output.inputs["Surface"])
        volume = nodes.new("ShaderNodeVolumeCoefficients")
        absorption, scattering = self.scene.coefficients(medium)
        volume.inputs["Absorption Coefficients"].default_value = absorption
        volume.inputs["Scatter Coefficients"].default_value = scattering
        volume.inputs["Anisotropy"].default_value = self.scene.asymmetry(medium)
        link(volume.outputs[0], output.inputs["Volume"])
        return material

    def material(self, name):
        """An empty material, its nodes and the last of them."""
        material = self.bpy.data.materials.new(name)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        return material, nodes, nodes.new("ShaderNodeOutputMaterial")

    def attribute(self, nodes, name):
        """The value of an attribute of the face."""
        node = nodes.new("ShaderNodeAttribute")
        node.attribute_name = name
        return node.outputs["Factor"]

    def object(self, name, points, triangles, material):
        """A mesh in the scene."""
        data = self.bpy.data.meshes.new(name)
        data.from_pydata(points.tolist(), [], triangles.tolist())
        data.materials.append(material)
        made = self.link(name, data)
        made.cycles.is_caustics_caster = made.cycles.is_caustics_receiver = self.arguments.mode == "mnee"
        return made

    def face_values(self, made, name, values):
        """An attribute of every face."""
        attribute = made.data.attributes.new(name, "FLOAT", "FACE")
        attribute.data.foreach_set("value", np.asarray(values, np.float32))

    def link(self, name, data):
        """Into the scene."""
        made = self.bpy.data.objects.new(name, data)
        self.bpy.context.collection.objects.link(made)
        return made


if __name__ == "__main__":
    run("Cycles", MODES, prepare)
