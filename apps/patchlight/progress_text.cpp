#include "apps/patchlight/progress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace patchlight {

namespace {

constexpr int widest_bar = 20, narrowest_bar = 4, columns_per_bar_column = 8;

/// What can stand beside the bar, in order; `rank`: the higher is left out first.
struct Part {
    int rank;
    std::string text;
};

std::vector<Part> parts_of(const ProgressText& t)
{
    std::vector<Part> parts;
    if (t.fraction > 0) {
        parts.push_back({1, fmt::format("{:.0f} %", std::floor(100 * t.fraction))});
    }
    parts.push_back({2, t.stage});
    if (t.cycle >= 0) {
        parts.push_back({4, fmt::format("cycle {}", t.cycle)});
    }
    if (t.elements > 0) {
        parts.push_back({5, fmt::format("{} elements", t.elements)});
    }
    if (t.rays_per_second > 0) {
        parts.push_back({7, fmt::format("{:.2f} M rays/s", 1e-6 * t.rays_per_second)});
    }
    if (t.unshot >= 0) {
        parts.push_back({6, fmt::format("unshot {:.2f} %", 100 * t.unshot)});
    }
    if (t.residual >= 0) {
        parts.push_back({6, fmt::format("residual {:.1e}", t.residual)});
    }
    if (t.seconds_left >= 0) {
        parts.push_back({3, time_in_words(t.seconds_left) + " left"});
    }
    return parts;
}

std::string joined(const std::vector<Part>& parts)
{
    std::string text;
    for (const Part& part : parts) {
        text += text.empty() ? "" : "  ";
        text += part.text;
    }
    return text;
}

std::string bar(double fraction, int width)
{
    const int full = static_cast<int>(std::lround(fraction * width));
    return fmt::format("[{}{}] ", std::string(static_cast<std::size_t>(full), '#'),
                       std::string(static_cast<std::size_t>(width - full), '.'));
}

}  // namespace

std::string progress_line(const ProgressText& text, int width)
{
    constexpr int around_bar = 3;
    const int wanted = std::clamp(width / columns_per_bar_column, narrowest_bar, widest_bar);
    std::vector<Part> parts = parts_of(text);
    while (!parts.empty() && static_cast<int>(joined(parts).size()) + wanted + around_bar > width) {
        parts.erase(std::ranges::max_element(parts, {}, &Part::rank));
    }
    const std::string words = joined(parts);
    const int room = std::min(wanted, width - around_bar - static_cast<int>(words.size()));
    return room < 1 ? "" : bar(std::clamp(text.fraction, 0.0, 1.0), room) + words;
}

std::string time_in_words(double seconds)
{
    if (seconds <= 99) {
        return fmt::format("{:.0f} s", std::ceil(seconds));
    }
    if (seconds < 99.5 * 60) {
        return fmt::format("{:.0f} min", seconds / 60);
    }
    return seconds < 48 * 3600 ? fmt::format("{:.0f} h", seconds / 3600) : "days";
}

double TimeLeft::after(double seconds, double fraction)
{
    constexpr double slowness = 2;  // seconds after which two thirds of what is new are believed
    if (seconds < 1 || fraction < 0.05) {
        return -1;
    }
    const double end = seconds / std::min(1.0, fraction);
    const double trust = ends_ < 0 ? 1 : 1 - std::exp(-std::max(0.0, seconds - at_) / slowness);
    ends_ = ends_ < 0 ? end : ends_ + trust * (end - ends_);
    at_ = seconds;
    return std::max(0.0, ends_ - seconds);
}

}  // namespace patchlight
