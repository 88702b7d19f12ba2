#include "apps/imaging/picture.h"

#include "apps/imaging/exposure.h"
#include "apps/imaging/line_overlay.h"
#include "apps/imaging/seen_point.h"
#include "apps/imaging/view_rays.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace patchlight {

namespace {

struct Sample {
    Rgb radiance{0.0};
    std::uint32_t patch = Id<PatchTag>::invalid_value;
};

Sample shade(const ShownSolution& solution, const ViewRays& rays, const Vec3& direction, std::uint32_t surface,
             Shade how)
{
    const auto seen = seen_point(solution, rays, direction, surface);
    if (!seen) {
        return {};
    }
    const Rgb B = how == Shade::flat ? solution.B[seen->patch] : solution.light().at(seen->patch, seen->in_plane);
    return {B / std::numbers::pi, seen->patch.value};
}

/// What is drawn as white.
double full_ink(double white)
{
    return std::isfinite(white) ? white : 1.0;
}

/// A line that can be told from what it crosses, on bright ground and on dark.
Rgb inked(const Rgb& ground, double white)
{
    const double full = full_ink(white);
    return luminance(ground) > 0.04 * full ? ground * 0.18 : ground + Rgb(0.09 * full);
}

class RowShader {
public:
    RowShader(const ShownSolution& solution, const ViewHits& hits, const PictureOptions& options)
        : solution_(solution), hits_(hits), options_(options), rays_(hits.view, hits.width, hits.height)
    {
        if (options.patch_borders) {
            lines_ = line_samples(solution.mesh, hits);
            for (const LineKind kind : line_kinds) {
                const Rgb c = line_color(kind);
                inks_.push_back(full_ink(options.white) * Rgb(srgb_decoded(c.r), srgb_decoded(c.g), srgb_decoded(c.b)));
            }
        }
    }

    /// The samples of one row of the sample grid; past the last row: that one again.
    void samples_of(int row, std::vector<Sample>& out) const
    {
        const int across = hits_.width * hits_.samples;
        row = std::min(row, hits_.height * hits_.samples - 1);
        out.resize(static_cast<std::size_t>(across));
        const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(across);
        for (int x = 0; x < across; ++x) {
            const Vec3 d = rays_.direction((x + 0.5) / hits_.samples, (row + 0.5) / hits_.samples);
            out[x] = shade(solution_, rays_, d, hits_.surface[first + x], options_.shade);
        }
    }

    /// `row` and the one below it, which are rows `number` and `number` + 1 of the sample grid.
    void add(const std::vector<Sample>& row, const std::vector<Sample>& below, int number, Image& image) const
    {
        const double share = 1.0 / (hits_.samples * hits_.samples);
        const std::size_t first = static_cast<std::size_t>(number) * row.size();
        for (int x = 0; x < static_cast<int>(row.size()); ++x) {
            Rgb radiance = glm::min(row[x].radiance, Rgb(options_.white));
            if (options_.patch_borders && borders(row, below, x)) {
                radiance = inked(radiance, options_.white);
            }
            if (!lines_.empty() && lines_[first + x] > 0) {
                radiance = inks_[lines_[first + x] - 1U];
            }
            float* pixel = image.pixel(x / hits_.samples, number / hits_.samples);
            for (int band = 0; band < 3; ++band) {
                pixel[band] += static_cast<float>(share * radiance[band]);
            }
        }
    }

private:
    static bool borders(const std::vector<Sample>& row, const std::vector<Sample>& below, int x)
    {
        const bool last = x + 1 == static_cast<int>(row.size());
        return row[x].patch != below[x].patch || (!last && row[x].patch != row[x + 1].patch);
    }

    const ShownSolution& solution_;
    const ViewHits& hits_;
    const PictureOptions& options_;
    ViewRays rays_;
    std::vector<std::uint8_t> lines_;  ///< see line_samples(); empty: none are drawn
    std::vector<Rgb> inks_;            ///< by LineKind
};

void check_size(int width, int height, int samples)
{
    if (width < 1 || height < 1 || width > largest_picture_side || height > largest_picture_side || samples < 1 ||
        samples > 8) {
        throw std::invalid_argument("a picture's sides are 1 … 8192 pixels, its samples 1 … 8");
    }
}

}  // namespace

ViewHits trace_view(const RayCaster& caster, const View& view, int width, int height, int samples)
{
    check_size(width, height, samples);
    const int across = width * samples, rows = height * samples;
    ViewHits result{view, width, height, samples, {}};
    result.surface.resize(static_cast<std::size_t>(across) * static_cast<std::size_t>(rows));
    const ViewRays rays(view, width, height);
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, 8), [&](const tbb::blocked_range<int>& range) {
        RayBatch batch;
        HitBatch hits;
        batch.resize(static_cast<std::size_t>(across));
        for (int row = range.begin(); row < range.end(); ++row) {
            for (int x = 0; x < across; ++x) {
                const Vec3 d = rays.direction((x + 0.5) / samples, (row + 0.5) / samples);
                batch.set(static_cast<std::size_t>(x), rays.from(), d, std::numeric_limits<float>::infinity());
            }
            caster.closest(batch, hits);
            const auto first = static_cast<std::ptrdiff_t>(row) * across;
            std::copy_n(hits.surface.begin(), across, result.surface.begin() + first);
        }
    });
    return result;
}

Image shade_view(const ShownSolution& solution, const ViewHits& hits, const PictureOptions& options)
{
    Image image(hits.width, hits.height);
    const RowShader shader(solution, hits, options);
    tbb::parallel_for(tbb::blocked_range<int>(0, hits.height, 4), [&](const tbb::blocked_range<int>& range) {
        std::vector<Sample> row, below;
        for (int y = range.begin(); y < range.end(); ++y) {
            shader.samples_of(y * hits.samples, row);
            for (int s = 0; s < hits.samples; ++s) {
                if (options.patch_borders || s + 1 < hits.samples) {
                    shader.samples_of(y * hits.samples + s + 1, below);
                }
                shader.add(row, below, y * hits.samples + s, image);
                std::swap(row, below);
            }
        }
    });
    return image;
}

Image render_picture(const ShownSolution& solution, const RayCaster& caster, const View& view,
                     const PictureOptions& options)
{
    return shade_view(solution, trace_view(caster, view, options.width, options.height, options.samples), options);
}

}  // namespace patchlight
