// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/accessors.h"
#include "aglow/scene/gltf/test_files.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <rapidcheck.h>
#include <cmath>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

struct Type {
    int code;
    size_t bytes;
    double low, high, one;  ///< range of integers, and the integer that stands for 1
};
constexpr Type kTypes[] = {{5120, 1, -128, 127, 127},       {5121, 1, 0, 255, 255},
                           {5122, 2, -32768, 32767, 32767}, {5123, 2, 0, 65535, 65535},
                           {5125, 4, 0, 4294967295.0, 1},   {5126, 4, -1000, 1000, 1}};
constexpr const char* kShapes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};

void put(Bytes& bytes, size_t at, const Type& type, double value) {
    if (type.code == 5126) {
        const float number = static_cast<float>(value);
        std::memcpy(&bytes[at], &number, 4);
    } else {
        const auto integer = static_cast<int64_t>(value);
        std::memcpy(&bytes[at], &integer, type.bytes);  // two's complement, little-endian
    }
}

double draw(const Type& type) {
    if (type.code == 5126) return *rc::gen::inRange(-100000, 100001) / 128.0;
    return static_cast<double>(*rc::gen::inRange<int64_t>(static_cast<int64_t>(type.low),
                                                          static_cast<int64_t>(type.high) + 1));
}

/// Reads accessor 0 of `members` over one buffer.
Result<std::vector<float>> read(const std::string& members, const Bytes& buffer) {
    const auto json = gltf::JsonDocument::parse(document(members));
    if (!json) return tl::unexpected(json.error());
    std::vector<Bytes> buffers{buffer};
    const auto views = gltf::read_buffer_views(json->root(), buffers);
    if (!views) return tl::unexpected(views.error());
    auto accessors = gltf::Accessors::read(json->root(), *views, buffer.size());
    if (!accessors) return tl::unexpected(accessors.error());
    return accessors->floats(0);
}

}  // namespace

TEST_CASE("any layout of an accessor reads back what was written") {
    const bool holds = rc::check([] {
        const Type type =
            *rc::gen::elementOf(std::vector<Type>(std::begin(kTypes), std::end(kTypes)));
        const auto width = *rc::gen::inRange<size_t>(1, 5);
        const auto count = *rc::gen::inRange<size_t>(1, 20);
        const bool normalized = type.code <= 5123 && *rc::gen::arbitrary<bool>();
        const auto view_offset = *rc::gen::inRange<size_t>(0, 9);  // any alignment is read
        const auto offset = *rc::gen::inRange<size_t>(0, 9);
        const size_t element = width * type.bytes;
        const auto padding = *rc::gen::inRange<size_t>(0, 9);
        const size_t stride = element + padding;
        Bytes buffer(view_offset + offset + count * stride + 1, 0xab);
        std::vector<double> values;
        for (size_t i = 0; i < count; ++i)
            for (size_t k = 0; k < width; ++k) {
                values.push_back(draw(type));
                put(buffer, view_offset + offset + i * stride + k * type.bytes, type,
                    values.back());
            }

        // A sparse part replaces some elements.
        const auto sparse_count = *rc::gen::inRange<size_t>(0, count + 1);
        const size_t index_offset = buffer.size();
        buffer.resize(buffer.size() + 4 * sparse_count);
        const size_t value_offset = buffer.size();
        buffer.resize(buffer.size() + element * sparse_count);
        for (size_t s = 0; s < sparse_count; ++s) {
            const auto i = *rc::gen::inRange<size_t>(0, count);
            put(buffer, index_offset + 4 * s, kTypes[4], static_cast<double>(i));
            for (size_t k = 0; k < width; ++k) {
                values[i * width + k] = draw(type);
                put(buffer, value_offset + s * element + k * type.bytes, type,
                    values[i * width + k]);
            }
        }
        const std::string sparse = fmt::format(
            R"(, "sparse": {{"count": {}, "indices": {{"bufferView": 1, "componentType": 5125}},
                "values": {{"bufferView": 2}}}})",
            sparse_count);
        const std::string members = fmt::format(
            R"("buffers": [{{"byteLength": {}}}],
               "bufferViews": [{{"buffer": 0, "byteOffset": {}, "byteLength": {}, "byteStride": {}}},
                               {{"buffer": 0, "byteOffset": {}, "byteLength": {}}},
                               {{"buffer": 0, "byteOffset": {}, "byteLength": {}}}],
               "accessors": [{{"bufferView": 0, "byteOffset": {}, "componentType": {},
                               "normalized": {}, "type": "{}", "count": {}{}}}])",
            buffer.size(), view_offset, offset + count * stride, stride, index_offset,
            4 * sparse_count, value_offset, element * sparse_count, offset, type.code, normalized,
            kShapes[width - 1], count, sparse_count > 0 ? sparse : "");

        const auto read_back = read(members, buffer);
        RC_ASSERT(read_back.has_value());
        RC_ASSERT(read_back->size() == values.size());
        for (size_t i = 0; i < values.size(); ++i) {
            // glTF 2.0, section 3.6.2.2: f = max(c / (2^(b-1) - 1), -1), or c / (2^b - 1).
            const double expected = normalized ? std::max(values[i] / type.one, -1.0) : values[i];
            const double error = std::abs(static_cast<double>((*read_back)[i]) - expected);
            RC_ASSERT(error <= 1e-7 * std::abs(expected));
        }
    });
    CHECK(holds);
}

