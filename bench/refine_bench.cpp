// SPDX-License-Identifier: Apache-2.0
// Subdivision beside OpenSubdiv, in one run, from the same meshes, one thread each:
//   refine_bench [LEVEL [SEGMENTS]]  to LEVEL (4) from a torus of SEGMENTS x SEGMENTS (71) quads;
//                                    Loop splits these along diagonals that differ without order
// Seconds are the least of several repetitions, in processor time, which other work on the machine
// changes little.
#include "aglow/core/parallel.h"
#include "aglow/refine/subdivision.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/refine/testing/open_subdiv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace aglow;
using namespace aglow::refine::testing;
namespace far = OpenSubdiv::Far;

namespace {

double now() {
    timespec time = {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

/// Least seconds of what is done several times, until two seconds are over.
template <class Work>
double seconds(const Work& work) {
    double least = 1e30, all = 0;
    for (int i = 0; i < 3 || (all < 2 && i < 200); ++i) {
        const double start = now();
        work();
        const double passed = now() - start;
        least = std::min(least, passed);
        all += passed;
    }
    return least;
}

using Point = BasicOsdPoint<float>;

CoarseMesh torus_of_quads(uint32_t n) {
    CoarseMesh mesh{"torus", {}, {}, {}, {}};
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            const double a = 6.283185307179586 * i / n, b = 6.283185307179586 * j / n;
            const double r = 3 + std::cos(b);
            mesh.add_vertex(r * std::cos(a), r * std::sin(a), std::sin(b));
        }
    const auto at = [&](uint32_t i, uint32_t j) { return i % n * n + j % n; };
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j)
            mesh.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

/// Quads as two triangles, along one diagonal or the other: valences 4 to 8.
CoarseMesh with_mixed_diagonals(const CoarseMesh& quads) {
    CoarseMesh mesh = quads;
    mesh.name += " with mixed diagonals";
    mesh.polygons.face_begin = {0};
    mesh.polygons.corners.clear();
    Noise noise(1);
    for (uint32_t f = 0; f < quads.polygons.face_count(); ++f) {
        const uint32_t* c = &quads.polygons.corners[quads.polygons.face_begin[f]];
        const uint32_t k = noise() < 0.5 ? 0 : 1;
        mesh.add_face({c[k], c[k + 1], c[k + 2]});
        mesh.add_face({c[k], c[k + 2], c[(k + 3) % 4]});
    }
    return mesh;
}

/// What OpenSubdiv takes to build and to evaluate.
struct Peer {
    double topology = 0, stencils = 0;
    double primvar = 0, update = 0, evaluator = 0;
};

std::unique_ptr<far::TopologyRefiner> refined(const Topology& mesh, Scheme scheme, int level) {
    auto refiner = make_refiner(mesh, scheme, Corners::smooth);
    refiner->RefineUniform(far::TopologyRefiner::UniformOptions(level));
    return refiner;
}

std::unique_ptr<const far::StencilTable> stencils_of(const far::TopologyRefiner& refiner) {
    far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    options.generateOffsets = true;
    return std::unique_ptr<const far::StencilTable>(
        far::StencilTableFactory::Create(refiner, options));
}

Peer measure_peer(const Topology& mesh, Scheme scheme, int level,
                  const std::vector<vec3>& control) {
    Peer peer;
    std::unique_ptr<far::TopologyRefiner> refiner;
    std::unique_ptr<const far::StencilTable> stencils;
    peer.topology = seconds([&] { refiner = refined(mesh, scheme, level); });
    peer.stencils = seconds([&] { stencils = stencils_of(*refiner); });

    std::vector<std::vector<Point>> levels(1);
    for (const vec3 p : control) levels[0].push_back({p.x, p.y, p.z});
    for (int k = 1; k <= level; ++k)
        levels.emplace_back(static_cast<size_t>(refiner->GetLevel(k).GetNumVertices()));
    const far::PrimvarRefiner primvar(*refiner);
    peer.primvar = seconds([&] {
        for (size_t k = 1; k < levels.size(); ++k)
            primvar.Interpolate(static_cast<int>(k), levels[k - 1], levels[k]);
    });
    std::vector<Point>& points = levels.back();
    peer.update = seconds([&] { stencils->UpdateValues(levels[0].data(), points.data()); });
    const OpenSubdiv::Osd::BufferDescriptor three(0, 3, 3);
    peer.evaluator = seconds([&] {
        OpenSubdiv::Osd::CpuEvaluator::EvalStencils(
            &levels[0][0].x, three, &points[0].x, three, &stencils->GetSizes()[0],
            &stencils->GetOffsets()[0], &stencils->GetControlIndices()[0],
            &stencils->GetWeights()[0], 0, stencils->GetNumStencils());
    });
    return peer;
}

void print_line(const char* what, double ours, const char* whose, double theirs) {
    fmt::print("  {:28} {:9.2f} ms   {:34} {:9.2f} ms   {:5.1f}x\n", what, ours * 1e3, whose,
               theirs * 1e3, theirs / ours);
}

int compare(const CoarseMesh& coarse, Scheme scheme, int level) {
    const Topology mesh = topology_of(coarse);
    const SubdivisionOptions options{scheme, level, Corners::smooth};
    Result<Subdivision> ours = Subdivision::create(mesh, options);
    if (!ours) {
        fmt::print(stderr, "refine_bench: {}\n", to_string(ours.error()));
        return EXIT_FAILURE;
    }
    const double build = seconds([&] { ours = Subdivision::create(mesh, options); });
    const double faces = seconds([&] {
        if (scheme == Scheme::loop)
            static_cast<void>(ours->triangles());
        else
            static_cast<void>(ours->quads());
    });
    std::vector<vec3> points(ours->vertex_count()), normals(points);
    const double evaluate =
        seconds([&] { static_cast<void>(ours->evaluate(coarse.positions, points)); });
    const double copy = seconds([&] { std::ranges::copy(points, normals.begin()); });
    const double limit = seconds(
        [&] { static_cast<void>(ours->evaluate_limit(coarse.positions, points, normals)); });
    const Peer peer = measure_peer(mesh, scheme, level, coarse.positions);

    fmt::print("{}, {}: {} faces, {} refined vertices at level {}\n", coarse.name,
               scheme == Scheme::loop ? "Loop" : "Catmull-Clark", mesh.face_count(),
               ours->vertex_count(), level);
    print_line("positions", evaluate, "PrimvarRefiner, all levels", peer.primvar);
    print_line("", evaluate, "StencilTable::UpdateValues", peer.update);
    print_line("", evaluate, "CpuEvaluator::EvalStencils", peer.evaluator);
    print_line("tables", build, "TopologyRefiner", peer.topology);
    print_line("tables, indices", build + faces, "TopologyRefiner", peer.topology);
    print_line("", build + faces, "TopologyRefiner, StencilTable", peer.topology + peer.stencils);
    fmt::print("  limit points, normals {:16.2f} ms; copy of the positions {:.2f} ms\n",
               limit * 1e3, copy * 1e3);
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    const int level = argc > 1 ? std::atoi(argv[1]) : 4;
    const auto segments = static_cast<uint32_t>(argc > 2 ? std::atoi(argv[2]) : 71);
    const ThreadLimit one(1);
    const CoarseMesh quads = torus_of_quads(segments);
    return compare(with_mixed_diagonals(quads), Scheme::loop, level) |
           compare(triangulated(quads), Scheme::loop, level) |
           compare(quads, Scheme::catmull_clark, level);
}
