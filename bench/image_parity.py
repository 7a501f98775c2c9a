#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures drawn on a GPU against those of the CPU: six rooms, and four models at three times.

    bench/image_parity.py --aglow build/release/apps/cli/aglow --out /var/tmp/parity

Rooms are baked as a draft and drawn with their light, once with each structure; models are drawn
unbaked under a uniform sky. The table goes to stdout. Fails where a relative RMSE reaches 1 %.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BOUND = 0.01
ACCELS = ["grid", "grid2", "bvh"]
BUILT_IN = ["cornell-box", "corridor", "living-room"]
ROOMS = ["rooms/bevy-cornellbox/CornellBox.glb", "rooms/godot-living-room/living_room.glb",
         "rooms/bevy-mixed-lighting/MixedLightingExample.gltf"]
MODELS = {"khronos/Fox/Fox.glb": (0, 0.4, 1.1), "khronos/CesiumMan/CesiumMan.glb": (0, 0.6, 1.3),
          "khronos/BoxAnimated/BoxAnimated.glb": (0, 1.5, 3),
          "khronos/AnimatedMorphCube/AnimatedMorphCube.glb": (0, 1.5, 3)}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--aglow", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT / ".." / "shared" / "scenes")
    parser.add_argument("--device", default="gpu:llvmpipe")
    parser.add_argument("--size", default="320x200")
    parser.add_argument("--samples", type=int, default=4)
    parser.add_argument("--resolution", type=int, default=128, help="of the rooms' lightmaps")
    return parser.parse_args()


def run_aglow(arguments, *words):
    command = [arguments.aglow, *map(str, words), "--json", "--quiet"]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)


def lit_room(arguments, name):
    """A room with its light baked, and what to call it."""
    if name in BUILT_IN:
        scene = arguments.out / f"{name}.glb"
        run_aglow(arguments, "scene", name, "-o", scene)
    else:
        scene = arguments.scenes / name
    lit = arguments.out / f"{scene.stem}-lit.glb"
    run_aglow(arguments, "bake", scene, "-o", lit, "--resolution", arguments.resolution,
              "--quality", "draft", "--sky", 200)
    return lit, scene.stem


def draw(arguments, scene, picture, *words):
    return run_aglow(arguments, "render", scene, "-o", picture, "--size", arguments.size,
                     "--samples", arguments.samples, *words)


def compare(arguments, scene, label, *words):
    """One row for each structure."""
    wanted = arguments.out / f"{label}-cpu.exr"
    cpu = draw(arguments, scene, wanted, "--device", "cpu", *words)
    for accel in ACCELS:
        drawn = arguments.out / f"{label}-{accel}.exr"
        gpu = draw(arguments, scene, drawn, "--device", arguments.device, "--accel", accel, *words)
        difference = run_aglow(arguments, "compare", drawn, wanted)
        yield {"picture": label, "accel": accel, "rmse": difference["relative_rmse"],
               "rays": (gpu["rays"], cpu["rays"]),
               "seconds": (gpu["seconds"]["draw"], cpu["seconds"]["draw"])}


def pictures(arguments):
    for name in BUILT_IN + ROOMS:
        lit, label = lit_room(arguments, name)
        yield from compare(arguments, lit, label)
    for name, times in MODELS.items():
        for time in times:
            label = f"{pathlib.Path(name).stem}-{time}"
            yield from compare(arguments, arguments.scenes / name, label, "--time", time,
                               "--sky", 1000)


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    print("| picture | structure | relative RMSE | rays (CPU) | seconds (CPU) |")
    print("|---|---|---|---|---|")
    failures = 0
    for row in pictures(arguments):
        good = row["rmse"] < BOUND
        failures += not good
        print(f"| {row['picture']} | {row['accel']} | {row['rmse']:.2e}{'' if good else ' FAILS'} | "
              f"{row['rays'][0]} ({row['rays'][1]}) | "
              f"{row['seconds'][0]:.2f} ({row['seconds'][1]:.2f}) |", flush=True)
    print(f"\n{failures} pictures differ by {BOUND:.0%} or more")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
