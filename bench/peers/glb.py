# SPDX-License-Identifier: Apache-2.0
"""Reads the triangles, materials and lightmap UVs of a lit scene (.glb) with nothing but Python."""
import json
import struct
from dataclasses import dataclass

COMPONENTS = {5121: ("B", 1), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]  # column-major


@dataclass
class Part:
    """One primitive in the world."""
    positions: list  # [(x, y, z)] metres, +Y up
    triangles: list  # [(a, b, c)]
    uvs: list        # [(u, v)] of the lightmap, V down
    material: int


@dataclass
class Material:
    name: str
    reflectance: tuple  # linear Rec. 709
    luminance: tuple    # cd/m^2
    double_sided: bool


def read_chunks(path):
    with open(path, "rb") as file:
        data = file.read()
    magic, _, length = struct.unpack_from("<4sII", data)
    if magic != b"glTF" or length > len(data):
        raise ValueError(f"{path}: not a GLB file")
    chunks, at = {}, 12
    while at < length:
        size, kind = struct.unpack_from("<I4s", data, at)
        chunks[kind] = data[at + 8:at + 8 + size]
        at += 8 + size
    return json.loads(chunks[b"JSON"]), chunks.get(b"BIN\0", b"")


def read_accessor(document, binary, index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    code, size = COMPONENTS[accessor["componentType"]]
    width = WIDTHS[accessor["type"]]
    stride = view.get("byteStride", size * width)
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    items = [struct.unpack_from(f"<{width}{code}", binary, start + i * stride)
             for i in range(accessor["count"])]
    return [item[0] for item in items] if width == 1 else items


def multiply(a, b):
    return [sum(a[4 * k + row] * b[4 * column + k] for k in range(4))
            for column in range(4) for row in range(4)]


def local_matrix(node):
    if "matrix" in node:
        return node["matrix"]
    tx, ty, tz = node.get("translation", (0, 0, 0))
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    sx, sy, sz = node.get("scale", (1, 1, 1))
    return [(1 - 2 * (y * y + z * z)) * sx, 2 * (x * y + w * z) * sx, 2 * (x * z - w * y) * sx, 0,
            2 * (x * y - w * z) * sy, (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z + w * x) * sy, 0,
            2 * (x * z + w * y) * sz, 2 * (y * z - w * x) * sz, (1 - 2 * (x * x + y * y)) * sz, 0,
            tx, ty, tz, 1]


def transform(m, p):
    return tuple(m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row]
                 for row in range(3))


def mesh_nodes(document):
    """(node, world matrix) of every node of the active scene that has a mesh."""
    scene = document["scenes"][document.get("scene", 0)]
    stack = [(index, IDENTITY) for index in scene.get("nodes", [])]
    while stack:
        index, parent = stack.pop()
        node = document["nodes"][index]
        world = multiply(parent, local_matrix(node))
        stack += [(child, world) for child in node.get("children", [])]
        if "mesh" in node:
            yield node, world


def read_material(material):
    pbr = material.get("pbrMetallicRoughness", {})
    color = pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]
    metallic = pbr.get("metallicFactor", 1)
    strength = (material.get("extensions", {}).get("KHR_materials_emissive_strength", {})
                .get("emissiveStrength", 1))
    emission = material.get("emissiveFactor", [0, 0, 0])
    return Material(material.get("name", ""), tuple(c * (1 - metallic) for c in color),
                    tuple(c * strength for c in emission), material.get("doubleSided", False))


def read_lit_scene(path):
    """Parts and materials of a scene whose materials have no textures but the lightmap."""
    document, binary = read_chunks(path)
    materials = [read_material(m) for m in document["materials"]]
    parts = []
    for node, world in mesh_nodes(document):
        placement = node.get("extensions", {}).get("MX_lightmap", {})
        su, sv = placement.get("scale", (1, 1))
        ou, ov = placement.get("offset", (0, 0))
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            material = document["materials"][primitive["material"]]
            uv_set = material["extensions"]["MOZ_lightmap"].get("texCoord", 0)
            attributes = primitive["attributes"]
            positions = read_accessor(document, binary, attributes["POSITION"])
            uvs = read_accessor(document, binary, attributes[f"TEXCOORD_{uv_set}"])
            indices = (read_accessor(document, binary, primitive["indices"])
                       if "indices" in primitive else range(len(positions)))
            corners = list(indices)
            parts.append(Part([transform(world, p) for p in positions],
                              [tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)],
                              [(ou + su * u, ov + sv * v) for u, v in uvs],
                              primitive["material"]))
    return parts, materials
