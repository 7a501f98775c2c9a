// SPDX-License-Identifier: Apache-2.0
// Rays on the GPU against Embree.
#include "aglow/accel/gpu/testing/agreement.h"
#include "aglow/accel/gpu/testing/rays.h"
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/testing/demand.h"
#include "aglow/vk/testing/test_device.h"
#include "tests/parity/scenes.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::testing;

namespace {

constexpr std::array kAccels = {Accel::grid, Accel::grid2, Accel::bvh};

struct Tally {
    size_t rounded = 0, differs = 0;
};

Tally compare(const Surfaces& surfaces, const RayScene& reference, GpuScene& scene,
              std::span<const Ray> rays) {
    const Judge judge(surfaces);
    const auto hits = demand(scene.intersect(rays));
    Tally tally;
    for (size_t i = 0; i < rays.size(); ++i) {
        const Verdict verdict =
            judge(rays[i], Judge::answer(hits[i]), Judge::answer(reference.intersect(rays[i])));
        tally.rounded += verdict == Verdict::rounded;
        tally.differs += verdict == Verdict::differs;
    }
    return tally;
}

}  // namespace

TEST_CASE("rays meet what Embree says they meet, in every structure") {
    vk::TestDevice device;
    if (!device) return;
    constexpr size_t kRays = 3000;  // of each class, in each scene and structure
    for (const TestScene& test : test_scenes()) {
        const RayScene reference = demand(RayScene::create(test.scene, test.surfaces));
        for (const Accel accel : kAccels) {
            GpuScene scene = demand(GpuScene::create(device.gpu(), test.surfaces, accel));
            for (const RayClass kind : kRayClasses) {
                CAPTURE(test.name);
                CAPTURE(std::string(name(accel)));
                CAPTURE(std::string(testing::name(kind)));
                const auto rays =
                    RaySource(test.surfaces, static_cast<uint64_t>(kind)).rays(kind, kRays);
                const Tally tally = compare(test.surfaces, reference, scene, rays);
                CHECK(tally.differs == 0);
                if (kind == RayClass::uniform) CHECK(tally.rounded == 0);
            }
        }
    }
}
