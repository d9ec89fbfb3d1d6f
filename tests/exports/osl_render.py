"""A sheet with an OSL shader in Blender's Cycles, seen from any side under light from anywhere. Runs where bpy is (PyPI)."""

import json
import math
import pathlib
import sys
import tempfile
import warnings

import bpy
from mathutils import Vector

warnings.filterwarnings("ignore", category=DeprecationWarning)  # use_nodes, which older versions need

# The wheel keeps what compiles script nodes where Blender's own Python would look for it.
sys.path += map(str, pathlib.Path(bpy.utils.resource_path("LOCAL")).glob("python/lib/python*/site-packages"))

PIXELS = 8


def direction(theta_deg, phi_deg, front):
    theta, phi = math.radians(theta_deg), math.radians(phi_deg)
    z = math.cos(theta)
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), z if front else -z)


class Sheet:
    """A square in the plane z = 0, its front up, that fills the image."""

    def __init__(self, shader):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.device = "CPU"
        scene.cycles.shading_system = True
        scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.filter_width = 0.01
        scene.cycles.sample_clamp_indirect = 0
        scene.cycles.blur_glossy = 0
        scene.cycles.max_bounces = 2
        scene.render.use_persistent_data = True
        scene.render.resolution_percentage = 100
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        bpy.ops.mesh.primitive_plane_add(size=100)
        material = bpy.data.materials.new("leaf")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        script, output = nodes.new("ShaderNodeScript"), nodes.new("ShaderNodeOutputMaterial")
        script.mode, script.filepath = "EXTERNAL", str(shader)
        sockets = [s for s in script.outputs if s.name == "BSDF"]
        if not sockets:
            raise SystemExit(f"{shader} was not compiled")
        links.new(sockets[0], output.inputs["Surface"])
        bpy.context.object.data.materials.append(material)
        self.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(self.camera)
        scene.camera = self.camera
        self.sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
        self.sun.data.angle = 0
        scene.collection.objects.link(self.sun)
        scene.world = bpy.data.worlds.new("world")
        scene.world.use_nodes = True

    def sky(self, above, below):
        """Radiance from either half of all directions."""
        tree = self.scene.world.node_tree
        tree.nodes.clear()
        place, split, up = (tree.nodes.new(f"ShaderNode{n}") for n in ("NewGeometry", "SeparateXYZ", "Math"))
        mix, back, output = (tree.nodes.new(f"ShaderNode{n}") for n in ("MapRange", "Background", "OutputWorld"))
        up.operation = "GREATER_THAN"
        up.inputs[1].default_value = 0
        mix.inputs["To Min"].default_value, mix.inputs["To Max"].default_value = above, below  # Incoming points back
        back.inputs["Color"].default_value = (1, 1, 1, 1)
        tree.links.new(place.outputs["Incoming"], split.inputs[0])
        tree.links.new(split.outputs["Z"], up.inputs[0])
        tree.links.new(up.outputs[0], mix.inputs["Value"])
        tree.links.new(mix.outputs[0], back.inputs["Strength"])
        tree.links.new(back.outputs[0], output.inputs[0])

    def sunlight(self, toward, irradiance):
        """Parallel light, from that direction, on a square across it."""
        self.sun.rotation_euler = Vector(toward).to_track_quat("Z", "Y").to_euler()
        self.sun.data.energy = irradiance

    def image(self, width, height, samples):
        """Rows from below, of red, green and blue."""
        self.scene.cycles.samples = samples
        self.scene.render.resolution_x, self.scene.render.resolution_y = width, height
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "image.exr"
            self.scene.render.filepath = str(path)
            bpy.ops.render.render(write_still=True)
            image = bpy.data.images.load(str(path))
            image.colorspace_settings.name = "Non-Color"
            v = list(image.pixels)
            bpy.data.images.remove(image)
        return [[v[4 * (y * width + x):4 * (y * width + x) + 3] for x in range(width)] for y in range(height)]

    def seen_from(self, toward, samples):
        """Mean radiance from one direction."""
        self.camera.data.type, self.camera.data.ortho_scale = "ORTHO", 0.1
        self.camera.location = [10 * x for x in toward]
        self.camera.rotation_euler = Vector(toward).to_track_quat("Z", "Y").to_euler()
        pixels = sum(self.image(PIXELS, PIXELS, samples), [])
        return [sum(p[c] for p in pixels) / len(pixels) for c in range(3)]

    def seen_from_everywhere(self, step_deg, front):
        """Radiance toward directions of one side: [theta, phi, colour], by an image of all directions from a point close
        to the sheet."""
        camera = self.camera.data
        camera.type = "PANO"
        for holder in (camera, getattr(camera, "cycles", None)):  # older versions have it in the latter
            if hasattr(holder, "panorama_type"):
                holder.panorama_type = "EQUIRECTANGULAR"
        camera.clip_start = 1e-6
        self.camera.location = (0, 0, 1e-3 if front else -1e-3)
        self.camera.rotation_euler = (math.pi / 2, 0, 0)  # the middle of the image is +y, its right +x, its top +z
        width, height = round(360 / step_deg), round(180 / step_deg)
        found = []
        for y, row in enumerate(self.image(width, height, 1)):
            latitude = (y + 0.5) * step_deg - 90
            if (latitude < 0) != front:
                continue
            for x, color in enumerate(row):
                longitude = math.radians((x + 0.5) * step_deg - 180)
                phi = math.degrees(math.atan2(-math.cos(longitude), -math.sin(longitude))) % 360
                found.append([90 - abs(latitude), phi, color])
        return found


def main():
    """osl_render.py SHADER ANSWERS < JSON: a list of {"shares": [theta, front], "samples": n}, answered by R, T and their
    sum in a furnace, and of {"f": [theta, front, front of the viewer], "step": degrees}, answered by [theta, phi
    from the light's azimuth, f in three colours] for all views."""
    sheet = Sheet(pathlib.Path(sys.argv[1]).resolve())
    answers = []
    for question in json.load(sys.stdin):
        if "shares" in question:
            theta, front = question["shares"]
            toward, n = direction(theta, 0, front), question["samples"]
            sheet.sunlight((0, 0, 1), 0)
            shares = {}
            for name, sky in (("R", (1, 0)), ("T", (0, 1)), ("furnace", (1, 1))):
                sheet.sky(*(sky if front else sky[::-1]))
                shares[name] = sheet.seen_from(toward, n)
            answers.append(shares)
        else:
            (theta, front, viewer_in_front), step = question["f"], question["step"]
            sheet.sky(0, 0)
            sheet.sunlight(direction(theta, step / 2, front), 1)  # so that a column of the image is at its azimuth
            cosine = math.cos(math.radians(theta))
            answers.append([[t, (p - step / 2) % 360, [x / cosine for x in color]]
                            for t, p, color in sheet.seen_from_everywhere(step, viewer_in_front)])
    pathlib.Path(sys.argv[2]).write_text(json.dumps(answers))


if __name__ == "__main__":
    main()
