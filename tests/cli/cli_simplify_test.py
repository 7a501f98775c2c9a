#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Dense meshes made coarse: what `aglow simplify` writes and says."""
import json
import struct
import subprocess

import harness


def gltf_of(path):
    """The JSON of a GLB."""
    data = path.read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length])


class Simplify(harness.AglowTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        done = harness.aglow("scene", "sculpture:30000", "-o", "dense.glb", cwd=cls.dir)
        assert done.returncode == 0, done.stderr

    def test_a_rough_shape_keeps_its_form_in_two_percent_of_its_triangles(self):
        report = self.json_of("simplify", "dense.glb", "-o", "fair.glb", "--ratio", "0.02")
        self.assertLessEqual(report["ratio"], 0.02)
        mesh, = report["meshes"]
        self.assertLess(mesh["rms_of_diagonal"], 1e-3)
        self.assertGreaterEqual(mesh["hausdorff"], mesh["rms"])
        self.assertAlmostEqual(mesh["rms"], mesh["rms_of_diagonal"] * mesh["diagonal"])
        self.assertGreaterEqual(mesh["refined_triangles"], mesh["dense_triangles"])
        self.assertEqual(report["outputs"], ["fair.displacement.exr", "fair.glb"])
        for name in report["outputs"]:
            self.assertTrue((self.dir / name).exists())

        document = gltf_of(self.dir / "fair.glb")
        primitive = document["meshes"][0]["primitives"][0]
        self.assertEqual(primitive["extras"]["displacement"],
                         {"uri": "fair.displacement.exr", "texCoord": 0, "scale": 1, "bias": 0})
        self.assertIn("TANGENT", primitive["attributes"])
        material = document["materials"][primitive["material"]]
        self.assertEqual(document["textures"][material["normalTexture"]["index"]]["source"], 0)
        self.assertEqual(self.json_of("info", "fair.glb")["triangles"], report["triangles"])

    def test_refine_finds_the_heights_by_itself_and_leaves_no_trace_of_them(self):
        report = self.json_of("simplify", "dense.glb", "-o", "coarse.glb", "--no-compare")
        refined = self.json_of("refine", "coarse.glb", "-o", "again.glb", "--level", "3")
        self.assertEqual(refined["refined"]["triangles"], 64 * report["triangles"])
        document = gltf_of(self.dir / "again.glb")
        self.assertNotIn("extras", document["meshes"][0]["primitives"][0])
        self.assertNotIn("normalTexture", document["materials"][0])
        dense, again = (self.json_of("info", name)["bounds"] for name in ("dense.glb", "again.glb"))
        for side in ("low", "high"):
            for a, b in zip(dense[side], again[side]):
                self.assertAlmostEqual(a, b, delta=0.005)

    def test_drawing_refined_shows_the_dense_shape(self):
        if not self.gpus():
            self.skipTest("no GPU")
        self.run_aglow("simplify", "dense.glb", "-o", "drawn.glb", "--ratio", "0.04",
                       "--no-compare")
        def drawn(scene, name, *arguments):
            return self.json_of("render", scene, "-o", f"{name}.exr", "--size", "160x120",
                                "--sky", "20", "--sun", "120,50,3000", "--engine", "raster",
                                "--device", self.gpus()[0], *arguments)
        dense = drawn("dense.glb", "dense")
        drawn("drawn.glb", "coarse")
        drawn("drawn.glb", "uniform", "--refine", "pn:3")
        auto = drawn("drawn.glb", "auto", "--refine", "auto:0.25")
        self.assertLess(auto["triangles"], 2 * dense["triangles"])
        def rmse(name):
            return self.json_of("compare", f"{name}.exr", "dense.exr")["relative_rmse"]
        self.assertLess(rmse("uniform"), 0.5 * rmse("coarse"))
        self.assertLess(rmse("auto"), 0.6 * rmse("coarse"))

    def test_the_khronos_validator_finds_nothing(self):
        self.run_aglow("simplify", "dense.glb", "-o", "valid.glb", "--no-compare")
        done = subprocess.run(["node", harness.ROOT / "tools" / "validate_gltf.mjs", "--warnings",
                               "valid.glb"], cwd=self.dir, capture_output=True, text=True,
                              timeout=300)
        if done.returncode == 3:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_same_input_gives_the_same_bytes_for_any_number_of_threads(self):
        for name, threads in (("one", 1), ("three", 3)):
            (self.dir / name).mkdir()
            self.run_aglow("simplify", "dense.glb", "-o", f"{name}/same.glb", "--map-size", "256",
                           "--no-compare", "--threads", threads)
        for file in ("same.glb", "same.displacement.exr"):
            self.assertEqual((self.dir / "one" / file).read_bytes(),
                             (self.dir / "three" / file).read_bytes())

    def test_a_bound_on_the_error_keeps_more_triangles(self):
        few = self.json_of("simplify", "dense.glb", "-o", "few.glb", "--no-compare")
        more = self.json_of("simplify", "dense.glb", "-o", "more.glb", "--no-compare",
                            "--max-error", "0.0005")
        self.assertGreater(more["triangles"], 2 * few["triangles"])
        self.assertNotIn("rms", few["meshes"][0])

    def test_a_scene_of_several_meshes_has_a_map_for_each(self):
        report = self.json_of("simplify", "cornell-box.glb", "-o", "box.glb", "--ratio", "1",
                              "--map-size", "64")
        self.assertEqual(report["triangles"], report["dense_triangles"])
        self.assertEqual(len(report["outputs"]), len(report["meshes"]) + 1)
        for mesh in report["meshes"]:
            self.assertLess(mesh["rms_of_diagonal"], 1e-5)

    def test_wrong_usage_is_told(self):
        simplify = ("simplify", "dense.glb", "-o", "out.glb")
        for arguments, says in [
            ((*simplify, "--ratio", "0"), "--ratio"),
            ((*simplify, "--ratio", "1.5"), "--ratio"),
            ((*simplify, "--max-error", "-1"), "--max-error"),
            ((*simplify, "--map-size", "4"), "--map-size"),
            (("simplify", "dense.glb", "-o", "out.gltf"), ".glb"),
            (("simplify", "dense.glb", "-o", "dense.glb"), "input"),
            (("simplify", "dense.glb"), "-o"),
        ]:
            with self.subTest(arguments):
                self.run_aglow(*arguments, code=1, says=says)
        self.assertFalse((self.dir / "out.glb").exists())
        self.run_aglow("simplify", "nothing.glb", "-o", "out.glb", code=2, says="nothing.glb")


if __name__ == "__main__":
    harness.main()
