// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/pattern.h"
#include "aglow/refine/scene/alike.h"
#include "aglow/refine/scene/refine_mesh.h"
#include "aglow/scene/gltf_source.h"

#include <fmt/format.h>

#include <new>
#include <optional>

namespace aglow {
namespace {

bool subdivides(RefineScheme scheme) {
    return scheme == RefineScheme::loop || scheme == RefineScheme::catmull_clark;
}

Status check_pattern(const RefineOptions& options) {
    const PatternOptions& pattern = options.pattern;
    if (subdivides(options.scheme) && (pattern.irregular || pattern.tolerance))
        return fail(Errc::bad_argument,
                    "only patches (pn, st, phong) have irregular patterns and a tolerance");
    if (pattern.eye && !pattern.irregular)
        return fail(Errc::bad_argument, "an eye draws the vertices of irregular patterns alone");
    if (pattern.eye && options.share)
        return fail(Errc::bad_argument,
                    "an eye sees every mesh another way: nothing can be shared");
    if (!pattern.tolerance) return {};
    if (!(*pattern.tolerance > 0))
        return fail(Errc::bad_argument,
                    fmt::format("a tolerance of {} is not above 0", *pattern.tolerance));
    if (options.displacement || options.field)
        return fail(
            Errc::bad_argument,
            "the tolerance is that of the smooth surface: it says nothing of a displaced one");
    if ((1 << options.level) > kMostAdaptiveSegments)
        return fail(Errc::bad_argument,
                    fmt::format("with a tolerance an edge has at most {} segments: take a lower "
                                "level than {}",
                                kMostAdaptiveSegments, options.level));
    return {};
}

Status check_model(const RefineOptions& options) {
    if (!options.model) return {};
    if (subdivides(options.scheme))
        return fail(Errc::bad_argument, "only patches (pn, st, phong) carry models");
    if (options.displacement || options.field)
        return fail(Errc::bad_argument,
                    "models stand on the smooth surface: leave displacement out");
    if (options.model->repeats < 1 || options.model->triangles.empty())
        return fail(Errc::bad_argument,
                    "a model has triangles, and stands on a face once at least");
    return {};
}

Status check_options(const RefineOptions& options) {
    const int finest = finest_level(options.scheme);
    if (options.level < 1 || options.level > finest)
        return fail(Errc::bad_argument,
                    fmt::format("level {} is outside 1 to {}", options.level, finest));
    if (options.limit && !subdivides(options.scheme))
        return fail(Errc::bad_argument, "only subdivision (loop, catmull-clark) has a limit");
    if (options.control.quads && options.scheme == RefineScheme::loop)
        return fail(Errc::bad_argument,
                    "Loop subdivision is for triangles: leave quads out, or "
                    "take catmull-clark");
    if (options.displacement && options.field)
        return fail(Errc::bad_argument, "a surface is displaced by a map or by a function");
    AG_CHECK(check_pattern(options));
    return check_model(options);
}

uint64_t triangle_count(const Scene& scene) {
    uint64_t count = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) count += p.triangles.size();
    return count;
}

/// Before the work, from the triangles that there are; Catmull-Clark makes three quads of one.
Status check_size(const Scene& scene, const RefineOptions& options) {
    const bool thirds = options.scheme == RefineScheme::catmull_clark && !options.control.quads;
    const uint64_t coarse = triangle_count(scene);
    uint64_t models = 0;
    if (const auto& model = options.model)
        models = coarse * model->triangles.size() * static_cast<uint64_t>(model->repeats) *
                 static_cast<uint64_t>(model->repeats);
    const auto fine = [&](int level) {
        return models + (coarse << 2 * level) / 2 * (thirds ? 3 : 2);
    };
    if (fine(options.level) <= kMostRefinedTriangles) return {};
    int fits = options.level;
    while (fits > 0 && fine(fits) > kMostRefinedTriangles) --fits;
    return fail(Errc::bad_argument,
                fmt::format("level {} would make {} triangles of {}, more than the {} that a file "
                            "can hold; {}",
                            options.level, fine(options.level), coarse, kMostRefinedTriangles,
                            fits > 0 ? fmt::format("level {} fits", fits) : "no level fits"));
}

/// The heights that a mesh names itself; all its primitives have one map.
Result<std::optional<HeightDisplacement>> own_heights(const Scene& scene, const Mesh& mesh) {
    for (const Primitive& p : mesh.primitives) {
        if (!p.displacement) continue;
        const std::filesystem::path folder = scene.source ? scene.source->folder : "";
        HeightDisplacement own;
        AG_TRY(own.map, read_height_map(folder / p.displacement->file));
        own.scale = p.displacement->scale;
        own.bias = p.displacement->bias;
        own.texcoord = p.displacement->texcoord;
        return std::optional(std::move(own));
    }
    return std::optional<HeightDisplacement>();
}

/// The eye in the space of a mesh: of the node that shows it nearest.
std::optional<vec3> eye_of_mesh(const Scene& scene, size_t mesh, vec3 eye) {
    const std::vector<mat4> transforms = world_transforms(scene);
    std::optional<vec3> nearest;
    float distance = kInfinity;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].mesh != static_cast<int>(mesh)) continue;
        const vec3 place = transform_point(transforms[n], {0, 0, 0});
        if (length(place - eye) >= distance) continue;
        distance = length(place - eye);
        nearest = transform_point(inverse_affine(transforms[n]), eye);
    }
    return nearest;
}

