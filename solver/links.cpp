#include "solver/links.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

namespace patchlight {

namespace {

/// Of the errors that different links bring to one node: what they miss, a corner's darkness say, is partly the same.
/// Measured against dense answers: 0 says too little by up to 4, 1 too much by up to 6.
constexpr double correlation = 0.1;

/// To keep threads busy.
constexpr std::size_t enough_pairs = 2048;

/// The upper half of a float, rounded up: three digits.
std::uint16_t packed(double x)
{
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
    return static_cast<std::uint16_t>((bits + 0xffffU) >> 16);
}

double unpacked(std::uint16_t half)
{
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(half) << 16));
}

double square(double x)
{
    return x * x;
}

}  // namespace

/// What becomes of a pair of nodes.
struct LinkOperator::Judged {
    enum class Verdict : std::uint8_t { nothing, linked, divided };
    Link link;
    std::uint32_t rays = 0;
    Verdict verdict = Verdict::nothing;
};

/// The wrong irradiance, squared, that a link may bring to its two nodes.
LinkOperator::Wrong LinkOperator::wrong_at(const Link& link, const NodeLight& light) const
{
    const PatchHierarchy::Node &p = tree_.nodes[link.p], &q = tree_.nodes[link.q];
    const double s_p = square(unpacked(link.spread_p));
    const double s_q = p.is_leaf() && q.is_leaf() ? s_p : square(unpacked(link.spread_q));
    const auto from = [&](std::uint32_t node, double own_spread, double other_spread) {
        return square(tree_.nodes[node].area) * (glm::dot(light.B[node], light.B[node]) * other_spread +
                                                 square(static_cast<double>(light.unevenness[node])) * own_spread);
    };
    return {from(link.q, s_q, s_p), from(link.p, s_p, s_q)};
}

double LinkOperator::error_of(const Link& link, const NodeLight& light) const
{
    const auto [p, q] = wrong_at(link, light);
    return weight_of(link.p, light) * p + weight_of(link.q, light) * q;
}

double LinkOperator::weight_of(std::uint32_t node, const NodeLight& light) const
{
    return tree_.nodes[node].area * square(static_cast<double>(light.rho[node]));
}

LinkOperator::Judged LinkOperator::judge(const Pair& pair, const NodeLight& light, double most,
                                         NodeExchange::Scratch& scratch) const
{
    using enum Judged::Verdict;
    const auto [p, q, expected] = pair;
    Judged judged{{p, q, 0, 0, 0, packed(expected)}, 0, nothing};
    const PatchHierarchy::Node &a = tree_.nodes[p], &b = tree_.nodes[q];
    if (p == q) {
        judged.verdict = a.surface.valid() ? nothing : divided;
        return judged;
    }
    if (!exchange_.may_face(p, q)) return judged;
    Link& link = judged.link;
    const double greatest = greatest_kernel(a, b);
    const bool patches = a.is_leaf() && b.is_leaf();
    link.spread_p = packed(greatest);
    link.spread_q = patches ? 0 : link.spread_p;
    const double at_most = error_of(link, light);
    const auto take = [&](const MeanKernel& kernel) {
        link.kernel = static_cast<float>(std::min(kernel.mean, greatest));
        link.open = packed(kernel.open);
        judged.rays += kernel.rays;
        return kernel;
    };
    if (at_most <= most) {
        take(exchange_.between_points(p, q, 2, 0, expected, scratch));
    } else if (patches) {
        const double spread = greatest * std::sqrt(most / at_most);
        const MeanKernel kernel = take(exchange_.between_patches(p, q, spread, expected, scratch));
        link.spread_p = packed(kernel.spread_p);
        link.spread_q = kernel.best ? 1 : 0;
    } else {
        judged.verdict = divided;
        if (greatest * std::max(a.area, b.area) >= 1) return judged;  // they touch, or nearly
        const MeanKernel kernel = take(exchange_.between_points(p, q, 4, 0, expected, scratch));
        link.spread_p = packed(std::min(kernel.spread_p, greatest));
        link.spread_q = packed(std::min(kernel.spread_q, greatest));
        if (error_of(link, light) > most) return judged;
        // Afresh: points that chance to agree are taken too often, and on the average with too little light.
        take(exchange_.between_points(p, q, 4, 1, expected, scratch));
    }
    const bool certainly_none = link.kernel == 0 && link.spread_p == 0 && (patches || link.spread_q == 0);
    judged.verdict = certainly_none ? nothing : linked;
    return judged;
}

