#include "meshing/read_mtl.h"

#include "meshing/obj_text.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace patchlight {

namespace {

/// The colours as the text spells them: the reader rounds numbers, and takes `nan` for 0.
struct MtlColours {
    std::map<std::string, Rgb> Kd, Ke;
};

Rgb scan_colour(std::string_view rest, const std::string& file_name, std::size_t line, const std::string& material)
{
    Rgb colour{0.0};
    for (int k = 0; k < 3; ++k) {
        const std::string_view word = next_word(rest);
        // One number stands for a grey.
        colour[k] = k > 0 && word.empty() ? colour[k - 1] : number_or_nan(word);
        if (!std::isfinite(colour[k])) {
            throw SceneError("material", fmt::format("{}:{}: material {}: \"{}\" is no finite number", file_name, line,
                                                     material, word));
        }
    }
    return colour;
}

MtlColours scan_mtl(std::string_view text, const std::string& file_name)
{
    MtlColours colours;
    LineReader lines(text);
    std::string_view line;
    std::string material;
    while (lines.next(line)) {
        const std::string_view keyword = next_word(line);
        if (keyword == "newmtl") material = trimmed(line);
        if (keyword != "Kd" && keyword != "Ke") continue;
        std::string_view ahead = line;
        const std::string_view first = next_word(ahead);
        if (first == "spectral" || first == "xyz") continue;
        auto& colour = keyword == "Kd" ? colours.Kd : colours.Ke;
        colour[material] = scan_colour(line, file_name, lines.number(), material);
    }
    return colours;
}

void warn_of_what_is_left_out(const tinyobj::material_t& read, std::vector<std::string>& warnings)
{
    const auto texture = [&](const std::string& name, const char* factor) {
        if (name.empty()) return;
        warnings.push_back(
            fmt::format("material {}: texture {} is not read; {} is used for all of it", read.name, name, factor));
    };
    texture(read.diffuse_texname, "Kd");
    texture(read.emissive_texname, "Ke");
    if (read.dissolve < 1) {
        warnings.push_back(fmt::format("material {}: transparency is ignored, it is opaque here", read.name));
    }
}

}  // namespace

void read_mtl(const std::string& text, const std::string& file_name, MtlLibrary& library)
{
    const MtlColours colours = scan_mtl(text, file_name);
    std::map<std::string, int> indices;
    std::vector<tinyobj::material_t> read;
    std::string warning, error;
    std::istringstream stream(text);
    tinyobj::LoadMtl(&indices, &read, &stream, &warning, &error);
    for (const tinyobj::material_t& material : read) {
        if (material.name.empty() || library.materials.contains(material.name)) continue;
        Material ours;
        ours.name = material.name;
        if (const auto Ke = colours.Ke.find(ours.name); Ke != colours.Ke.end())
            ours.emission = std::numbers::pi * Ke->second;
        const auto Kd = colours.Kd.find(ours.name);
        if (Kd != colours.Kd.end()) {
            ours.reflectance = Kd->second;
        } else if (ours.emits()) {
            ours.reflectance = Rgb{0.0};
        } else {
            library.warnings.push_back(fmt::format("material {}: no Kd, reflectance 0.5 is used", ours.name));
        }
        warn_of_what_is_left_out(material, library.warnings);
        library.materials.emplace(ours.name, ours);
    }
}

void read_material_files(const std::string& names, const SceneFolder& folder, const std::string& obj_name,
                         MtlLibrary& library)
{
    const auto read_one = [&](const std::string& name, bool quiet) {
        const auto file = folder.resolve(name);
        std::error_code failure;
        if (!file || !std::filesystem::is_regular_file(*file, failure)) {
            if (quiet) return false;
            library.warnings.push_back(
                file ? fmt::format("{}: material file {} is missing", obj_name, name)
                     : fmt::format("{}: material file {} is outside the scene's folder and was not opened", obj_name,
                                   name));
            return false;
        }
        read_mtl(read_whole_file(*file), file->filename().string(), library);
        return true;
    };
    // One name with spaces, or several names: the line doesn't tell.
    const bool several = names.find_first_of(" \t") != std::string::npos;
    if (read_one(names, several) || !several) return;
    std::string_view rest = names;
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest)) {
        read_one(std::string(name), false);
    }
}

}  // namespace patchlight
