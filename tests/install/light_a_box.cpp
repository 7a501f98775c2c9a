// SPDX-License-Identifier: Apache-2.0
#include <aglow/bake/bake.h>
#include <aglow/scene/builtin.h>
#include <cstdio>

int main() {
    auto scene = aglow::builtin_scene("cornell-box");
    if (!scene) return std::puts(to_string(scene.error()).c_str()), 1;
    auto lit = aglow::bake(
        *scene, {.solve = {.quality = aglow::Quality::draft}, .unwrap = {.resolution = 64}});
    if (!lit) return std::puts(to_string(lit.error()).c_str()), 1;
    std::printf("%zu texels lit\n", lit->texels.element_count());
}