void LinkOperator::split(const Link& link, std::vector<Pair>& pairs) const
{
    const std::uint32_t p = link.p, q = link.q;
    const double open = unpacked(link.open);
    const auto children = [&](std::uint32_t node) {
        return std::pair(static_cast<std::uint32_t>(tree_.nodes[node].left),
                         static_cast<std::uint32_t>(tree_.nodes[node].right));
    };
    if (p == q) {
        const auto [left, right] = children(p);
        for (const Pair& pair : {Pair{left, left, open}, Pair{left, right, open}, Pair{right, right, open}})
            pairs.push_back(pair);
        return;
    }
    const PatchHierarchy::Node &a = tree_.nodes[p], &b = tree_.nodes[q];
    if (b.is_leaf() || (!a.is_leaf() && a.diameter() >= b.diameter())) {
        const auto [left, right] = children(p);
        pairs.push_back({left, q, open});
        pairs.push_back({right, q, open});
    } else {
        const auto [left, right] = children(q);
        pairs.push_back({p, left, open});
        pairs.push_back({p, right, open});
    }
}

LinkOperator::Branch LinkOperator::refine_all(std::span<const Pair> pairs, const NodeLight& light, double most,
                                              NodeExchange::Scratch& scratch) const
{
    Branch branch;
    std::vector<Pair> left(pairs.rbegin(), pairs.rend());
    while (!left.empty()) {
        const Pair pair = left.back();
        left.pop_back();
        const Judged j = judge(pair, light, most, scratch);
        branch.rays += j.rays;
        if (j.verdict == Judged::Verdict::linked) branch.links.push_back(j.link);
        if (j.verdict == Judged::Verdict::divided) split(j.link, left);
    }
    return branch;
}

LinkingReport LinkOperator::refine(const NodeLight& light, double most, const WorkMonitor& monitor)
{
    LinkingReport report;
    std::vector<Pair> work, next;
    const bool from_root = !started_;
    if (from_root && !tree_.nodes.empty()) work.push_back({tree_.root(), tree_.root()});
    started_ = true;
    std::size_t kept = 0;
    for (const Link& link : links_) {
        const bool patches = tree_.nodes[link.p].is_leaf() && tree_.nodes[link.q].is_leaf();
        const bool final = patches && link.spread_q != 0;
        if (final || error_of(link, light) <= most) {
            links_[kept++] = link;
            continue;
        }
        ++report.refined;
        if (patches)
            work.push_back({link.p, link.q, unpacked(link.open)});
        else
            split(link, work);
    }
    links_.resize(kept);
    NodeExchange::Scratch scratch;
    while (from_root && !work.empty() && work.size() < enough_pairs) {
        if (monitor.stop.stop_requested()) throw Interrupted();
        next.clear();
        for (const Pair& pair : work) {
            const Judged j = judge(pair, light, most, scratch);
            report.rays += j.rays;
            if (j.verdict == Judged::Verdict::linked) links_.push_back(j.link);
            if (j.verdict == Judged::Verdict::divided) split(j.link, next);
        }
        work.swap(next);
    }
    // From here on each pair with all that it is divided into at once: what is near one another in space stays near in
    // memory, and in the rays' caches.
    const std::size_t group = std::clamp<std::size_t>(work.size() / enough_pairs, 1, 64);
    std::vector<Branch> branches((work.size() + group - 1) / group);
    WorkMonitor dividing{monitor.stop, {}};
    std::atomic<std::size_t> rays{report.rays};
    if (monitor.tell) dividing.tell = [&](const WorkState&) { monitor.tell({.rays = rays}); };
    for_each_row<NodeExchange::Scratch>(
        branches.size(), dividing,
        [&](std::size_t i, NodeExchange::Scratch& own) {
            const std::size_t first = i * group;
            branches[i] =
                refine_all(std::span(work).subspan(first, std::min(group, work.size() - first)), light, most, own);
            rays += branches[i].rays;
        },
        1);
    for (const Branch& branch : branches) links_.insert(links_.end(), branch.links.begin(), branch.links.end());
    report.rays = rays;
    report.links = static_cast<std::size_t>(std::ranges::count_if(links_, [](const Link& l) { return l.kernel > 0; }));
    return report;
}

