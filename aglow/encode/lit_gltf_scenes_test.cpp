// SPDX-License-Identifier: Apache-2.0
// Every real scene makes the round trip, in both forms and both containers.
#include "aglow/encode/gltf/testing/attributes.h"
#include "aglow/encode/testing/round_trip.h"

using namespace aglow;
using namespace aglow::encode::testing;
namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxTriangles = 12000;  // posed; keeps the test within seconds

std::vector<fs::path> gltf_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (ending == ".glb" || ending == ".gltf") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

/// One file of each folder of a kit speaks for its siblings.
std::vector<fs::path> chosen_files() {
    std::vector<fs::path> chosen;
    for (const fs::path& file : gltf_files(scenes_folder())) {
        const bool sibling = !chosen.empty() && chosen.back().parent_path() == file.parent_path();
        if (!sibling) chosen.push_back(file);
    }
    return chosen;
}

void round_trip(const Scene& before, FakeBake& bake, const fs::path& path) {
    written(bake, path);
    Scene after = load(path);
    check_attributes(before, after);
    const auto lit = read_lit_gltf(after, path);
    REQUIRE_MESSAGE(lit, (lit ? "" : to_string(lit.error())));
    const Surfaces surfaces = pose(after, -1, &lit->atlas);
    CHECK(triangle_set(surfaces) == triangle_set(bake.surfaces));
    CHECK(light_error(surfaces, lit->irradiance, origin_of(surfaces)) < 1e-3);
}

}  // namespace

TEST_CASE("real scenes keep their geometry, attributes and light, and validate") {
    if (!fs::is_directory(scenes_folder())) {
        MESSAGE("no scenes in " << scenes_folder().string() << "; skipped");
        return;
    }
    const TemporaryFolder folder;
    std::vector<fs::path> outputs;
    for (const fs::path& file : chosen_files()) {
        CAPTURE(file.string());
        const Scene before = load(file);
        const size_t triangles = pose(before).triangles.size();
        if (triangles == 0 || triangles > kMaxTriangles) continue;
        const fs::path stem = folder.path / std::to_string(outputs.size()) / file.stem();
        fs::create_directory(stem.parent_path());
        const fs::path glb = stem.string() + ".glb", text = stem.string() + "-text.gltf",
                       unlit = stem.string() + "-unlit.glb";
        FakeBake bake(before);
        round_trip(before, bake, glb);
        round_trip(before, bake, text);
        written(bake, unlit, LitForm::unlit);
        const Surfaces shown = pose(load(unlit));
        CHECK(triangle_set(shown).size() == triangle_set(bake.surfaces).size());
        outputs.insert(outputs.end(), {glb, text, unlit});
    }
    CHECK(outputs.size() >= 3 * 20);
    CHECK(validator_agrees(outputs));
}
