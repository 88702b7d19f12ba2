#include "apps/run/exporting.h"

#include "apps/run/element_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <vector>

namespace patchlight {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they are in memory");

template <class T>
void append(std::string& out, T value)
{
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out.append(bytes, sizeof(T));
}

unsigned char srgb_byte(double linear)
{
    linear = std::clamp(linear, 0.0, 1.0);
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(encoded * 255));
}

std::string ply_header(std::size_t vertices, std::size_t faces)
{
    return fmt::format("ply\nformat binary_little_endian 1.0\n"
                       "comment patchlight: B in W/m2, colours are sRGB\n"
                       "element vertex {}\n"
                       "property double x\nproperty double y\nproperty double z\n"
                       "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                       "property float radiosity_r\nproperty float radiosity_g\nproperty float radiosity_b\n"
                       "element face {}\n"
                       "property list uchar uint vertex_indices\nproperty uint surface\n"
                       "end_header\n",
                       vertices, faces);
}

/// The triangles of a patch, by its nodes.
std::span<const std::array<std::size_t, 3>> faces_of(std::size_t nodes_per_patch)
{
    static constexpr std::array<std::array<std::size_t, 3>, 1> linear{{{0, 1, 2}}};
    static constexpr std::array<std::array<std::size_t, 3>, 4> quadratic{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
    if (nodes_per_patch == 3) {
        return linear;
    }
    return quadratic;
}

/// As the scene's file has it.
Vec3 in_file(const Scene& scene, const Vec3& p)
{
    return (p + scene.center) / scene.unit;
}

/// A name as a CSV field: quoted when it must be.
std::string csv_field(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (char c : text) {
        quoted += c;
        if (c == '"') {
            quoted += c;
        }
    }
    return quoted + "\"";
}

}  // namespace

double display_scale(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B)
{
    std::vector<double> lit;
    for (VertexId v : mesh.vertices()) {
        const double highest = std::max({vertex_B[v].r, vertex_B[v].g, vertex_B[v].b});
        if (highest > 0 && !scene.material_of(mesh.surface(v)).emits()) {
            lit.push_back(highest / std::numbers::pi);
        }
    }
    if (lit.empty()) {
        return 1;
    }
    const auto high = lit.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), high, lit.end());
    return 0.8 / *high;
}

std::string encode_ply(const StoredSolution& solution)
{
    const PatchMesh& mesh = solution.mesh;
    const ElementNodes nodes = element_nodes(solution);
    const auto faces = faces_of(nodes.per_patch);
    std::string out = ply_header(nodes.positions.size(), faces.size() * mesh.patch_count());
    const double scale = display_scale(solution.scene, mesh, solution.vertex_B) / std::numbers::pi;
    for (std::size_t i = 0; i < nodes.positions.size(); ++i) {
        const Vec3& p = nodes.positions[i];
        const Rgb& B = nodes.B[i];
        for (int k = 0; k < 3; ++k) {
            append(out, p[k]);
        }
        for (int band = 0; band < 3; ++band) {
            append(out, srgb_byte(scale * B[band]));
        }
        for (int band = 0; band < 3; ++band) {
            append(out, static_cast<float>(B[band]));
        }
    }
    for (PatchId patch : mesh.patches()) {
        const std::uint32_t* node = &nodes.of_patches[patch.value * nodes.per_patch];
        for (const auto& face : faces) {
            append(out, static_cast<unsigned char>(3));
            for (std::size_t corner : face) {
                append(out, node[corner]);
            }
            append(out, mesh.surface(patch).value);
        }
    }
    return out;
}

std::string encode_csv(const StoredSolution& solution)
{
    std::string out = "patch,surface,material,x,y,z,area,Br,Bg,Bb,eta\n";
    for (PatchId patch : solution.mesh.patches()) {
        const SurfaceId surface = solution.mesh.surface(patch);
        const Vec3 c = in_file(solution.scene, solution.mesh.centroid(patch));
        const Rgb& B = solution.B[patch];
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", patch.value, surface.value,
                           csv_field(solution.scene.material_of(surface).name), c.x, c.y, c.z,
                           solution.mesh.area(patch), B.r, B.g, B.b, solution.eta[patch]);
    }
    return out;
}

}  // namespace patchlight
