#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`aglow refine`: what it writes, what it keeps, and what it says when it cannot."""
import json
import math
import os
import pathlib
import struct
import subprocess
import zlib

import harness
from harness import ROOT, aglow

SCENES = pathlib.Path(os.environ.get("AGLOW_SCENES", ROOT / ".." / "shared" / "scenes"))
LARGEST = 3_000_000  # bytes of a scene; keeps the test within a minute


def document_of(glb):
    """The JSON of a .glb, and its binary chunk."""
    data = glb.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


def values_of(document, binary, index, layout):
    """The elements of an accessor."""
    accessor = document["accessors"][index]
    start = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)
    return list(struct.iter_unpack(
        layout, binary[start:start + struct.calcsize(layout) * accessor["count"]]))


def validate(files):
    """Errors that the Khronos validator finds; none where it is not installed."""
    if not (ROOT / "node_modules" / "gltf-validator").exists():
        return ""
    done = subprocess.run(["node", ROOT / "tools/validate_gltf.mjs", *files],
                          capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode else ""


def write_white_png(path):
    """2 x 2 pixels, 16-bit grey."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    rows = b"".join(b"\0" + b"\xff" * 4 for _ in range(2))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     chunk(b"IHDR", struct.pack(">2I5B", 2, 2, 16, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def crowd(path, plane):
    """The triangles of a plane, a hundred times."""
    document = json.loads(plane.read_text())
    data = plane.with_suffix(".bin").read_bytes()
    data = data[:48] + 100 * data[48:60]
    document["accessors"][1]["count"] = 600
    document["bufferViews"][1]["byteLength"] = 1200
    document["buffers"][0] = {"byteLength": len(data), "uri": path.stem + ".bin"}
    path.with_suffix(".bin").write_bytes(data)
    path.write_text(json.dumps(document))


class Refinement(harness.AglowTest):
    def test_every_scheme_makes_four_triangles_of_one(self):
        for scheme, triangles in (("loop", 2 * 16), ("pn", 2 * 16), ("st", 2 * 16),
                                  ("phong", 2 * 16), ("catmull-clark", 2 * 24)):
            report = self.json_of("refine", "plane.gltf", "-o", "fine.glb", "--scheme", scheme,
                                  "--level", "2")
            self.assertEqual(report["coarse"]["triangles"], 2)
            self.assertEqual(report["refined"]["triangles"], triangles, scheme)
            self.assertEqual(validate([self.dir / "fine.glb"]), "")
            # The plane stays the plane: its corners are kept.
            plane = self.json_of("info", "fine.glb")
            self.assertEqual(plane["bounds"], {"low": [-10, 0, -10], "high": [10, 0, 10]})
            self.assertAlmostEqual(plane["surface_area"], 400, places=3)
        report = self.json_of("refine", "plane.gltf", "-o", "fine.gltf", "--scheme",
                              "catmull-clark", "--quads", "--limit", "--level", "1")
        self.assertEqual(report["refined"]["triangles"], 8)
        self.assertEqual(report["outputs"], ["fine.gltf", "fine.bin"])
        self.assertEqual(validate([self.dir / "fine.gltf"]), "")

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 4):
            self.run_aglow("refine", "lit.glb", "-o", f"t{threads}.glb", "--threads", threads)
        self.assertEqual((self.dir / "t1.glb").read_bytes(), (self.dir / "t4.glb").read_bytes())

    def test_a_lit_scene_stays_lit(self):
        self.run_aglow("refine", "lit.glb", "-o", "lit-fine.glb", "--creases-at-normals",
                       "--level", "1")
        for name in ("lit", "lit-fine"):
            self.run_aglow("render", f"{name}.glb", "-o", f"seen-{name}.exr", "--size",
                           "64x48", "--device", "cpu")
        compared = self.json_of("compare", "seen-lit-fine.exr", "seen-lit.exr")
        self.assertLess(compared["relative_rmse"], 0.02)

    def test_what_the_file_had_is_kept(self):
        document = json.loads((self.dir / "plane.gltf").read_text())
        document["extras"] = {"made": "by hand"}
        document["materials"][0]["extensions"] = {"EXT_of_someone": {"depth": 3}}
        document["extensionsUsed"] = ["EXT_of_someone"]
        primitive = document["meshes"][0]["primitives"][0]
        primitive["extras"] = {"creases": [[0, 1]], "note": "floor"}
        document["cameras"] = [{"type": "perspective",
                                "perspective": {"yfov": 0.7, "znear": 0.1}}]
        document["nodes"].append({"camera": 0, "translation": [0, 2, 5]})
        (self.dir / "rich.gltf").write_text(json.dumps(document))
        self.run_aglow("refine", "rich.gltf", "-o", "rich.glb", "--level", "3")
        written, _ = document_of(self.dir / "rich.glb")
        for key in ("extras", "materials", "cameras", "nodes", "extensionsUsed"):
            self.assertEqual(written[key], document[key])
        extras = written["meshes"][0]["primitives"][0]["extras"]
        self.assertEqual(extras["note"], "floor")
        # The edge of eight segments stays sharp for ever.
        self.assertEqual([s for _, _, s in extras["creases"]], [10.0] * 8)
        self.assertEqual(len({v for a, b, _ in extras["creases"] for v in (a, b)}), 9)

    def test_displacement_moves_by_scale_times_height_plus_bias(self):
        document = json.loads((self.dir / "plane.gltf").read_text())
        uvs = struct.pack("<8f", 0, 0, 0, 1, 1, 1, 1, 0)
        document["buffers"].append({"byteLength": 32, "uri": "uvs.bin"})
        document["bufferViews"].append({"buffer": 1, "byteLength": 32})
        document["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 4,
                                      "type": "VEC2"})
        document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2
        (self.dir / "uvs.bin").write_bytes(uvs)
        (self.dir / "flat.gltf").write_text(json.dumps(document))
        write_white_png(self.dir / "white.png")  # every height is 1
        self.run_aglow("refine", "flat.gltf", "-o", "up.glb", "--displace", "white.png",
                       "--displace-scale", "0.5", "--displace-bias", "-0.125")
        bounds = self.json_of("info", "up.glb")["bounds"]
        self.assertAlmostEqual(bounds["low"][1], 0.375, places=5)
        self.assertAlmostEqual(bounds["high"][1], 0.375, places=5)

    def test_functions_of_place_displace(self):
        self.run_aglow("refine", "plane.gltf", "-o", "waves.glb", "--level", "6",
                       "--displace", "sin:0.5,1,0,0.5")
        document, binary = document_of(self.dir / "waves.glb")
        attributes = document["meshes"][0]["primitives"][0]["attributes"]
        for x, y, z in values_of(document, binary, attributes["POSITION"], "<3f"):
            self.assertAlmostEqual(y, 0.5 * math.sin(x + 0.5 * z), places=5)
        self.run_aglow("refine", "plane.gltf", "-o", "rough.glb", "--level", "6",
                       "--displace", "noise:0.25,0.7")
        bounds = self.json_of("info", "rough.glb")["bounds"]
        self.assertLess(bounds["low"][1], -0.05)
        self.assertGreater(bounds["low"][1], -0.5)
        self.assertGreater(bounds["high"][1], 0.05)
        self.assertLess(bounds["high"][1], 0.5)

    def test_a_tolerance_saves_triangles_where_nothing_bends(self):
        report = self.json_of("refine", "plane.gltf", "-o", "flat.glb", "--scheme", "pn",
                              "--tolerance", "0.001", "--level", "5")
        self.assertEqual(report["refined"]["triangles"], 2)
        self.run_aglow("scene", "chess", "-o", "chess.glb")
        counts = []
        for more in ([], ["--tolerance", "0.0002"], ["--pattern", "irregular"],
                     ["--pattern", "irregular", "--camera", "auto"]):
            report = self.json_of("refine", "chess.glb", "-o", f"chess{len(counts)}.glb",
                                  "--scheme", "pn", "--level", "3", *more)
            counts.append(report["refined"]["triangles"])
        self.assertEqual(counts[2:], [counts[0]] * 2)
        self.assertLess(counts[1], counts[0] / 4)
        self.assertEqual(validate([self.dir / f"chess{i}.glb" for i in range(4)]), "")
        self.assertNotEqual((self.dir / "chess2.glb").read_bytes(),
                            (self.dir / "chess3.glb").read_bytes())

    def test_pieces_that_differ_in_colour_are_stored_once(self):
        self.run_aglow("scene", "chess", "-o", "set.glb")
        self.run_aglow("refine", "set.glb", "-o", "set-fine.glb", "--level", "3")
        self.assertEqual(validate([self.dir / "set-fine.glb"]), "")
        written, _ = document_of(self.dir / "set-fine.glb")
        vertices = {}
        for mesh in written["meshes"]:
            vertices[mesh["name"]] = [p["attributes"]["POSITION"] for p in mesh["primitives"]]
        for piece in ("pawn", "bishop", "queen", "king"):
            self.assertEqual(vertices[f"white {piece}"], vertices[f"black {piece}"])

    def test_splats_lie_on_the_surface_and_cover_it(self):
        report = self.json_of("refine", "plane.gltf", "-o", "splats.glb", "--level", "3",
                              "--splats")
        self.assertEqual(validate([self.dir / "splats.glb"]), "")
        document, binary = document_of(self.dir / "splats.glb")
        primitive = document["meshes"][0]["primitives"][0]
        self.assertEqual(primitive["mode"], 0)
        self.assertNotIn("indices", primitive)
        positions = values_of(document, binary, primitive["attributes"]["POSITION"], "<3f")
        normals = values_of(document, binary, primitive["attributes"]["NORMAL"], "<3f")
        radii = values_of(document, binary, primitive["attributes"]["_RADIUS"], "<f")
        self.assertEqual(len(positions), report["refined"]["vertices"])
        self.assertEqual(len(positions), 9 * 9)
        self.assertEqual(len(radii), len(positions))
        for normal in normals:
            self.assertEqual([round(c, 6) for c in normal], [0, 1, 0])
        self.assertEqual({p[1] for p in positions}, {0})
        for i in range(50):
            for j in range(50):
                x, z = 0.4 * (i + 0.5) - 10, 0.4 * (j + 0.5) - 10
                self.assertTrue(any((x - p[0]) ** 2 + (z - p[2]) ** 2 <= r[0] ** 2
                                    for p, r in zip(positions, radii)), (x, z))

    def test_splats_of_what_is_no_gltf(self):
        (self.dir / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        self.run_aglow("refine", "tetra.obj", "-o", "tetra.glb", "--splats", "--level", "1")
        self.assertEqual(validate([self.dir / "tetra.glb"]), "")
        document, _ = document_of(self.dir / "tetra.glb")
        primitive = document["meshes"][0]["primitives"][0]
        self.assertEqual(primitive["mode"], 0)
        self.assertEqual(document["accessors"][primitive["attributes"]["_RADIUS"]]["count"], 10)

    def test_a_mesh_on_a_mesh(self):
        report = self.json_of("refine", "plane.gltf", "-o", "studs.glb", "--level", "1",
                              "--scheme", "pn", "--quads", "--mesh-on-mesh", "cube-tc58.glb",
                              "--mesh-repeats", "4")
        self.assertEqual(report["refined"]["triangles"], 8 + 16 * 12)
        self.assertEqual(validate([self.dir / "studs.glb"]), "")
        bounds = self.json_of("info", "studs.glb")["bounds"]  # cubes of a quarter of 20 m
        for low, high, l, h in zip(bounds["low"], bounds["high"], (-10, 0, -10), (10, 5, 10)):
            self.assertAlmostEqual(low, l, places=4)
            self.assertAlmostEqual(high, h, places=4)

    def test_moved_copies_are_placed(self):
        self.run_aglow("scene", "living-room", "-o", "room.glb")
        apart = self.json_of("refine", "room.glb", "-o", "apart.glb", "--level", "1")
        shared = self.json_of("refine", "room.glb", "-o", "shared.glb", "--level", "1", "--share")
        self.assertEqual(apart["placed_copies"], 0)
        self.assertGreater(shared["placed_copies"], 0)
        self.assertLess((self.dir / "shared.glb").stat().st_size,
                        (self.dir / "apart.glb").stat().st_size)
        self.assertEqual(validate([self.dir / "shared.glb"]), "")
        a, b = (self.json_of("info", f"{name}.glb") for name in ("apart", "shared"))
        self.assertEqual(a["triangles"], b["triangles"])
        self.assertAlmostEqual(a["surface_area"], b["surface_area"], places=3)

    def test_errors_say_what_to_do_and_leave_no_file(self):
        refine = ("refine", "plane.gltf", "-o", "none.glb")
        crowd(self.dir / "crowd.gltf", self.dir / "plane.gltf")
        before = self.folder_names()
        for arguments, code, says in [
            ((*refine, "--scheme", "butterfly"), 1, "catmull-clark"),
            ((*refine, "--level", "0"), 1, "--level"),
            ((*refine, "--level", "11"), 1, "--level"),
            ((*refine, "--scheme", "pn", "--level", "9"), 1, "1 to 8"),
            ((*refine, "--quads"), 1, "catmull-clark"),
            ((*refine, "--scheme", "pn", "--limit"), 1, "limit"),
            ((*refine, "--displace-scale", "2"), 1, "--displace"),
            ((*refine, "--displace", "sin:1,2,3"), 1, "--displace"),
            ((*refine, "--displace", "noise:1,x"), 1, "--displace"),
            ((*refine, "--displace", "noise:1,2", "--displace-scale", "2"), 1, "--displace FILE"),
            ((*refine, "--pattern", "irregular"), 1, "pn, st, phong"),
            ((*refine, "--tolerance", "0.1"), 1, "pn, st, phong"),
            ((*refine, "--scheme", "pn", "--tolerance", "0"), 1, "--tolerance"),
            ((*refine, "--scheme", "pn", "--tolerance", "1", "--displace", "noise:1,2"), 1,
             "displaced"),
            ((*refine, "--scheme", "pn", "--camera", "auto"), 1, "--pattern irregular"),
            ((*refine, "--scheme", "pn", "--pattern", "irregular", "--camera", "auto"), 1,
             "no camera"),
            (("refine", "lit.glb", "-o", "none.glb", "--scheme", "pn", "--share", "--pattern",
              "irregular", "--camera", "auto"), 1, "shared"),
            ((*refine, "--mesh-on-mesh", "lit.glb"), 1, "pn, st, phong"),
            ((*refine, "--scheme", "pn", "--mesh-on-mesh", "absent.glb"), 2, "absent.glb"),
            ((*refine, "--mesh-repeats", "2"), 1, "--mesh-on-mesh FILE"),
            ((*refine, "--crease", "200"), 1, "--crease"),
            ((*refine, "--displace", "absent.png"), 2, "absent.png"),
            (("refine", "absent.glb", "-o", "none.glb"), 2, "absent.glb"),
            (("refine", "plane.gltf", "-o", "none.txt"), 1, ".glb"),
            (("refine", "lit.glb", "-o", "lit.glb"), 1, "input"),
            (("refine", "plane.bin", "-o", "none.glb"), 3, "plane.bin"),
            (("refine", "crowd.gltf", "-o", "none.glb", "--level", "10"), 1,
             "would make 209715200 triangles of 200"),
            (("refine", "plane.gltf", "-o", "plane2.gltf", "--device", "gpu"), 5, "CPU"),
        ]:
            with self.subTest(arguments):
                self.run_aglow(*arguments, code=code, says=says)
        self.assertEqual(self.folder_names(), before)

    def test_real_scenes_are_refined_and_valid(self):
        if not SCENES.is_dir():
            self.skipTest(f"no scenes in {SCENES}")
        files = sorted(f for ending in ("glb", "gltf") for f in SCENES.rglob(f"*.{ending}")
                       if f.stat().st_size < LARGEST)
        out = self.dir / "real"
        out.mkdir()
        for i, file in enumerate(files):
            options = (["loop"], ["catmull-clark", "--splats"], ["pn", "--tolerance", "0.01"],
                       ["phong", "--share"], ["st", "--pattern", "irregular"],
                       ["loop", "--share", "--displace", "noise:0.01,3"])[i % 6]
            done = aglow("refine", file, "-o", out / f"{i}.glb", "--level", "1", "--scheme",
                         *options, "--quiet", cwd=self.dir)
            self.assertEqual(done.returncode, 0, f"{file}: {done.stderr}")
        self.assertEqual(validate(sorted(out.glob("*.glb"))), "")


if __name__ == "__main__":
    harness.main()
