#pragma once

#include "formfactor/ray_caster.h"
#include "meshing/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// What is projected: corners counter-clockwise seen from the front. The back is black and blocks as well.
struct HemicubeTriangle {
    std::array<Vec3, 3> corners{};
    std::uint32_t item = 0;  ///< may be shared; at most Hemicube::max_item, memory grows with the highest
};

/// F_item = Σ ΔF_q over the pixels q where an item is seen, items in order of their first pixel.
struct HemicubeSums {
    std::vector<std::uint32_t> items;
    std::vector<double> factors;
    double escaped = 0;  ///< Σ ΔF_q of the pixels that see nothing
    double backs = 0;    ///< Σ ΔF_q of the pixels that see a black back

    double total() const;
};

/// The lecture's hemicube: five faces of a half cube of edge 2 about a point, `resolution`² pixels on the top and
/// resolution × resolution/2 on each side, an item and a depth per pixel [CohenGreenberg85]. A pixel sees what its
/// centre sees. One object a thread: buffers are kept from call to call.
/// An outline that runs along the pixels' rows errs all along by up to half a pixel, 1 % of a factor of 0.2 at 128;
/// others err at random, 0.03 % there in the median: hence a random turn for each patch.
/// Pixels are numbered in rows of `resolution`: the top (rows along v), then the sides +u, −u, +v, −v (rows from the
/// horizon upwards).
class Hemicube {
public:
    static constexpr std::uint32_t escaped = HitBatch::escaped;
    static constexpr std::uint32_t black_back = HitBatch::black_back;
    static constexpr std::uint32_t max_item = 0x7ffffffdU;

    /// Throws std::invalid_argument unless the resolution is even, 4 … 4096.
    explicit Hemicube(int resolution);

    /// Projects the triangles on all faces seen from frame.origin, frame.n upwards, u and v turned by `turn`
    /// radians about n. The nearest item wins; at one depth (to 2⁻²², single precision's) the one that faces the
    /// origin, then the lower item: the result does not depend on the triangles' order. Triangles whose plane
    /// contains the origin are not seen, nor is what lies nearer than about 1e-9 of the distance of the farthest
    /// corner. Throws std::invalid_argument for items above max_item and corners that are not finite.
    void render(std::span<const HemicubeTriangle> triangles, const PlaneFrame& frame, double turn = 0);

    /// The factors of what was rendered last.
    void sum(HemicubeSums& sums);

    int resolution() const { return static_cast<int>(resolution_); }
    std::size_t pixels() const { return 3 * resolution_ * resolution_; }
    /// The item seen in a pixel, or `escaped` or `black_back`.
    std::uint32_t item(std::size_t pixel) const;
    /// ΔF of a pixel: ΔA/(π(x² + y² + 1)²) on the top, zΔA/(π(y² + z² + 1)²) on a side.
    double factor(std::size_t pixel) const;
    /// From the origin to the pixel's centre on the half cube, as it stood at the last render.
    Vec3 direction(std::size_t pixel) const;

private:
    /// In the coordinates of a face: a along its rows, b across them, w away from the origin.
    struct Corner {
        double a, b, w;
    };
    struct Polygon {
        std::array<Corner, 9> corners;  ///< a triangle cut by five planes has eight at most
        std::size_t count = 0;
    };
    struct Face;
    /// A plane: 1/w = a·sx + b·sy + w at the point (sx, sy) = (a/w, b/w) of a face.
    struct Depth {
        double a, b, w;
    };
    /// Rows [first, last) of a face, and the bounds of 1/w.
    struct Outline {
        std::size_t first = 0, last = 0;
        double least = 0, most = 0;
    };

    static const std::array<Face, 5>& faces();
    const Face& face_of(std::size_t pixel) const;
    Vec2 centre(std::size_t pixel, const Face& face) const;
    static bool clip(const Face& face, double near, Polygon& polygon);
    static void cut(const Corner& plane, double offset, Polygon& polygon);
    double checked_extent(std::span<const HemicubeTriangle> triangles, const Vec3& origin);
    void project(const std::array<Vec3, 3>& corners, std::uint32_t item, double near);
    Outline trace(const Face& face, const Polygon& polygon);
    void rasterise(const Face& face, const Polygon& polygon, const Depth& depth, std::uint32_t key);
    void add_run(std::uint32_t key, double factor, HemicubeSums& sums);
    void trace_edge(const Vec2& p, const Vec2& q, std::size_t rows);

    std::size_t resolution_;
    std::vector<std::uint32_t> keys_;   ///< per pixel: the item, with the top bit set if its back is seen
    std::vector<float> depths_;         ///< per pixel: 1/w, 0 = nothing
    std::vector<double> row_factors_;   ///< Σ ΔF of the pixels before each in its row, of the top and of one side
    std::vector<double> left_, right_;  ///< per row of a face: where the polygon starts and ends, in pixels
    std::vector<double> weights_;       ///< per item, 0 between sums
    std::size_t items_ = 0;             ///< above all items rendered
    Vec3 u_{1, 0, 0}, v_{0, 1, 0}, n_{0, 0, 1};
};

}  // namespace patchlight