/// A mesh with heights of its own stays flat under them; creases and quads would change the
/// surface that they stand on.
Result<Mesh> refined_mesh(const Scene& scene, const Mesh& mesh, const RefineOptions& options,
                          std::vector<std::string>& warnings) {
    if (options.displacement || options.field) return refine::refine_mesh(mesh, options, warnings);
    AG_TRY(std::optional<HeightDisplacement> heights, own_heights(scene, mesh));
    if (!heights) return refine::refine_mesh(mesh, options, warnings);
    RefineOptions flat;
    flat.scheme = RefineScheme::flat;
    flat.level = options.level;
    flat.displacement = std::move(heights);
    return refine::refine_mesh(mesh, flat, warnings);
}

/// One mesh after the other, each once.
class SceneRefiner {
public:
    SceneRefiner(const Scene& scene, const RefineOptions& options)
        : scene_(scene), options_(options), refined_(scene) {
        if (options.pattern.eye) {
            seen_ = options;
        } else {
            const bool moved = options.share && !options.field;
            alike_ =
                refine::find_alike(scene, moved ? refine::Motions::rigid : refine::Motions::none);
        }
    }

    Status refine(size_t m) {
        if (!alike_.empty() && alike_[m].mesh != m) {
            copy(refined_.meshes[alike_[m].mesh], refined_.meshes[m]);
            return {};
        }
        if (seen_) seen_->pattern.eye = eye_of_mesh(scene_, m, *options_.pattern.eye);
        std::vector<std::string> warnings;
        auto mesh = refined_mesh(scene_, scene_.meshes[m], seen_ ? *seen_ : options_, warnings);
        const std::string name = fmt::format("mesh {} \"{}\"", m, scene_.meshes[m].name);
        if (!mesh)
            return fail(mesh.error().code, fmt::format("{}: {}", name, mesh.error().message),
                        mesh.error().context);
        refined_.meshes[m] = std::move(*mesh);
        for (const std::string& warning : warnings)
            refined_.warnings.push_back(fmt::format("{}: {}", name, warning));
        return {};
    }

    Scene take() {
        if (!alike_.empty()) refine::place_moved(refined_, alike_);
        return std::move(refined_);
    }

private:
    /// All but name, weights and materials.
    static void copy(const Mesh& from, Mesh& to) {
        for (size_t p = 0; p < to.primitives.size(); ++p) {
            const int material = to.primitives[p].material;
            to.primitives[p] = from.primitives[p];
            to.primitives[p].material = material;
        }
    }

    const Scene& scene_;
    const RefineOptions& options_;
    std::optional<RefineOptions> seen_;  // with the eye where the mesh sees it
    std::vector<refine::Likeness> alike_;
    Scene refined_;
};

}  // namespace

int finest_level(RefineScheme scheme) {
    if (subdivides(scheme)) return kDeepestLevel;
    int level = 0;
    while ((2 << level) <= kMostSegments) ++level;
    return level;
}

Result<Scene> refine_scene(const Scene& scene, const RefineOptions& options,
                           const Monitor& monitor) try {
    AG_CHECK(check_options(options));
    AG_CHECK(check_size(scene, options));
    SceneRefiner refiner(scene, options);
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        if (monitor.cancelled()) return fail(Errc::cancelled, "interrupted");
        monitor("refine", static_cast<double>(m) / static_cast<double>(scene.meshes.size()));
        AG_CHECK(refiner.refine(m));
    }
    monitor("refine", 1);
    return refiner.take();
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                "the refined scene does not fit into memory: take a lower "
                "level");
}

}  // namespace aglow
