#pragma once

#include "meshing/box_pairs.h"
#include "meshing/union_find.h"
#include "meshing/vectors.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace patchlight {

/// The regions of space that triangles with shared vertices bound. Triangle sides that meet at shared edges, going
/// round the edge, bound the same region: they are one shell. A shell that bounds a volume from outside closes its
/// region; one that doesn't (a plate in the air, a free block) lies in the region that a ray from its outermost
/// triangle meets. Of very many free pieces (more than 5e8 / triangles) the last count as lying in open space.
class SpaceRegions {
public:
    /// The vertices must live as long as the regions.
    SpaceRegions(const std::vector<Vec3>& vertices, std::vector<std::array<std::uint32_t, 3>> triangles,
                 double diameter);

    /// The shell that a triangle's side is part of: the front is where its counter-clockwise normal points.
    std::uint32_t shell(std::uint32_t triangle, bool front) { return sides_.root(side_of(triangle, front)); }

    /// Whether the shell bounds a volume from outside.
    bool closes(std::uint32_t shell) const;

    /// The shell that closes the region this one lies in: itself, if it does; none in open space.
    std::optional<std::uint32_t> closing_shell(std::uint32_t shell);

    /// Whether there were too many free pieces to say where they all lie.
    bool gave_up() const { return tests_ > most_tests; }

    /// What a shell reaches over.
    const Box3& box(std::uint32_t shell) const { return shells_.at(shell).box; }

private:
    static constexpr double most_tests = 5e8;

    using Triangle = std::array<std::uint32_t, 3>;
    struct Shell {
        double volume = 0;     ///< that its sides face, six times; negative when they face outward
        double magnitude = 0;  ///< of the terms that volume sums
        Vec3 base{0.0};
        std::optional<Vec3> start;  ///< the middle of its outermost triangle from where `outward` leads off it
        Box3 box;
    };

    static constexpr std::uint32_t side_of(std::uint32_t triangle, bool front)
    {
        return 2 * triangle + (front ? 0 : 1);
    }

    void join_sides();
    void add_to_shell(std::uint32_t triangle, bool front);
    bool runs_along_normal(std::uint32_t triangle) const;  // the ray `outward`
    std::optional<double> hit(const Triangle& triangle, const Vec3& p) const;
    std::optional<std::uint32_t> beyond(std::uint32_t shell);

    const std::vector<Vec3>& vertices_;
    std::vector<Triangle> triangles_;
    double diameter_;
    UnionFind sides_;
    std::map<std::uint32_t, Shell> shells_;
    std::map<std::uint32_t, std::optional<std::uint32_t>> closing_;
    double tests_ = 0;
};

}  // namespace patchlight
