#pragma once

#include "meshing/ids.h"
#include "meshing/vectors.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace patchlight {

/// What makes the light break off along a line. D0: its value jumps; D1, D2: its first or second derivative does.
enum class LineKind : std::uint8_t {
    contact,  ///< something stands on the surface or passes through it: D0
    ev,       ///< a blocker's edge seen against a source's vertex: D2, D1 where it is parallel to an edge there
    ve,       ///< a blocker's vertex seen against a source's edge: D2
    eee,      ///< a source's edge seen against two skew edges of blockers: D2, a conic
    plane     ///< the plane of a source, or of a blocker seen edge on: D1
};
inline constexpr std::array line_kinds{LineKind::contact, LineKind::ev, LineKind::ve, LineKind::eee, LineKind::plane};

constexpr std::string_view name_of(LineKind kind)
{
    constexpr std::array<std::string_view, 5> names{"contact", "EV", "VE", "EEE", "plane"};
    return names[static_cast<std::size_t>(kind)];
}

/// A straight piece of a line on a surface, in the plane coordinates of the surface's frame, m. A curve is several.
struct SurfaceLine {
    SurfaceId surface;
    LineKind kind = LineKind::contact;
    Vec2 start{0.0}, end{0.0};
};

}  // namespace patchlight
