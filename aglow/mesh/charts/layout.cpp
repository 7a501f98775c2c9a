// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/layout.h"

#include <algorithm>
#include <cmath>

namespace aglow::mesh {
namespace {

/// Longer boxes than this fit no atlas; the bound keeps sizes within int.
constexpr double kHugeBox = 1e5;

/// A length as a whole number of texels, and the length it is given there.
struct Fitted {
    int cells = 0;
    double length = 0;
};

/// Rounds a length so that the chart fills its texels where that changes it by less than 2 %: then
/// texels along straight borders are whole. A length below one texel is given one, so that
/// no chart vanishes.
Fitted fit_length(double meters, double texel) {
    const double wanted = std::min(meters / texel, kHugeBox);
    const double whole = std::max(1.0, std::round(wanted + 2 * kInset));
    const double filled = whole - 2 * kInset;
    if (wanted <= filled || std::abs(filled - wanted) <= 0.02 * wanted) {
        if (wanted >= 0.98 * filled || whole == 1) return {static_cast<int>(whole), filled};
        return {static_cast<int>(whole), wanted};
    }
    return {static_cast<int>(std::ceil(wanted + 2 * kInset)), wanted};
}

struct FittedBox {
    Fitted x, y;
};

FittedBox fit_box_to(Point2 box, Point2 texel, bool turned) {
    if (turned) std::swap(box.x, box.y);
    return {fit_length(box.x, texel.x), fit_length(box.y, texel.y)};
}

PackItem item_of(Point2 box, Point2 texel, int gutter, bool may_turn) {
    const FittedBox upright = fit_box_to(box, texel, false);
    PackItem item{upright.x.cells + gutter, upright.y.cells + gutter};
    if (may_turn) {
        const FittedBox turned = fit_box_to(box, texel, true);
        item.turned_width = turned.x.cells + gutter;
        item.turned_height = turned.y.cells + gutter;
    }
    return item;
}

PlacedBox placed_box(Point2 box, Point2 texel, const PackedItem& at, int margin) {
    const FittedBox fitted = fit_box_to(box, texel, at.turned);
    return {{at.x + margin + kInset, at.y + margin + kInset},
            {fitted.x.length, fitted.y.length},
            at.turned};
}

std::vector<PackItem> items_of(const std::vector<Point2>& boxes, Point2 texel, int gutter,
                               bool may_turn) {
    std::vector<PackItem> items;
    items.reserve(boxes.size());
    for (const Point2& box : boxes) items.push_back(item_of(box, texel, gutter, may_turn));
    return items;
}

/// Packs one mesh's charts into the block of least area, tried at several widths.
GroupLayout lay_out_block(const LayoutGroup& group, Point2 texel, int gutter) {
    const std::vector<PackItem> items = items_of(group.boxes, texel, gutter, group.may_turn);
    double area = 0;
    int widest = 1;
    for (const PackItem& i : items) {
        area += double(i.width) * i.height;
        widest = std::max(widest, i.turned_width > 0 ? std::min(i.width, i.turned_width) : i.width);
    }
    GroupLayout best;
    best.is_block = true;
    double least = 0;
    for (const double factor : {0.6, 0.8, 1.0, 1.1, 1.25, 1.5, 2.0}) {
        const int width = std::max(widest, static_cast<int>(std::ceil(factor * std::sqrt(area))));
        const Packing packing = pack(items, width, 1 << 24, PackEffort::quick);
        if (packing.height < 0) continue;
        GroupLayout tried;
        tried.is_block = true;
        int right = 1;
        for (size_t i = 0; i < items.size(); ++i) {
            const PackedItem& at = packing.items[i];
            right = std::max(right, at.x + (at.turned ? items[i].turned_width : items[i].width));
            tried.charts.push_back(placed_box(group.boxes[i], texel, at, 0));
        }
        tried.block = {double(std::max(1, right - gutter)),
                       double(std::max(1, packing.height - gutter))};
        // Of equal areas the squarer block packs better.
        const double cost =
            right * double(packing.height) +
            0.05 * (right * double(right) + double(packing.height) * packing.height);
        if (best.charts.empty() || cost < least) {
            best = std::move(tried);
            least = cost;
        }
    }
    return best;
}

bool same_scale(const std::vector<double>& scales) {
    const auto [low, high] = std::minmax_element(scales.begin(), scales.end());
    return *high <= *low * (1 + 1e-4);
}

/// The scale a block is laid out for: that of the smallest placement, so that gutters hold in all.
double block_scale(const std::vector<double>& scales) {
    double least = 0;
    for (double s : scales)
        if (s > 0 && (least == 0 || s < least)) least = s;
    return least > 0 ? least : 1;
}

/// Size of placement p of a block, in texels.
Point2 shown_size(const GroupLayout& layout, const LayoutGroup& group, size_t p) {
    const double scale = block_scale(group.scales);
    const double ratio = same_scale(group.scales) ? 1 : std::max(1.0, group.scales[p] / scale);
    return layout.block * std::min(ratio, kHugeBox);
}

bool is_free(const LayoutGroup& group) { return group.scales.size() == 1; }

int cells(double length) { return static_cast<int>(std::ceil(std::min(length, kHugeBox) - 1e-9)); }

/// Texel size in the units of a group's boxes.
Point2 local_texel(const LayoutGroup& group, Point2 texel) {
    return texel * (1 / block_scale(group.scales));
}

/// Lays out the group's block, where it has one, and lists what it packs into the atlas.
GroupLayout list_items(const LayoutGroup& group, Point2 texel, int gutter,
                       std::vector<PackItem>& items) {
    GroupLayout result;
    if (is_free(group)) {
        const auto own = items_of(group.boxes, local_texel(group, texel), gutter, group.may_turn);
        items.insert(items.end(), own.begin(), own.end());
    } else if (!group.boxes.empty()) {
        // Blocks shown larger lose their grip on the texel grid: one texel more keeps the gutter.
        const int between = gutter + (same_scale(group.scales) ? 0 : 1);
        result = lay_out_block(group, local_texel(group, texel), between);
        for (size_t p = 0; p < group.scales.size(); ++p) {
            const Point2 size = shown_size(result, group, p);
            items.push_back({cells(size.x) + gutter, cells(size.y) + gutter});
        }
    }
    return result;
}

/// Takes the group's places from the packing, starting at item `next`; moves `next` on.
void take_places(const LayoutGroup& group, Point2 texel, int gutter, const Packing& packing,
                 size_t& next, GroupLayout& result) {
    if (is_free(group)) {
        for (const Point2& box : group.boxes)
            result.charts.push_back(
                placed_box(box, local_texel(group, texel), packing.items[next++], gutter));
    } else if (!group.boxes.empty()) {
        for (size_t p = 0; p < group.scales.size(); ++p) {
            const PackedItem& at = packing.items[next++];
            result.placements.push_back(
                {{double(at.x + gutter), double(at.y + gutter)}, shown_size(result, group, p)});
        }
    }
}

}  // namespace

std::optional<Layout> lay_out(const std::vector<LayoutGroup>& groups, Point2 texel,
                              const LayoutBounds& bounds, PackEffort effort) {
    Layout layout;
    layout.texel = texel;
    std::vector<PackItem> items;
    for (const LayoutGroup& group : groups)
        layout.groups.push_back(list_items(group, texel, bounds.gutter, items));
    const Packing packing =
        pack(items, bounds.width - bounds.gutter, bounds.max_height - bounds.gutter, effort);
    if (packing.height < 0) return std::nullopt;
    layout.width = bounds.width;
    layout.height = std::max(1, packing.height + bounds.gutter);
    size_t next = 0;
    for (size_t g = 0; g < groups.size(); ++g)
        take_places(groups[g], texel, bounds.gutter, packing, next, layout.groups[g]);
    return layout;
}

}  // namespace aglow::mesh
