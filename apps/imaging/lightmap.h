#pragma once

#include "apps/imaging/image.h"
#include "apps/imaging/picture.h"

#include <vector>

namespace patchlight {

/// Texels around each chart that continue its edge: more than a bilinear look-up reaches.
inline constexpr int lightmap_gutter = 2;

struct LightmapOptions {
    int size = 1024;              ///< texels, each side of the atlas at most, 16 … largest_picture_side
    double texels_per_metre = 0;  ///< at least; 0: as many as fit
};

/// A surface's rectangle of the atlas, gutter included. The outermost texel centres within the gutter lie on the edges
/// of the surface's bounding rectangle in its plane.
struct LightmapChart {
    int x = 0, y = 0, width = 0, height = 0;
    Vec2 low{0.0};               ///< that rectangle's corner, plane coordinates, metres
    Vec2 texels_per_metre{0.0};  ///< along u and v
};

/// Where each surface lies in a picture: one chart a surface, none over another.
struct LightmapAtlas {
    int width = 0, height = 0;
    double texels_per_metre = 0;  ///< of every chart at least, along u and v
    std::vector<LightmapChart> charts;

    /// In texels from the left and the top: (0.5, 0.5) is the centre of the first texel.
    Vec2 texel_at(SurfaceId surface, const Vec2& q) const
    {
        const LightmapChart& chart = charts[surface.value];
        return Vec2(chart.x, chart.y) + (lightmap_gutter + 0.5) + (q - chart.low) * chart.texels_per_metre;
    }
    /// The plane's point that texel_at() gave.
    Vec2 plane_at(SurfaceId surface, const Vec2& texel) const
    {
        const LightmapChart& chart = charts[surface.value];
        return chart.low + (texel - Vec2(chart.x, chart.y) - (lightmap_gutter + 0.5)) / chart.texels_per_metre;
    }
    /// Texture coordinates as in glTF: (0, 0) is the picture's upper left corner.
    Vec2 texture_at(SurfaceId surface, const Vec2& q) const { return texel_at(surface, q) / Vec2(width, height); }
};

/// Packs the surfaces' rectangles. Throws std::invalid_argument when they don't fit, even with the fewest texels or
/// with those that are asked for.
LightmapAtlas lay_out_lightmap(const Scene& scene, const LightmapOptions& options);

enum class LightmapQuantity {
    radiosity,  ///< B, W/m²: what a surface sends out
    irradiance  ///< H = (B − E)/ρ, W/m²: what arrives, to be multiplied by the engine's own ρ; 0 in bands where ρ is 0
};

/// The atlas filled with the elements' reconstruction at the texels' centres; at centres beside the surface, with that
/// at its nearest point, so that a bilinear look-up anywhere on a surface mixes light of that surface alone. Texels
/// further away from a surface than the gutter's width have their chart's mean, those of no chart are 0. Light that
/// breaks off within a texel is smoothed over it.
Image lightmap_image(const ShownSolution& solution, const LightmapAtlas& atlas, LightmapQuantity quantity);

}  // namespace patchlight
