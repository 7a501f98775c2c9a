// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin.h"

#include "aglow/scene/builtin/scenes.h"

#include <fmt/format.h>

#include <charconv>
#include <new>

namespace aglow {
namespace {

constexpr std::string_view kStressPrefix = "stress:";

struct Entry {
    const char* name;
    const char* description;
    Scene (*make)();  ///< none for a family
};

constexpr Entry kEntries[] = {
    {"cornell-box", "the Cornell box, original measurements, one area light", builtin::cornell_box},
    {"furnace", "closed cube whose walls all shine and reflect alike", builtin::furnace},
    {"cube-tc58", "CIE 171 case 5.8: 4 m cube, 10 klm point light in its centre",
     builtin::cube_tc58},
    {"corridor", "closed U-shaped corridor lit at one end", builtin::corridor},
    {"living-room", "furnished room with windows, sun and lamps", builtin::living_room},
    {"stress:N", "room full of bumpy spheres, N triangles in all", nullptr},
};

Result<int64_t> stress_size(std::string_view text) {
    int64_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size() || count < builtin::kMinStress ||
        count > builtin::kMaxStress)
        return fail(Errc::bad_argument,
                    fmt::format("stress:{}: N must be a number from {} to {}", text,
                                builtin::kMinStress, builtin::kMaxStress));
    return count;
}

}  // namespace

std::vector<BuiltinScene> builtin_scenes() {
    std::vector<BuiltinScene> scenes;
    for (const Entry& entry : kEntries) scenes.push_back({entry.name, entry.description});
    return scenes;
}

Result<Scene> builtin_scene(std::string_view name) {
    try {
        if (name.starts_with(kStressPrefix)) {
            AG_TRY(const int64_t count, stress_size(name.substr(kStressPrefix.size())));
            return builtin::stress(count);
        }
        std::string known;
        for (const Entry& entry : kEntries) {
            if (entry.make && entry.name == name) return entry.make();
            known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
        }
        return fail(Errc::bad_argument,
                    fmt::format("no built-in scene \"{}\"; there are: {}", name, known));
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the scene does not fit into memory");
    }
}

}  // namespace aglow
