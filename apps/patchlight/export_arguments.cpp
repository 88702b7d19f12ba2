#include "apps/patchlight/export_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

namespace patchlight {

void add_export(CLI::App& app, ExportCommand& c, ExportTexts& t)
{
    app.add_option("run", c.run, "folder of a run")->required()->type_name("RUN");
    app.add_option(
           "--format", c.format,
           "glb, ply: vertices with their light; vtu: for ParaView, patches' error, size and surface beside it; "
           "pvd: a vtu of each cycle beside it; csv: a row a patch; lightmap: an EXR, and the surfaces with "
           "texture coordinates in a GLB beside it")
        ->required()
        ->check(CLI::IsMember({"glb", "vtu", "pvd", "ply", "csv", "lightmap"}));
    app.add_option("-o", c.output, "file to write; for a lightmap it ends in .exr")->required()->type_name("FILE");
    t.cycle_option = app.add_option("--cycle", t.cycle, "which cycle: a number, first or last; a pvd has them all")
                         ->type_name("N")
                         ->capture_default_str();
    auto* density = app.add_option("--texels-per-metre", c.lightmap.texels_per_metre,
                                   "of a lightmap, at least [as many as --size holds]")
                        ->check(number_above(0))
                        ->type_name("X");
    t.size_option = app.add_option("--size", c.lightmap.size,
                                   "of a lightmap, texels a side at most [1024; with --texels-per-metre 8192]")
                        ->check(whole_between(16, largest_picture_side))
                        ->type_name("N");
    auto* quantity = app.add_option("--quantity", t.quantity,
                                    "of a lightmap, W/m2: radiosity, what surfaces send out; irradiance, what they "
                                    "receive, (B - E)/reflectance")
                         ->check(CLI::IsMember({"radiosity", "irradiance"}))
                         ->capture_default_str();
    for (CLI::Option* option : {density, t.size_option, quantity}) option->group("Lightmap");
}

void finish_export(ExportCommand& c, const ExportTexts& t)
{
    c.cycle = cycle_in("--cycle", t.cycle);
    c.quantity = t.quantity == "irradiance" ? LightmapQuantity::irradiance : LightmapQuantity::radiosity;
    if (c.lightmap.texels_per_metre > 0 && t.size_option->count() == 0) c.lightmap.size = largest_picture_side;
    const bool lightmap = c.format == "lightmap";
    if (!lightmap &&
        (c.lightmap.texels_per_metre > 0 || t.size_option->count() > 0 || c.quantity != LightmapQuantity::radiosity)) {
        throw UsageError("usage", "--texels-per-metre, --size and --quantity are for --format lightmap");
    }
    if (lightmap && !c.output.ends_with(".exr")) {
        throw UsageError("usage", "-o: \"" + c.output + "\" does not end in .exr");
    }
    if (c.format == "pvd" && t.cycle_option->count() > 0) {
        throw UsageError("usage", "--cycle: a pvd has all cycles");
    }
}

}  // namespace patchlight
