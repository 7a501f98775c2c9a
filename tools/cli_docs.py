#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/cli.md from what the commands say of themselves.

    tools/cli_docs.py AGLOW OUT.md          writes the document
    tools/cli_docs.py AGLOW OUT.md --check  fails where the document says something else
"""
import pathlib
import re
import subprocess
import sys

HEAD = """# The command line

Written by `./dev docs` from `aglow COMMAND --help`.

Results go to stdout, everything else to stderr; with `--json` the result is one JSON object.
Progress is shown where stderr is a terminal. Files are written under a temporary name in their
folder and renamed when they are whole: a killed or failed run damages nothing.

| exit code | meaning |
|---|---|
| 0 | done |
| 1 | wrong usage: an option is unknown, missing, senseless, or contradicts another |
| 2 | a file could not be read or written |
| 3 | invalid input: a file breaks the rules of its format |
| 4 | run-time failure: memory ran out, or the device failed |
| 5 | the input, or an option, asks for a feature that this build does not have |
| 7 | a compared difference exceeds its bound (`compare --max-rmse`, `validate`) |
| 130 | interrupted |

Lengths are in metres, illuminance in lux, luminance in cd/m², flux in lumen; +Y is up, north is -Z.
"""


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def document(aglow):
    commands = re.findall(r"^  ([a-z]+) ", output(aglow, "--help"), re.MULTILINE)
    text = HEAD
    for command in commands:
        text += f"\n## aglow {command}\n\n```\n{output(aglow, command, '--help')}```\n"
    return text


def main(aglow, path, *flags):
    text = document(aglow)
    if "--check" not in flags:
        pathlib.Path(path).write_text(text)
        return 0
    same = pathlib.Path(path).exists() and pathlib.Path(path).read_text() == text
    print(f"{path} {'agrees with' if same else 'differs from'} --help")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
