"""Draws the grid "density" of a .vdb file with Blender, without its window.

    emscape simulate scenarios/jacksboro.yaml -o out --look fog --times 40
    blender --background --factory-startup --python examples/blender_fog.py -- out/jacksboro_0001.vdb fog.png
"""
import math
import pathlib
import sys

import bpy
from mathutils import Vector

FOG_DENSITY = 0.2  # of the voxels with the strongest field, per unit of the scene
GLOW = 2.0         # their light
WIDTH = 10.0       # of the volume, in Blender's units


def main(volume_file: pathlib.Path, picture: str) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.object.volume_import(filepath=str(volume_file.resolve()), align="WORLD")
    volume = bpy.context.object
    volume.data.grids.load()
    bpy.context.view_layer.update()
    corners = [Vector(corner) for corner in volume.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box]
    low = Vector(min(c[axis] for c in corners) for axis in range(3))
    high = Vector(max(c[axis] for c in corners) for axis in range(3))
    scale = WIDTH / max(high.x - low.x, high.y - low.y)
    volume.scale = (scale, scale, 3 * scale)  # heights three times as large
    center = (low + high) / 2
    volume.location = (-center.x * scale, -center.y * scale, -low.z * 3 * scale)

    volume.data.render.space = "WORLD"  # else density is per metre, not per unit of the scaled scene
    material = bpy.data.materials.new("fog")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    links = material.node_tree.links
    value, fog, output = (nodes.new("ShaderNode" + kind) for kind in ("Attribute", "VolumePrincipled", "OutputMaterial"))
    glow = nodes.new("ShaderNodeMath")
    value.attribute_name = "density"
    glow.operation, glow.inputs[1].default_value = "MULTIPLY", GLOW
    fog.inputs["Density"].default_value = FOG_DENSITY
    fog.inputs["Color"].default_value = fog.inputs["Emission Color"].default_value = (0.1, 0.5, 1, 1)
    links.new(value.outputs["Fac"], glow.inputs[0])
    links.new(glow.outputs["Value"], fog.inputs["Emission Strength"])
    links.new(fog.outputs["Volume"], output.inputs["Volume"])
    volume.data.materials.append(material)

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, -1.6 * WIDTH, 1.2 * WIDTH)
    camera.rotation_euler = (math.radians(57), 0, 0)
    scene = bpy.context.scene
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("sky")
    scene.world.color = (0.01, 0.01, 0.02)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = 480, 300
    scene.render.filepath = str(pathlib.Path(picture).resolve())
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1:]
    main(pathlib.Path(arguments[0]), arguments[1])
