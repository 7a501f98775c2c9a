#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over the sources: those changed against git's HEAD first, then the rest.

A source that passed is remembered by a hash of all that clang-tidy reads of it (its text, that of
the project's headers, the configuration), so that only what changed is checked again.

    tools/tidy.py BUILD_FOLDER [--seconds N] [--jobs N]

BUILD_FOLDER holds compile_commands.json. Exit code 1 if anything is found. With --seconds, sources
that no time is left for are named at the end and do not fail the run.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = ("aglow", "apps")


def project_sources(build):
    commands = json.loads((build / "compile_commands.json").read_text())
    files = {pathlib.Path(c["file"]).resolve() for c in commands}
    return sorted(f for f in files
                  if f.is_relative_to(ROOT) and f.relative_to(ROOT).parts[0] in FOLDERS
                  and not f.name.endswith("_test.cpp"))  # doctest's macros are not ours to judge


def changed_files():
    def lines(*arguments):
        done = subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True)
        return done.stdout.splitlines() if done.returncode == 0 else []
    names = lines("diff", "--name-only", "HEAD") + lines("diff", "--name-only", "HEAD~1", "HEAD")
    return {ROOT / name for name in names + lines("ls-files", "--others", "--exclude-standard")}


def digest_of_headers():
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    for folder in FOLDERS:
        for header in sorted((ROOT / folder).rglob("*.h")):
            digest.update(str(header).encode() + b"\0" + header.read_bytes())
    return digest.digest()


def tidy(build, source):
    """What clang-tidy finds in the source, or an empty text."""
    done = subprocess.run(["clang-tidy", "--quiet", "-p", str(build), "--extra-arg=-Wno-error",
                           "--extra-arg=-Wno-unknown-warning-option",
                           str(source)], capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode != 0 else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()

    passed = options.build / "tidy-passed"
    passed.mkdir(exist_ok=True)
    headers, changed = digest_of_headers(), changed_files()
    todo = []
    for source in sorted(project_sources(options.build), key=lambda s: (s not in changed, s)):
        stamp = passed / hashlib.sha256(headers + str(source).encode() +
                                        source.read_bytes()).hexdigest()
        if not stamp.exists():
            todo.append((source, stamp))

    end = time.monotonic() + options.seconds
    findings, skipped = 0, []

    def check(job):
        source, stamp = job
        if time.monotonic() > end:
            return source, None
        found = tidy(options.build, source)
        if not found:
            stamp.touch()
        return source, found

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for source, found in pool.map(check, todo):
            if found is None:
                skipped.append(source.relative_to(ROOT))
            elif found:
                findings += 1
                print(found)
    print(f"clang-tidy: {len(todo) - len(skipped)} sources checked, {findings} with findings, "
          f"{len(skipped)} left for lack of time")
    for source in skipped:
        print(f"  not checked: {source}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
