#include "meshing/box_pairs.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>
#include <glm/common.hpp>

#include <algorithm>

namespace patchlight {

namespace {

using CgalBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

std::vector<CgalBox> cgal_boxes(const std::vector<Box3>& boxes)
{
    std::vector<CgalBox> result;
    result.reserve(boxes.size());
    for (const Box3& box : boxes) {
        const CGAL::Bbox_3 bounds(box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z);
        result.emplace_back(bounds, static_cast<std::uint32_t>(result.size()));
    }
    return result;
}

}  // namespace

Box3 Box3::around(std::span<const std::uint32_t> corners, const std::vector<Vec3>& vertices, double margin)
{
    Box3 box{vertices[corners[0]], vertices[corners[0]]};
    for (const std::uint32_t v : corners) {
        box.low = glm::min(box.low, vertices[v]);
        box.high = glm::max(box.high, vertices[v]);
    }
    box.low -= margin;
    box.high += margin;
    return box;
}

std::vector<IndexPair> touching_pairs(const std::vector<Box3>& boxes, const PairTest& test)
{
    std::vector<CgalBox> ours = cgal_boxes(boxes);
    std::vector<IndexPair> pairs;
    CGAL::box_self_intersection_d(ours.begin(), ours.end(), [&](const CgalBox& a, const CgalBox& b) {
        const IndexPair pair = std::minmax(a.info(), b.info());
        if (test(pair.first, pair.second)) pairs.push_back(pair);
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<IndexPair> touching_pairs(const std::vector<Box3>& a, const std::vector<Box3>& b, const PairTest& test)
{
    std::vector<CgalBox> first = cgal_boxes(a), second = cgal_boxes(b);
    std::vector<IndexPair> pairs;
    CGAL::box_intersection_d(first.begin(), first.end(), second.begin(), second.end(),
                             [&](const CgalBox& p, const CgalBox& q) {
                                 if (test(p.info(), q.info())) pairs.emplace_back(p.info(), q.info());
                             });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace patchlight
