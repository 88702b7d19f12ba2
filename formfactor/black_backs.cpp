#include "formfactor/black_backs.h"

#include "formfactor/facet_points.h"
#include "formfactor/random_numbers.h"
#include "meshing/positive_part.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {

namespace {

constexpr std::size_t few_rays = 64, many_rays = 1024;
constexpr std::uint64_t stream = 0xbacULL << 48;  // other random numbers than the rows'

struct Scratch {
    std::size_t traced = 0;
    RayBatch rays;
    HitBatch hits;
};

/// The patch cut along every contact that crosses it.
std::vector<Polygon> cut_along_contacts(const std::array<Vec3, 3>& patch, const Vec3& n, const Blockers& blockers)
{
    std::vector<Polygon> pieces(1);
    pieces[0].assign(patch.begin(), patch.end());
    const double offset = glm::dot(n, patch[0]), snap = blockers.snap();
    Vec3 low = glm::min(glm::min(patch[0], patch[1]), patch[2]) - snap;
    Vec3 high = glm::max(glm::max(patch[0], patch[1]), patch[2]) + snap;
    for (const Blocker& blocker : blockers.all()) {
        Vec3 p = blocker.corners.back();
        for (const Vec3& q : blocker.corners) {
            const bool in_plane =
                std::abs(glm::dot(n, p) - offset) <= snap && std::abs(glm::dot(n, q) - offset) <= snap;
            const bool near = glm::all(glm::lessThanEqual(glm::min(p, q), high)) &&
                              glm::all(glm::greaterThanEqual(glm::max(p, q), low));
            if (in_plane && near && std::abs(glm::dot(blocker.normal, n)) < 1 - 1e-9) {
                const Vec3 across = glm::normalize(glm::cross(n, q - p));
                std::vector<Polygon> halves;
                for (const Polygon& piece : pieces)
                    for (const double side : {1.0, -1.0}) {
                        Polygon half;
                        keep_front(piece, side * across, side * glm::dot(across, p), snap, half);
                        if (half.size() >= 3) halves.push_back(half);
                    }
                pieces = std::move(halves);
            }
            p = q;
        }
    }
    return pieces;
}

struct Shares {
    double backs = 0, escaped = 0;
};

/// The shares of cosine-weighted rays from a piece that meet backs, and that meet nothing.
Shares lost_shares(const RayCaster& caster, const FacetPoints& piece, const PlaneFrame& frame, std::size_t count,
                   RandomNumbers& random, Scratch& scratch)
{
    scratch.rays.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double u = random.uniform(), phi = 2 * std::numbers::pi * random.uniform();
        const Vec3 d = std::sqrt(u) * (std::cos(phi) * frame.u + std::sin(phi) * frame.v) + std::sqrt(1 - u) * frame.n;
        const Vec3 from = piece.at(random.uniform(), random.uniform()).position;
        scratch.rays.set(k, caster.leave(from, frame.n), d, std::numeric_limits<float>::infinity());
    }
    caster.closest(scratch.rays, scratch.hits);
    scratch.traced += count;
    const auto share = [&](std::uint32_t what) {
        return static_cast<double>(std::ranges::count(scratch.hits.surface, what)) / static_cast<double>(count);
    };
    return {share(HitBatch::black_back), share(HitBatch::escaped)};
}

}  // namespace

void add_backs(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const Blockers& blockers,
               double least, std::uint64_t seed, FormFactorMatrix& F, const WorkMonitor& monitor)
{
    std::vector<PatchId> rows;
    for (const PatchId p : mesh.patches())
        if (1 - F.raw_sum[p] > least) rows.push_back(p);
    F.rays += for_each_row<Scratch>(
        rows.size(), monitor,
        [&](std::size_t k, Scratch& scratch) {
            const PatchId p = rows[k];
            const auto c = mesh.corners(p);
            const PlaneFrame& frame = scene.surface(mesh.surface(p)).frame;
            RandomNumbers random(seed, stream ^ p.value);
            double sum = 0;
            bool looks_out = false;
            for (const Polygon& piece : cut_along_contacts(
                     {mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])}, frame.n, blockers)) {
                if (!(glm::length(area_vector(piece)) > 1e-12 * mesh.area(p))) continue;
                const FacetPoints points{std::span<const Vec3>(piece)};
                Shares shares = lost_shares(caster, points, frame, few_rays, random, scratch);
                if (shares.backs > 0 && shares.backs < 1)
                    shares = lost_shares(caster, points, frame, many_rays, random, scratch);
                sum += shares.backs * points.area();
                looks_out = looks_out || shares.escaped > 0;
            }
            F.backs[p] = sum / mesh.area(p);
            if (looks_out) F.escaped[p] = positive_part(1 - F.raw_sum[p] - F.backs[p]);
        },
        1);
}

}  // namespace patchlight
