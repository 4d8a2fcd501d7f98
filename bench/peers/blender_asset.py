# SPDX-License-Identifier: Apache-2.0
"""The chain of `relief make` in Blender 3.4: imports a dense model, decimates it, unwraps the result,
bakes its maps with Cycles and exports it. bench/asset_chain runs it:

    blender -b --factory-startup -P blender_asset.py -- SOURCE.glb ASSET.glb TRIANGLES SIZE AO_SIZE AO_RAYS

Prints a line for each stage, "stage NAME SECONDS", in processor time.
"""
import math
import sys
import time

import bpy
import numpy

# Debian's importer of glTF uses a name that its numpy no longer has.
if "bool" not in numpy.__dict__:
    numpy.bool = bool

MARGIN = 8  # Texels around charts, as in `relief make`.


class Stages:
    def __init__(self):
        self.before = time.process_time()

    def end(self, name):
        now = time.process_time()
        print(f"stage {name} {now - self.before:.3f}", flush=True)
        self.before = now


def only_selected(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for one in objects:
        one.select_set(True)
    bpy.context.view_layer.objects.active = objects[-1]


def import_source(file):
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.import_scene.gltf(filepath=file)
    return next(o for o in bpy.context.scene.objects if o.type == "MESH")


def decimated(high, triangles):
    only_selected(high)
    bpy.ops.object.duplicate()
    low = bpy.context.view_layer.objects.active
    low.name = "asset"
    low.data.materials.clear()
    while low.data.uv_layers:
        low.data.uv_layers.remove(low.data.uv_layers[0])
    # The importer keeps the seams of the texture coordinates, at which decimation would open the surface.
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.remove_doubles(threshold=1e-6)
    bpy.ops.object.mode_set(mode="OBJECT")
    low.data.use_auto_smooth = False
    low.data.free_normals_split() if hasattr(low.data, "free_normals_split") else None
    if low.data.has_custom_normals:
        bpy.ops.mesh.customdata_custom_splitnormals_clear()
    modifier = low.modifiers.new("decimate", "DECIMATE")
    modifier.ratio = triangles / len(low.data.polygons)
    modifier.use_collapse_triangulate = True
    bpy.ops.object.modifier_apply(modifier=modifier.name)
    bpy.ops.object.shade_smooth()
    low.data.use_auto_smooth = True
    low.data.auto_smooth_angle = math.radians(60)
    return low


def unwrap(low, size):
    only_selected(low)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=math.radians(66), island_margin=MARGIN / size)
    bpy.ops.object.mode_set(mode="OBJECT")


def new_map(material, name, size, is_data):
    image = bpy.data.images.new(name, size, size, is_data=is_data)
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    return node


def bake(high, low, node, kind, samples, **options):
    for other in node.id_data.nodes:
        other.select = False
    node.select = True
    node.id_data.nodes.active = node
    only_selected(high, low)
    bpy.context.scene.cycles.samples = samples
    reach = 0.05 * max(low.dimensions)
    bpy.ops.object.bake(
        type=kind,
        use_selected_to_active=True,
        cage_extrusion=reach,
        max_ray_distance=2.0 * reach,
        margin=MARGIN,
        **options,
    )


def export(low, material, nodes, file):
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(nodes["color"].outputs["Color"], shader.inputs["Base Color"])
    separate = tree.nodes.new("ShaderNodeSeparateColor")
    tree.links.new(nodes["roughness"].outputs["Color"], separate.inputs["Color"])
    tree.links.new(separate.outputs["Green"], shader.inputs["Roughness"])
    direction = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(nodes["normal"].outputs["Color"], direction.inputs["Color"])
    tree.links.new(direction.outputs["Normal"], shader.inputs["Normal"])
    # The exporter takes the occlusion from a group of this name.
    group = bpy.data.node_groups.new("glTF Material Output", "ShaderNodeTree")
    group.inputs.new("NodeSocketFloat", "Occlusion")
    settings = tree.nodes.new("ShaderNodeGroup")
    settings.node_tree = group
    tree.links.new(nodes["occlusion"].outputs["Color"], settings.inputs["Occlusion"])
    shader.inputs["Metallic"].default_value = 0.0
    only_selected(low)
    bpy.ops.export_scene.gltf(filepath=file, export_format="GLB", use_selection=True, export_tangents=True)


def main():
    source, asset = sys.argv[sys.argv.index("--") + 1 :][:2]
    triangles, size, occlusion_size, rays = map(int, sys.argv[sys.argv.index("--") + 3 :])
    stages = Stages()
    high = import_source(source)
    stages.end("import")
    low = decimated(high, triangles)
    stages.end("decimate")
    unwrap(low, size)
    stages.end("unwrap")
    material = bpy.data.materials.new("asset")
    material.use_nodes = True
    low.data.materials.append(material)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.render.bake.use_clear = True
    nodes = {
        "normal": new_map(material, "normal", size, True),
        "color": new_map(material, "color", size, False),
        "roughness": new_map(material, "roughness", size, True),
        "occlusion": new_map(material, "occlusion", occlusion_size, True),
    }
    bake(high, low, nodes["normal"], "NORMAL", 1)
    stages.end("normal")
    bake(high, low, nodes["color"], "DIFFUSE", 1, pass_filter={"COLOR"})
    stages.end("color")
    bake(high, low, nodes["roughness"], "ROUGHNESS", 1)
    stages.end("roughness")
    bake(high, low, nodes["occlusion"], "AO", rays)
    stages.end("occlusion")
    export(low, material, nodes, asset)
    stages.end("export")
    print(f"triangles {len(low.data.polygons)}")


main()
