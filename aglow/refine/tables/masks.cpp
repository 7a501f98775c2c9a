// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/masks.h"

#include "aglow/refine/tables/split.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aglow::refine {
namespace {

constexpr double kPiD = std::numbers::pi;

/// Weight of each neighbour of a smooth vertex with n of them. The factored form's average and
/// correction in one: 3/(8n) cf(n) with cf(n) = 5/3 - 8/3 (3/8 + cos(2 pi/n)/4)^2.
double loop_neighbour(double n) {
    const double beta = 0.375 + 0.25 * std::cos(2 * kPiD / n);
    return (0.625 - beta * beta) / n;
}

std::pair<size_t, size_t> ends(const std::vector<float>& sharpness) {
    size_t first = 0, last = sharpness.size() - 1;
    while (sharpness[first] <= 0) ++first;
    while (sharpness[last] <= 0) --last;
    return {first, last};
}

}  // namespace

void Masks::walk(uint32_t start) {
    spokes_.clear();
    uint32_t h = start;
    do {
        const bool open = mesh_.twin[h] == kNone;
        spokes_.push_back({h, mesh_.end(h), open ? kSharp : mesh_.edge_sharpness[mesh_.edge[h]]});
        const uint32_t previous = mesh_.previous(h);
        h = mesh_.twin[previous];
        if (h == kNone) spokes_.push_back({previous, mesh_.vertex[previous], kSharp});
    } while (h != kNone && h != start);
    sharp_.clear();
    for (const Spoke& spoke : spokes_) sharp_.push_back(spoke.sharpness);
}

Masks::Rule Masks::rule(float vertex_sharpness, const std::vector<float>& sharpness) const {
    if (vertex_sharpness > 0) return Rule::corner;
    const auto count = std::ranges::count_if(sharpness, [](float s) { return s > 0; });
    return count < 2 ? Rule::smooth : count == 2 ? Rule::crease : Rule::corner;
}

void Masks::add_face(uint32_t f, double weight, Terms& terms) const {
    const uint32_t size = mesh_.face_size(f);
    for (uint32_t h = mesh_.face_begin[f]; h < mesh_.face_begin[f + 1]; ++h)
        terms.push_back({mesh_.vertex[h], weight / size});
}

void Masks::add_smooth(uint32_t v, double scale, Terms& terms) const {
    const auto n = static_cast<double>(spokes_.size());
    if (scheme_ == Scheme::loop) {
        const double each = loop_neighbour(n);
        terms.push_back({v, scale * (1 - n * each)});
        for (const Spoke& spoke : spokes_) terms.push_back({spoke.end, scale * each});
        return;
    }
    terms.push_back({v, scale * (n - 2) / n});
    for (const Spoke& spoke : spokes_) {
        terms.push_back({spoke.end, scale / (n * n)});
        add_face(mesh_.face[spoke.half], scale / (n * n), terms);
    }
}

void Masks::add_rule(Rule rule, const std::vector<float>& sharpness, uint32_t v, double scale,
                     Terms& terms) const {
    if (rule == Rule::smooth) return add_smooth(v, scale, terms);
    if (rule == Rule::corner) return terms.push_back({v, scale});
    const auto [first, last] = ends(sharpness);
    terms.push_back({v, scale * 0.75});
    terms.push_back({spokes_[first].end, scale * 0.125});
    terms.push_back({spokes_[last].end, scale * 0.125});
}

/// How much the rule before counts where that one level on differs: the mean of what is lost.
double Masks::blend(float vertex_sharpness) const {
    double sum = 0, count = 0;
    const auto lose = [&](float before) {
        if (before <= 0 || child_sharpness(before) > 0) return;
        sum += before;
        ++count;
    };
    lose(vertex_sharpness);
    for (const float s : sharp_) lose(s);
    return count > 0 ? std::min(sum / count, 1.0) : 0;
}

void Masks::vertex(uint32_t v, Terms& terms) {
    terms.clear();
    if (mesh_.vertex_half[v] == kNone) return terms.push_back({v, 1});
    walk(mesh_.vertex_half[v]);
    const float sharpness = mesh_.vertex_sharpness[v];
    const Rule before = rule(sharpness, sharp_);
    if (before == Rule::smooth) return add_smooth(v, 1, terms);
    sharp_next_.clear();
    for (const float s : sharp_) sharp_next_.push_back(child_sharpness(s));
    const Rule after = rule(child_sharpness(sharpness), sharp_next_);
    if (before == after) return add_rule(before, sharp_, v, 1, terms);
    const double weight = blend(sharpness);
    add_rule(before, sharp_, v, weight, terms);
    add_rule(after, sharp_next_, v, 1 - weight, terms);
}

void Masks::edge(uint32_t e, Terms& terms) {
    terms.clear();
    const uint32_t h = mesh_.edge_half[e], twin = mesh_.twin[h];
    const double sharp = twin == kNone ? 1.0 : std::min(double{mesh_.edge_sharpness[e]}, 1.0);
    const bool loop = scheme_ == Scheme::loop;
    const double end = 0.5 * sharp + (1 - sharp) * (loop ? 0.375 : 0.25);
    terms.push_back({mesh_.vertex[h], end});
    terms.push_back({mesh_.end(h), end});
    if (sharp >= 1) return;
    for (const uint32_t side : {h, twin}) {
        if (loop)
            terms.push_back({mesh_.vertex[mesh_.previous(side)], (1 - sharp) * 0.125});
        else
            add_face(mesh_.face[side], (1 - sharp) * 0.25, terms);
    }
}

