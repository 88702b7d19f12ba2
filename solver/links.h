#pragma once

#include "formfactor/node_exchange.h"
#include "formfactor/work_monitor.h"
#include "solver/radiosity.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// Light between two nodes of a PatchHierarchy, both ways: p gets the irradiance kernel × area(q) × B(q), q the
/// reverse. So the operator is reciprocal to the bit, and what one gets the other has sent.
struct Link {
    std::uint32_t p = 0, q = 0;
    float kernel = 0;                          ///< MeanKernel::mean, 1/m²
    std::uint16_t spread_p = 0, spread_q = 0;  ///< floats' upper halves; between two patches spread_q = 1: final
    std::uint16_t open = 0;                    ///< MeanKernel::open, the same
};

/// What nodes send out and how they answer, three bands.
struct NodeLight {
    std::vector<Rgb> B;             ///< W/m², mean over the node
    std::vector<float> unevenness;  ///< W/m², standard deviation over the node's patches, the bands' squares added
    std::vector<float> rho;         ///< root of the mean of ρ² over patches and bands
};

/// How a refinement of links went.
struct LinkingReport {
    std::size_t links = 0;  ///< that carry light
    std::size_t rays = 0;
    std::size_t refined = 0;  ///< links replaced by finer or surer ones
};

/// F on a patch mesh as links between groups of patches [HanrahanSalzmanAupperle91], with clusters above the surfaces
/// [SmitsArvoGreenberg94], so that it takes O(n) memory and time instead of n². Starts from the root alone.
/// Light is constant over a patch, as in the dense system; over a group of patches as far as the links' errors allow.
class LinkOperator {
public:
    /// Keeps references to all but the options.
    LinkOperator(const PatchHierarchy& tree, const NodeExchange& exchange) : tree_(tree), exchange_(exchange) {}

    /// BF-refinement: splits every link whose squared error is above `most` W²/m² until none is left or only patches
    /// meet, whose rays are increased instead. Of a link p–q: A_p ρ_p² A_q² (B_q² s_p² + b_q² s_q²) and the reverse, s
    /// the spreads of its kernel, b the unevenness of B: the square of the wrong light that it brings to the receiver,
    /// integrated there. On all threads, the same bytes on any number. Throws Interrupted; then it may not be used on.
    LinkingReport refine(const NodeLight& light, double most, const WorkMonitor& monitor = {});
    /// ∫|error of ρ H|² dA that the links add up to, W²/m²: what they bring to one node is taken for correlated by a
    /// quarter. An estimate, not a bound.
    double squared_error(const NodeLight& light) const;

    /// H = F B for all patches: pulled up, over the links, pushed down. Call sort_links() after a refinement.
    void gather(const PatchField<Rgb>& B, PatchField<Rgb>& H);
    void sort_links();

    /// B and unevenness of all nodes.
    void pull(const PatchField<Rgb>& B, NodeLight& light) const;

    /// Also those found to carry nothing that may yet.
    std::span<const Link> links() const { return links_; }
    /// Of memory, for links alone.
    std::size_t bytes() const;

private:
    struct Judged;
    struct Pair {
        std::uint32_t p = 0, q = 0;
        double expected = 0.5;  ///< share of rays
    };
    struct Entry {
        std::uint32_t other = 0;
        float kernel = 0;
    };

    Judged judge(const Pair& pair, const NodeLight& light, double most, NodeExchange::Scratch& scratch) const;
    struct Wrong {
        double at_p = 0, at_q = 0;
    };
    Wrong wrong_at(const Link& link, const NodeLight& light) const;
    double error_of(const Link& link, const NodeLight& light) const;
    double weight_of(std::uint32_t node, const NodeLight& light) const;
    struct Branch {
        std::vector<Link> links;
        std::size_t rays = 0;
    };
    /// Those pairs and all that they are divided into, in order.
    Branch refine_all(std::span<const Pair> pairs, const NodeLight& light, double most,
                      NodeExchange::Scratch& scratch) const;
    void split(const Link& link, std::vector<Pair>& pairs) const;

    const PatchHierarchy& tree_;
    const NodeExchange& exchange_;
    std::vector<Link> links_;
    bool started_ = false;
    std::vector<std::size_t> entry_start_;  ///< by node
    std::vector<Entry> entries_;            ///< each link at both of its nodes
    std::vector<Rgb> flux_, irradiance_;    ///< working memory of gather(): by node
};

}  // namespace patchlight
