#include "formfactor/exact_rows.h"

#include "formfactor/audit.h"
#include "formfactor/black_backs.h"
#include "formfactor/partial_exchange.h"
#include "formfactor/patch_tree.h"
#include "formfactor/unoccluded_exchange.h"
#include "meshing/positive_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace patchlight {

namespace {

constexpr double default_tolerance = 2e-5;
constexpr double least_visible = 1e-12;  // of what would be exchanged with nothing in between
constexpr double look_for_backs = 1e-4;  // rows that miss more may see some

using Triangle = std::array<Vec3, 3>;

/// What of a patch pairs ask for, in the tree's order.
struct Patches {
    std::vector<Triangle> corners;
    std::vector<Vec3> centroid;
    std::vector<double> radius, area;
};

/// The half of a row behind its patch in the tree's order.
struct HalfRow {
    std::vector<std::uint32_t> columns;
    std::vector<double> exchange;
};

struct Scratch {
    std::size_t traced = 0;
    PartialScratch partial;
    ExactCounts counts;
    std::vector<double> kernel;
    std::vector<std::uint32_t> in_shaft;
    std::vector<std::vector<Blocker>> lists;  ///< by depth of the tree
};

double height(const Vec3& p, const Vec3& n, double offset)
{
    return glm::dot(n, p) - offset;
}

class ExactAssembly {
public:
    ExactAssembly(const Scene& scene, const PatchMesh& mesh, const Blockers& blockers, double tolerance)
        : scene_(scene), blockers_(blockers), tree_(patch_tree(scene, mesh)), snap_(blockers.snap()),
          tolerance_(tolerance), rows_(mesh.patch_count())
    {
        for (const PatchId p : tree_.order) {
            const auto c = mesh.corners(p);
            const Triangle t{mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])};
            const Vec3 middle = mesh.centroid(p);
            patches_.corners.push_back(t);
            patches_.centroid.push_back(middle);
            patches_.radius.push_back(
                std::max({glm::length(t[0] - middle), glm::length(t[1] - middle), glm::length(t[2] - middle)}));
            patches_.area.push_back(mesh.area(p));
        }
        blocks5_.resize(tree_.nodes.size());
        for (const std::uint32_t leaf : tree_.leaves) {
            const PatchTree::Node& node = tree_.nodes[leaf];
            blocks5_[leaf] =
                node_block(std::span(patches_.corners).subspan(node.first, node.last - node.first), normal_of(node), 5);
        }
        for (std::size_t i = 0; i < tree_.order.size(); ++i)
            own5_.push_back(node_block(std::span(patches_.corners).subspan(i, 1),
                                       scene.surface(mesh.surface(tree_.order[i])).frame.n, 5));
    }

    /// All pairs of the patches of a leaf with those behind it.
    void leaf_rows(std::size_t leaf, Scratch& scratch)
    {
        const PatchTree::Node& from = tree_.nodes[tree_.leaves[leaf]];
        scratch.lists.resize(std::max<std::size_t>(scratch.lists.size(), 1));
        std::vector<Blocker>& all = scratch.lists[0];
        all.clear();
        Blocker front;
        const Vec3 n = normal_of(from);
        const double offset = glm::dot(n, from.hull[0]);
        for (const Blocker& blocker : blockers_.all()) {
            keep_front(blocker.corners, n, offset, snap_, front.corners);
            if (front.corners.size() < 3) continue;
            front.normal = blocker.normal;
            front.offset = blocker.offset;
            all.push_back(front);
        }
        visit(from, n, offset, tree_.root(), 0, scratch);
    }

    std::vector<HalfRow>& rows() { return rows_; }
    const PatchTree& tree() const { return tree_; }
    std::size_t leaf_count() const { return tree_.leaves.size(); }

