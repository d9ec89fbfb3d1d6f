"""Blender's Cycles, by the module bpy, on one thread."""

import math
import pathlib
import sys
import tempfile
import warnings

import bpy
import numpy
from mathutils import Matrix, Vector

from ..truth.make import colors
from . import interface

warnings.filterwarnings("ignore", category=DeprecationWarning)  # use_nodes, which older versions need
# The wheel keeps what compiles script nodes where Blender's own Python would look for it.
sys.path += map(str, pathlib.Path(bpy.utils.resource_path("LOCAL")).glob("python/lib/python*/site-packages"))


def start(width, height, bounces, box=True):
    """An empty scene that is rendered without what changes the expectation; without `box`, a pixel is its middle."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    settings = {"device": "CPU", "shading_system": True, "use_adaptive_sampling": False, "use_denoising": False, "pixel_filter_type": "BOX" if box else "GAUSSIAN",
                "filter_width": 0.01,  # the box has a width of 1
                "sample_clamp_direct": 0, "sample_clamp_indirect": 0, "blur_glossy": 0,
                "light_sampling_threshold": 0, "max_bounces": bounces, "diffuse_bounces": bounces, "glossy_bounces": bounces,
                "transmission_bounces": bounces}
    for name, value in settings.items():
        setattr(scene.cycles, name, value)
    r = scene.render
    r.threads_mode, r.threads, r.use_persistent_data = "FIXED", 1, True
    r.resolution_x, r.resolution_y, r.resolution_percentage = width, height, 100
    r.image_settings.file_format, r.image_settings.color_depth = "OPEN_EXR", "32"
    scene.world = bpy.data.worlds.new("world")
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    return scene


def render(out, samples, seed):
    """CPU seconds of a render whose data are there."""
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed, scene.render.filepath = samples, seed, str(out)
    before = interface.cpu()
    bpy.ops.render.render(write_still=True)
    return interface.cpu() - before


def material(name, surface):
    """A material whose surface is the socket that `surface(nodes, link)` returns."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    made.node_tree.links.new(surface(nodes, made.node_tree.links.new), nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def node(nodes, kind, **inputs):
    made = nodes.new(f"ShaderNode{kind}")
    for name, value in inputs.items():
        made.inputs[name].default_value = value
    return made


def diffuse(color, kind="BsdfDiffuse"):
    return lambda nodes, _: node(nodes, kind, Color=(*color, 1)).outputs["BSDF"]


def emission(strength):
    return lambda nodes, _: node(nodes, "Emission", Strength=strength).outputs[0]


def add(nodes, link, parts):
    both = nodes.new("ShaderNodeAddShader")
    for i, part in enumerate(parts):
        link(part(nodes, link), both.inputs[i])
    return both.outputs[0]


def by_side(front, back):
    """One shader for each side of a surface."""
    def surface(nodes, link):
        mix = nodes.new("ShaderNodeMixShader")
        link(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs[0])
        link(front(nodes, link), mix.inputs[1])
        link(back(nodes, link), mix.inputs[2])
        return mix.outputs[0]
    return surface


def script(path):
    """The BSDF of an OSL shader."""
    def surface(nodes, link):
        shader = nodes.new("ShaderNodeScript")
        shader.mode, shader.filepath = "EXTERNAL", str(path)
        return next(s for s in shader.outputs if s.name == "BSDF")
    return surface


def frame(toward, up):
    """Rotation whose z axis is `toward`, as columns."""
    z = Vector(toward).normalized()
    x = Vector(up).cross(z).normalized()
    return Matrix((x, z.cross(x), z)).transposed().to_4x4()


