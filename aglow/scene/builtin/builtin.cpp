// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin.h"

#include "aglow/scene/builtin/scenes.h"

#include <fmt/format.h>

#include <charconv>
#include <new>

namespace aglow {
namespace {

struct Entry {
    const char* name;
    const char* description;
    Scene (*make)();                         ///< none for a family
    Scene (*make_sized)(int64_t) = nullptr;  ///< of a family, whose name ends in ":N"
};

constexpr Entry kEntries[] = {
    {"cornell-box", "the Cornell box, original measurements, one area light", builtin::cornell_box},
    {"furnace", "closed cube whose walls all shine and reflect alike", builtin::furnace},
    {"cube-tc58", "CIE 171 case 5.8: 4 m cube, 10 klm point light in its centre",
     builtin::cube_tc58},
    {"corridor", "closed U-shaped corridor lit at one end", builtin::corridor},
    {"living-room", "furnished room with windows, sun and lamps", builtin::living_room},
    {"chess", "an endgame on a board: few, coarse pieces to refine", builtin::chess},
    {"walker", "mannequin that walks in place: a skinned mesh", builtin::walker},
    {"marbles", "marbles that roll and knock together in a tray: rigid motion", builtin::marbles},
    {"toys", "train, sailing boat and duck on a table: rigid motion and morphs", builtin::toys},
    {"forest", "glade with a pond, its leaves and grass in the wind", builtin::forest},
    {"scatter", "ball whose triangles fly apart, each on its own way, and meet again",
     builtin::scatter},
    {"stress:N", "room full of bumpy spheres, N triangles in all", nullptr, builtin::stress},
    {"cad:N", "machine of densely packed parts, large and small, N triangles in all", nullptr,
     builtin::cad},
    {"sculpture:N", "closed organic shape under a sun, rough down to its finest triangles, about N",
     nullptr, builtin::sculpture},
};

/// The family's name with its colon where `name` is of that family, else nothing.
std::string_view prefix_of(const Entry& entry, std::string_view name) {
    std::string_view prefix = entry.name;
    prefix.remove_suffix(1);
    return entry.make_sized && name.starts_with(prefix) ? prefix : std::string_view();
}

Result<Scene> make_sized(const Entry& entry, std::string_view name, std::string_view size) {
    int64_t count = 0;
    const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), count);
    if (error != std::errc() || end != size.data() + size.size() ||
        count < builtin::kMinTriangles || count > builtin::kMaxTriangles)
        return fail(Errc::bad_argument,
                    fmt::format("{}: N must be a number from {} to {}", name,
                                builtin::kMinTriangles, builtin::kMaxTriangles));
    return entry.make_sized(count);
}

}  // namespace

std::vector<BuiltinScene> builtin_scenes() {
    std::vector<BuiltinScene> scenes;
    for (const Entry& entry : kEntries) scenes.push_back({entry.name, entry.description});
    return scenes;
}

Result<Scene> builtin_scene(std::string_view name) {
    try {
        std::string known;
        for (const Entry& entry : kEntries) {
            if (entry.make && entry.name == name) return entry.make();
            if (const std::string_view prefix = prefix_of(entry, name); !prefix.empty())
                return make_sized(entry, name, name.substr(prefix.size()));
            known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
        }
        return fail(Errc::bad_argument,
                    fmt::format("no built-in scene \"{}\"; there are: {}", name, known));
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the scene does not fit into memory");
    }
}

}  // namespace aglow