private:
    Vec3 normal_of(const PatchTree::Node& node) const { return scene_.surface(node.surface).frame.n; }

    template <class Points>
    bool any_in_front(const Points& points, const Vec3& n, double offset) const
    {
        return std::ranges::any_of(points, [&](const Vec3& p) { return height(p, n, offset) > snap_; });
    }

    void visit(const PatchTree::Node& from, const Vec3& n, double offset, const PatchTree::Node& to, std::size_t depth,
               Scratch& scratch)
    {
        if (to.last <= from.last || !any_in_front(to.hull, n, offset)) return;
        Vec3 m(0.0);
        double to_offset = 0;
        if (to.surface.valid()) {
            m = normal_of(to);
            to_offset = glm::dot(m, to.hull[0]);
            if (!any_in_front(from.hull, m, to_offset)) return;
        }
        if (scratch.lists.size() < depth + 2) scratch.lists.resize(depth + 2);
        narrow(from, to, m, to_offset, scratch.lists[depth], scratch.lists[depth + 1]);
        if (to.is_leaf()) {
            for (std::uint32_t i = from.first; i < from.last; ++i)
                add_pairs(i, n, offset, to, m, to_offset, scratch.lists[depth + 1], scratch);
            return;
        }
        visit(from, n, offset, tree_.nodes[static_cast<std::size_t>(to.left)], depth + 1, scratch);
        visit(from, n, offset, tree_.nodes[static_cast<std::size_t>(to.right)], depth + 1, scratch);
    }

    /// The blockers that may stand between two nodes; clipped where the second has a plane.
    void narrow(const PatchTree::Node& from, const PatchTree::Node& to, const Vec3& m, double to_offset,
                const std::vector<Blocker>& candidates, std::vector<Blocker>& found) const
    {
        found.clear();
        const Shaft shaft{from.hull, to.hull};
        Blocker front;
        for (const Blocker& blocker : candidates) {
            if (!to.surface.valid()) {
                if (visibility_past(shaft, blocker.view(), snap_) != Visibility::visible) found.push_back(blocker);
                continue;
            }
            keep_front(blocker.corners, m, to_offset, snap_, front.corners);
            if (front.corners.size() < 3) continue;
            front.normal = blocker.normal;
            front.offset = blocker.offset;
            if (visibility_past(shaft, front.view(), snap_) != Visibility::visible) found.push_back(front);
        }
    }

    /// The pairs of patch i with those of a leaf.
    void add_pairs(std::uint32_t i, const Vec3& n, double offset, const PatchTree::Node& to, const Vec3& m,
                   double to_offset, const std::vector<Blocker>& between, Scratch& scratch)
    {
        const std::size_t count = to.last - to.first;
        scratch.kernel.resize(count);
        mean_kernel(own5_[i], blocks5_[static_cast<std::size_t>(&to - tree_.nodes.data())], scratch.kernel);
        HalfRow& row = rows_[i];
        for (std::uint32_t j = to.first; j < to.last; ++j) {
            const double exchange = pair(i, n, offset, j, m, to_offset, between, scratch.kernel[j - to.first], scratch);
            if (!(exchange > 0)) continue;
            row.columns.push_back(j);
            row.exchange.push_back(exchange);
        }
    }

    /// −1 wholly behind or in the plane, 1 wholly in front, 0 across.
    int side_of(const Triangle& t, const Vec3& n, double offset) const
    {
        bool front = false, back = false;
        for (const Vec3& p : t) {
            const double h = height(p, n, offset);
            front = front || h > snap_;
            back = back || h < -snap_;
        }
        if (!front) return -1;
        return back ? 0 : 1;
    }

    double pair(std::uint32_t i, const Vec3& n, double offset, std::uint32_t j, const Vec3& m, double to_offset,
                const std::vector<Blocker>& between, double kernel, Scratch& scratch)
    {
        const Triangle &a = patches_.corners[i], &b = patches_.corners[j];
        const int side_a = side_of(a, m, to_offset), side_b = side_of(b, n, offset);
        if (side_a < 0 || side_b < 0) return 0;
        ++scratch.counts.facing;
        std::span<const Vec3> front_a = a, front_b = b;
        Polygon part_a, part_b;
        if (side_a == 0) keep_front(a, m, to_offset, snap_, part_a), front_a = part_a;
        if (side_b == 0) keep_front(b, n, offset, snap_, part_b), front_b = part_b;
        const bool whole = side_a > 0 && side_b > 0;
        const double apart = glm::length(patches_.centroid[i] - patches_.centroid[j]);
        const bool far = whole && apart > 2.7 * (patches_.radius[i] + patches_.radius[j]);
        const auto unoccluded = [&] {
            return far ? positive_part(kernel) * patches_.area[i] * patches_.area[j]
                       : unoccluded_exchange(front_a, n, front_b, m);
        };
        if (between.empty()) return unoccluded();
        switch (sift({front_a, front_b}, between, snap_, scratch.in_shaft)) {
        case Visibility::visible:
            return unoccluded();
        case Visibility::hidden:
            return 0;
        case Visibility::partial:
            break;
        }
        ++scratch.counts.partial;
        const double all = unoccluded();
        const double seen =
            partial_exchange(front_a, n, front_b, m, between, scratch.in_shaft, snap_, all,
                             tolerance_ * std::min(patches_.area[i], patches_.area[j]), scratch.partial);
        // The rest of a pair that is hidden, by rounding.
        return seen > least_visible * all ? seen : 0;
    }

    const Scene& scene_;
    const Blockers& blockers_;
    PatchTree tree_;
    double snap_, tolerance_;
    Patches patches_;
    std::vector<NodeBlock> blocks5_, own5_;
    std::vector<HalfRow> rows_;
};

