#pragma once

#include "meshing/crossing_faces.h"
#include "meshing/polygon_soup.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace patchlight {

/// Every edge of every face, and every segment in which two faces cross, split at all vertices that lie on it and at
/// all edges it meets, so that faces that touch or cross share the same pieces of it.
class EdgeChains {
public:
    /// Appends the crossing points of edges and of faces to soup.vertices; counts T-junctions and crossing faces.
    EdgeChains(PolygonSoup& soup, SceneReport& report);

    using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< ascending

    const std::vector<Edge>& edges() const { return edges_; }

    const std::vector<CrossingSegment>& crossings() const { return crossings_; }

    /// Where in edges() the edge between two vertices is, which must be one.
    std::size_t index_of(std::uint32_t a, std::uint32_t b) const;

    /// The vertices along an edge, from its smaller to its larger end, both included.
    std::span<const std::uint32_t> chain(std::size_t edge) const { return chains_[edge]; }

    /// The loop of a face with all vertices of its chains.
    std::vector<std::uint32_t> split_loop(const SoupFace& face) const;

private:
    std::vector<CrossingSegment> crossings_;
    std::vector<Edge> edges_;  ///< ascending, each once
    std::vector<std::vector<std::uint32_t>> chains_;
};

}  // namespace patchlight
