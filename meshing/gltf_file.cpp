#include "meshing/gltf_file.h"

#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace patchlight {

namespace {

using nlohmann::json;

constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t bin_chunk = 0x004E4942;
constexpr std::size_t deepest_nesting = 128;

[[noreturn]] void refuse(const std::string& name, const std::string& reason)
{
    throw SceneError("gltf", fmt::format("{}: {}", name, reason));
}

std::uint32_t word_at(const std::string& bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 4; ++k) word |= std::uint32_t{static_cast<unsigned char>(bytes[offset + k])} << (8 * k);
    return word;
}

void append_word(std::string& bytes, std::size_t word)
{
    for (std::size_t k = 0; k < 4; ++k) bytes.push_back(static_cast<char>((word >> (8 * k)) & 0xFFU));
}

/// The JSON text of a file, and the binary chunk of a GLB.
struct Parts {
    bool is_glb = false;
    std::string text;
    std::string binary;
};

Parts split(std::string bytes, const std::string& name)
{
    if (!bytes.starts_with("glTF")) return {false, std::move(bytes), {}};
    Parts parts;
    parts.is_glb = true;
    if (bytes.size() < 20) refuse(name, fmt::format("GLB of {} bytes is truncated", bytes.size()));
    if (word_at(bytes, 4) != 2) refuse(name, fmt::format("GLB version {} is not 2", word_at(bytes, 4)));
    const std::size_t claimed = word_at(bytes, 8);
    if (claimed > bytes.size()) refuse(name, fmt::format("GLB claims {} bytes, has {}", claimed, bytes.size()));
    std::size_t offset = 12;
    while (offset + 8 <= claimed) {
        const std::size_t length = word_at(bytes, offset);
        const std::uint32_t kind = word_at(bytes, offset + 4);
        offset += 8;
        if (length > claimed - offset) {
            refuse(name, fmt::format("GLB chunk claims {} bytes, {} are left", length, claimed - offset));
        }
        if (kind == json_chunk && parts.text.empty()) parts.text = bytes.substr(offset, length);
        if (kind == bin_chunk && parts.binary.empty()) parts.binary = bytes.substr(offset, length);
        offset += length;
    }
    return parts;
}

/// Parsers of JSON recurse: refuse what would exhaust the stack.
void check_nesting(const std::string& text, const std::string& name)
{
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > deepest_nesting) refuse(name, "JSON is nested too deeply");
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
}

json parse(const std::string& text, const std::string& name)
{
    check_nesting(text, name);
    json document;
    try {
        document = json::parse(text);
    } catch (const json::exception& failure) {
        refuse(name, fmt::format("not a glTF file: {}", failure.what()));
    }
    if (!document.is_object()) refuse(name, "not a glTF file: no JSON object");
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object()) refuse(name, "not a glTF file: no asset");
    const auto version = asset->find("version");
    if (version == asset->end() || !version->is_string()) refuse(name, "not a glTF file: no version");
    if (!version->get<std::string>().starts_with("2")) {
        refuse(name, fmt::format("glTF version {} is not 2", version->get<std::string>()));
    }
    return document;
}

json& array_of(json& document, const char* key, const std::string& name)
{
    json& array = document[key];
    if (array.is_null()) array = json::array();
    if (!array.is_array()) refuse(name, fmt::format("\"{}\" is not an array", key));
    for (const json& item : array) {
        if (!item.is_object()) refuse(name, fmt::format("\"{}\" holds something that is no object", key));
    }
    return array;
}

std::size_t count_in(const json& object, const char* key, const std::string& name)
{
    const auto value = object.find(key);
    if (value == object.end()) return 0;
    if (!value->is_number_unsigned()) refuse(name, fmt::format("\"{}\" is not a count", key));
    return value->get<std::size_t>();
}

void check_buffer_views(json& document, const std::string& name)
{
    const json& buffers = array_of(document, "buffers", name);
    const json& views = array_of(document, "bufferViews", name);
    for (std::size_t v = 0; v < views.size(); ++v) {
        const std::size_t buffer = count_in(views[v], "buffer", name);
        if (buffer >= buffers.size())
            refuse(name, fmt::format("buffer view {} refers to buffer {} of {}", v, buffer, buffers.size()));
        const std::size_t length = count_in(buffers[buffer], "byteLength", name);
        const std::size_t offset = count_in(views[v], "byteOffset", name),
                          size = count_in(views[v], "byteLength", name);
        if (offset > length || size > length - offset) {
            refuse(name, fmt::format("buffer view {} ends past its buffer's {} bytes", v, length));
        }
    }
}

