# SPDX-License-Identifier: Apache-2.0
"""What the tests of the command line share: a folder with a few scenes, and ways to run `aglow`.

Each test of this folder runs as

    cli_test.py AGLOW [-k TEXT]    -k: only tests whose name contains TEXT
"""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

AGLOW = os.path.abspath(sys.argv[1])
ROOT = pathlib.Path(__file__).resolve().parents[2]
FAST = ["--resolution", "64", "--quality", "draft"]


def aglow(*arguments, cwd, limit=None):
    """Runs `aglow` in a folder; `limit` is called in the child before it starts."""
    return subprocess.run([AGLOW, *map(str, arguments)], cwd=cwd, capture_output=True, text=True,
                          timeout=300, preexec_fn=limit)


def ground_plane(path, extensions_required=()):
    """A glTF of one horizontal square, 20 m wide, at height 0, facing up."""
    corners = [(-10, 0, -10), (-10, 0, 10), (10, 0, 10), (10, 0, -10)]
    data = b"".join(struct.pack("<3f", *c) for c in corners)
    data += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1],
                                                "metallicFactor": 0}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [-10, 0, -10], "max": [10, 0, 10]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": len(data), "uri": path.stem + ".bin"}],
    }
    if extensions_required:
        document["extensionsRequired"] = document["extensionsUsed"] = list(extensions_required)
    path.with_suffix(".bin").write_bytes(data)
    path.write_text(json.dumps(document))


class AglowTest(unittest.TestCase):
    """Runs in a folder with two scenes, one of them baked too, and a plane."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.temporary.name)
        for scene in ("cornell-box", "cube-tc58"):
            done = aglow("scene", scene, "-o", f"{scene}.glb", cwd=cls.dir)
            assert done.returncode == 0, done.stderr
        done = aglow("bake", "cornell-box.glb", "-o", "lit.glb", *FAST, "--json", cwd=cls.dir)
        assert done.returncode == 0, done.stderr
        cls.baked = json.loads(done.stdout)
        ground_plane(cls.dir / "plane.gltf")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def run_aglow(self, *arguments, code=0, says="", limit=None):
        done = aglow(*arguments, cwd=self.dir, limit=limit)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        if code not in (0, 7):
            self.assertEqual(done.stdout, "", "stdout carries results only")
            self.assertTrue(done.stderr.startswith("aglow"), done.stderr)
        self.assertIn(says, done.stderr)
        return done

    def json_of(self, *arguments, code=0):
        done = self.run_aglow(*arguments, "--json", "--quiet", code=code)
        self.assertEqual(done.stderr, "")
        return json.loads(done.stdout)

    def folder_names(self):
        return sorted(p.name for p in self.dir.iterdir())

    def gpus(self):
        """Those that can draw, as --device names them."""
        return [d["name"] for d in self.json_of("info")["devices"][1:] if "missing" not in d]


def main():
    """Runs the tests of the file that is run."""
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
