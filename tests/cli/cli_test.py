#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The command line, used as people use it: every command, every exit code, whole files only.

    cli_test.py AGLOW [-k TEXT]    -k: only tests whose name contains TEXT
"""
import csv
import json
import math
import os
import pathlib
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
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


class CommandLine(unittest.TestCase):
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

    def measured(self, *arguments, points):
        """Rows of `measure` at sensors (x, y, z, nx, ny, nz), as dictionaries of numbers."""
        lines = [",".join(map(str, point)) for point in points]
        (self.dir / "points.csv").write_text("x,y,z,nx,ny,nz\n" + "\n".join(lines) + "\n")
        self.run_aglow("measure", *arguments, "--points", "points.csv", "-o", "measured.csv")
        with open(self.dir / "measured.csv", newline="") as file:
            return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]

    def folder_names(self):
        return sorted(p.name for p in self.dir.iterdir())

    # --- what the program says of itself ---------------------------------------------------------

    def test_every_command_explains_itself(self):
        overview = self.run_aglow("--help").stdout
        for command in ("bake", "render", "measure", "compare", "validate", "bench", "scene",
                        "info"):
            self.assertIn(f"\n  {command} ", overview)
            text = self.run_aglow(command, "--help").stdout
            for shared in ("--device", "--threads", "--seed", "--json", "--quiet", "--verbose"):
                self.assertIn(shared, text)
        self.assertRegex(self.run_aglow("--version").stdout, r"^aglow \d+\.\d+\.\d+\n$")

    def test_the_manual_agrees_with_help(self):
        done = subprocess.run([sys.executable, ROOT / "tools/cli_docs.py", AGLOW,
                               ROOT / "docs/cli.md", "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + "run ./dev docs")

    # --- exit codes ------------------------------------------------------------------------------

    def test_wrong_usage_exits_with_1(self):
        bake = ("bake", "plane.gltf", "-o", "out.glb")
        for arguments, says in [
            ((), "Usage"),
            (("paint",), "paint"),
            (("bake",), "IN"),
            (("bench", "speed"), "accel"),
            (("bench", "accel", "--device", "cpu"), "--device gpu"),
            (("bake", "plane.gltf"), "--output"),
            ((*bake, "--shiny"), "--shiny"),
            ((*bake, "extra"), "extra"),
            (("bake", "plane.gltf", "-o", "out.txt"), ".glb"),
            ((*bake, "--threads", "-1"), "--threads"),
            ((*bake, "--threads", "two"), "two"),
            ((*bake, "--seed", "1.5"), "--seed"),
            ((*bake, "--texel-size", "0"), "--texel-size"),
            ((*bake, "--texel-size", "nan"), "nan"),
            ((*bake, "--resolution", "99999999999999999999"), "--resolution"),
            ((*bake, "--bounces", "-2"), "--bounces"),
            ((*bake, "--clay", "1.5"), "--clay"),
            ((*bake, "--sun", "0,30"), "--sun"),
            ((*bake, "--sun", "0,95,1000"), "elevation"),
            ((*bake, "--light", "0,1,0"), "--light"),
            ((*bake, "--light", "0,1,0,-5"), "negative"),
            ((*bake, "--sky", "-3"), "negative"),
            ((*bake, "--method", "magic"), "gather"),
            ((*bake, "--quality", "high", "--samples", "4"), "--samples"),
            ((*bake, "--texel-size", "1", "--resolution", "64"), "--resolution"),
            ((*bake, "--quiet", "--verbose"), "--verbose"),
            ((*bake, "--exposure", "1"), "--as unlit"),
            ((*bake, "--json", "--seed", "1", "--seed", "2"), "--seed"),
            (("bake", "cornell-box.glb", "-o", "cornell-box.glb"), "input"),
            (("measure", "plane.gltf", "-o", "m.csv"), "--grid"),
            (("measure", "plane.gltf", "-o", "m.csv", "--grid", "1", "--points", "p.csv"), "one"),
            (("measure", "plane.gltf", "-o", "m.csv", "--grid", "1e-5"), "sensors"),
            (("measure", "plane.gltf", "-o", "m.csv", "--points", "p", "--image", "i.png"),
             "--image"),
            (("render", "plane.gltf", "-o", "r.png", "--size", "10"), "WIDTH"),
            (("render", "lit.glb", "-o", "r.png", "--frames", "3"), "FIRST:LAST"),
            (("render", "lit.glb", "-o", "r.png", "--frames", "5:3"), "3:5"),
            (("render", "lit.glb", "-o", "r.png", "--frames", "0:1", "--time", "1"), "--time"),
            (("render", "lit.glb", "-o", "r.png", "--fps", "24"), "--frames"),
            (("render", "lit.glb", "-o", "r.png", "--engine", "path", "--reflections", "1"),
             "--engine rays"),
            (("render", "lit.glb", "-o", "r.png", "--device", "cpu", "--accel", "bvh"), "--accel"),
            (("render", "lit.glb", "-o", "r.png", "--light", "0,0,0,1"), "--engine path"),
            (("render", "lit.glb", "-o", "r.exr", "--exposure", "1"), ".png"),
            (("render", "lit.glb", "-o", "r.png", "--camera", "no such"), "no such"),
            (("scene", "palace", "-o", "p.glb"), "palace"),
            (("scene", "stress:5", "-o", "p.glb"), "stress"),
            (("scene", "--list", "-o", "p.glb"), "--list"),
            (("scene", "furnace"), "-o"),
            (("compare", "lit.exr"), "B"),
            (("compare", "lit.exr", "lit.exr", "--max-rmse", "x"), "--max-rmse"),
        ]:
            with self.subTest(arguments):
                if arguments:
                    self.run_aglow(*arguments, code=1, says=says)
                else:
                    self.assertEqual(aglow(cwd=self.dir).returncode, 1)
        self.assertFalse((self.dir / "out.glb").exists())

    def test_files_that_cannot_be_read_or_written_exit_with_2(self):
        for arguments, says in [
            (("bake", "nothing.glb", "-o", "out.glb"), "nothing.glb"),
            (("bake", ".", "-o", "out.glb"), "."),
            (("bake", "plane.gltf", "-o", "nowhere/out.glb"), "nowhere"),
            (("bake", "plane.gltf", "-o", "out.glb", "--sky", "nothing.hdr"), "nothing.hdr"),
            (("measure", "plane.gltf", "-o", "m.csv", "--points", "nothing.csv"), "nothing.csv"),
            (("compare", "lit.exr", "nothing.exr"), "nothing.exr"),
            (("info", "/dev/zero"), "/dev/zero"),
        ]:
            with self.subTest(arguments):
                self.run_aglow(*arguments, code=2, says=says)

    def test_invalid_input_exits_with_3(self):
        whole = (self.dir / "cornell-box.glb").read_bytes()
        (self.dir / "cut.glb").write_bytes(whole[:len(whole) // 2])
        (self.dir / "bad.csv").write_text("x,y,z,nx,ny,nz\n0,0,0,0,1,0\n0,0,0,0,one,0\n")
        (self.dir / "zero.csv").write_text("0,0,0,0,0,0\n")
        (self.dir / "empty.csv").write_text("\n")
        (self.dir / "bad.hdr").write_text("#?RADIANCE\n")
        self.run_aglow("bake", "cut.glb", "-o", "out.glb", code=3, says="cut.glb")
        measure = ("measure", "plane.gltf", "-o", "m.csv", "--points")
        self.run_aglow(*measure, "bad.csv", code=3, says="bad.csv: line 3")
        self.run_aglow(*measure, "zero.csv", code=3, says="normal")
        self.run_aglow(*measure, "empty.csv", code=3, says="no sensor")
        self.run_aglow("bake", "plane.gltf", "-o", "out.glb", "--sky", "bad.hdr", code=3,
                       says="bad.hdr")

    def test_exhausted_memory_exits_with_4(self):
        def little_memory():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        self.run_aglow("bake", "cornell-box.glb", "-o", "huge.glb", "--resolution", "16384",
                       "--threads", "1", code=4, says="memory", limit=little_memory)
        self.assertFalse((self.dir / "huge.glb").exists())

    def test_features_this_build_lacks_exit_with_5(self):
        ground_plane(self.dir / "strange.gltf", ["ACME_strange_light"])
        bake = ("bake", "plane.gltf", "-o", "out.glb")
        for arguments, says in [
            ((*bake, "--method", "hierarchical"), "gather"),
            ((*bake, "--method", "progressive"), "gather"),
            ((*bake, "--encode", "hce"), "lightmap"),
            ((*bake, "--device", "gpu"), "--device cpu"),
            ((*bake, "--device", "gpu:llvmpipe"), "--device cpu"),
            (("render", "lit.glb", "-o", "r.png", "--engine", "raster"), "rays"),
            (("refine", "plane.gltf", "-o", "out.glb"), "refine"),
            (("info", "strange.gltf"), "ACME_strange_light"),
        ]:
            with self.subTest(arguments):
                self.run_aglow(*arguments, code=5, says=says)

    def test_compare_tells_how_far_and_exits_with_7_beyond_the_bound(self):
        self.run_aglow("bake", "cornell-box.glb", "-o", "other.glb", *FAST, "--seed", "5")
        same = self.json_of("compare", "lit.glb", "lit.glb", "--max-rmse", "0")
        self.assertEqual((same["rmse"], same["relative_rmse"], same["max"]), (0, 0, 0))
        found = self.json_of("compare", "other.glb", "lit.glb")
        self.assertAlmostEqual(found["pixels"], self.baked["texels"],
                               delta=0.05 * self.baked["texels"])  # some lie inside the blocks
        self.assertGreater(found["relative_rmse"], 0)
        above, below = 101 * found["relative_rmse"], 99 * found["relative_rmse"]
        self.json_of("compare", "other.glb", "lit.glb", "--max-rmse", f"{above}%")
        self.json_of("compare", "other.glb", "lit.glb", "--max-rmse", f"{below}%", code=7)
        self.json_of("compare", "other.glb", "lit.glb", "--max-rmse", found["rmse"] * 0.99, code=7)
        self.json_of("compare", "other.exr", "lit.exr", "--max-rmse", "100%")
        self.run_aglow("bake", "cornell-box.glb", "-o", "small.glb", "--resolution", "32",
                       "--quality", "draft")
        self.run_aglow("compare", "small.glb", "lit.glb", code=1)

    # --- whole files only ------------------------------------------------------------------------

    def start_long_bake(self, output):
        return subprocess.Popen([AGLOW, "bake", "cornell-box.glb", "-o", output, "--resolution",
                                 "1024", "--method", "path", "--samples", "100000"],
                                cwd=self.dir, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def test_an_interrupted_run_exits_with_130_and_leaves_nothing(self):
        for sent in (signal.SIGINT, signal.SIGTERM):
            before = self.folder_names()
            process = self.start_long_bake("interrupted.glb")
            time.sleep(1)
            process.send_signal(sent)
            start = time.monotonic()
            stdout, stderr = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130, stderr)
            self.assertLess(time.monotonic() - start, 10)
            self.assertEqual(stdout, b"")
            self.assertEqual(self.folder_names(), before)

    def test_a_killed_run_leaves_the_old_file_as_it_was(self):
        old = self.dir / "old.glb"
        old.write_bytes(b"what was here before")
        process = self.start_long_bake("old.glb")
        time.sleep(1)
        process.kill()
        process.communicate(timeout=60)
        self.assertEqual(old.read_bytes(), b"what was here before")

    def test_a_failed_write_leaves_the_old_file_and_no_other(self):
        def small_files_only():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))
        for name, arguments in [("keep.glb", ("bake", "cornell-box.glb", *FAST)),
                                ("keep.csv", ("measure", "cornell-box.glb", "--grid", "0.02",
                                              "--method", "path", "--samples", "1")),
                                ("keep.png", ("render", "lit.glb", "--size", "99x99")),
                                ("keep2.glb", ("scene", "stress:1000"))]:
            with self.subTest(name):
                (self.dir / name).write_text("old")
                before = self.folder_names()
                self.run_aglow(*arguments, "-o", name, code=2, says=name, limit=small_files_only)
                self.assertEqual((self.dir / name).read_text(), "old")
                self.assertEqual(self.folder_names(), before)

    # --- results ---------------------------------------------------------------------------------

    def test_bake_reports_what_the_contract_names(self):
        wanted = {"scene", "device", "method", "encode", "triangles", "texels", "samples",
                  "seconds", "peak_memory_bytes", "rays", "mean_irradiance_lux", "outputs",
                  "charts", "bounces", "black_texels", "clipped_share", "warnings"}
        self.assertLessEqual(wanted, set(self.baked))
        self.assertEqual(set(self.baked["seconds"]),
                         {"load", "unwrap", "solve", "encode", "write", "total"})
        self.assertEqual((self.baked["device"], self.baked["method"]), ("cpu", "gather"))
        self.assertGreater(self.baked["mean_irradiance_lux"], 0)
        self.assertEqual(self.baked["outputs"][0], "lit.glb")
        for output in self.baked["outputs"]:
            self.assertTrue((self.dir / output).is_file(), output)

    def test_other_commands_report_in_json_too(self):
        scenes = {s["name"] for s in self.json_of("scene", "--list")["scenes"]}
        self.assertLessEqual({"cornell-box", "furnace", "cube-tc58", "corridor", "living-room"},
                             scenes)
        devices = self.json_of("info")["devices"]
        self.assertEqual(devices[0]["name"], "cpu")
        for gpu in devices[1:]:
            self.assertTrue(gpu["name"].startswith("gpu:"), gpu)
            self.assertIn(gpu["kind"], ("discrete", "integrated", "virtual", "software"))
        info = self.json_of("info", "plane.gltf", "--sun", "0,45,1000")
        self.assertEqual((info["triangles"], info["lights"]["directional"]), (2, 1))
        self.assertAlmostEqual(info["surface_area"], 400, delta=0.01)
        report = self.json_of("render", "lit.glb", "-o", "r.exr", "--size", "32x24")
        self.assertEqual(report["size"], [32, 24])
        validated = self.json_of("validate", "--filter", "point light", "--scale", "1")
        self.assertTrue(validated["passed"])
        self.assertGreater(len(validated["cases"]), 0)

    def test_structures_are_measured_beside_embree(self):
        arguments = ("bench", "accel", "--scene", "cornell-box", "--scene", "plane.gltf",
                     "--rays", "256", "--device", "gpu:llvmpipe")
        if aglow(*arguments, cwd=self.dir).returncode == 5:
            self.skipTest("there is no Vulkan driver")
        report = self.json_of(*arguments)
        self.assertIn("llvmpipe", report["device"])
        self.assertEqual([s["scene"] for s in report["scenes"]], ["cornell-box", "plane.gltf"])
        for scene in report["scenes"]:
            embree, *structures = scene["structures"]
            self.assertEqual([s["accel"] for s in structures], ["grid", "grid2", "bvh"])
            for structure in structures:
                self.assertGreater(structure["build_ms"], 0)
                self.assertGreaterEqual(structure["references_per_triangle"], 1)
                for rays in ("primary", "shadow", "diffuse"):
                    self.assertEqual(structure[rays]["rays"], embree[rays]["rays"])
                    self.assertGreater(structure[rays]["ratio_to_embree"], 0)
        text = self.run_aglow(*arguments).stdout
        for word in ("cornell-box", "plane.gltf", "embree", "grid2", "bvh", "diffuse"):
            self.assertIn(word, text)

    def test_frames_are_numbered_files_of_one_exposure(self):
        report = self.json_of("render", "lit.glb", "-o", "f.png", "--size", "32x24", "--frames",
                              "2:4", "--fps", "10", "--device", "cpu")
        self.assertEqual(report["outputs"], ["f-0002.png", "f-0003.png", "f-0004.png"])
        self.assertEqual((report["frames"], report["device"]), (3, "cpu"))
        self.assertEqual([p["pass"] for p in report["passes"]], ["pose", "build", "trace"])
        self.assertGreaterEqual(report["rays"], 3 * 32 * 24 * 16)
        still = [(self.dir / name).read_bytes() for name in report["outputs"]]
        self.assertEqual(still[0], still[1])
        self.assertEqual(still[0], still[2])
        self.assertFalse((self.dir / "f.png").exists())

    def test_a_gpu_draws_the_same_picture(self):
        gpus = [d["name"] for d in self.json_of("info")["devices"][1:] if "missing" not in d]
        if not gpus:
            self.skipTest("no GPU")
        self.run_aglow("render", "lit.glb", "-o", "r.png", "--device", "gpu:no such", code=5,
                       says="no such")
        picture = ("--size", "48x32", "--samples", "4")
        self.run_aglow("render", "lit.glb", "-o", "cpu.exr", *picture, "--device", "cpu")
        for accel in ("grid", "grid2", "bvh"):
            report = self.json_of("render", "lit.glb", "-o", f"{accel}.exr", *picture, "--device",
                                  gpus[0], "--accel", accel)
            self.assertEqual((report["device"], report["accel"]), (gpus[0], accel))
            self.run_aglow("compare", f"{accel}.exr", "cpu.exr", "--max-rmse", "1%")

    def test_an_interrupted_sequence_keeps_the_finished_frames(self):
        process = subprocess.Popen(
            [AGLOW, "render", "lit.glb", "-o", "long.png", "--frames", "0:999", "--size",
             "160x120"], cwd=self.dir, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        deadline = time.monotonic() + 60
        while not (self.dir / "long-0001.png").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        frames = sorted(self.dir.glob("long*"))
        self.assertGreaterEqual(len(frames), 2)
        self.assertEqual([f.name for f in frames],
                         [f"long-{i:04}.png" for i in range(len(frames))])
        for frame in frames:
            self.assertEqual(frame.read_bytes()[-12:], frames[0].read_bytes()[-12:])  # IEND

    def test_light_is_computed_on_the_spot_where_none_is_baked(self):
        sun = ("--size", "16x16", "--sun", "0,60,1000", "--samples", "64")
        self.run_aglow("render", "plane.gltf", "-o", "sun.exr", *sun, "--reflections", "0")
        self.run_aglow("render", "plane.gltf", "-o", "path.exr", *sun, "--engine", "path")
        self.run_aglow("compare", "sun.exr", "path.exr", "--max-rmse", "5")
        dark = self.run_aglow("render", "plane.gltf", "-o", "dark.exr", "--size", "16x16")
        self.assertIn("nothing in the scene shines", dark.stderr)

    def test_text_says_what_json_says(self):
        text = self.run_aglow("info", "plane.gltf").stdout
        self.assertRegex(text, r"(?m)^triangles +2$")

    def test_results_do_not_depend_on_threads_or_run(self):
        for run, threads in (("t1", "1"), ("t2", "2"), ("t3", "2")):
            shared = ("--threads", threads, "--seed", "3")
            (self.dir / run).mkdir(exist_ok=True)
            self.run_aglow("bake", "cornell-box.glb", "-o", f"{run}/b.glb", *FAST, *shared)
            self.run_aglow("bake", "cornell-box.glb", "-o", f"{run}/p.glb", "--resolution", "32",
                           "--method", "path", "--samples", "16", *shared)
            self.run_aglow("measure", "cornell-box.glb", "-o", f"{run}/m.csv", "--grid", "0.1",
                           "--image", f"{run}/m.png", *FAST, *shared)
            self.run_aglow("render", "lit.glb", "-o", f"{run}/r.png", "--size", "64x64", *shared)
            self.run_aglow("render", "cornell-box.glb", "-o", f"{run}/p.png", "--size", "32x32",
                           "--engine", "path", "--samples", "4", *shared)
        files = sorted(p.name for p in (self.dir / "t1").iterdir())
        self.assertGreaterEqual(len(files), 9)
        for other in ("t2", "t3"):
            self.assertEqual(files, sorted(p.name for p in (self.dir / other).iterdir()))
            for name in files:
                self.assertEqual((self.dir / "t1" / name).read_bytes(),
                                 (self.dir / other / name).read_bytes(), f"{other}/{name}")

    def test_a_point_light_gives_intensity_over_distance_squared(self):
        floor = (0, -1.999999, 0, 0, 2, 0)  # in the cube's frame, its centre at the origin or not
        info = self.json_of("info", "cube-tc58.glb")
        low, high = info["bounds"]["low"], info["bounds"]["high"]
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        at = [centre[0], centre[1] - 1, centre[2]]
        row, = self.measured("cube-tc58.glb", "--bounces", "0", *FAST, points=[(*at, *floor[3:])])
        self.assertAlmostEqual(row["E"], 10000 / (4 * math.pi), delta=0.5)  # 1 m below 10 klm
        self.assertEqual(row["indirect"], 0)
        self.assertEqual(row["ny"], 1)

    def test_sky_sun_and_lights_mean_what_the_options_say(self):
        up, north, east = (0, 1, 0, 0, 1, 0), (0, 1, 0, 0, 0, -1), (0, 1, 0, 1, 0, 0)
        exact = ("plane.gltf", "--bounces", "0", "--samples", "1024", "--resolution", "16")
        sky, = self.measured(*exact, "--sky", "100", points=[up])
        self.assertAlmostEqual(sky["E"], math.pi * 100, delta=0.5)
        sun = self.measured(*exact, "--sun", "0,30,1000", points=[up, north, east])
        for row, expected in zip(sun, (500, 1000 * math.cos(math.radians(30)), 0)):
            self.assertAlmostEqual(row["direct"], expected, delta=0.5)
        sun = self.measured(*exact, "--sun", "90,0,1000", points=[up, north, east])
        for row, expected in zip(sun, (0, 0, 1000)):
            self.assertAlmostEqual(row["direct"], expected, delta=0.5)
        lamp = "0,2,0,1256.637"  # 100 cd, 1 m above the sensor
        lights, = self.measured(*exact, "--light", lamp, "--light", "-1e0,2,0,0", points=[up])
        self.assertAlmostEqual(lights["E"], 100, delta=0.1)
        self.assertAlmostEqual(lights["E"], 0.2126 * lights["Er"] + 0.7152 * lights["Eg"] +
                               0.0722 * lights["Eb"], delta=1e-3)
        grey, = self.measured("plane.gltf", "--sky", "100", "--clay", "0.2", "--samples", "1024",
                              "--resolution", "16", points=[(0, 0.001, 0, 0, -1, 0)])
        self.assertAlmostEqual(grey["E"], 0.2 * math.pi * 100, delta=1)  # the lit ground, from above

    def test_luminaires_shine_by_their_ies_file_wherever_the_scene_goes(self):
        folder = self.dir / "luminaires"
        folder.mkdir()
        (folder / "lamp.ies").write_text(  # 100 cd straight down, 50 cd from 60 degrees on
            "IESNA:LM-63-2002\n[LUMINAIRE] lamp\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 0\n"
            "0 60 90\n0\n100 50 50\n")
        points = [(0, 0.0001, 0, 0, 1, 0), (2 * math.sqrt(3), 0.0001, 0, 0, 1, 0)]
        expected = [100 / 4, 50 / 16 * 0.5]

        def check(scene, *words):
            rows = self.measured(scene, *words, "--bounces", "0", *FAST, points=points)
            for row, value in zip(rows, expected):
                self.assertAlmostEqual(row["E"], value, delta=0.01)

        check("plane.gltf", "--light", "0,2,0,luminaires/lamp.ies")
        ground_plane(folder / "lit.gltf")
        document = json.loads((folder / "lit.gltf").read_text())
        document["extensionsUsed"] = document["extensionsRequired"] = ["EXT_lights_ies"]
        document["extensions"] = {"EXT_lights_ies": {"lights": [{"uri": "lamp.ies"}]}}
        half = math.sqrt(0.5)
        document["nodes"].append({"translation": [0, 2, 0], "rotation": [-half, 0, 0, half],
                                  "extensions": {"EXT_lights_ies": {"light": 0}}})
        document["scenes"][0]["nodes"].append(1)
        (folder / "lit.gltf").write_text(json.dumps(document))
        check("luminaires/lit.gltf")
        for out in ("moved.glb", "moved.gltf"):
            self.run_aglow("bake", "luminaires/lit.gltf", "-o", out, *FAST)
            self.assertEqual(self.json_of("info", out)["lights"]["photometric"], 1)
            check(out)
        (folder / "broken.ies").write_text("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 two")
        for name, code, says in (("broken.ies", 3, "number of vertical angles"),
                                 ("missing.ies", 2, "missing.ies")):
            self.run_aglow("measure", "plane.gltf", "-o", "no.csv", "--grid", "5", "--light",
                           f"0,2,0,luminaires/{name}", code=code, says=says)
        self.assertFalse((self.dir / "no.csv").exists())

    def test_measure_reads_what_spreadsheets_write(self):
        (self.dir / "odd.csv").write_bytes(
            b"\xef\xbb\xbfX, Y, Z, NX, NY, NZ\r\n\r\n# desk\r\n 0 , 1 ,0, 0, 3, 0 \r\n")
        self.run_aglow("measure", "plane.gltf", "-o", "odd_out.csv", "--points", "odd.csv", "--sky",
                       "1", *FAST)
        lines = (self.dir / "odd_out.csv").read_text().splitlines()
        self.assertEqual(lines[0], "x,y,z,nx,ny,nz,Er,Eg,Eb,E,direct,indirect")
        self.assertEqual(lines[1].split(",")[:6], ["0", "1", "0", "0", "1", "0"])

    def test_a_grid_covers_upward_faces_and_draws_a_plan(self):
        report = self.json_of("measure", "plane.gltf", "-o", "g.csv", "--grid", "1", "--sky", "10",
                              "--image", "g.png", *FAST)
        self.assertAlmostEqual(report["sensors"], 400, delta=41)
        self.assertAlmostEqual(report["mean_irradiance_lux"], math.pi * 10, delta=0.2)
        self.assertEqual((self.dir / "g.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
