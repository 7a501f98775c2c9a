// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/rect_pack.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace aglow::mesh {
namespace {

struct Rect {
    int x, y, width, height;
    bool contains(const Rect& r) const {
        return r.x >= x && r.y >= y && r.x + r.width <= x + width && r.y + r.height <= y + height;
    }
    bool meets(const Rect& r) const {
        return r.x < x + width && r.x + r.width > x && r.y < y + height && r.y + r.height > y;
    }
};

/// A place for an item; the least score wins, compared in order.
struct Place {
    int64_t score = std::numeric_limits<int64_t>::max();
    int64_t tie = 0;
    int x = 0, y = 0, width = 0, height = 0;
    bool turned = false;
    bool better_than(const Place& other) const {
        return score != other.score ? score < other.score : tie < other.tie;
    }
    bool found() const { return width > 0; }
};

/// Calls visit(width, height, turned) for each way an item may lie.
template <class Visit>
void for_each_turn(const PackItem& item, Visit visit) {
    visit(item.width, item.height, false);
    if (item.turned_width > 0 &&
        (item.turned_width != item.width || item.turned_height != item.height))
        visit(item.turned_width, item.turned_height, true);
}

/// Keeps every maximal free rectangle. Tight, but quadratic.
class MaximalRectangles {
public:
    enum class Rule { lowest_top, short_side };

    MaximalRectangles(int width, int height, Rule rule)
        : free_{{0, 0, width, height}}, rule_(rule) {}

    Place find(const PackItem& item) const {
        Place best;
        for_each_turn(item, [&](int w, int h, bool turned) {
            for (const Rect& f : free_) {
                if (w > f.width || h > f.height) continue;
                Place place{0, 0, f.x, f.y, w, h, turned};
                const int rest_x = f.width - w, rest_y = f.height - h;
                if (rule_ == Rule::lowest_top) {
                    place.score = f.y + h;
                    place.tie = f.x;
                } else {
                    place.score = std::min(rest_x, rest_y);
                    place.tie = std::max(rest_x, rest_y);
                }
                if (place.better_than(best)) best = place;
            }
        });
        return best;
    }

    void take(const Place& place) {
        const Rect used{place.x, place.y, place.width, place.height};
        std::vector<Rect> cut;
        for (const Rect& f : free_) {
            if (!f.meets(used)) {
                cut.push_back(f);
                continue;
            }
            const int right = used.x + used.width, top = used.y + used.height;
            if (used.x > f.x) cut.push_back({f.x, f.y, used.x - f.x, f.height});
            if (right < f.x + f.width) cut.push_back({right, f.y, f.x + f.width - right, f.height});
            if (used.y > f.y) cut.push_back({f.x, f.y, f.width, used.y - f.y});
            if (top < f.y + f.height) cut.push_back({f.x, top, f.width, f.y + f.height - top});
        }
        free_ = without_contained(cut);
    }

private:
    static std::vector<Rect> without_contained(const std::vector<Rect>& rects) {
        std::vector<Rect> kept;
        for (size_t i = 0; i < rects.size(); ++i) {
            bool redundant = false;
            for (size_t j = 0; j < rects.size() && !redundant; ++j)
                redundant = i != j && rects[j].contains(rects[i]) &&
                            (!rects[i].contains(rects[j]) || j < i);
            if (!redundant) kept.push_back(rects[i]);
        }
        return kept;
    }

    std::vector<Rect> free_;
    Rule rule_;
};

/// Keeps the upper outline of what is packed. Fast for any number of items.
class Skyline {
public:
    Skyline(int width, int height) : outline_{{0, 0, width}}, width_(width), height_(height) {}

    Place find(const PackItem& item) const {
        Place best;
        for_each_turn(item, [&](int w, int h, bool turned) {
            for (size_t i = 0; i < outline_.size() && outline_[i].x + w <= width_; ++i) {
                int y = 0, remaining = w;
                int64_t waste = 0;
                for (size_t j = i; remaining > 0; ++j) {
                    const int run = std::min(remaining, outline_[j].width);
                    if (outline_[j].y > y) {
                        waste += int64_t{outline_[j].y - y} * (w - remaining);
                        y = outline_[j].y;
                    }
                    waste += int64_t{y - outline_[j].y} * run;
                    remaining -= run;
                    if (y + h > height_ || y + h > best.score) break;
                }
                if (remaining > 0 || y + h > height_) continue;
                Place place{y + h, waste, outline_[i].x, y, w, h, turned};
                if (place.better_than(best)) best = place;
            }
        });
        return best;
    }

