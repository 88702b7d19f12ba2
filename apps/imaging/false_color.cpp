#include "apps/imaging/false_color.h"

#include "apps/imaging/exposure.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

const Rgb ground{0.09, 0.09, 0.10};
const Rgb bright{0.95, 0.95, 0.95};
const Rgb dim{0.70, 0.72, 0.75};
const Rgb no_value{0.38, 0.38, 0.38};
constexpr double half_line = 0.45;  // pixels
constexpr double legend_ticks = 9;

Rgb decoded(const Rgb& srgb)
{
    return {srgb_decoded(srgb.r), srgb_decoded(srgb.g), srgb_decoded(srgb.b)};
}

Rgb encoded(const Rgb& linear)
{
    return {srgb_encoded(linear.r), srgb_encoded(linear.g), srgb_encoded(linear.b)};
}

const Rgb& color_at(const ColorTable& table, double position)
{
    return table[static_cast<std::size_t>(std::lround(position * static_cast<double>(table.size() - 1)))];
}

class Colorist {
public:
    Colorist(const QuantityMap& map, const FalseColor& how) : map_(map), how_(how)
    {
        for (const Rgb& color : how.table) linear_.push_back(decoded(color));
        for (const double value : how.isolines) {
            // Where a scale begins at 0, dark places would be scattered with pieces of that line.
            if (value != how.scale.low) levels_.push_back(how.scale.coordinate(value));
        }
    }

    /// Of one sample, linear.
    Rgb at(int x, int y) const
    {
        const float value = map_.values.at(x, y);
        Rgb color = std::isnan(value) ? decoded(no_value) : color_at(linear_, how_.scale.position(double(value)));
        if (how_.patch_borders && (differs(x, y, x + 1, y) || differs(x, y, x, y + 1))) {
            color *= 0.3;
        }
        const double line =
            levels_.empty() || std::isnan(value) ? 0.0 : line_at(x, y, how_.scale.coordinate(double(value)));
        return line > 0 ? glm::mix(color, Rgb(luminance(color) > 0.2 ? 0.0 : 1.0), line) : color;
    }

private:
    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.values.width) + static_cast<std::size_t>(x);
    }
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < map_.values.width && y < map_.values.height; }

    bool differs(int x, int y, int x2, int y2) const
    {
        return !map_.patch.empty() && inside(x2, y2) && map_.patch[index(x, y)] != map_.patch[index(x2, y2)];
    }

    /// The slope along one axis, from the neighbours that show the same surface.
    double slope(int x, int y, int dx, int dy, double here) const
    {
        double difference = 0;
        int steps = 0;
        for (const int side : {-1, 1}) {
            const int nx = x + side * dx, ny = y + side * dy;
            if (!inside(nx, ny) || map_.surface[index(nx, ny)] != map_.surface[index(x, y)]) continue;
            const double there = how_.scale.coordinate(double(map_.values.at(nx, ny)));
            if (!std::isfinite(there)) continue;
            difference += side * (there - here);
            ++steps;
        }
        return steps > 0 ? difference / steps : 0;
    }

    /// How much of the sample the nearest isoline covers: its distance is that in value over the slope.
    double line_at(int x, int y, double here) const
    {
        const double steep = std::hypot(slope(x, y, 1, 0, here), slope(x, y, 0, 1, here));
        if (!(steep > 0) || !std::isfinite(here)) return 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (const double level : levels_) nearest = std::min(nearest, std::abs(here - level) / steep);
        return std::clamp(half_line * map_.samples + 0.5 - nearest, 0.0, 1.0);
    }

    const QuantityMap& map_;
    const FalseColor& how_;
    ColorTable linear_;
    std::vector<double> levels_;
};

void fill(Image& image, int x0, int x1, int y0, int y1, const Rgb& color)
{
    for (int y = std::max(0, y0); y < std::min(y1, image.height); ++y) {
        for (int x = std::max(0, x0); x < std::min(x1, image.width); ++x) image.set(x, y, color);
    }
}

std::string text_of(double value)
{
    return fmt::format("{:.6g}", value);
}

/// DejaVu Sans is about so wide; what is asked for is only whether words collide.
int width_of(const std::string& text, int size)
{
    return static_cast<int>(0.62 * size * static_cast<double>(text.size()));
}

void draw_ticks(Image& image, const FalseColor& how, int left, int right, int below, int size)
{
    const std::vector<double> ticks =
        how.isolines.empty() ? round_values(how.scale, static_cast<int>(legend_ticks)) : how.isolines;
    int free_from = 0;
    for (const double tick : ticks) {
        const int x = left + static_cast<int>(std::lround(how.scale.position(tick) * (right - left)));
        fill(image, x - std::max(1, size / 12), x + std::max(1, size / 12), below, below + size / 3, bright);
        const std::string text = text_of(tick);
        const int width = width_of(text, size);
        const int start = std::clamp(x - width / 2, 2, std::max(2, image.width - 2 - width));
        if (start >= free_from) {
            draw_text(image, start + width / 2, below + size * 3 / 2, text, size, dim, TextAlign::center);
            free_from = start + width + size / 2;
        }
    }
}

}  // namespace

ColorTable diverging_colors()
{
    const std::vector<Rgb> knots{{33, 102, 172},  {103, 169, 207}, {209, 229, 240}, {247, 247, 247},
                                 {253, 219, 199}, {239, 138, 98},  {178, 24, 43}};
    ColorTable table;
    for (int i = 0; i <= 256; ++i) {
        const double at = i / 256.0 * static_cast<double>(knots.size() - 1);
        const std::size_t k = std::min(static_cast<std::size_t>(at), knots.size() - 2);
        table.push_back(glm::mix(knots[k], knots[k + 1], at - static_cast<double>(k)) / 255.0);
    }
    return table;
}

Image false_color(const QuantityMap& map, const FalseColor& how)
{
    const Colorist colorist(map, how);
    const int samples = map.samples;
    Image image(map.values.width / samples, map.values.height / samples);
    tbb::parallel_for(tbb::blocked_range<int>(0, image.height, 4), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            for (int x = 0; x < image.width; ++x) {
                Rgb sum{0.0};
                for (int j = 0; j < samples; ++j) {
                    for (int i = 0; i < samples; ++i) sum += colorist.at(x * samples + i, y * samples + j);
                }
                image.set(x, y, encoded(sum / static_cast<double>(samples * samples)));
            }
        }
    });
    return image;
}

Image with_legend(const Image& picture, const FalseColor& how, const std::string& title, const std::string& note)
{
    const int size = std::clamp(picture.width / 34, 9, 28);
    const int margin = size * 3 / 2, left = margin, right = std::max(left + 1, picture.width - margin);
    const int top = picture.height, bar = top + size * 2, below = bar + size;
    Image result(picture.width, below + size * 9 / 4);
    std::copy(picture.rgb.begin(), picture.rgb.end(), result.rgb.begin());
    fill(result, 0, result.width, top, result.height, ground);
    for (int x = left; x < right; ++x) {
        fill(result, x, x + 1, bar, below, color_at(how.table, (x - left + 0.5) / (right - left)));
    }
    draw_text(result, left, top + size * 3 / 2, title, size, bright);
    if (!note.empty() && right - left > width_of(title + note, size) + size) {
        draw_text(result, right, top + size * 3 / 2, note, size * 7 / 8, dim, TextAlign::right);
    }
    draw_ticks(result, how, left, right, below, size);
    return result;
}

std::string note_on(const QuantityMap& map)
{
    const bool any = std::ranges::any_of(map.values.values, [](float v) { return std::isnan(v); });
    return any ? "grey: no value" : "";
}

}  // namespace patchlight
