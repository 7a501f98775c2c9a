#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bakes every .glb and .gltf below a folder and writes the table docs/scenes.md.

    bench/scenes.py --aglow build/release/apps/cli/aglow --out /var/tmp/scenes

Each scene is baked as `aglow bake SCENE -o OUT --resolution 256 --quality draft --sky 1000` (many
have no light of their own). A row fails on a crash, an error, a value that is not finite or an
error of the Khronos validator (`npm ci` first).
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench" / "peers"))
import exr  # noqa: E402

EXITS = {1: "usage", 2: "unreadable", 3: "invalid input", 4: "memory", 5: "unsupported",
         124: "time"}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--aglow", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT / ".." / "shared" / "scenes")
    parser.add_argument("--table", type=pathlib.Path, default=ROOT / "docs" / "scenes.md")
    parser.add_argument("--sky", default="1000", help="cd/m^2")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--limit", type=float, default=600, help="seconds for one scene")
    parser.add_argument("--filter", default="", help="only paths that contain it")
    return parser.parse_args()


def run(command, limit):
    """Exit code, stdout and stderr; 124 where the time ran out."""
    try:
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True,
                              timeout=limit, check=False)
        return done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        return 124, "", f"stopped after {limit:g} s"


def non_finite(path):
    _, _, planes = exr.read_rgb(path)
    return sum(1 for plane in planes for value in plane if not math.isfinite(value))


def validator_errors(path):
    """None where the validator is not installed, else its complaint or an empty string."""
    if not (ROOT / "node_modules" / "gltf-validator").exists():
        return None
    code, out, err = run(["node", ROOT / "tools" / "validate_gltf.mjs", path], 600)
    return "" if code == 0 else (out + err).strip()


def bake(arguments, scene):
    name = scene.relative_to(arguments.scenes).as_posix()
    lit = arguments.out / (name.replace("/", "_").rsplit(".", 1)[0] + ".glb")
    start = time.perf_counter()
    code, out, err = run([arguments.aglow, "bake", scene, "-o", lit, "--resolution", 256,
                          "--quality", "draft", "--sky", arguments.sky, "--threads",
                          arguments.threads, "--json", "--quiet"], arguments.limit)
    row = {"scene": name, "exit": code, "seconds": time.perf_counter() - start,
           "problem": ""}
    if code != 0:
        row["problem"] = f"{EXITS.get(code, f'exit {code}')}: {err.strip()}"
        return row
    row |= json.loads(out)
    row["scene"] = name
    bad = non_finite(lit.with_suffix(".exr"))
    complaint = validator_errors(lit)
    row["validator"] = {None: "not run", "": "0 errors"}.get(complaint, "errors")
    if bad:
        row["problem"] = f"{bad} values are not finite"
    elif complaint:
        row["problem"] = complaint
    return row


def line(row):
    if row["exit"] != 0:
        return f"| {row['scene']} | | | | | | | {row['problem'].splitlines()[0]} |"
    black = row["black_texels"]
    share = 100 * black / row["texels"] if row["texels"] else 0
    note = row["problem"].splitlines()[0] if row["problem"] else row["validator"]
    return (f"| {row['scene']} | {row['triangles']} | {row['charts']} | {row['texels']} | "
            f"{black} ({share:.1f} %) | {row['seconds']['total']:.2f} | "
            f"{row['mean_irradiance_lux']:.4g} | {note} |")


def page(arguments, rows):
    failed = sum(1 for row in rows if row["problem"])
    head = (
        "# Scenes\n\nEvery scene of the collection, baked by\n"
        f"`aglow bake SCENE -o OUT.glb --resolution 256 --quality draft --sky {arguments.sky}`\n"
        f"and checked with the Khronos validator. Written by `bench/scenes.py` on "
        f"{datetime.date.today().isoformat()}, {platform.machine()}, {arguments.threads} threads of "
        f"{os.cpu_count()}.\n\n{len(rows) - failed} of {len(rows)} scenes bake without an error, a "
        "value that is not finite or a complaint of the validator. Black texels are covered texels "
        "that receive nothing: insides of closed objects, floors under furniture.\n\n"
        "| scene | triangles | charts | texels | black | seconds | mean E (lx) | validator |\n"
        "|---|---|---|---|---|---|---|---|\n")
    return head + "\n".join(map(line, rows)) + "\n"


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    scenes = sorted(p for p in arguments.scenes.resolve().rglob("*")
                    if p.suffix in (".glb", ".gltf") and arguments.filter in str(p))
    arguments.scenes = arguments.scenes.resolve()
    rows = []
    for scene in scenes:
        rows.append(bake(arguments, scene))
        print(line(rows[-1]), flush=True)
    arguments.table.write_text(page(arguments, rows))
    (arguments.out / "scenes.json").write_text(json.dumps(rows, indent=2) + "\n")
    return 1 if any(row["problem"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
