#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the build, then builds and runs a small program that knows only the installed package.
# Usage: install_test.sh BUILD_FOLDER PROGRAM_FOLDER CMAKE
set -euo pipefail
build=$1 program=$2 cmake=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$cmake" --install "$build" --prefix "$work/prefix" >"$work/install.log" || {
    cat "$work/install.log"
    exit 1
}
"$work/prefix/bin/aglow" --version
"$cmake" -S "$program" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/configure.log" 2>&1 || {
    cat "$work/configure.log"
    exit 1
}
"$cmake" --build "$work/build"
said=$("$work/build/light_a_box")
echo "$said"
[[ "$said" =~ ^[1-9][0-9]*\ texels\ lit$ ]]
