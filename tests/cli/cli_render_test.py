#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures: what `aglow render` draws, on the CPU and on a GPU, and what `aglow bench` measures."""
import resource
import signal
import subprocess
import time

import harness
from harness import AGLOW, aglow


class Pictures(harness.AglowTest):
    def test_frames_are_numbered_files_of_one_exposure(self):
        report = self.json_of("render", "lit.glb", "-o", "f.png", "--size", "32x24", "--frames",
                              "2:4", "--fps", "10", "--device", "cpu")
        self.assertEqual(report["outputs"], ["f-0002.png", "f-0003.png", "f-0004.png"])
        self.assertEqual((report["frames"], report["device"]), (3, "cpu"))
        self.assertEqual([p["pass"] for p in report["passes"]], ["pose", "build", "trace"])
        kinds = report["rays_by_kind"]
        self.assertEqual(list(kinds), ["camera", "mirror", "shadow"])
        self.assertEqual(kinds["camera"], 3 * 32 * 24 * 16)
        self.assertEqual(report["rays"], sum(kinds.values()))
        still = [(self.dir / name).read_bytes() for name in report["outputs"]]
        self.assertEqual(still[0], still[1])
        self.assertEqual(still[0], still[2])
        self.assertFalse((self.dir / "f.png").exists())

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

    def test_a_gpu_draws_the_same_picture(self):
        gpus = self.gpus()
        if not gpus:
            self.skipTest("no GPU")
        self.run_aglow("render", "lit.glb", "-o", "r.png", "--device", "gpu:no such", code=5,
                       says="no such")
        picture = ("--size", "48x32", "--samples", "4")
        cpu = self.json_of("render", "lit.glb", "-o", "cpu.exr", *picture, "--device", "cpu")
        for accel in ("grid", "grid2", "bvh"):
            report = self.json_of("render", "lit.glb", "-o", f"{accel}.exr", *picture, "--device",
                                  gpus[0], "--accel", accel)
            self.assertEqual((report["device"], report["accel"]), (gpus[0], accel))
            self.assertEqual(report["rays_by_kind"], cpu["rays_by_kind"])
            self.run_aglow("compare", f"{accel}.exr", "cpu.exr", "--max-rmse", "1%")

    def test_a_picture_that_fits_nowhere_says_what_it_needs(self):
        if not any("llvmpipe" in gpu for gpu in self.gpus()):
            self.skipTest("there is no Vulkan driver")
        def little_memory():
            resource.setrlimit(resource.RLIMIT_AS, (5 << 29, 5 << 29))
        done = aglow("render", "lit.glb", "-o", "huge.png", "--size", "16384x16384", "--samples",
                     "1", "--threads", "1", "--device", "gpu:llvmpipe", cwd=self.dir,
                     limit=little_memory)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(f'buffer "image" needs {16384 * 16384 * 12} bytes', done.stderr)
        self.assertIn("the CPU goes on", done.stderr)
        self.assertIn("not enough memory for 16384 x 16384 pixels", done.stderr)
        self.assertFalse((self.dir / "huge.png").exists())

    def test_triangles_are_drawn_as_rays_see_them(self):
        gpus = self.gpus()
        if not gpus:
            self.skipTest("no GPU")
        size = ("--size", "48x32")
        report = self.json_of("render", "lit.glb", "-o", "raster.exr", *size, "--engine", "raster",
                              "--device", gpus[0])
        self.assertEqual((report["engine"], report["device"]), ("raster", gpus[0]))
        self.assertEqual([p["pass"] for p in report["passes"] if p["pass"] != "other"],
                         ["pose", "draw", "read", "host"])
        sun = ("render", "plane.gltf", *size, "--sun", "0,60,1000", "-o")
        self.run_aglow(*sun, "raster.exr", "--engine", "raster", "--device", gpus[0])
        self.run_aglow(*sun, "rays.exr", "--reflections", "0")
        # Within the plane they agree; its outline is filtered by a box here, by a tent there.
        self.run_aglow("compare", "raster.exr", "rays.exr", "--max-rmse", "12%")
        self.run_aglow("render", "lit.glb", "-o", "r.png", "--engine", "raster", "--device", "cpu",
                       code=5, says="draws on a GPU")
        self.run_aglow("render", "lit.glb", "-o", "r.png", "--engine", "raster", "--reflections",
                       "1", code=1, says="traces no rays")

    def test_refinement_while_drawing_keeps_tolerance_and_budget(self):
        gpus = self.gpus()
        if not gpus:
            self.skipTest("no GPU")
        self.run_aglow("scene", "sculpture:300", "-o", "coarse.glb")
        def drawn(name, *arguments):
            return self.json_of("render", "coarse.glb", "-o", f"{name}.exr", "--size", "96x72",
                                "--sky", "100", "--sun", "30,60,5000", "--engine", "raster",
                                "--device", gpus[0], *arguments)
        none = drawn("none")
        self.assertNotIn("tolerance_pixels", none)
        fine = drawn("fine", "--refine", "pn:5")
        auto = drawn("auto", "--refine", "auto:0.25")
        self.assertEqual(fine["triangles"], 1024 * none["triangles"])
        self.assertEqual(auto["tolerance_pixels"], 0.25)
        self.assertGreater(auto["triangles"], none["triangles"])
        self.assertLess(auto["triangles"], fine["triangles"] / 50)
        self.run_aglow("compare", "auto.exr", "fine.exr", "--max-rmse", "5%")
        self.run_aglow("compare", "none.exr", "fine.exr", "--max-rmse", "10%", code=7)
        budget = none["triangles"] + 1000
        less = drawn("less", "--refine", "auto:0.05", "--budget", budget)
        self.assertLessEqual(less["triangles"], budget)
        self.assertGreater(less["tolerance_pixels"], 0.05)
        walk = drawn("walk", "--refine", "auto", "--frames", "0:2", "--budget", budget)
        self.assertEqual(walk["frames"], 3)
        self.assertLessEqual(walk["triangles"], budget)
        for arguments, word in ((("--refine", "auto:0"), "0.01"), (("--refine", "auto:x"), "x"),
                                (("--refine", "auto:1e9"), "1000"), (("--refine", "pn"), "auto"),
                                (("--budget", "9"), "--refine auto"),
                                (("--budget", "9", "--refine", "pn:2"), "--refine auto"),
                                (("--budget", "0", "--refine", "auto"), "--budget")):
            self.run_aglow("render", "plane.gltf", "-o", "n.png", "--engine", "raster", *arguments,
                           code=1, says=word)

    def test_subdivided_triangles_are_those_of_refine(self):
        gpus = self.gpus()
        if not gpus:
            self.skipTest("no GPU")
        picture = ("--size", "48x32", "--sun", "0,60,1000", "--engine", "raster", "--device",
                   gpus[0])
        for scheme in ("loop", "catmull-clark"):
            report = self.json_of("render", "plane.gltf", "-o", "on-gpu.exr", *picture, "--refine",
                                  f"{scheme}:2")
            self.assertIn("refine", [p["pass"] for p in report["passes"]])
            self.run_aglow("refine", "plane.gltf", "-o", "fine.glb", "--scheme", scheme, "--level",
                           "2", "--limit")
            self.run_aglow("render", "fine.glb", "-o", "on-cpu.exr", *picture)
            self.run_aglow("compare", "on-gpu.exr", "on-cpu.exr", "--max-rmse", "0.5%")
        render = ("render", "plane.gltf", "-o", "none.exr")
        for wrong in ("loop", "loop:8", "loop:-1", "catmull-clark:0", "butterfly:2"):
            self.run_aglow(*render, *picture, "--refine", wrong, code=1, says="--refine")
        self.run_aglow(*render, "--refine", "loop:2", code=1, says="--engine raster")
        self.run_aglow(*render, *picture, "--refine", "loop:2", "--crease", "30")
        self.run_aglow(*render, *picture, "--crease", "30", code=1, says="--refine")

    def test_structures_are_measured_beside_embree(self):
        arguments = ("bench", "accel", "--scene", "cornell-box", "--scene", "plane.gltf",
                     "--rays", "256", "--device", "gpu:llvmpipe")
        if not any("llvmpipe" in gpu for gpu in self.gpus()):
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
        for word in ("llvmpipe", "cornell-box", "plane.gltf", "embree", "grid2", "bvh", "diffuse"):
            self.assertIn(word, text)

    def test_subdivision_is_measured_in_all_forms(self):
        arguments = ("bench", "refine", "--scene", "queen", "--device", "gpu:llvmpipe")
        if not any("llvmpipe" in gpu for gpu in self.gpus()):
            self.skipTest("there is no Vulkan driver")
        report = self.json_of(*arguments)
        self.assertEqual([row["level"] for row in report["scenes"]], [1, 2])
        for row in report["scenes"]:
            self.assertEqual(row["triangles"], row["coarse_triangles"] * 4 ** row["level"])
            self.assertEqual([form["form"] for form in row["forms"]],
                             ["compute", "NITM", "TA", "VS_OUTPUT"])
            for form in row["forms"]:
                self.assertLess(form["difference_to_cpu"], 1e-5)
                self.assertGreater(form["fps"], 0)
        text = self.run_aglow(*arguments).stdout
        for word in ("beside the CPU", "queen", "VS_OUTPUT", "--teaset FILE"):
            self.assertIn(word, text)
        self.run_aglow("bench", "refine", "--scene", "cup", "--device", "gpu:llvmpipe", code=1,
                       says="--teaset FILE")

    def test_frames_are_measured_with_more_and_more_rays(self):
        arguments = ("bench", "rays", "--scene", "cube-tc58.glb", "--side", "16", "--device",
                     "gpu:llvmpipe")
        if not any("llvmpipe" in gpu for gpu in self.gpus()):
            self.skipTest("there is no Vulkan driver")
        report = self.json_of(*arguments)
        self.assertIn("llvmpipe", report["device"])
        self.assertEqual(report["side"], 16)
        scene, = report["scenes"]
        self.assertEqual((scene["scene"], scene["motion"]), ("cube-tc58.glb", "still"))
        self.assertEqual([s["accel"] for s in scene["structures"]],
                         ["embree", "grid", "grid2", "bvh"])
        for row in scene["structures"]:
            rays = [row[effect]["rays"] for effect in ("primary", "shadow", "reflection")]
            self.assertEqual(rays[0], 16 * 16)
            self.assertLess(rays[0], rays[1])
            self.assertLess(rays[1], rays[2])
            self.assertGreater(row["reflection"]["frame_ms"], 0)
        text = self.run_aglow(*arguments).stdout
        for word in ("llvmpipe", "16 x 16", "cube-tc58.glb", "still", "embree", "grid2"):
            self.assertIn(word, text)


if __name__ == "__main__":
    harness.main()
