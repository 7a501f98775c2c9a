// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu_subdivision.h"
#include "bench.h"
#include "refine_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace aglow::cli {
namespace {

constexpr int kRepeats = 5;              // the best counts: what else runs only ever adds time
constexpr double kRepeatSeconds = 0.05;  // of frames that are timed together
constexpr int kMostFrames = 200;
constexpr int kDeepLevel = 8;  // of the cube: 12 triangles become 786 432

/// Frames per second for surface subdivision in Concheiro et al., table 1 (Radeon 5870).
struct Published {
    const char* object;
    std::array<double, 3> fps;  // NITM, TA, VS_OUTPUT
};
constexpr std::array kPublished = {
    Published{"pawn", {1840, 1966, 4063}},   Published{"bishop", {1879, 1989, 4063}},
    Published{"queen", {1850, 1975, 3998}},  Published{"king", {1820, 1960, 3975}},
    Published{"teapot", {1720, 1873, 3970}}, Published{"spoon", {1701, 1810, 3907}},
    Published{"cup", {1772, 1920, 3970}},
};

std::optional<double> published_fps(const std::string& object, SubdivisionForm form) {
    const auto found = std::ranges::find_if(
        kPublished, [&](const Published& row) { return object == row.object; });
    if (found == kPublished.end() || form == SubdivisionForm::compute) return std::nullopt;
    return found->fps[static_cast<size_t>(form) - 1];
}

Result<double> best_frame(GpuSubdivision& gpu) {
    AG_TRY(double best, gpu.frame_seconds(1));  // shaders are compiled before
    for (int i = 0; i < kRepeats; ++i) {
        const double wanted = kRepeatSeconds / std::max(best, 1e-7);
        AG_TRY(const double seconds,
               gpu.frame_seconds(std::clamp(static_cast<int>(wanted), 1, kMostFrames)));
        best = std::min(best, seconds);
    }
    return best;
}

Result<double> best_on_cpu(const Subdivision& cpu, const CoarseObject& object,
                           std::vector<vec3>& points) {
    double best = kInfinity, sum = 0;
    for (int i = 0; i < kMostFrames && (i < kRepeats || sum < kRepeatSeconds); ++i) {
        const Stopwatch watch;
        AG_CHECK(cpu.evaluate(object.positions, points));
        best = std::min(best, watch.seconds());
        sum += watch.seconds();
    }
    return best;
}

/// The largest distance between two sets of points, of the size of their bounding box.
double relative_difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    Box box;
    float largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        box.add(a[i]);
        largest = std::max(largest, length(a[i] - b[i]));
    }
    return double{largest} / double{length(box.size())};
}

Result<Json> measure_form(const Gpu& gpu, const std::string& name, const CoarseObject& object,
                          int level, SubdivisionForm form, double triangles,
                          const std::vector<vec3>& expected) {
    AG_TRY(GpuSubdivision made,
           GpuSubdivision::create(gpu, object.topology, {.level = level}, form));
    std::vector<vec3> points(made.vertex_count());
    AG_CHECK(made.evaluate(object.positions, points));
    AG_TRY(const double seconds, best_frame(made));
    Json row = {{"form", aglow::name(form)},
                {"ms", seconds * 1e3},
                {"fps", 1 / seconds},
                {"mtriangles_per_second", triangles / seconds / 1e6},
                {"difference_to_cpu", relative_difference(expected, points)}};
    if (const auto fps = published_fps(name, form)) row["published_fps"] = *fps;
    return row;
}

Result<Json> measure_level(const Gpu& gpu, const std::string& name, const CoarseObject& object,
                           int level) {
    AG_TRY(const Subdivision cpu, Subdivision::create(object.topology, {.level = level}));
    std::vector<vec3> expected(cpu.vertex_count());
    AG_TRY(const double cpu_seconds, best_on_cpu(cpu, object, expected));
    const auto triangles = static_cast<double>(cpu.face_count());
    Json forms = Json::array();
    for (const SubdivisionForm form : kSubdivisionForms) {
        AG_TRY(const Json row, measure_form(gpu, name, object, level, form, triangles, expected));
        forms.push_back(row);
    }
    return Json{{"scene", name},
                {"coarse_triangles", object.topology.face_count()},
                {"level", level},
                {"triangles", cpu.face_count()},
                {"cpu_ms", cpu_seconds * 1e3},
                {"cpu_ratio_to_compute", cpu_seconds * 1e3 / forms[0]["ms"].get<double>()},
                {"forms", forms}};
}

Result<Json> measure(const Gpu& gpu, const std::string& name, const BenchOptions& options,
                     Console& console) {
    AG_TRY(const CoarseObject object, coarse_object(name, options.teaset));
    Json rows = Json::array();
    const std::vector<int> levels = name == "cube" ? std::vector{kDeepLevel} : std::vector{1, 2};
    for (const int level : levels) {
        AG_CHECK(console.go_on(fmt::format("{}, level {}", name, level)));
        AG_TRY(const Json row, measure_level(gpu, name, object, level));
        rows.push_back(row);
    }
    return rows;
}

std::string text_of(const Json& report) {
    std::string text =
        "frames per second of subdivision alone (published: Radeon 5870), "
        "million triangles per second\n\n";
    text += fmt::format("{:<8} {:>5} {:>9} {:>9}", "object", "level", "triangles", "CPU ms");
    for (const SubdivisionForm form : kSubdivisionForms)
        text += fmt::format(" | {:<24}", name(form));
    text += '\n';
    for (const Json& row : report["scenes"]) {
        text += fmt::format("{:<8} {:>5} {:>9} {:>9.3f}", row["scene"].get<std::string>(),
                            row["level"].get<int>(), row["triangles"].get<uint32_t>(),
                            row["cpu_ms"].get<double>());
        for (const Json& form : row["forms"]) {
            const std::string published =
                form.contains("published_fps")
                    ? fmt::format("({:.0f})", form["published_fps"].get<double>())
                    : "";
            text += fmt::format(" | {:>8.1f} {:<6} {:>8.2f}", form["fps"].get<double>(), published,
                                form["mtriangles_per_second"].get<double>());
        }
        text += '\n';
    }
    if (report.contains("left_out"))
        text += "\nLeft out: teapot, spoon and cup; name their file with --teaset FILE.\n";
    return text;
}

}  // namespace

BenchTable refine_table(const BenchOptions& options) {
    BenchTable table{
        {"pawn", "bishop", "queen", "king"}, Json::object(), measure, text_of, "the CPU"};
    if (options.teaset.empty())
        table.settings["left_out"] = {"teapot", "spoon", "cup"};
    else
        table.scenes.insert(table.scenes.end(), {"teapot", "spoon", "cup"});
    table.scenes.push_back("cube");
    return table;
}

}  // namespace aglow::cli
