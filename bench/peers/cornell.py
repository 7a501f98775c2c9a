#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Aglow beside Cycles on the Cornell box: error over time, each against its own converged bake,
and how far the two converged bakes are apart.

    bench/peers/cornell.py --aglow build/release/apps/cli/aglow --out /var/tmp/cornell

Prints a Markdown table and writes OUT/cornell.json. Error is the relative RMSE of
`aglow compare` over the texels that both programs light, the reference's own noise taken out. Time
is the wall time of Blender's bake operator without start and import, and of Aglow's whole
command.
"""
import argparse
import json
import pathlib
import subprocess
import sys

from errors import Map, Reference, mean, rms_difference, seconds_to

HERE = pathlib.Path(__file__).resolve().parent


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--aglow", required=True)
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--resolution", type=int, default=512)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--cycles-spp", default="16,64,256,1024")
    parser.add_argument("--cycles-reference-spp", type=int, default=2048)
    parser.add_argument("--bounces", type=int, default=8,
                        help="of Cycles' timed bakes; Aglow's go on until light has died out")
    parser.add_argument("--aglow-samples", default="8,16,32,64,128,256")
    parser.add_argument("--aglow-reference-samples", type=int, default=8192)
    return parser.parse_args()


def run_aglow(arguments, *words):
    command = [arguments.aglow, *map(str, words), "--json", "--quiet"]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


def bake_aglow(arguments, scene, stem, *words):
    report = run_aglow(arguments, "bake", scene, "-o", stem.with_suffix(".glb"), "--resolution",
                       arguments.resolution, "--threads", arguments.threads, *words)
    return report, Map.read(stem.with_suffix(".exr"))


def bake_cycles(arguments, lit, stem, size, spp, seeds, bounces):
    command = [arguments.blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python",
               str(HERE / "cycles_bake.py"), "--", str(lit), str(stem), "--spp", str(spp),
               "--seeds", str(seeds), "--size", size, "--bounces", str(bounces), "--threads",
               str(arguments.threads)]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True)
    runs = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    return [(run, Map.read(run["exr"])) for run in runs]


def measure_cycles(arguments, lit, size):
    out = arguments.out
    runs = bake_cycles(arguments, lit, out / "cycles", size, arguments.cycles_spp, 0,
                       arguments.bounces)
    halves = [m for _, m in bake_cycles(arguments, lit, out / "cycles_reference", size,
                                        arguments.cycles_reference_spp, "1,2", arguments.bounces)]
    # Where light has not died out after so many bounces, a bake that follows it longer is the
    # one to agree with.
    far = [m for _, m in bake_cycles(arguments, lit, out / "cycles_far", size,
                                     arguments.cycles_reference_spp // 2, "3,4", 64)]
    return runs, halves, far


def measure_aglow(arguments, scene):
    out = arguments.out
    runs = [bake_aglow(arguments, scene, out / f"aglow_{n}", "--samples", n)
            for n in arguments.aglow_samples.split(",")]
    halves = [bake_aglow(arguments, scene, out / f"aglow_reference_{seed}", "--samples",
                         arguments.aglow_reference_samples, "--seed", seed)[1] for seed in (1, 2)]
    return runs, halves


def table(result):
    lines = ["| program | samples | seconds | relative RMSE |", "|---|---|---|---|"]
    for program in ("cycles", "aglow"):
        for row in result[program]["runs"]:
            lines.append(f"| {program} | {row['samples']} | {row['seconds']:.2f} | "
                         f"{100 * row['error']:.2f} % |")
    for program in ("cycles", "aglow"):
        lines.append(f"| {program} | to 2 % | {result[program]['seconds_to_2_percent']:.2f} | |")
    cross = result["agreement"]
    lines += ["", f"Aglow is {result['ratio']:.1f} times as fast to 2 %. Converged bakes: means "
              f"differ by {100 * cross['mean']:+.3f} %, relative RMS {100 * cross['rms']:.2f} % "
              f"(noise of both together {100 * cross['noise']:.2f} %) over {cross['texels']} texels."]
    return "\n".join(lines)


def summarise(runs, reference):
    rows = [{"samples": n, "seconds": s, "error": reference.error_of(m)} for n, s, m in runs]
    return {"runs": rows, "reference_noise": reference.noise,
            "seconds_to_2_percent": seconds_to(0.02, [(r["seconds"], r["error"]) for r in rows])}


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    scene = arguments.out / "cornell.glb"
    run_aglow(arguments, "scene", "cornell-box", "-o", scene)
    _, layout = bake_aglow(arguments, scene, arguments.out / "layout", "--quality", "draft")
    size = f"{layout.width}x{layout.height}"
    aglow_runs, aglow_halves = measure_aglow(arguments, scene)
    cycles_runs, cycles_halves, far = measure_cycles(arguments, arguments.out / "layout.glb", size)

    # Cycles lights the texels whose centres lie in a chart; Aglow those and the edges too.
    pixels = [i for i in cycles_halves[0].lit() if any(p[i] for p in aglow_halves[0].planes)]
    cycles_reference = Reference(*cycles_halves, pixels)
    aglow_reference = Reference(*aglow_halves, pixels)
    far_reference = Reference(*far, pixels)
    result = {
        "cycles": summarise([(r["spp"], r["seconds"], m) for r, m in cycles_runs],
                            cycles_reference),
        "aglow": summarise([(r["samples"], r["seconds"]["total"], m) for r, m in aglow_runs],
                           aglow_reference),
        "agreement": {
            "texels": len(pixels),
            "mean": mean(aglow_reference.map, pixels) / mean(far_reference.map, pixels) - 1,
            "rms": rms_difference(aglow_reference.map, far_reference.map, pixels)
            / far_reference.rms,
            "noise": (aglow_reference.noise ** 2 + far_reference.noise ** 2) ** 0.5,
        },
    }
    result["ratio"] = (result["cycles"]["seconds_to_2_percent"] /
                       result["aglow"]["seconds_to_2_percent"])
    (arguments.out / "cornell.json").write_text(json.dumps(result, indent=2) + "\n")
    print(table(result))
    return 0


if __name__ == "__main__":
    sys.exit(main())
