// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/rewrite_gltf.h"

#include "aglow/scene/gltf/edit/add_nodes.h"
#include "aglow/scene/gltf/edit/guard.h"
#include "aglow/scene/gltf/edit/replace_meshes.h"
#include "aglow/scene/gltf/edit/scene_files.h"

namespace aglow {
namespace {

namespace fs = std::filesystem;

Result<RewrittenFiles> rewrite(const Scene& scene, const fs::path& path, const SplatRadii& splats) {
    AG_TRY(const auto files, gltf::edit::scene_files(path));
    // Without a source the document is made from the scene, meshes and all.
    AG_TRY(auto document, gltf::edit::open_document(scene));
    AG_CHECK(gltf::edit::protect_input(scene, document, files, {}));
    RewrittenFiles result;
    if (scene.source || !splats.empty()) {
        AG_CHECK(gltf::edit::replace_meshes(document, scene, splats, result.warnings));
        gltf::edit::add_nodes(document, scene);
    }
    gltf::edit::OutputSet outputs;
    AG_CHECK(gltf::edit::add_scene(document, files, outputs));
    AG_TRY(result.outputs, outputs.commit());
    return result;
}

}  // namespace

Result<RewrittenFiles> rewrite_gltf(const Scene& scene, const fs::path& path,
                                    const SplatRadii& splats) {
    return gltf::edit::guarded(scene, path, [&] { return rewrite(scene, path, splats); });
}

}  // namespace aglow
