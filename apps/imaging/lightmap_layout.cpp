#include "apps/imaging/lightmap.h"

#include <fmt/format.h>

#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace patchlight {

namespace {

struct PlaneBox {
    Vec2 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

std::vector<PlaneBox> boxes_of(const Scene& scene)
{
    std::vector<PlaneBox> boxes(scene.surfaces.size());
    for (std::size_t s = 0; s < boxes.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        for (const auto& loop : surface.loops) {
            for (const std::uint32_t vertex : loop) {
                const Vec2 q = surface.frame.to_plane(scene.vertices[vertex]);
                boxes[s].low = glm::min(boxes[s].low, q);
                boxes[s].high = glm::max(boxes[s].high, q);
            }
        }
        const Vec2 extent = boxes[s].high - boxes[s].low;
        if (!(extent.x > 0 && extent.y > 0)) throw std::invalid_argument(fmt::format("surface {} has no extent", s));
    }
    return boxes;
}

/// Two texels at least, so that both edges have one; wider than any atlas where the extent asks for it.
int texels_along(double extent, double texels_per_metre)
{
    return 1 + static_cast<int>(std::clamp(std::ceil(extent * texels_per_metre), 1.0, 2.0 * largest_picture_side));
}

/// The charts in a square of `size` texels, if they fit. Source: Sean Barrett's stb_rect_pack, skyline bottom-left.
std::optional<LightmapAtlas> packed(const std::vector<PlaneBox>& boxes, double texels_per_metre, int size)
{
    LightmapAtlas atlas;
    atlas.texels_per_metre = texels_per_metre;
    std::vector<stbrp_rect> rectangles(boxes.size());
    double texels = 0;
    for (std::size_t s = 0; s < boxes.size(); ++s) {
        const Vec2 extent = boxes[s].high - boxes[s].low;
        const int w = texels_along(extent.x, texels_per_metre), h = texels_along(extent.y, texels_per_metre);
        rectangles[s] = {static_cast<int>(s), w + 2 * lightmap_gutter, h + 2 * lightmap_gutter, 0, 0, 0};
        atlas.charts.push_back({0, 0, rectangles[s].w, rectangles[s].h, boxes[s].low, Vec2(w - 1, h - 1) / extent});
        texels += static_cast<double>(rectangles[s].w) * rectangles[s].h;
    }
    if (texels > static_cast<double>(size) * size) return std::nullopt;
    stbrp_context context;
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(size));
    stbrp_init_target(&context, size, size, nodes.data(), size);
    if (!stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size()))) return std::nullopt;
    for (std::size_t s = 0; s < boxes.size(); ++s) {
        atlas.charts[s].x = rectangles[s].x;
        atlas.charts[s].y = rectangles[s].y;
        atlas.width = std::max(atlas.width, rectangles[s].x + rectangles[s].w);
        atlas.height = std::max(atlas.height, rectangles[s].y + rectangles[s].h);
    }
    return atlas;
}

/// The finest that fits, to a hundredth.
LightmapAtlas finest(const std::vector<PlaneBox>& boxes, int size)
{
    double longest = 0;
    for (const PlaneBox& box : boxes) longest = std::max({longest, box.high.x - box.low.x, box.high.y - box.low.y});
    double low = 0, high = size / longest;
    std::optional<LightmapAtlas> best = packed(boxes, low, size);
    if (!best) {
        throw std::invalid_argument(fmt::format("{} surfaces don't fit into {} x {} texels, even with the fewest each",
                                                boxes.size(), size, size));
    }
    while (high - low > 0.01 * high) {
        const double middle = 0.5 * (low + high);
        if (auto atlas = packed(boxes, middle, size)) {
            best = std::move(atlas);
            low = middle;
        } else {
            high = middle;
        }
    }
    return std::move(*best);
}

}  // namespace

LightmapAtlas lay_out_lightmap(const Scene& scene, const LightmapOptions& options)
{
    const std::vector<PlaneBox> boxes = boxes_of(scene);
    if (options.texels_per_metre <= 0) return finest(boxes, options.size);
    for (int size = 16;; size = std::min(options.size, size + size / 8)) {
        if (auto atlas = packed(boxes, options.texels_per_metre, size)) return std::move(*atlas);
        if (size >= options.size) break;
    }
    throw std::invalid_argument(fmt::format("{} texels per metre don't fit into {} x {} texels",
                                            options.texels_per_metre, options.size, options.size));
}

}  // namespace patchlight