double LinkOperator::squared_error(const NodeLight& light) const
{
    std::vector<double> sums(tree_.nodes.size(), 0.0), squares(tree_.nodes.size(), 0.0);
    for (const Link& link : links_) {
        const auto [p, q] = wrong_at(link, light);
        sums[link.p] += std::sqrt(p);
        sums[link.q] += std::sqrt(q);
        squares[link.p] += p;
        squares[link.q] += q;
    }
    double error = 0;
    for (std::size_t i = 0; i < sums.size(); ++i)
        error += weight_of(static_cast<std::uint32_t>(i), light) *
                 (correlation * square(sums[i]) + (1 - correlation) * squares[i]);
    return error;
}

void LinkOperator::sort_links()
{
    entry_start_.assign(tree_.nodes.size() + 1, 0);
    for (const Link& link : links_) {
        if (link.kernel == 0) continue;
        ++entry_start_[link.p + 1];
        ++entry_start_[link.q + 1];
    }
    for (std::size_t k = 1; k < entry_start_.size(); ++k) entry_start_[k] += entry_start_[k - 1];
    std::vector<std::size_t> next(entry_start_.begin(), entry_start_.end() - 1);
    entries_.resize(entry_start_.back());
    for (const Link& link : links_) {
        if (link.kernel == 0) continue;
        entries_[next[link.p]++] = {link.q, link.kernel};
        entries_[next[link.q]++] = {link.p, link.kernel};
    }
}

void LinkOperator::gather(const PatchField<Rgb>& B, PatchField<Rgb>& H)
{
    const std::size_t n = tree_.nodes.size();
    flux_.resize(n);
    irradiance_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const PatchHierarchy::Node& node = tree_.nodes[i];
        flux_[i] = node.is_leaf()
                       ? node.area * B[tree_.order[node.first]]
                       : flux_[static_cast<std::size_t>(node.left)] + flux_[static_cast<std::size_t>(node.right)];
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 256), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            Rgb sum(0.0);
            for (std::size_t k = entry_start_[i]; k < entry_start_[i + 1]; ++k)
                sum += static_cast<double>(entries_[k].kernel) * flux_[entries_[k].other];
            irradiance_[i] = sum;
        }
    });
    for (std::size_t i = n; i-- > 0;) {
        const PatchHierarchy::Node& node = tree_.nodes[i];
        if (node.is_leaf()) {
            H[tree_.order[node.first]] = irradiance_[i];
        } else {
            irradiance_[static_cast<std::size_t>(node.left)] += irradiance_[i];
            irradiance_[static_cast<std::size_t>(node.right)] += irradiance_[i];
        }
    }
}

void LinkOperator::pull(const PatchField<Rgb>& B, NodeLight& light) const
{
    const std::size_t n = tree_.nodes.size();
    light.B.resize(n);
    light.unevenness.resize(n);
    std::vector<double> square_mean(n);
    for (std::size_t i = 0; i < n; ++i) {
        const PatchHierarchy::Node& node = tree_.nodes[i];
        if (node.is_leaf()) {
            light.B[i] = B[tree_.order[node.first]];
            square_mean[i] = glm::dot(light.B[i], light.B[i]);
        } else {
            const auto l = static_cast<std::size_t>(node.left), r = static_cast<std::size_t>(node.right);
            const double share = tree_.nodes[l].area / node.area;
            light.B[i] = share * light.B[l] + (1 - share) * light.B[r];
            square_mean[i] = share * square_mean[l] + (1 - share) * square_mean[r];
        }
        light.unevenness[i] =
            static_cast<float>(std::sqrt(std::max(0.0, square_mean[i] - glm::dot(light.B[i], light.B[i]))));
    }
}

std::size_t LinkOperator::bytes() const
{
    return links_.capacity() * sizeof(Link) + entries_.capacity() * sizeof(Entry) +
           entry_start_.capacity() * sizeof(std::size_t);
}

}  // namespace patchlight
