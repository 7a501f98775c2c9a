#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails when a file includes a folder it may not know about. Run by ctest as `layers`.

The table is that of docs/architecture.md. Headers directly in a stage, and those of the solvers in
transport/gather and transport/path, are public; cpu/, gpu/ and gltf/ folders are open to the same
folders of later stages; every other subfolder is private to its stage.
"""
import pathlib
import re
import sys
import tempfile

BASE = {"shared", "core"}
# Of `vk`, all may see the list of devices; the rest shows Vulkan and belongs to gpu/ folders.
DEVICES = "devices.h"
MAY_INCLUDE = {
    "shared": set(),
    "core": {"shared"},
    "vk": BASE,
    "scene": BASE,
    "mesh": BASE | {"scene"},
    "refine": BASE | {"mesh", "scene"},
    "accel": BASE | {"mesh", "refine"},
    "transport": BASE | {"scene", "mesh", "refine", "accel"},
    "encode": BASE | {"scene", "mesh", "refine", "transport"},
    "render": BASE | {"scene", "mesh", "refine", "accel", "encode"},
    "bake": BASE | {"scene", "mesh", "refine", "accel", "transport", "encode"},
}
PUBLIC_SUBFOLDERS = {("transport", "gather"), ("transport", "path")}
SHARED_FOLDERS = {"cpu", "gpu", "gltf"}
# What never appears in a public header: whoever includes it would need the library's headers.
HIDDEN = re.compile(
    r'^\s*#\s*include\s+["<](embree|tbb|oneapi|tiny_gltf|Eigen|nlohmann|fmt|vulkan|OpenEXR|Imf)',
    re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+["<]aglow/(\w+)/([^">]+)[">]', re.MULTILINE)
SOURCES = {".h", ".cpp", ".glsl", ".comp", ".vert", ".tesc", ".tese", ".geom", ".frag"}


def is_public(stage, folders):
    return not folders or (len(folders) == 1 and (stage, folders[0]) in PUBLIC_SUBFOLDERS)


def shared_folder(folders):
    return next((folder for folder in folders if folder in SHARED_FOLDERS), None)


def allowed(parts, stage, header):
    """May the file at `parts` (from the root) include aglow/<stage>/<header>?"""
    folders = header.split("/")[:-1]
    if stage == "vk" and header != DEVICES:
        return "vk" in parts[1:2] or "gpu" in parts[2:-1] or parts[0] not in {"aglow", "apps"}
    if parts[0] == "apps":  # an app sees only what an installed library would show it
        return is_public(stage, folders)
    if parts[0] != "aglow" or len(parts) < 3:  # tests and benchmarks see everything
        return True
    mine, my_folders = parts[1], parts[2:-1]
    if stage == mine:
        return True
    if stage == "vk":
        return mine not in {"shared", "core", "scene"}
    if stage not in MAY_INCLUDE[mine]:
        return False
    if (stage, folders) == ("core", ["testing"]):  # tests beside the code
        return parts[-1].endswith("_test.cpp") or "testing" in my_folders
    return is_public(stage, folders) or (
        shared_folder(folders) is not None and
        shared_folder(folders) == shared_folder(my_folders))


def violations(root):
    for path in sorted(p for p in root.rglob("*") if p.suffix in SOURCES):
        parts = path.relative_to(root).parts
        if parts[0] in {"build", "out", "node_modules", ".git"}:
            continue
        text = path.read_text()
        for stage, header in INCLUDE.findall(text):
            if not allowed(parts, stage, header):
                yield f"{'/'.join(parts)}: may not include aglow/{stage}/{header}"
        public = parts[0] == "aglow" and len(parts) >= 3 and is_public(parts[1], parts[2:-1]) and (
            parts[1] != "vk" or parts[-1] == DEVICES)
        if public and path.suffix == ".h" and HIDDEN.search(text):
            yield f"{'/'.join(parts)}: a public header includes {HIDDEN.search(text).group(1)}"


PLANTED = {
    "aglow/scene/a.cpp": '#include "aglow/mesh/b.h"\n',
    "aglow/render/a.cpp": '#include "aglow/transport/gather/gather.h"\n',
    "aglow/bake/a.cpp": '#include "aglow/accel/cpu/embree_scene.h"\n',
    "aglow/bake/b.cpp": '#include "aglow/scene/gltf/json.h"\n',
    "apps/cli/a.cpp": '#include <aglow/transport/gather/cpu/kernel.h>\n',
    "aglow/accel/a.h": "#include <embree3/rtcore.h>\n",
    "aglow/accel/b.h": '#include "aglow/vk/stream.h"\n',
    "aglow/scene/c.cpp": '#include "aglow/vk/devices.h"\n',
    "apps/cli/c.cpp": '#include "aglow/vk/device.h"\n',
    "aglow/vk/devices.h": "#include <vulkan/vulkan.h>\n",
}
FINE = {
    "aglow/transport/gather/cpu/a.cpp": '#include "aglow/accel/cpu/embree_scene.h"\n',
    "aglow/scene/b.cpp": '#include "aglow/scene/gltf/json.h"\n',
    "aglow/encode/gltf/a.cpp": '#include "aglow/scene/gltf/edit/document.h"\n',
    "apps/cli/b.cpp": '#include "aglow/transport/path/path.h"\n',
    "aglow/accel/cpu/a.h": "#include <embree3/rtcore.h>\n",
    "aglow/accel/gpu/a.cpp": '#include "aglow/vk/stream.h"\n',
    "aglow/accel/c.h": '#include "aglow/vk/devices.h"\n',
    "apps/cli/d.cpp": '#include "aglow/vk/devices.h"\n',
    "aglow/vk/a.h": "#include <vulkan/vulkan.h>\n",
}


def finds_what_is_planted():
    """The check itself, on violations it must find and on files it must not blame."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in (PLANTED | FINE).items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        found = {line.split(":")[0] for line in violations(root)}
    return found == set(PLANTED)


if __name__ == "__main__":
    if not finds_what_is_planted():
        sys.exit("the layer test does not find what is planted")
    found = list(violations(pathlib.Path(__file__).resolve().parents[2]))
    print("\n".join(found) if found else "layers hold")
    sys.exit(bool(found))
