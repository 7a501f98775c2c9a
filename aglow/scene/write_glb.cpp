// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/file.h"
#include "aglow/scene/glb/builder.h"
#include "aglow/scene/write.h"

#include <fmt/format.h>

#include <new>

namespace aglow {
namespace {

Status check_writable(const Scene& scene) {
    for (const Node& node : scene.nodes)
        if (!node.instances.empty())
            return fail(Errc::unsupported, "instances cannot be written as a new GLB");
    return {};
}

Result<std::vector<uint8_t>> build(const Scene& scene) {
    glb::Builder glb;
    glb::add_nodes(glb, scene);
    AG_CHECK(glb::add_meshes(glb, scene));
    AG_CHECK(glb::add_skins(glb, scene));
    glb::add_animations(glb, scene);
    glb::add_materials(glb, scene);
    AG_CHECK(glb::add_textures(glb, scene));
    glb::add_cameras(glb, scene);
    glb::add_lights(glb, scene);
    return glb.finish();
}

}  // namespace

Result<std::vector<uint8_t>> to_glb(const Scene& scene) {
    AG_CHECK(check_writable(scene));
    try {
        return build(scene);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the GLB does not fit into memory");
    } catch (const nlohmann::json::exception& error) {
        return fail(Errc::bad_argument,
                    fmt::format("the scene has no JSON form: {}", error.what()));
    }
}

Status write_glb(const Scene& scene, const std::filesystem::path& path) {
    Result<std::vector<uint8_t>> glb = to_glb(scene);
    if (!glb) {
        glb.error().context = path.string();
        return tl::unexpected<Error>(std::move(glb).error());
    }
    return write_file(path, *glb);
}

}  // namespace aglow
