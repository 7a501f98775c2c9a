# SPDX-License-Identifier: Apache-2.0
"""Bakes the irradiance of a lit scene's surfaces with Blender's Cycles, over the same lightmap UVs.

    blender -b --factory-startup --python bench/peers/cycles_bake.py -- \\
        LIT.glb OUT_STEM --spp 16,64 --size 512x512 --bounces 8 --seeds 0 --threads 2

Writes OUT_STEM_<spp>_<seed>.exr (lux) for each, and one JSON line per bake on stdout:
{"spp", "seed", "seconds", "cpu_seconds", "exr"}.
"""
import argparse
import json
import math
import pathlib
import sys
import time

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import glb  # noqa: E402


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("stem")
    parser.add_argument("--spp", default="16")
    parser.add_argument("--seeds", default="0")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--bounces", type=int, default=8)
    parser.add_argument("--threads", type=int, default=0)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def make_material(source, image):
    """Diffuse on both sides, emitting from the front (or both), with the bake's target image."""
    material = bpy.data.materials.new(source.name or "material")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*source.reflectance, 1)
    surface = diffuse.outputs["BSDF"]
    if any(source.luminance):
        brightest = max(source.luminance)
        emission = nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*(c / brightest for c in source.luminance), 1)
        emission.inputs["Strength"].default_value = brightest
        if not source.double_sided:
            geometry = nodes.new("ShaderNodeNewGeometry")
            front = nodes.new("ShaderNodeMath")
            front.operation = "MULTIPLY_ADD"  # strength * (1 - backfacing)
            front.inputs[1].default_value = -brightest
            front.inputs[2].default_value = brightest
            links.new(geometry.outputs["Backfacing"], front.inputs[0])
            links.new(front.outputs[0], emission.inputs["Strength"])
        both = nodes.new("ShaderNodeAddShader")
        links.new(surface, both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        surface = both.outputs[0]
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(surface, output.inputs["Surface"])
    target = nodes.new("ShaderNodeTexImage")
    target.image = image
    nodes.active = target
    return material


def make_object(parts, materials):
    """All parts as one mesh; Blender's V runs upwards."""
    vertices, faces, uvs, slots = [], [], [], []
    for part in parts:
        first = len(vertices)
        # Turned to Blender's +Z up: (x, y, z) -> (x, -z, y).
        vertices += [(x, -z, y) for x, y, z in part.positions]
        for triangle in part.triangles:
            faces.append([first + corner for corner in triangle])
            uvs += [(part.uvs[c][0], 1 - part.uvs[c][1]) for c in triangle]
            slots.append(part.material)
    mesh = bpy.data.meshes.new("scene")
    mesh.from_pydata(vertices, [], faces)
    for material in materials:
        mesh.materials.append(material)
    layer = mesh.uv_layers.new(name="lightmap")
    for loop, uv in zip(layer.data, uvs):
        loop.uv = uv
    for polygon, slot in zip(mesh.polygons, slots):
        polygon.material_index = slot
    lit = bpy.data.objects.new("scene", mesh)
    bpy.context.collection.objects.link(lit)
    bpy.context.view_layer.objects.active = lit
    lit.select_set(True)


def set_up_cycles(arguments):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    if arguments.threads:
        scene.render.threads_mode = "FIXED"
        scene.render.threads = arguments.threads
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0  # clamping would lose light
    cycles.light_sampling_threshold = 0
    cycles.max_bounces = cycles.diffuse_bounces = arguments.bounces
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    settings.exr_codec = "NONE"
    return scene


def bake(scene, image, spp, seed, stem):
    scene.cycles.samples, scene.cycles.seed = spp, seed
    start, cpu_start = time.perf_counter(), time.process_time()
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, margin=0,
                        use_clear=True)
    seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - cpu_start
    # Without its colour a diffuse bake holds the luminance of a white surface, E / pi.
    pixels = [value * math.pi for value in image.pixels[:]]
    lux = bpy.data.images.new("lux", image.size[0], image.size[1], float_buffer=True)
    lux.colorspace_settings.name = "Non-Color"
    lux.pixels[:] = pixels
    path = f"{stem}_{spp}_{seed}.exr"
    lux.save_render(path, scene=scene)
    bpy.data.images.remove(lux)
    print(json.dumps({"spp": spp, "seed": seed, "seconds": round(seconds, 3),
                      "cpu_seconds": round(cpu_seconds, 3), "exr": path}), flush=True)


def main():
    arguments = parse_arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.world = bpy.data.worlds.new("dark")
    bpy.ops.preferences.addon_enable(module="cycles")
    width, height = map(int, arguments.size.split("x"))
    image = bpy.data.images.new("target", width, height, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    parts, sources = glb.read_lit_scene(arguments.scene)
    make_object(parts, [make_material(source, image) for source in sources])
    scene = set_up_cycles(arguments)
    scene.view_settings.view_transform = "Raw"
    for seed in map(int, arguments.seeds.split(",")):
        for spp in map(int, arguments.spp.split(",")):
            bake(scene, image, spp, seed, arguments.stem)


main()
