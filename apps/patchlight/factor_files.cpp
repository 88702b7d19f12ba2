#include "apps/patchlight/factor_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>

namespace patchlight {

namespace {

static_assert(std::endian::native == std::endian::little, "the binary file is written as memory has it");
static_assert(sizeof(std::size_t) == 8);

constexpr std::size_t piece_size = std::size_t{1} << 22;

/// Collects text and hands it on in pieces.
class TextPieces {
public:
    TextPieces(const FileWriter::Sink& sink, const Checkpoint& check) : sink_(sink), check_(check) {}

    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values)
    {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
        if (text_.size() >= piece_size) {
            flush();
        }
    }

    void flush()
    {
        check_();
        sink_(std::span(reinterpret_cast<const unsigned char*>(text_.data()), text_.size()));
        text_.clear();
    }

private:
    const FileWriter::Sink& sink_;
    const Checkpoint& check_;
    fmt::memory_buffer text_;
};

template <class Value>
void put(std::span<const Value> values, const FileWriter::Sink& sink, const Checkpoint& check)
{
    std::span<const unsigned char> bytes(reinterpret_cast<const unsigned char*>(values.data()), values.size_bytes());
    while (!bytes.empty()) {
        check();
        const std::size_t count = std::min(bytes.size(), piece_size);
        sink(bytes.first(count));
        bytes = bytes.subspan(count);
    }
}

/// A name as a field: quoted where it would be taken apart.
std::string csv_field(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    }
    return quoted + "\"";
}

}  // namespace

void write_factors_csv(const std::filesystem::path& file, const FormFactorMatrix& matrix, FileWriter& writer,
                       const Checkpoint& check)
{
    writer.write_pieces(file, [&](const FileWriter::Sink& sink) {
        TextPieces out(sink, check);
        out.add("row,column,factor\n");
        for (std::size_t i = 0; i < matrix.size(); ++i) {
            for (std::size_t k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k) {
                out.add("{},{},{:.17g}\n", i, matrix.columns[k], matrix.factors[k]);
            }
        }
        out.flush();
    });
}

void write_factors_binary(const std::filesystem::path& file, const FormFactorMatrix& matrix,
                          const PatchField<double>& areas, FileWriter& writer, const Checkpoint& check)
{
    writer.write_pieces(file, [&](const FileWriter::Sink& sink) {
        static constexpr unsigned char magic[] = {'P', 'L', 'F', 'F', 'C', 'S', 'R', '1'};
        const std::uint64_t counts[] = {matrix.size(), matrix.factors.size()};
        sink(magic);
        put(std::span<const std::uint64_t>(counts), sink, check);
        put(std::span<const std::size_t>(matrix.row_start), sink, check);
        put(std::span<const std::uint32_t>(matrix.columns), sink, check);
        put(std::span<const double>(matrix.factors), sink, check);
        put(areas.values(), sink, check);
    });
}

void write_patches_csv(const std::filesystem::path& file, const Scene& scene, const PatchMesh& mesh, FileWriter& writer,
                       const Checkpoint& check)
{
    writer.write_pieces(file, [&](const FileWriter::Sink& sink) {
        TextPieces out(sink, check);
        out.add("patch,surface,object,area,x,y,z,nx,ny,nz\n");
        for (const PatchId patch : mesh.patches()) {
            const SurfaceId surface = mesh.surface(patch);
            const Vec3 at = (mesh.centroid(patch) + scene.center) / scene.unit;
            const Vec3& n = scene.surface(surface).frame.n;
            out.add("{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", patch.value, surface.value,
                    csv_field(scene.objects[scene.surface(surface).object.value]), mesh.area(patch), at.x, at.y, at.z,
                    n.x, n.y, n.z);
        }
        out.flush();
    });
}

}  // namespace patchlight