void Masks::face(uint32_t f, Terms& terms) {
    terms.clear();
    add_face(f, 1, terms);
}

uint32_t Masks::opposite(const Spoke& spoke) const { return mesh_.end(mesh_.next(spoke.half)); }

void Masks::limit(uint32_t v, uint32_t start, Terms& position, Terms& u, Terms& w) {
    for (Terms* terms : {&position, &u, &w}) terms->clear();
    walk(mesh_.on_boundary(v) ? mesh_.vertex_half[v] : start);
    const Rule here = rule(mesh_.vertex_sharpness[v], sharp_);
    const bool folded = scheme_ == Scheme::catmull_clark && spokes_.size() == 2;
    if (here == Rule::smooth && !folded) return smooth_limit(v, position, u, w);
    if (here == Rule::crease) return crease_limit(v, position, u, w);
    position.push_back({v, 1});
    for (const auto& [terms, spoke] : {std::pair(&u, spokes_[0]), std::pair(&w, spokes_[1])}) {
        terms->push_back({v, -1});
        terms->push_back({spoke.end, 1});
    }
}

void Masks::smooth_limit(uint32_t v, Terms& position, Terms& u, Terms& w) const {
    const auto n = static_cast<double>(spokes_.size());
    const double theta = 2 * kPiD / n;
    const bool loop = scheme_ == Scheme::loop;
    const double each = loop ? 1 / (n + 3 / (8 * loop_neighbour(n))) : 4 / (n * (n + 5));
    const double across = loop ? 0 : each / 4;
    const double root = std::cos(theta / 2) * std::sqrt(2 * (9 + std::cos(theta)));
    const double lambda = (5 + std::cos(theta) + root) / 16;
    const double diagonal = loop ? 0 : 1 / (16 * lambda - 4);
    position.push_back({v, 1 - n * (each + across)});
    for (size_t i = 0; i < spokes_.size(); ++i) {
        const double a = theta * static_cast<double>(i), b = a + theta;
        const uint32_t end = spokes_[i].end;
        position.push_back({end, each});
        u.push_back({end, std::cos(a)});
        w.push_back({end, std::sin(a)});
        if (loop) continue;
        const uint32_t corner = opposite(spokes_[i]);
        position.push_back({corner, across});
        u.push_back({corner, diagonal * (std::cos(a) + std::cos(b))});
        w.push_back({corner, diagonal * (std::sin(a) + std::sin(b))});
    }
}

void Masks::crease_limit(uint32_t v, Terms& position, Terms& u, Terms& w) const {
    const auto [first, last] = ends(sharp_);
    position.push_back({v, 2.0 / 3});
    position.push_back({spokes_[first].end, 1.0 / 6});
    position.push_back({spokes_[last].end, 1.0 / 6});
    u.push_back({spokes_[first].end, 1});
    u.push_back({spokes_[last].end, -1});
    if (scheme_ == Scheme::loop)
        loop_cross(v, first, last, w);
    else
        catmull_clark_cross(v, first, last, w);
}

/// Across a crease, into the part between its two spokes.
void Masks::loop_cross(uint32_t v, size_t first, size_t last, Terms& w) const {
    const size_t inner = last - first - 1;
    if (inner == 0) {
        w = {{v, -2}, {spokes_[first].end, 1}, {spokes_[last].end, 1}};
        return;
    }
    if (inner == 1) {
        w = {{v, -1}, {spokes_[first + 1].end, 1}};
        return;
    }
    if (inner == 2) {
        w = {{v, -2}, {spokes_[first].end, -1}, {spokes_[last].end, -1}};
        w.push_back({spokes_[first + 1].end, 2});
        w.push_back({spokes_[first + 2].end, 2});
        return;
    }
    const double theta = kPiD / static_cast<double>(inner + 1);
    w = {{spokes_[first].end, -std::sin(theta)}, {spokes_[last].end, -std::sin(theta)}};
    for (size_t i = 1; i <= inner; ++i)
        w.push_back({spokes_[first + i].end,
                     2 * (1 - std::cos(theta)) * std::sin(static_cast<double>(i) * theta)});
}

void Masks::catmull_clark_cross(uint32_t v, size_t first, size_t last, Terms& w) const {
    const size_t faces = last - first;
    if (faces == 1) {
        w = {{v, -2}, {spokes_[first].end, 1}, {spokes_[last].end, 1}};
        return;
    }
    const double theta = kPiD / static_cast<double>(faces);
    const double c = std::cos(theta), r = (c + 1) / std::sin(theta);
    w = {{v, 4 * r * (c - 1)}};
    for (const size_t i : {first, last}) w.push_back({spokes_[i].end, -r * (1 + 2 * c)});
    for (size_t i = 0; i < faces; ++i) {
        const double a = std::sin(static_cast<double>(i) * theta);
        const double b = std::sin(static_cast<double>(i + 1) * theta);
        if (i > 0) w.push_back({spokes_[first + i].end, 4 * a});
        w.push_back({opposite(spokes_[first + i]), a + b});
    }
}

}  // namespace aglow::refine
