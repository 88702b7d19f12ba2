#include "apps/imaging/lightmap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace patchlight {

namespace {

/// Further from a surface, squared, its light says nothing: it covers a gutter's corners.
constexpr float reach2 = (lightmap_gutter + 1) * (lightmap_gutter + 1);

Vec2 nearest_on_segment(const Vec2& p, const Vec2& a, const Vec2& b)
{
    const double length2 = glm::dot(b - a, b - a);
    const double t = length2 > 0 ? std::clamp(glm::dot(p - a, b - a) / length2, 0.0, 1.0) : 0.0;
    return a + t * (b - a);
}

/// The nearest point of a counter-clockwise triangle.
Vec2 nearest_on_triangle(const Vec2& p, const std::array<Vec2, 3>& t)
{
    if (cross2(t[0], t[1], p) >= 0 && cross2(t[1], t[2], p) >= 0 && cross2(t[2], t[0], p) >= 0) return p;
    Vec2 nearest = nearest_on_segment(p, t[0], t[1]);
    for (std::size_t k = 1; k < 3; ++k) {
        const Vec2 other = nearest_on_segment(p, t[k], t[(k + 1) % 3]);
        if (glm::dot(other - p, other - p) < glm::dot(nearest - p, nearest - p)) nearest = other;
    }
    return nearest;
}

/// One surface's chart, patch by patch: each texel takes its light from the patch that comes nearest to its centre.
class ChartPainter {
public:
    ChartPainter(const ShownSolution& solution, const LightmapAtlas& atlas, SurfaceId surface,
                 LightmapQuantity quantity)
        : solution_(solution), atlas_(atlas), chart_(atlas.charts[surface.value]), surface_(surface),
          material_(solution.scene.material_of(surface)), quantity_(quantity),
          distance2_(static_cast<std::size_t>(chart_.width) * static_cast<std::size_t>(chart_.height), reach2)
    {}

    void paint(Image& image)
    {
        for (const PatchId patch : solution_.mesh.patches_of(surface_)) add(patch, image);
        fill_with_mean(image);
    }

private:
    float& distance2_at(int x, int y)
    {
        return distance2_[static_cast<std::size_t>(y - chart_.y) * static_cast<std::size_t>(chart_.width) +
                          static_cast<std::size_t>(x - chart_.x)];
    }

    void add(PatchId patch, Image& image)
    {
        const auto corners = solution_.mesh.corners(patch);
        std::array<Vec2, 3> t;
        for (std::size_t k = 0; k < 3; ++k) {
            t[k] = atlas_.texel_at(surface_, solution_.mesh.plane_position(corners[k]));
        }
        const Vec2 low = glm::min(glm::min(t[0], t[1]), t[2]) - double(lightmap_gutter);
        const Vec2 high = glm::max(glm::max(t[0], t[1]), t[2]) + double(lightmap_gutter);
        const int x0 = std::max(chart_.x, static_cast<int>(std::floor(low.x)));
        const int y0 = std::max(chart_.y, static_cast<int>(std::floor(low.y)));
        const int x1 = std::min(chart_.x + chart_.width, static_cast<int>(std::ceil(high.x)));
        const int y1 = std::min(chart_.y + chart_.height, static_cast<int>(std::ceil(high.y)));
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                const Vec2 center(x + 0.5, y + 0.5), nearest = nearest_on_triangle(center, t);
                const auto d2 = static_cast<float>(glm::dot(nearest - center, nearest - center));
                if (d2 < distance2_at(x, y)) {
                    distance2_at(x, y) = d2;
                    image.set(x, y, value(solution_.light().at(patch, atlas_.plane_at(surface_, nearest))));
                }
            }
        }
    }

    Rgb value(const Rgb& B) const
    {
        if (quantity_ == LightmapQuantity::radiosity) return B;
        Rgb H(0.0);
        for (int band = 0; band < 3; ++band) {
            const double rho = material_.reflectance[band];
            // Where hardly anything arrives, rounding may leave B below E.
            if (rho > 0) H[band] = std::max(0.0, B[band] - material_.emission[band]) / rho;
        }
        return H;
    }

    void fill_with_mean(Image& image)
    {
        Rgb sum(0.0);
        std::size_t painted = 0;
        for (int y = chart_.y; y < chart_.y + chart_.height; ++y) {
            for (int x = chart_.x; x < chart_.x + chart_.width; ++x) {
                if (distance2_at(x, y) == reach2) continue;
                sum += image.at(x, y);
                ++painted;
            }
        }
        if (painted == 0) return;
        for (int y = chart_.y; y < chart_.y + chart_.height; ++y) {
            for (int x = chart_.x; x < chart_.x + chart_.width; ++x) {
                if (distance2_at(x, y) == reach2) image.set(x, y, sum / static_cast<double>(painted));
            }
        }
    }

    const ShownSolution& solution_;
    const LightmapAtlas& atlas_;
    const LightmapChart& chart_;
    SurfaceId surface_;
    const Material& material_;
    LightmapQuantity quantity_;
    std::vector<float> distance2_;  ///< from a texel's centre to the patch it has its light from, texels²
};

}  // namespace

Image lightmap_image(const ShownSolution& solution, const LightmapAtlas& atlas, LightmapQuantity quantity)
{
    Image image(atlas.width, atlas.height);
    tbb::parallel_for(std::size_t{0}, atlas.charts.size(), [&](std::size_t s) {
        ChartPainter(solution, atlas, SurfaceId(static_cast<std::uint32_t>(s)), quantity).paint(image);
    });
    return image;
}

}  // namespace patchlight
