#include "apps/imaging/camera_path.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

template <class Value>
Value catmull_rom(const Value& a, const Value& b, const Value& c, const Value& d, double t)
{
    return 0.5 * (2.0 * b + t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a))));
}

Vec3 direction(const Vec3& v, const Vec3& otherwise)
{
    const double length = glm::length(v);
    return length > 1e-6 ? v / length : otherwise;
}

}  // namespace

View view_on_path(const std::vector<View>& keys, double t)
{
    const double last = static_cast<double>(keys.size() - 1);
    t = std::clamp(t, 0.0, last);
    const auto k = static_cast<std::size_t>(std::min(std::floor(t), std::max(last - 1, 0.0)));
    const double s = t - static_cast<double>(k);
    const auto key = [&](std::ptrdiff_t i) -> const View& {
        return keys[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, std::ptrdiff_t(keys.size()) - 1))];
    };
    const auto i = static_cast<std::ptrdiff_t>(k);
    const View &a = key(i - 1), &b = key(i), &c = key(i + 1), &d = key(i + 2);
    const View& nearer = s < 0.5 ? b : c;
    View view = nearer;
    view.name = "path";
    view.from = catmull_rom(a.from, b.from, c.from, d.from, s);
    view.forward = direction(catmull_rom(a.forward, b.forward, c.forward, d.forward, s), nearer.forward);
    view.up = direction(catmull_rom(a.up, b.up, c.up, d.up, s), nearer.up);
    view.vertical_fov =
        std::clamp(catmull_rom(a.vertical_fov, b.vertical_fov, c.vertical_fov, d.vertical_fov, s), 0.1, 170.0);
    view.aspect = keys.front().aspect;
    return view;
}

}  // namespace patchlight
