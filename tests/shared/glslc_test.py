#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every header of aglow/shared compiles as GLSL too. Run by ctest as `shared_headers`.

Each header is included twice in a compute shader that does nothing, and the result is checked by
spirv-val. Exit code 77, "skipped", where glslc is missing.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHADER = """#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#include "{0}"
#include "{0}"
layout(local_size_x = 1) in;
void main() {{}}
"""


def compile_as_glsl(header, folder):
    """What glslc or spirv-val has to say about the header; empty if nothing."""
    source = folder / "shader.comp"
    binary = folder / "shader.spv"
    source.write_text(SHADER.format(header.relative_to(ROOT).as_posix()))
    commands = [["glslc", "--target-env=vulkan1.2", "-I", str(ROOT), "-Werror", str(source), "-o",
                 str(binary)]]
    if shutil.which("spirv-val"):
        commands.append(["spirv-val", "--target-env", "vulkan1.2", str(binary)])
    for command in commands:
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            return done.stdout + done.stderr
    return ""


def main():
    if not shutil.which("glslc"):
        print("skipped: glslc is not installed")
        return 77
    headers = sorted((ROOT / "aglow/shared").glob("*.h"))
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for header in headers:
            problem = compile_as_glsl(header, pathlib.Path(folder))
            failures += bool(problem)
            if problem:
                print(f"{header.relative_to(ROOT)}:\n{problem}")
    print(f"{len(headers) - failures} of {len(headers)} shared headers compile as GLSL")
    return 1 if failures or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
