// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/math.h"
#include "aglow/core/image.h"
#include "aglow/core/parallel.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>
#include <vector>

using namespace aglow;

namespace {

const mat4 kAffine = compose({3, -1, 2}, {0.5f, 0.5f, 0.5f, 0.5f}, {2, -3, 0.25f});

void check_near(vec3 a, vec3 b) { CHECK(length(a - b) < 1e-5f); }

}  // namespace

TEST_CASE("a transform times its inverse is the identity") {
    for (const vec3 p : {vec3{0, 0, 0}, vec3{1, 2, 3}, vec3{-4, 0.5f, 7}})
        check_near(transform_point(inverse_affine(kAffine), transform_point(kAffine, p)), p);
}

TEST_CASE("the quaternion (1,1,1,1)/2 turns x to y, y to z and z to x") {
    const mat4 turn = compose({0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}, {1, 1, 1});
    check_near(transform_direction(turn, {1, 0, 0}), {0, 1, 0});
    check_near(transform_direction(turn, {0, 1, 0}), {0, 0, 1});
    check_near(transform_direction(turn, {0, 0, 1}), {1, 0, 0});
}

TEST_CASE("normals stay perpendicular to their surface and on its outer side under mirrors") {
    const vec3 a{1, 2, 0}, b{0, 1, 1};
    const vec3 n = cross(a, b);
    const vec3 image = transform_normal(kAffine, n);
    CHECK(determinant3(kAffine) < 0);
    CHECK(dot(image, transform_direction(kAffine, a)) == doctest::Approx(0).epsilon(1e-4));
    CHECK(dot(image, transform_direction(kAffine, b)) == doctest::Approx(0).epsilon(1e-4));
    CHECK(dot(image, transform_direction(kAffine, n)) > 0);
}

TEST_CASE("a frame is orthonormal and right-handed for every normal") {
    for (const vec3 v : {vec3{0, 0, 1}, vec3{0, 0, -1}, vec3{1, 0, 0}, vec3{0.3f, -0.8f, -0.52f}}) {
        const Frame frame(normalize(v));
        CHECK(dot(frame.tangent, frame.bitangent) == doctest::Approx(0).epsilon(1e-6));
        check_near(cross(frame.tangent, frame.bitangent), frame.normal);
    }
}

TEST_CASE("parallel ranges cover every item once") {
    std::vector<int> visits(1003, 0);
    parallel_for(visits.size(), 10, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) ++visits[i];
    });
    CHECK(std::accumulate(visits.begin(), visits.end(), 0) == 1003);
    CHECK(*std::max_element(visits.begin(), visits.end()) == 1);
}

TEST_CASE("a thread limit of one keeps all work on the thread that asked for it") {
    const ThreadLimit limit(1);
    std::atomic<int> elsewhere = 0;
    const auto caller = std::this_thread::get_id();
    parallel_for(1000, 1, [&](size_t, size_t) {
        std::this_thread::sleep_for(std::chrono::microseconds(20));
        elsewhere += std::this_thread::get_id() != caller;
    });
    CHECK(elsewhere == 0);
}

TEST_CASE("sRGB coding is its own inverse and puts middle grey where the standard says") {
    CHECK(srgb_to_linear(0.5f) == doctest::Approx(0.21404).epsilon(1e-4));
    for (const float v : {0.0f, 0.001f, 0.18f, 0.9f, 1.0f})
        CHECK(srgb_to_linear(linear_to_srgb(v)) == doctest::Approx(v).epsilon(1e-4));
}