/// Both halves of all rows, in the patches' own order, columns ascending.
FormFactorMatrix whole_matrix(ExactAssembly& assembly, const PatchMesh& mesh)
{
    const std::vector<PatchId>& order = assembly.tree().order;
    const std::size_t n = mesh.patch_count();
    FormFactorMatrix F;
    std::vector<std::size_t> counts(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        counts[order[i].value] += assembly.rows()[i].columns.size();
        for (const std::uint32_t j : assembly.rows()[i].columns) ++counts[order[j].value];
    }
    F.row_start.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) F.row_start[i + 1] = F.row_start[i] + counts[i];
    F.columns.resize(F.row_start[n]);
    F.factors.resize(F.row_start[n]);
    std::vector<std::size_t> next(F.row_start.begin(), F.row_start.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
        HalfRow& row = assembly.rows()[i];
        for (std::size_t k = 0; k < row.columns.size(); ++k) {
            const std::uint32_t p = order[i].value, q = order[row.columns[k]].value;
            F.columns[next[p]] = q;
            F.factors[next[p]++] = row.exchange[k] / mesh.area(PatchId(p));
            F.columns[next[q]] = p;
            F.factors[next[q]++] = row.exchange[k] / mesh.area(PatchId(q));
        }
        row = {};
    }
    sort_columns(F);
    return F;
}

}  // namespace

FormFactorMatrix exact_rows(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                            const FormFactorOptions& options, const WorkMonitor& monitor, bool occluded,
                            ExactCounts* counts)
{
    const Blockers blockers = occluded ? Blockers(scene) : Blockers({}, scene.diameter);
    ExactAssembly assembly(scene, mesh, blockers, options.tolerance > 0 ? options.tolerance : default_tolerance);
    std::vector<ExactCounts> leaf_counts(assembly.leaf_count());
    for_each_row<Scratch>(
        assembly.leaf_count(), monitor,
        [&](std::size_t leaf, Scratch& scratch) {
            scratch.counts = {};
            scratch.partial.nodes = 0;
            assembly.leaf_rows(leaf, scratch);
            scratch.counts.nodes = scratch.partial.nodes;
            scratch.traced += scratch.counts.nodes;
            leaf_counts[leaf] = scratch.counts;
        },
        1);
    ExactCounts sum;
    for (const ExactCounts& c : leaf_counts) {
        sum.facing += c.facing;
        sum.partial += c.partial;
        sum.nodes += c.nodes;
    }
    FormFactorMatrix F = whole_matrix(assembly, mesh);
    F.rays = sum.nodes;
    F.raw_sum = F.escaped = F.backs = PatchField<double>(mesh.patch_count(), 0.0);
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k) F.raw_sum[PatchId(i)] += F.factors[k];
    if (scene.closed && occluded) add_backs(scene, caster, mesh, blockers, look_for_backs, options.seed, F, monitor);
    if (!scene.closed)
        for (const PatchId p : mesh.patches()) F.escaped[p] = positive_part(1 - F.raw_sum[p]);
    if (counts != nullptr) *counts = sum;
    return F;
}

}  // namespace patchlight
