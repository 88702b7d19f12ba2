#include "apps/imaging/image_file.h"
#include "apps/imaging/lightmap.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/exporting.h"
#include "apps/run/stored_scene.h"
#include "apps/run/textured_glb.h"
#include "apps/run/vtu_file.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

std::string encoded(const std::string& format, const StoredSolution& stored)
{
    if (format == "vtu") return encode_vtu(stored);
    if (format == "ply") return encode_ply(stored);
    if (format == "csv") return encode_csv(stored);
    return encode_solution(stored.scene, stored.mesh, stored.B, stored.vertex_B, stored.eta, stored.edge,
                           stored.middle_B);
}

/// STEM-NN.vtu beside STEM.pvd, which is written last: it never names what isn't there.
void export_series(const OpenedRun& run, const std::filesystem::path& output, Session& session)
{
    std::vector<std::pair<int, std::string>> files;
    for (const CycleRecord& record : run.record.cycles) {
        const StoredSolution stored = solution_of(run, {WhichCycle::Kind::number, record.cycle});
        session.interruption.check();
        const std::string name = fmt::format("{}-{:02}.vtu", output.stem().string(), record.cycle);
        session.writer.write(output.parent_path() / name, encode_vtu(stored));
        files.emplace_back(record.cycle, name);
    }
    session.writer.write(output, encode_pvd(files));
}

ImageMetadata lightmap_metadata(const OpenedRun& run, const StoredSolution& stored, const LightmapAtlas& atlas,
                                const ExportCommand& command)
{
    const bool radiosity = command.quantity == LightmapQuantity::radiosity;
    return {{"patchlight:quantity", radiosity ? "radiosity B" : "irradiance (B-E)/rho"},
            {"patchlight:unit", "W/m2, linear Rec. 709"},
            {"patchlight:scene", as_utf8(stored.scene.name)},
            {"patchlight:texels_per_metre", fmt::format("{}", atlas.texels_per_metre)},
            {"patchlight:options", run.record.identity.options.dump(-1, ' ', true, Json::error_handler_t::replace)}};
}

void export_lightmap(const OpenedRun& run, const StoredSolution& stored, const ExportCommand& command, Session& session)
{
    LightmapAtlas atlas;
    try {
        atlas = lay_out_lightmap(stored.scene, command.lightmap);
    } catch (const std::invalid_argument& problem) {
        throw UsageError("lightmap", std::string(problem.what()) + "; give --size or --texels-per-metre");
    }
    const PatchLocator locator(stored.mesh);
    const ShownSolution shown{stored.scene, stored.mesh, locator, stored.B, stored.vertex_B, &stored.middle_B};
    const Image image = lightmap_image(shown, atlas, command.quantity);
    session.interruption.check();
    const std::filesystem::path picture(command.output);
    session.writer.write(picture, encode_exr(image, lightmap_metadata(run, stored, atlas, command)));
    session.writer.write(std::filesystem::path(picture).replace_extension(".glb"),
                         encode_textured_glb(
                             stored.scene, [&](SurfaceId s, const Vec2& q) { return atlas.texture_at(s, q); },
                             picture.filename().string()));
}

}  // namespace

int run_command(const ExportCommand& command, Session& session)
{
    const OpenedRun run = open_run(command.run);
    const std::filesystem::path output(command.output);
    if (command.format == "pvd") {
        (void)record_of(run, {});  // throws when there is no cycle
        FileWriter::make_folder_of(output);
        export_series(run, output, session);
        return 0;
    }
    const StoredSolution stored = solution_of(run, command.cycle);
    session.interruption.check();
    FileWriter::make_folder_of(output);
    if (command.format == "lightmap") {
        export_lightmap(run, stored, command, session);
    } else {
        session.writer.write(output, encoded(command.format, stored));
    }
    return 0;
}

}  // namespace patchlight
