#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Light in numbers: what `aglow measure` finds, beside closed forms."""
import csv
import json
import math

import harness
from harness import FAST, ground_plane


class Light(harness.AglowTest):
    def measured(self, *arguments, points):
        """Rows of `measure` at sensors (x, y, z, nx, ny, nz), as dictionaries of numbers."""
        lines = [",".join(map(str, point)) for point in points]
        (self.dir / "points.csv").write_text("x,y,z,nx,ny,nz\n" + "\n".join(lines) + "\n")
        self.run_aglow("measure", *arguments, "--points", "points.csv", "-o", "measured.csv")
        with open(self.dir / "measured.csv", newline="") as file:
            return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]

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
    harness.main()
