#include "apps/run/vtu_file.h"

#include "apps/run/element_nodes.h"
#include "apps/run/markup_text.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace patchlight {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they are in memory");

constexpr std::uint8_t vtk_triangle = 5, vtk_quadratic_triangle = 22;

template <class T>
constexpr const char* vtk_type = nullptr;
template <>
constexpr const char* vtk_type<double> = "Float64";
template <>
constexpr const char* vtk_type<std::int32_t> = "Int32";
template <>
constexpr const char* vtk_type<std::int64_t> = "Int64";
template <>
constexpr const char* vtk_type<std::uint8_t> = "UInt8";

/// The XML that names arrays, and their bytes.
class Arrays {
public:
    void open(const std::string& element) { xml_ += "<" + element + ">\n"; }
    void close(const std::string& element) { xml_ += "</" + element + ">\n"; }

    template <class T>
    void add(const std::string& name, std::span<const T> values, int components = 1)
    {
        xml_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                            "offset=\"{}\"/>\n",
                            vtk_type<T>, name, components, bytes_.size());
        const std::uint64_t size = values.size_bytes();
        bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    }
    template <class T>
    void add(const std::string& name, const std::vector<T>& values)
    {
        add(name, std::span<const T>(values));
    }
    void add(const std::string& name, std::span<const Vec3> values)
    {
        static_assert(sizeof(Vec3) == 3 * sizeof(double));
        const double* first = values.empty() ? nullptr : &values.front().x;
        add(name, std::span<const double>(first, 3 * values.size()), 3);
    }

    std::string file(std::size_t points, std::size_t cells) const
    {
        return fmt::format("<?xml version=\"1.0\"?>\n"
                           "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                           "header_type=\"UInt64\">\n<UnstructuredGrid>\n"
                           "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n{}</Piece>\n</UnstructuredGrid>\n"
                           "<AppendedData encoding=\"raw\">\n_",
                           points, cells, xml_) +
               bytes_ + "\n</AppendedData>\n</VTKFile>\n";
    }

private:
    std::string xml_, bytes_;
};

template <class T, class Value>
std::vector<T> of_patches(const PatchMesh& mesh, const Value& value)
{
    std::vector<T> values;
    values.reserve(mesh.patch_count());
    for (const PatchId patch : mesh.patches()) values.push_back(static_cast<T>(value(patch)));
    return values;
}

void add_cells(const PatchMesh& mesh, const ElementNodes& nodes, Arrays& arrays)
{
    const bool quadratic = nodes.per_patch == 6;
    arrays.open("Cells");
    arrays.add("connectivity", std::vector<std::int64_t>(nodes.of_patches.begin(), nodes.of_patches.end()));
    arrays.add("offsets", of_patches<std::int64_t>(mesh, [&](PatchId p) { return (p.value + 1) * nodes.per_patch; }));
    arrays.add("types",
               std::vector<std::uint8_t>(mesh.patch_count(), quadratic ? vtk_quadratic_triangle : vtk_triangle));
    arrays.close("Cells");
}

void add_cell_data(const StoredSolution& solution, Arrays& arrays)
{
    const PatchMesh& mesh = solution.mesh;
    const auto surface = [&](PatchId p) -> const Surface& { return solution.scene.surface(mesh.surface(p)); };
    arrays.open("CellData");
    arrays.add("radiosity", solution.B.values());
    arrays.add("error", solution.eta.values());
    arrays.add("area", mesh.areas().values());
    arrays.add("surface", of_patches<std::int32_t>(mesh, [&](PatchId p) { return mesh.surface(p).value; }));
    arrays.add("material", of_patches<std::int32_t>(mesh, [&](PatchId p) { return surface(p).material.value; }));
    arrays.add("level", of_patches<std::int32_t>(mesh, [&](PatchId p) {
                   return std::max(0L, std::lround(std::log2(surface(p).area / mesh.area(p))));
               }));
    arrays.close("CellData");
}

}  // namespace

std::string encode_vtu(const StoredSolution& solution)
{
    const ElementNodes nodes = element_nodes(solution);
    Arrays arrays;
    arrays.open("PointData");
    arrays.add("radiosity", std::span<const Rgb>(nodes.B));
    arrays.close("PointData");
    add_cell_data(solution, arrays);
    arrays.open("Points");
    arrays.add("position", std::span<const Vec3>(nodes.positions));
    arrays.close("Points");
    add_cells(solution.mesh, nodes, arrays);
    return arrays.file(nodes.positions.size(), solution.mesh.patch_count());
}

std::string encode_pvd(const std::vector<std::pair<int, std::string>>& files)
{
    std::string out = "<?xml version=\"1.0\"?>\n"
                      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const auto& [cycle, name] : files) {
        out += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", cycle, markup_text(as_utf8(name)));
    }
    return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace patchlight
