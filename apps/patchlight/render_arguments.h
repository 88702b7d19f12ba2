#pragma once

#include "apps/patchlight/false_color_arguments.h"

namespace patchlight {

/// Words that are only understood once everything has been read.
struct RenderTexts {
    std::string size, shade = "gouraud", exposure = "auto", cycle = "last", from, to, up = "0,1,0";
    double fov = 0;
    FalseColorTexts false_color;
};

void add_render(CLI::App& app, RenderCommand& command, RenderTexts& texts);
/// Throws UsageError.
void finish_render(RenderCommand& command, const RenderTexts& texts);

}  // namespace patchlight
