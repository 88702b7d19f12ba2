#include "apps/run/stored_factors.h"

#include "apps/run/run_record.h"
#include "apps/run/sha256.h"
#include "apps/run/stored_scene.h"
#include "meshing/scene_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ranges>
#include <span>

namespace patchlight {

namespace {

constexpr std::string_view magic = "patchlight-factors/1\n";
constexpr std::size_t digest_size = 64;
constexpr std::size_t deepest_json = 16;

/// The scene with what factors don't depend on left out.
Scene without_light(Scene scene)
{
    scene.name.clear();
    scene.objects.assign(scene.objects.size(), {});
    scene.views.clear();
    for (Material& m : scene.materials)
        m = {.name = {},
             .reflectance = Rgb(m.reflects() ? 1 : 0),
             .emission = Rgb(m.emits() ? 1 : 0),
             .two_sided = m.two_sided};
    return scene;
}

template <std::ranges::contiguous_range R>
void append(std::string& out, const R& values)
{
    static_assert(std::is_trivially_copyable_v<std::ranges::range_value_t<R>>);
    out.append(reinterpret_cast<const char*>(std::ranges::data(values)),
               std::ranges::size(values) * sizeof(std::ranges::range_value_t<R>));
}

std::string mesh_digest(const PatchMeshArrays& mesh)
{
    std::string bytes = std::to_string(mesh.positions.size()) + ' ' + std::to_string(mesh.triangles.size()) + '\n';
    append(bytes, mesh.positions);
    append(bytes, mesh.triangles);
    append(bytes, mesh.patch_surface);
    append(bytes, mesh.vertex_surface);
    for (const MeshLine& line : mesh.lines) {
        append(bytes, line.left);
        append(bytes, line.right);
        bytes += line.beyond ? 'b' : '-';
    }
    return sha256_hex(bytes);
}

bool single_precision(std::span<const double> values)
{
    return std::ranges::all_of(values, [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
}

void append(std::string& out, const FormFactorMatrix& F)
{
    const bool single = single_precision(F.factors);
    const std::uint64_t sizes[] = {F.size(), F.columns.size(), F.rays, single ? 4U : 8U};
    append(out, sizes);
    if (F.size() == 0) return;
    const std::vector<std::uint64_t> starts(F.row_start.begin(), F.row_start.end());
    append(out, starts);
    append(out, F.columns);
    if (single)
        append(out, std::vector<float>(F.factors.begin(), F.factors.end()));
    else
        append(out, F.factors);
    for (const PatchField<double>* field : {&F.raw_sum, &F.escaped, &F.backs})
        for (std::size_t i = 0; i < F.size(); ++i) append(out, std::array{(*field)[PatchId(i)]});
}

[[noreturn]] void broken(const char* cause)
{
    throw SceneError("factors", cause);
}

/// Hands out arrays one after the other.
class FactorReader {
public:
    explicit FactorReader(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    std::vector<T> take(std::size_t count)
    {
        if (count > bytes_.size() / sizeof(T)) broken("is cut short");
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), bytes_.data(), count * sizeof(T));
        bytes_.remove_prefix(count * sizeof(T));
        return values;
    }
    std::size_t left() const { return bytes_.size(); }
    bool done() const { return bytes_.empty(); }

private:
    std::string_view bytes_;
};

PatchField<double> take_field(FactorReader& reader, std::size_t rows)
{
    const std::vector<double> values = reader.take<double>(rows);
    PatchField<double> field(rows);
    for (std::size_t i = 0; i < rows; ++i) field[PatchId(i)] = values[i];
    return field;
}

FormFactorMatrix take_matrix(FactorReader& reader, std::size_t patches)
{
    const auto sizes = reader.take<std::uint64_t>(4);
    if (sizes[0] > reader.left()) broken("is cut short");
    FormFactorMatrix F;
    F.rays = sizes[2];
    if (sizes[0] == 0) return F;
    const auto starts = reader.take<std::uint64_t>(sizes[0] + 1);
    if (starts.front() != 0 || starts.back() != sizes[1] || !std::ranges::is_sorted(starts)) broken("has no such rows");
    F.row_start.assign(starts.begin(), starts.end());
    F.columns = reader.take<std::uint32_t>(sizes[1]);
    if (sizes[3] == 4) {
        const auto factors = reader.take<float>(sizes[1]);
        F.factors.assign(factors.begin(), factors.end());
    } else {
        F.factors = reader.take<double>(sizes[1]);
    }
    if (std::ranges::any_of(F.columns, [&](std::uint32_t j) { return j >= patches; }) ||
        !std::ranges::all_of(F.factors, [](double x) { return x >= 0 && std::isfinite(x); }))
        broken("holds what are no factors of its mesh");
    F.raw_sum = take_field(reader, sizes[0]);
    F.escaped = take_field(reader, sizes[0]);
    F.backs = take_field(reader, sizes[0]);
    return F;
}

/// The first part that isn't the same.
std::string differing_part(const Json& stored, const Json& key)
{
    for (const auto& [part, value] : key.items())
        if (!stored.is_object() || !stored.contains(part) || stored.at(part) != value) return part;
    return stored.size() == key.size() ? "" : "key";
}

/// What lies between magic and digest, once the digest is right.
std::string_view body_of(std::string_view bytes)
{
    if (!bytes.starts_with(magic) || bytes.size() < magic.size() + digest_size) broken("isn't a file of factors");
    const std::string_view all = bytes.substr(0, bytes.size() - digest_size);
    if (sha256_hex(all) != bytes.substr(all.size())) broken("is cut short or was changed: its SHA-256 differs");
    return all.substr(magic.size());
}

}  // namespace

Json factors_key(const Scene& scene, const PatchMeshArrays& mesh, const AdaptiveOptions& options,
                 const std::string& instruction_set)
{
    Json solve = json_of(options);
    return {{"numeric", numeric_version()},
            {"instruction_set", instruction_set},
            {"scene", scene_digest(without_light(scene))},
            {"mesh", mesh_digest(mesh)},
            {"form_factors", solve.at("form_factors")},
            {"gather", solve.at("gather")},
            {"estimate", solve.at("estimate")},
            {"elements", solve.at("elements")},
            {"direct", solve.at("direct")}};
}

std::string encode_factors(const KeptRows& rows, const Json& key)
{
    std::string bytes(magic);
    bytes += key.dump() + '\n';
    for (const FormFactorMatrix* F : {&rows.patches, &rows.estimate, &rows.nodes}) append(bytes, *F);
    return bytes + sha256_hex(bytes);
}

StoredFactors decode_factors(std::string_view bytes, const Json& key, std::size_t patches)
{
    const std::string_view body = body_of(bytes);
    const std::size_t end = body.find('\n');
    if (end == std::string_view::npos || json_depth(body.substr(0, end)) > deepest_json) broken("has no key");
    const Json stored = Json::parse(body.substr(0, end), nullptr, false);
    const std::string differs = differing_part(stored, key);
    if (!differs.empty()) return {{}, differs};
    FactorReader reader(body.substr(end + 1));
    KeptRows rows;
    for (FormFactorMatrix* F : {&rows.patches, &rows.estimate, &rows.nodes}) *F = take_matrix(reader, patches);
    if (!reader.done()) broken("holds more than its rows");
    return {std::move(rows), ""};
}

double factors_bytes(double elements, const AdaptiveOptions& options)
{
    const bool rays = options.form_factors.method == FormFactorMethod::hemisphere;
    const auto row = [&](int most) { return 8 * std::min(elements, static_cast<double>(most)) + 32; };
    // Of a large mesh's nodes, vertices are half as many as elements, edges three halves.
    const double estimate = options.estimate.indicator == Indicator::vertex_difference ? 0.5 : 3;
    const double nodes = options.elements == Elements::quadratic ? 2 : 0.5;
    const int node_rays = options.gather.rays > 0 ? options.gather.rays : GatherOptions{}.rays;
    return elements * ((rays ? row(options.form_factors.rays) : 12 * elements) + estimate * row(options.estimate.rays) +
                       nodes * row(node_rays));
}

}  // namespace patchlight
