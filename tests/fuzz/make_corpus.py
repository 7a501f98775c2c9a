#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the seed corpus of gltf_fuzz: small files that reach every reader of the loader.

usage: make_corpus.py FOLDER
"""
import base64
import json
import pathlib
import struct
import sys
import zlib

F32, U16, U8, I16, I8 = 5126, 5123, 5121, 5122, 5120
FORMATS = {F32: "f", U16: "H", U8: "B", I16: "h", I8: "b"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class File:
    """A glTF document under construction, with one buffer."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []}
        self.bytes = b""

    def view(self, data, **more):
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more})
        self.bytes += data + b"\0" * (-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, shape="VEC3", component=F32, **more):
        data = struct.pack(f"<{len(values)}{FORMATS[component]}", *values)
        self.json["accessors"].append({"bufferView": self.view(data), "componentType": component,
                                       "type": shape, "count": len(values) // WIDTHS[shape], **more})
        return len(self.json["accessors"]) - 1

    def glb(self):
        self.json.setdefault("buffers", [{}])[0]["byteLength"] = len(self.bytes)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<II", len(text), 0x4E4F534A) + text
        body += struct.pack("<II", len(self.bytes), 0x004E4942) + self.bytes
        return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body

    def gltf(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        self.json["buffers"] = [{"byteLength": len(self.bytes), "uri": uri}]
        return json.dumps(self.json).encode()


SQUARE = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes((x * 37 + y * 91 + c * 50) % 256 for x in range(width)
                                  for c in range(3)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def plain():
    f = File()
    position = f.accessor(SQUARE)
    f.json["meshes"] = [{"primitives": [
        {"attributes": {"POSITION": position}, "mode": mode} for mode in range(7)]}]
    f.json["nodes"] = [{"mesh": 0, "children": [1], "scale": [1, -2, 1]},
                       {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 4, 1]}]
    f.json["scenes"] = [{"nodes": [0]}]
    f.json["scene"] = 0
    return f


def textured():
    f = File()
    f.json["images"] = [{"bufferView": f.view(png(3, 2)), "mimeType": "image/png"}]
    f.json["samplers"] = [{"wrapS": 33071, "magFilter": 9728}]
    f.json["textures"] = [{"source": 0, "sampler": 0}]
    transform = {"KHR_texture_transform": {"offset": [0.5, 0], "scale": [2, 2], "rotation": 1}}
    f.json["materials"] = [{
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": transform},
                                 "metallicFactor": 0},
        "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}, "alphaMode": "MASK",
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 50}}}]
    f.json["meshes"] = [{"primitives": [{
        "attributes": {"POSITION": f.accessor(SQUARE),
                       "NORMAL": f.accessor([0, 0, 127] * 4, component=I8, normalized=True),
                       "TEXCOORD_0": f.accessor([0, 0, 1, 0, 0, 1, 1, 1], "VEC2"),
                       "COLOR_0": f.accessor([255, 0, 0, 255] * 4, "VEC4", U8, normalized=True)},
        "indices": f.accessor([0, 1, 2, 2, 1, 3], "SCALAR", U16), "material": 0}]}]
    f.json["nodes"] = [{"mesh": 0}]
    return f


def sparse():
    f = File()
    position = f.accessor(SQUARE)
    f.json["accessors"][position]["sparse"] = {
        "count": 1, "indices": {"bufferView": f.view(b"\2"), "componentType": U8},
        "values": {"bufferView": f.view(struct.pack("<3f", 5, 6, 7))}}
    f.json["accessors"].append({"componentType": F32, "type": "VEC3", "count": 4})
    f.json["meshes"] = [{"weights": [0.5], "primitives": [{
        "attributes": {"POSITION": position}, "targets": [{"POSITION": 1, "NORMAL": 1}]}]}]
    f.json["nodes"] = [{"mesh": 0, "weights": [1]}]
    return f


def animated():
    f = File()
    f.json["meshes"] = [{"primitives": [{"attributes": {
        "POSITION": f.accessor(SQUARE),
        "JOINTS_0": f.accessor([0, 1, 0, 0] * 4, "VEC4", U8),
        "WEIGHTS_0": f.accessor([0.5, 0.5, 0, 0] * 4, "VEC4")}}]}]
    f.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices":
                        f.accessor([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2, "MAT4")}]
    f.json["nodes"] = [{"mesh": 0, "skin": 0}, {"children": [2]}, {}]
    times = f.accessor([0, 1], "SCALAR")
    outputs = [f.accessor([0, 0, 0, 1, 2, 3]),
               f.accessor([0, 0, 0, 1, 0, 1, 0, 0], "VEC4"),
               f.accessor([1] * 18)]
    f.json["animations"] = [{
        "samplers": [{"input": times, "output": outputs[0], "interpolation": "STEP"},
                     {"input": times, "output": outputs[1]},
                     {"input": times, "output": outputs[2], "interpolation": "CUBICSPLINE"}],
        "channels": [{"sampler": i, "target": {"node": i, "path": path}}
                     for i, path in enumerate(["translation", "rotation", "scale"])]}]
    return f


