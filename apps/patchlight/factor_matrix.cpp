#include "apps/patchlight/factor_matrix.h"

#include "apps/patchlight/cost_estimate.h"
#include "apps/patchlight/factor_files.h"
#include "apps/patchlight/progress_display.h"
#include "apps/run/stored_scene.h"
#include "formfactor/audit.h"
#include "formfactor/form_factor_matrix.h"
#include "meshing/refinement.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stdexcept>

namespace patchlight {

namespace {

/// A repair holds the exchanges, their transpose and their mean beside the matrix.
constexpr double repair_copies = 4;

struct MatrixResult {
    PatchMesh mesh;
    FormFactorMatrix matrix;
    FormFactorAudit audit;
    std::optional<RepairReport> repair;
    double bytes = 0;    ///< estimated beforehand
    double seconds = 0;  ///< of the factors alone
};

double needed_bytes(double patches, const FormFactorsCommand& command)
{
    const double matrix =
        matrix_bytes(command.method, static_cast<std::size_t>(std::min(patches, 1e12)), command.matrix);
    return mesh_bytes(patches) + (command.repair ? repair_copies : 1) * matrix;
}

/// Before the mesh by what it will be, after it by what it is.
double checked_bytes(double patches, const FormFactorsCommand& command)
{
    const double bytes = needed_bytes(patches, command);
    require_memory(bytes, command.memory, "ask for fewer elements or longer edges, or raise --memory");
    return bytes;
}

FormFactorMatrix computed(const Scene& scene, const PatchMesh& mesh, const FormFactorsCommand& command,
                          Session& session)
{
    const RayCaster caster(scene);
    const PatchLocator locator(mesh);
    ProgressDisplay display(session.messages);
    const WorkMonitor monitor{session.interruption.token(), [&](const WorkState& state) {
                                  display.show({.stage = "factors",
                                                .cycle = -1,
                                                .fraction = state.fraction,
                                                .elements = mesh.patch_count(),
                                                .rays = state.rays});
                              }};
    try {
        return form_factor_matrix(scene, caster, mesh, locator, command.matrix, monitor);
    } catch (const std::invalid_argument& problem) {
        throw SceneError("geometry",
                         fmt::format("{}: {}; see what inspect says of its faces", scene.name, problem.what()));
    }
}

/// Before hours of work, not after.
void make_folders(const FormFactorsCommand& command)
{
    for (const std::string& file : {command.output, command.patches}) {
        FileWriter::make_folder_of(file);
    }
}

MatrixResult make_matrix(const FormFactorsCommand& command, const SceneInput& input, Session& session)
{
    const Scene& scene = input.scene;
    checked_bytes(uniform_elements(scene, command.meshing), command);
    MatrixResult result;
    result.mesh = triangulate(scene, command.meshing);
    session.interruption.check();
    result.bytes = checked_bytes(static_cast<double>(result.mesh.patch_count()), command);
    make_folders(command);
    const auto begin = std::chrono::steady_clock::now();
    result.matrix = computed(scene, result.mesh, command, session);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    sort_columns(result.matrix);
    session.interruption.check();
    if (command.repair) {
        result.repair = repair_symmetrically(result.matrix, result.mesh.areas(), scene.closed);
        session.interruption.check();
    }
    result.audit = audit(result.matrix, result.mesh.areas(), scene.closed);
    return result;
}

void say_what_is_wrong(const MatrixResult& result, const FormFactorsCommand& command, const Session& session)
{
    const FormFactorAudit& a = result.audit;
    if (command.method == FormFactorMethod::closed_form) {
        session.messages.warning("closed-form looks through what stands between; --method exact doesn't");
    }
    for (const NamedFactor& f : a.outside) {
        session.messages.warning(fmt::format("the factor from patch {} to patch {} is {:.6g}, outside [0, 1]",
                                             f.row.value, f.column.value, f.factor));
    }
    for (const NamedFactor& f : a.non_finite) {
        session.messages.warning(
            fmt::format("the factor from patch {} to patch {} is not finite", f.row.value, f.column.value));
    }
    if (result.repair && !result.repair->converged) {
        session.messages.warning(fmt::format("the repair could not close every row: {:.2g} is left at patch {}",
                                             result.repair->closure_after.worst,
                                             result.repair->closure_after.worst_patch.value));
    }
}

void write_files(const MatrixResult& result, const FormFactorsCommand& command, const Scene& scene, Session& session)
{
    const Checkpoint check = [&] { session.interruption.check(); };
    if (command.output.ends_with(".csv")) {
        write_factors_csv(command.output, result.matrix, session.writer, check);
    } else if (!command.output.empty()) {
        write_factors_binary(command.output, result.matrix, result.mesh.areas(), session.writer, check);
    }
    if (!command.patches.empty()) {
        write_patches_csv(command.patches, scene, result.mesh, session.writer, check);
    }
}

Json id_or_null(PatchId patch)
{
    return patch.valid() ? Json(patch.value) : Json();
}

Json json_of(const ClosureDefect& c)
{
    return {{"mean", c.mean}, {"worst", c.worst}, {"worst_patch", id_or_null(c.worst_patch)}};
}

Json json_of(const ReciprocityDefect& r)
{
    return {{"mean", r.mean},
            {"worst", r.worst},
            {"worst_pair", Json::array({id_or_null(r.first), id_or_null(r.second)})},
            {"pairs", r.pairs}};
}

Json json_of(const std::vector<NamedFactor>& factors)
{
    Json list = Json::array();
    for (const NamedFactor& f : factors) {
        list.push_back({{"row", f.row.value}, {"column", f.column.value}, {"factor", f.factor}});
    }
    return list;
}

Json json_of(const RepairReport& r)
{
    return {{"closure_before", json_of(r.closure_before)},
            {"closure_after", json_of(r.closure_after)},
            {"reciprocity_before", json_of(r.reciprocity_before)},
            {"reciprocity_after", json_of(r.reciprocity_after)},
            {"iterations", r.iterations},
            {"converged", r.converged},
            {"added", r.added},
            {"largest_row_change", r.largest_row_change},
            {"largest_scaling", r.largest_scaling}};
}

Json options_of(const FormFactorsCommand& c)
{
    Json all = json_of(c.scene.options);
    all["max_edge"] = c.meshing.max_edge;
    all["max_elements"] = c.meshing.max_elements;
    all["min_angle"] = c.meshing.min_angle;
    switch (c.method) {
    case FormFactorMethod::hemicube:
        all["resolution"] = c.matrix.resolution;
        break;
    case FormFactorMethod::hemisphere:
        all["rays"] = c.matrix.rays;
        all["directions"] = name_of(direction_names(), c.matrix.directions);
        break;
    default:
        all["tolerance"] = c.matrix.tolerance > 0 ? Json(c.matrix.tolerance) : Json("default");
    }
    all["seed"] = c.matrix.seed;
    all["repair"] = c.repair ? "symmetric" : "none";
    return all;
}

Json json_of(const MatrixResult& r, const FormFactorsCommand& command, const SceneInput& input)
{
    const FormFactorAudit& a = r.audit;
    Json all{{"scene", as_utf8(input.scene.name)},
             {"sha256", input.sha256},
             {"method", name_of(form_factor_method_names(), command.method)},
             {"elements", r.mesh.patch_count()},
             {"entries", a.entries},
             {"samples", r.matrix.rays},
             {"seconds", r.seconds},
             {"bytes_estimated", r.bytes},
             {"closed", input.scene.closed},
             {"closure", json_of(a.closure)},
             {"reciprocity", json_of(a.reciprocity)},
             {"outside", {{"count", a.outside_count}, {"first", json_of(a.outside)}}},
             {"non_finite", {{"count", a.non_finite_count}, {"first", json_of(a.non_finite)}}},
             {"zero_rows", a.zero_rows}};
    if (r.repair) {
        all["repair"] = json_of(*r.repair);
    }
    all["options"] = options_of(command);
    return all;
}

const char* samples_are(FormFactorMethod method)
{
    switch (method) {
    case FormFactorMethod::hemicube:
        return "pixels";
    case FormFactorMethod::hemisphere:
        return "rays";
    default:
        return "nodes";
    }
}

std::string text_of(const MatrixResult& r, const FormFactorsCommand& command, const Scene& scene)
{
    const FormFactorAudit& a = r.audit;
    std::string out = fmt::format("scene        {}: {} surfaces, {}\n", scene.name, scene.surfaces.size(),
                                  scene.closed ? "closed" : "open");
    out += fmt::format("method       {}\n", name_of(form_factor_method_names(), command.method));
    out += fmt::format("patches      {}\n", r.mesh.patch_count());
    out += fmt::format("entries      {}, {} rows without any\n", a.entries, a.zero_rows);
    if (r.matrix.rays > 0) {
        out += fmt::format("{:<12} {}\n", samples_are(command.method), r.matrix.rays);
    }
    out += fmt::format("seconds      {:.3g}\n", r.seconds);
    out += fmt::format("memory       {:.0f} MiB estimated\n", r.bytes / (1024.0 * 1024));
    out += fmt::format("closure      {:.2g} mean, {:.2g} worst, at patch {}{}\n", a.closure.mean, a.closure.worst,
                       a.closure.worst_patch.value,
                       scene.closed ? "" : " (open: where what escapes isn't known, only excess)");
    out += fmt::format("reciprocity  {:.2g} mean, {:.2g} worst", a.reciprocity.mean, a.reciprocity.worst);
    out += a.reciprocity.first.valid()
               ? fmt::format(", between patches {} and {}\n", a.reciprocity.first.value, a.reciprocity.second.value)
               : "\n";
    out += fmt::format("outside 0..1 {}, not finite {}\n", a.outside_count, a.non_finite_count);
    if (r.repair) {
        const RepairReport& p = *r.repair;
        out += fmt::format("repaired     closure {:.2g} to {:.2g} worst, reciprocity {:.2g} to {:.2g} worst\n"
                           "             in {} iterations, {} factors added, rows changed by {:.2g} at most\n",
                           p.closure_before.worst, p.closure_after.worst, p.reciprocity_before.worst,
                           p.reciprocity_after.worst, p.iterations, p.added, p.largest_row_change);
    }
    for (const std::string& file : {command.output, command.patches}) {
        if (!file.empty()) {
            out += fmt::format("wrote        {}\n", file);
        }
    }
    return out;
}

}  // namespace

int report_matrix(const FormFactorsCommand& command, const SceneInput& input, Session& session)
{
    const MatrixResult result = make_matrix(command, input, session);
    say_what_is_wrong(result, command, session);
    write_files(result, command, input.scene, session);
    write_result(command.json
                     ? json_of(result, command, input).dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                     : text_of(result, command, input.scene));
    return 0;
}

}  // namespace patchlight
