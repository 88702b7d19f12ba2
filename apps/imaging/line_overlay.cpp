#include "apps/imaging/line_overlay.h"

#include "apps/imaging/image_file.h"
#include "apps/imaging/view_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace patchlight {

namespace {

constexpr double half_width = 0.9;  // pixels

/// A piece of a line in the picture, in samples from the left and the top.
struct Stroke {
    Vec2 from, to;
};

/// Nothing when all of it is behind the camera.
std::optional<Stroke> stroke_of(const ViewRays& rays, int samples, const Vec3& a, const Vec3& b)
{
    const double da = rays.depth(a), db = rays.depth(b);
    const double near = 1e-4 * std::max(da, db);
    if (near <= 0) {
        return std::nullopt;
    }
    const auto clipped = [&](const Vec3& p, double dp, const Vec3& q, double dq) {
        return dp >= near ? p : p + (near - dp) / (dq - dp) * (q - p);
    };
    return Stroke{static_cast<double>(samples) * rays.project(clipped(a, da, b, db)),
                  static_cast<double>(samples) * rays.project(clipped(b, db, a, da))};
}

class LinePainter {
public:
    explicit LinePainter(const ViewHits& hits)
        : hits_(hits), across_(hits.width * hits.samples), rows_(hits.height * hits.samples),
          reach_(half_width * hits.samples), mask_(hits.surface.size(), 0)
    {}

    void paint(const Stroke& s, SurfaceId surface, std::uint8_t value)
    {
        const auto [low, high] = range(s.from.y, s.to.y, rows_);
        for (int row = low; row < high; ++row) {
            // The part of the stroke within reach of this row's centres.
            const double y = row + 0.5, dy = s.to.y - s.from.y;
            double t0 = 0, t1 = 1;
            if (std::abs(dy) > 1e-9) {
                t0 = std::clamp((y - reach_ - s.from.y) / dy, 0.0, 1.0);
                t1 = std::clamp((y + reach_ - s.from.y) / dy, 0.0, 1.0);
            }
            const double dx = s.to.x - s.from.x;
            const auto [left, right] = range(s.from.x + t0 * dx, s.from.x + t1 * dx, across_);
            for (int x = left; x < right; ++x) {
                const std::size_t i =
                    static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(x);
                if (hits_.surface[i] == surface.value && distance(s, {x + 0.5, y}) <= reach_ &&
                    (mask_[i] == 0 || value < mask_[i])) {
                    mask_[i] = value;
                }
            }
        }
    }

    std::vector<std::uint8_t> take() && { return std::move(mask_); }

private:
    /// The samples whose centres are within reach of [a, b], in a picture of n.
    std::pair<int, int> range(double a, double b, int n) const
    {
        const auto [low, high] = std::minmax(a, b);
        return {static_cast<int>(std::clamp(std::ceil(low - reach_ - 0.5), 0.0, static_cast<double>(n))),
                static_cast<int>(std::clamp(std::floor(high + reach_ + 0.5), 0.0, static_cast<double>(n)))};
    }

    static double distance(const Stroke& s, const Vec2& p)
    {
        const Vec2 way = s.to - s.from;
        const double square = glm::dot(way, way);
        const double t = square > 0 ? std::clamp(glm::dot(p - s.from, way) / square, 0.0, 1.0) : 0.0;
        return glm::distance(p, s.from + t * way);
    }

    const ViewHits& hits_;
    int across_, rows_;
    double reach_;
    std::vector<std::uint8_t> mask_;
};

}  // namespace

Rgb line_color(LineKind kind)
{
    constexpr std::array<std::array<int, 3>, line_kinds.size()> colors{
        {{213, 94, 0}, {86, 180, 233}, {0, 158, 115}, {240, 228, 66}, {204, 121, 167}}};
    const auto& c = colors[static_cast<std::size_t>(kind)];
    return Rgb(c[0], c[1], c[2]) / 255.0;
}

std::vector<std::uint8_t> line_samples(const PatchMesh& mesh, const ViewHits& hits)
{
    const ViewRays rays(hits.view, hits.width, hits.height);
    LinePainter painter(hits);
    for (const MeshLine& line : mesh.lines()) {
        if (line.beyond) {
            continue;
        }
        const VertexId a(line.left[0]), b(line.left[1]);
        if (const auto stroke = stroke_of(rays, hits.samples, mesh.position(a), mesh.position(b))) {
            painter.paint(*stroke, mesh.surface(a), static_cast<std::uint8_t>(1 + static_cast<int>(line.kind)));
        }
    }
    return std::move(painter).take();
}

void draw_line_legend(const PatchMesh& mesh, Image& srgb)
{
    std::vector<LineKind> kinds;
    for (const LineKind kind : line_kinds) {
        if (std::ranges::any_of(mesh.lines(), [&](const MeshLine& l) { return l.kind == kind && !l.beyond; })) {
            kinds.push_back(kind);
        }
    }
    const int size = std::clamp(srgb.height / 45, 9, 30);
    const int line = size * 3 / 2, count = static_cast<int>(kinds.size());
    const int top = srgb.height - size / 2 - count * line, right = std::min(srgb.width, 8 * size);
    if (kinds.empty() || top < size) {
        return;
    }
    for (int y = top - size / 2; y < srgb.height; ++y) {
        for (int x = 0; x < right; ++x) {
            srgb.set(x, y, 0.25 * srgb.at(x, y));
        }
    }
    for (int k = 0; k < count; ++k) {
        const Rgb color = line_color(kinds[static_cast<std::size_t>(k)]);
        const int middle = top + k * line + line / 2, half = std::max(1, size / 7);
        for (int y = middle - half; y <= middle + half; ++y) {
            for (int x = size / 2; x < std::min(right, 5 * size / 2); ++x) {
                srgb.set(x, y, color);
            }
        }
        draw_text(srgb, 3 * size, middle + size * 3 / 8, std::string(name_of(kinds[static_cast<std::size_t>(k)])), size,
                  Rgb(0.95));
    }
}

}  // namespace patchlight