def lights():
    f = File()
    f.json["meshes"] = [{"primitives": [{"attributes": {"POSITION": f.accessor(SQUARE)}}]}]
    f.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                         {"type": "orthographic",
                          "orthographic": {"xmag": 1, "ymag": 1, "zfar": 2, "znear": 0}}]
    ies = "IESNA:LM-63-2002%0ATILT=NONE%0A1 -1 1 2 2 1 2 0 0 0 1 1 0%0A0 90 0 90 9 8 7 6"
    f.json["extensions"] = {"EXT_lights_ies": {"lights": [{"uri": "data:," + ies}]}}
    f.json["extensions"]["KHR_lights_punctual"] = {"lights": [
        {"type": "spot", "intensity": 5, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}},
        {"type": "directional", "color": [1, 0.5, 0]}, {"type": "point", "range": 4}]}
    f.json["nodes"] = [
        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"camera": 1, "extensions": {"MSFT_lod": {"ids": [0]},
                                     "EXT_lights_ies": {"light": 0, "multiplier": 2}}},
        {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {
            "TRANSLATION": f.accessor([1, 2, 3, 4, 5, 6]),
            "ROTATION": f.accessor([0, 0, 0, 32767] * 2, "VEC4", I16, normalized=True)}}}}]
    f.json["extensionsRequired"] = ["KHR_lights_punctual", "EXT_mesh_gpu_instancing"]
    return f


# One triangle, compressed once by meshoptimizer 0.18 (12-byte vertices, 16-bit indices) and by
# Draco 1.5.5 (POSITION under unique id 0); one WebP pixel.
MESHOPT_VERTICES = base64.b64decode(
    "oAAAATwAAAD//wE8AAAAfn0AAAEMAAAA/wEMAAAAfgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
    "AAAAAAAAAA==")
MESHOPT_INDICES = base64.b64decode("4PAAdodWZ3iphmWJaJgBaQAA")
DRACO = base64.b64decode(
    "RFJBQ08CAgEBAAAAAwEAAQAAAQf/AREB/wAAAQAJAwAAAgEBAQADA1UVrSoDBHCBMRAAAAAA/wcAAAAA"
    "AAAAAAAAAAAAAAAAgD8L")
WEBP = base64.b64decode("UklGRiAAAABXRUJQVlA4TBQAAAAvAAAAAAdQgVQIIAAKmv7HiIj+Bw==")


def meshopt():
    f = File()
    f.json["buffers"] = [{}, {"byteLength": 44, "extensions":
                              {"EXT_meshopt_compression": {"fallback": True}}}]
    for data, more in [(MESHOPT_VERTICES, {"byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}),
                       (MESHOPT_INDICES, {"byteStride": 2, "count": 3, "mode": "TRIANGLES"})]:
        raw = f.json["bufferViews"].pop(f.view(data))
        f.json["bufferViews"].append({
            "buffer": 1, "byteOffset": 36 if more["byteStride"] == 2 else 0,
            "byteLength": more["byteStride"] * 3,
            "extensions": {"EXT_meshopt_compression": {**raw, **more}}})
    f.json["accessors"] = [{"bufferView": 0, "componentType": F32, "type": "VEC3", "count": 3},
                           {"bufferView": 1, "componentType": U16, "type": "SCALAR", "count": 3}]
    f.json["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]
    f.json["nodes"] = [{"mesh": 0}]
    return f


def draco():
    f = File()
    view = f.view(DRACO)
    f.json["accessors"] = [{"componentType": F32, "type": "VEC3", "count": 3},
                           {"componentType": U16, "type": "SCALAR", "count": 3}]
    f.json["meshes"] = [{"primitives": [{
        "attributes": {"POSITION": 0}, "indices": 1, "extensions": {"KHR_draco_mesh_compression": {
            "bufferView": view, "attributes": {"POSITION": 0}}}}]}]
    f.json["nodes"] = [{"mesh": 0}]
    return f


def webp():
    f = textured()
    f.json["images"].append({"bufferView": f.view(WEBP), "mimeType": "image/webp"})
    f.json["textures"] = [{"extensions": {"EXT_texture_webp": {"source": 1}}}]
    return f


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for make in [plain, textured, sparse, animated, lights, meshopt, draco, webp]:
        (folder / f"{make.__name__}.glb").write_bytes(make().glb())
    (folder / "plain.gltf").write_bytes(plain().gltf())
