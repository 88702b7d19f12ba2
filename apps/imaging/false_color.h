#pragma once

#include "apps/imaging/image_file.h"
#include "apps/imaging/quantity.h"
#include "apps/imaging/value_scale.h"

#include <string>
#include <vector>

namespace patchlight {

/// How numbers become colours.
struct FalseColor {
    ColorTable table;
    ValueScale scale;
    std::vector<double> isolines{};  ///< values along which lines are drawn, but for the scale's low
    bool patch_borders = false;      ///< darkens the borders of patches
};

/// From blue over almost white to red, for differences with a sign [ColorBrewer's RdBu]: 257 colours, so that 0 in the
/// middle has one of its own.
ColorTable diverging_colors();

/// sRGB values. Each sample is coloured, then a pixel's samples are averaged in linear light. Where there is no value
/// it is grey. Isolines are .9 pixels wide, antialiased, black on bright colours and white on dark ones; they end
/// where another surface begins.
Image false_color(const QuantityMap& map, const FalseColor& how);

/// The picture with a strip below: a heading, the colours, and round values (the isolines, if there are any). Without a
/// font bar and ticks stand without words. `note` stands at the heading's right, where there is room.
Image with_legend(const Image& picture, const FalseColor& how, const std::string& title, const std::string& note = "");

/// What `note` is for a map that has places without a value; else empty.
std::string note_on(const QuantityMap& map);

}  // namespace patchlight
