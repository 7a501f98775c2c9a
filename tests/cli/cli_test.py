#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The command line, used as people use it: every command, every exit code, whole files only."""
import json
import resource
import signal
import subprocess
import sys
import time

import harness
from harness import AGLOW, FAST, ROOT, aglow, ground_plane


class CommandLine(harness.AglowTest):
    # --- what the program says of itself ---------------------------------------------------------

    def test_every_command_explains_itself(self):
        overview = self.run_aglow("--help").stdout
        for command in ("bake", "render", "refine", "simplify", "measure", "compare", "validate",
                        "bench", "scene", "info"):
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
            (("refine", "plane.gltf", "-o", "out.glb", "--device", "gpu"), "--device cpu"),
            (("view", "plane.gltf"), "refine"),
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


if __name__ == "__main__":
    harness.main()