    void take(const Place& place) {
        std::vector<Step> outline;
        const int left = place.x, right = place.x + place.width;
        bool added = false;
        const auto add = [&](Step step) {
            if (step.width <= 0) return;
            if (!outline.empty() && outline.back().y == step.y)
                outline.back().width += step.width;
            else
                outline.push_back(step);
        };
        for (const Step& s : outline_) {
            add({s.x, s.y, std::min(s.x + s.width, left) - s.x});
            if (!added && s.x + s.width > left) {
                add({left, place.y + place.height, place.width});
                added = true;
            }
            const int begin = std::max(s.x, right);
            add({begin, s.y, s.x + s.width - begin});
        }
        outline_ = std::move(outline);
    }

private:
    struct Step {
        int x, y, width;
    };
    std::vector<Step> outline_;
    int width_, height_;
};

template <class Packer>
Packing place_all(const std::vector<PackItem>& items, const std::vector<size_t>& order,
                  Packer packer) {
    Packing packing;
    packing.items.resize(items.size());
    for (size_t i : order) {
        const Place place = packer.find(items[i]);
        if (!place.found()) return {{}, -1};
        packer.take(place);
        packing.items[i] = {place.x, place.y, place.turned};
        packing.height = std::max(packing.height, place.y + place.height);
    }
    return packing;
}

/// Item numbers by falling key.
template <class Key>
std::vector<size_t> sorted_by(const std::vector<PackItem>& items, Key key) {
    std::vector<size_t> order(items.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return key(items[a]) > key(items[b]); });
    return order;
}

std::vector<std::vector<size_t>> orders(const std::vector<PackItem>& items) {
    return {sorted_by(items, [](const PackItem& i) { return std::max(i.width, i.height); }),
            sorted_by(items, [](const PackItem& i) { return i.height; }),
            sorted_by(items, [](const PackItem& i) { return int64_t{i.width} * i.height; }),
            sorted_by(items, [](const PackItem& i) { return i.width + i.height; })};
}

/// All items upright (tall) only, or lying only where `turn` is set and they may.
std::vector<PackItem> fixed(std::vector<PackItem> items, bool turn) {
    for (PackItem& i : items) {
        if (turn && i.turned_width > 0) {
            i.width = i.turned_width;
            i.height = i.turned_height;
        }
        i.turned_width = i.turned_height = 0;
    }
    return items;
}

}  // namespace

Packing pack(const std::vector<PackItem>& items, int width, int max_height, PackEffort effort) {
    Packing best{{}, -1};
    int64_t area = 0;
    for (const PackItem& i : items) area += int64_t{i.width} * i.height;
    if (items.empty()) return {{}, 0};
    if (area > int64_t{width} * max_height) return best;

    const auto keep = [&](Packing packing) {
        if (packing.height >= 0 && (best.height < 0 || packing.height < best.height))
            best = std::move(packing);
        // Nothing is lower than the area allows.
        return best.height >= 0 && int64_t{best.height} * width < area + width;
    };
    // Quadratic packing is for few items; beyond, the skyline is as tight.
    const bool few = items.size() <= (effort == PackEffort::thorough ? 200u : 60u);
    const auto all_orders = orders(items);
    const size_t order_count = few || effort == PackEffort::thorough ? all_orders.size() : 2;
    const std::vector<PackItem> upright = fixed(items, false), lying = fixed(items, true);
    for (size_t o = 0; o < order_count; ++o) {
        const auto& order = all_orders[o];
        if (keep(place_all(items, order, Skyline(width, max_height)))) return best;
        if (keep(place_all(upright, order, Skyline(width, max_height)))) return best;
        if (!few) continue;
        using Rule = MaximalRectangles::Rule;
        for (Rule rule : {Rule::lowest_top, Rule::short_side})
            if (keep(place_all(items, order, MaximalRectangles(width, max_height, rule))))
                return best;
        Packing turned = place_all(lying, order, Skyline(width, max_height));
        for (size_t i = 0; i < turned.items.size(); ++i)
            turned.items[i].turned = items[i].turned_width > 0;
        if (keep(std::move(turned))) return best;
    }
    return best;
}

}  // namespace aglow::mesh