/// Buffers in files outside the folder become one byte that nobody reads.
void refuse_buffers_outside(json& document, GltfFile& gltf)
{
    json& buffers = array_of(document, "buffers", gltf.name);
    gltf.buffer_refused.assign(buffers.size(), false);
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        const auto uri = buffers[b].find("uri");
        if (uri == buffers[b].end()) continue;
        if (!uri->is_string()) refuse(gltf.name, fmt::format("buffer {}: its uri is no text", b));
        const auto text = uri->get<std::string>();
        if (text.starts_with("data:")) continue;
        const auto target = gltf.folder.resolve(percent_decoded(text));
        std::error_code failure;
        if (target && !std::filesystem::exists(*target, failure)) {
            refuse(gltf.name, fmt::format("buffer {}: {} is missing", b, text));
        }
        if (target) continue;
        gltf.buffer_refused[b] = true;
        gltf.warnings.push_back(
            fmt::format("{}: buffer {} ({}) is outside the scene's folder and was not opened", gltf.name, b, text));
        *uri = "data:application/octet-stream;base64,AA==";
        buffers[b]["byteLength"] = 1;
    }
}

void warn_of_what_is_left_out(const json& document, GltfFile& gltf)
{
    for (const char* key : {"animations", "skins"}) {
        const auto value = document.find(key);
        if (value == document.end() || value->empty()) continue;
        gltf.warnings.push_back(fmt::format("{}: {} are ignored", gltf.name, key));
    }
    const auto extensions = document.find("extensions");
    if (extensions != document.end() && extensions->is_object() && extensions->contains("KHR_lights_punctual")) {
        gltf.warnings.push_back(fmt::format("{}: lights without area are ignored", gltf.name));
    }
}

/// The document with only what this reader looks at, as a file again.
std::string rebuilt(const json& document, const Parts& parts)
{
    json kept = json::object();
    for (const char* key : {"asset", "scene", "scenes", "nodes", "meshes", "materials", "textures", "accessors",
                            "bufferViews", "buffers", "cameras"}) {
        if (const auto value = document.find(key); value != document.end()) kept[key] = *value;
    }
    std::string text = kept.dump(-1, ' ', false, json::error_handler_t::replace);
    if (!parts.is_glb) return text;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    append_word(bytes, 2);
    const std::size_t binary = parts.binary.empty() ? 0 : 8 + parts.binary.size();
    append_word(bytes, 20 + text.size() + binary);
    append_word(bytes, text.size());
    append_word(bytes, json_chunk);
    bytes += text;
    if (binary > 0) {
        append_word(bytes, parts.binary.size());
        append_word(bytes, bin_chunk);
        bytes += parts.binary;
    }
    return bytes;
}

/// tinygltf's view of the file system: the scene's folder, whatever path it asks for.
tinygltf::FsCallbacks folder_callbacks(const SceneFolder& folder)
{
    static constexpr auto inside = [](const std::string& path, void* user) -> std::optional<std::filesystem::path> {
        const auto& scene_folder = *static_cast<const SceneFolder*>(user);
        const std::string prefix = scene_folder.path().string() + "/";
        if (!path.starts_with(prefix)) return {};
        return scene_folder.resolve(path.substr(prefix.size()));
    };
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string& path, void* user) {
        const auto target = inside(path, user);
        std::error_code failure;
        return target && std::filesystem::is_regular_file(*target, failure);
    };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error, const std::string& path,
                                 void* user) {
        const auto target = inside(path, user);
        if (!target) return false;
        try {
            const std::string bytes = read_whole_file(*target);
            out->assign(bytes.begin(), bytes.end());
        } catch (const SceneError& failure) {
            *error += failure.what();
            return false;
        }
        return true;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = const_cast<SceneFolder*>(&folder);
    return callbacks;
}

std::string one_line(std::string text)
{
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace

std::string percent_decoded(const std::string& uri)
{
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned value = 0;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(&uri[i + 1], &uri[i + 1] + 2, value, 16).ptr == &uri[i + 1] + 2) {
            text.push_back(static_cast<char>(value));
            i += 2;
        } else {
            text.push_back(uri[i]);
        }
    }
    return text;
}

GltfFile load_gltf(const std::filesystem::path& file)
{
    const std::string name = file.filename().string();
    const Parts parts = split(read_whole_file(file), name);
    json document = parse(parts.text, name);
    GltfFile gltf{name, SceneFolder(file), {}, {}, {}, {}, {}};
    check_buffer_views(document, name);
    refuse_buffers_outside(document, gltf);
    gltf.images = array_of(document, "images", name);
    for (const json& extension : document.value("extensionsRequired", json::array())) {
        if (extension.is_string()) gltf.required_extensions.push_back(extension.get<std::string>());
    }
    warn_of_what_is_left_out(document, gltf);

    const std::string bytes = rebuilt(document, parts);
    if (bytes.size() > std::numeric_limits<unsigned>::max()) refuse(name, "is larger than 4 GiB");
    const auto size = static_cast<unsigned>(bytes.size());
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(folder_callbacks(gltf.folder));
    std::string error, warning;
    const std::string folder = gltf.folder.path().string();
    const bool read =
        parts.is_glb ? reader.LoadBinaryFromMemory(&gltf.model, &error, &warning,
                                                   reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                     : reader.LoadASCIIFromString(&gltf.model, &error, &warning, bytes.data(), size, folder);
    if (!read) refuse(name, one_line(error));
    if (!warning.empty()) gltf.warnings.push_back(fmt::format("{}: {}", name, one_line(warning)));
    return gltf;
}

}  // namespace patchlight
