#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far the gather solver is from brute-force path tracing, beyond the latter's noise.

    bench/agreement.py --aglow build/release/apps/cli/aglow --out /var/tmp/agreement

Two path-traced bakes P1, P2 of unlike seeds tell their own noise: rms(P1 - P2)^2 / 2 is the
variance of each. What the gather bake G differs by is then
sqrt((rms(G - P1)^2 + rms(G - P2)^2) / 2 - rms(P1 - P2)^2 / 2). The estimate is made at growing sample
counts: it must stand still while the noise falls as 1 / sqrt(samples). All bakes are told their samples
instead of a quality, so that their texels have the same sample points.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

BOUND = 0.01


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--aglow", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--scenes", default="cornell-box,corridor,living-room")
    parser.add_argument("--resolution", type=int, default=128)
    parser.add_argument("--samples", default="1024,4096", help="of the path-traced bakes")
    parser.add_argument("--gather-samples", type=int, default=2048)
    parser.add_argument("--threads", type=int, default=2)
    return parser.parse_args()


def run_aglow(arguments, *words):
    command = [arguments.aglow, *map(str, words), "--json", "--quiet"]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


def bake(arguments, scene, out, *words):
    return run_aglow(arguments, "bake", scene, "-o", out, "--resolution", arguments.resolution,
                     "--threads", arguments.threads, *words)


def measure(arguments, name):
    out = arguments.out
    scene, gathered = out / f"{name}.glb", out / f"{name}_gather.glb"
    run_aglow(arguments, "scene", name, "-o", scene)
    seconds = bake(arguments, scene, gathered, "--samples",
                   arguments.gather_samples)["seconds"]["total"]
    for samples in map(int, arguments.samples.split(",")):
        paths = [out / f"{name}_path_{samples}_{seed}.glb" for seed in (1, 2)]
        reports = [bake(arguments, scene, path, "--method", "path", "--samples", samples,
                        "--seed", seed) for seed, path in zip((1, 2), paths)]
        between = run_aglow(arguments, "compare", *paths)["relative_rmse"]
        to_each = [run_aglow(arguments, "compare", gathered, path) for path in paths]
        squared = sum(d["relative_rmse"] ** 2 for d in to_each) / 2 - between ** 2 / 2
        yield {"scene": name, "path_samples": samples,
               "noise": between / math.sqrt(2), "difference": math.sqrt(max(0, squared)),
               "mean_difference": sum(d["mean_relative"] for d in to_each) / 2,
               "gather_seconds": seconds, "path_seconds": reports[0]["seconds"]["total"]}


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    print("| scene | path samples | noise of one path bake | gather beyond it | difference of means "
          "| gather s | path s |\n|---|---|---|---|---|---|---|")
    rows = []
    for name in arguments.scenes.split(","):
        for row in measure(arguments, name):
            rows.append(row)
            print(f"| {row['scene']} | {row['path_samples']} | {100 * row['noise']:.2f} % | "
                  f"{100 * row['difference']:.2f} % | {100 * row['mean_difference']:.3f} % | "
                  f"{row['gather_seconds']:.1f} | {row['path_seconds']:.1f} |", flush=True)
    (arguments.out / "agreement.json").write_text(json.dumps(rows, indent=2) + "\n")
    last = {row["scene"]: row["difference"] for row in rows}
    return 0 if all(difference <= BOUND for difference in last.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