TEST_CASE("matrix columns of small integers start at multiples of four bytes") {
    // MAT2 of bytes: two used, two of padding, per column.
    const Bytes bytes{1, 2, 99, 99, 3, 4, 99, 99};
    const auto values = read(R"("buffers": [{"byteLength": 8}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}],
        "accessors": [{"bufferView": 0, "componentType": 5121, "type": "MAT2", "count": 1}])",
                             bytes);
    REQUIRE(values.has_value());
    CHECK(*values == std::vector<float>{1, 2, 3, 4});
}

TEST_CASE(
    "an accessor without a buffer view is zero, except where its sparse part says otherwise") {
    Bytes bytes = bytes_of<uint32_t>({2});
    append(bytes, bytes_of<float>({7}));
    const auto values = read(R"("buffers": [{"byteLength": 8}],
        "bufferViews": [{"buffer": 0, "byteLength": 4}, {"buffer": 0, "byteOffset": 4, "byteLength": 4}],
        "accessors": [{"componentType": 5126, "type": "SCALAR", "count": 4, "sparse": {"count": 1,
            "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 1}}}])",
                             bytes);
    REQUIRE(values.has_value());
    CHECK(*values == std::vector<float>{0, 0, 7, 0});
}

TEST_CASE("a sparse index beyond the accessor is an error") {
    const auto values = read(R"("buffers": [{"byteLength": 8}],
        "bufferViews": [{"buffer": 0, "byteLength": 4}, {"buffer": 0, "byteOffset": 4, "byteLength": 4}],
        "accessors": [{"componentType": 5126, "type": "SCALAR", "count": 4, "sparse": {"count": 1,
            "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 1}}}])",
                             bytes_of<uint32_t>({4, 0}));
    REQUIRE_FALSE(values.has_value());
    CHECK(values.error().message == "accessor 0: sparse index 4 is not below count 4");
}

TEST_CASE("a few bytes cannot ask for gigabytes of zeros") {
    const auto values = read(R"("buffers": [{"byteLength": 0}],
        "accessors": [{"componentType": 5126, "type": "MAT4", "count": 4000000000}])",
                             {});
    REQUIRE_FALSE(values.has_value());
    CHECK(values.error().code == Errc::out_of_memory);
    CHECK(values.error().message ==
          "accessor 0: decodes to far more numbers than the file has bytes");
}