def world(task, leaf):
    scene, c = start(task.width, task.height, task.scattering_events), task.camera
    position, target = Vector(c["position"]), Vector(c["target"])
    scene.camera.data.angle, scene.camera.data.clip_start = math.radians(c["fov"]), 1e-3
    scene.camera.matrix_world = Matrix.Translation(position) @ frame(position - target, c["up"])
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*[task.sky] * 3, 1)
    for surface in task.surfaces:
        bpy.ops.wm.ply_import(filepath=task.mesh(surface))
        bpy.context.object.data.materials.append(material(surface["name"], diffuse(surface["reflectance"]) if surface["reflectance"] else leaf))
    for lamp in task.lamps:
        corners = 256  # of a polygon with the area of the disk
        radius = lamp["radius"] / math.sqrt(math.sin(2 * math.pi / corners) / (2 * math.pi / corners))
        bpy.ops.mesh.primitive_circle_add(vertices=corners, radius=radius, fill_type="TRIFAN")
        toward, up = lamp["toward"], (0, 0, 1) if abs(lamp["toward"][2]) < 0.9 else (1, 0, 0)
        bpy.context.object.matrix_world = Matrix.Translation(Vector(lamp["center"])) @ frame(toward, up)
        bpy.context.object.data.materials.append(material("lamp", emission(lamp["radiance"])))


def image(leaf):
    def draw(task, samples, seed, out):
        world(task, leaf(task))
        render(out, 1, seed)  # loads, and builds the tree of the geometry
        return render(out, samples, seed)
    return draw


def half_skies(above, below):
    tree = bpy.context.scene.world.node_tree
    tree.nodes.clear()
    place, split, up = (tree.nodes.new(f"ShaderNode{n}") for n in ("NewGeometry", "SeparateXYZ", "Math"))
    mix, back, output = (tree.nodes.new(f"ShaderNode{n}") for n in ("MapRange", "Background", "OutputWorld"))
    up.operation, up.inputs[1].default_value = "GREATER_THAN", 0
    mix.inputs["To Min"].default_value, mix.inputs["To Max"].default_value = above, below  # Incoming points back
    back.inputs["Color"].default_value = (1, 1, 1, 1)
    for a, b in ((place.outputs["Incoming"], split.inputs[0]), (split.outputs["Z"], up.inputs[0]), (up.outputs[0], mix.inputs["Value"]),
                 (mix.outputs[0], back.inputs["Strength"]), (back.outputs[0], output.inputs[0])):
        tree.links.new(a, b)


def table(leaf):
    def rows(task, samples, seed):
        seconds, scene, columns = 0, start(len(task.phi), len(task.theta), 2, box=False), len(task.phi)
        scene.world.use_nodes = True
        bpy.ops.mesh.primitive_plane_add(size=100)
        bpy.context.object.data.materials.append(material("leaf", leaf(task)))
        sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
        sun.data.angle = 0
        scene.collection.objects.link(sun)
        camera = scene.camera.data
        camera.type, camera.clip_start = "PANO", 1e-6
        for holder in (camera, getattr(camera, "cycles", None)):  # older versions have it in the latter
            if hasattr(holder, "panorama_type"):
                holder.panorama_type = "EQUIRECTANGULAR"
        scene.camera.rotation_euler = (math.pi / 2, 0, 0)  # the middle of the image is +y, its right +x, its top +z
        of_column = (columns // 4 - 1 - numpy.arange(columns)) % columns  # by azimuth of view

        def draw(light, sky, front):
            nonlocal seconds
            half_skies(*sky)
            sun.data.energy = 0 if light is None else 1
            if light is not None:
                sun.rotation_euler = Vector(light).to_track_quat("Z", "Y").to_euler()
            scene.camera.location = (7, 3, 1e-3 if front else -1e-3)  # far from the edge that the sheet's triangles share
            with tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / "image.exr"
                seconds += render(out, samples if light is None else max(1, samples // 8), seed)
                return colors(out)[::-1][:, of_column]
        return list(interface.rows_of_images(task, draw)), seconds
    return rows


def main(leaf):
    """`leaf(task)` makes the leaf's surface, as `diffuse` does."""
    sys.stdout, out = sys.stderr, sys.stdout  # Blender reports its progress
    try:
        interface.main(image(leaf), table(leaf), {"Blender": bpy.app.version_string}, output=out)
    finally:
        sys.stdout = out
