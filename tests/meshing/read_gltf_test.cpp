#include "written_scene.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <chrono>
#include <cstring>
#include <numbers>

using namespace patchlight;
using namespace patchlight::testing;
using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

namespace {

std::string base64(const std::string& bytes)
{
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text.push_back(i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63U] : '=');
        }
    }
    return text;
}

template <class T>
std::string bytes_of(const std::vector<T>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A lamp of 2 × 2 m in the plane z = 0, front up.
const std::string square_bytes =
    bytes_of<float>({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0}) + bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3});

json square_document()
{
    return {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"name", "square"}, {"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}}}},
        {"materials",
         {{{"name", "glow"},
           {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}}},
           {"emissiveFactor", {1, 0.5, 0.25}},
           {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
          {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
          {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}}},
        {"buffers", {{{"byteLength", 60}, {"uri", "data:application/octet-stream;base64," + base64(square_bytes)}}}}};
}

LoadedScene read_document(const json& document, const SceneOptions& options = {})
{
    const TemporaryFolder folder;
    return read_scene(folder.write("scene.gltf", document.dump()), options);
}

std::string error_of_document(const json& document)
{
    return error_of([&] { read_document(document); });
}

std::string glb(const std::string& text, const std::string& binary)
{
    const auto word = [](std::size_t value) { return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)}); };
    std::string padded = text;
    padded.resize((text.size() + 3) / 4 * 4, ' ');
    return "glTF" + word(2) + word(28 + padded.size() + binary.size()) + word(padded.size()) + "JSON" + padded +
           word(binary.size()) + std::string("BIN\0", 4) + binary;
}

Vec3 normal_of(const LoadedScene& loaded)
{
    return loaded.scene.surfaces.at(0).frame.n;
}

}  // namespace

TEST(ReadGltf, materials_have_their_meaning)
{
    const Scene scene = read_document(square_document()).scene;
    ASSERT_EQ(scene.surfaces.size(), 1U);
    EXPECT_NEAR(scene.surfaces[0].area, 4, 1e-14);
    EXPECT_EQ(normal_of({scene, {}}), (Vec3{0, 0, 1}));
    const Material& glow = scene.materials.at(0);
    EXPECT_EQ(glow.reflectance, (Rgb{0.5, 0.25, 0.125}));
    EXPECT_NEAR(glm::distance(glow.emission, std::numbers::pi * Rgb{4, 2, 1}), 0, 1e-14);
    EXPECT_FALSE(glow.two_sided);
    EXPECT_EQ(scene.objects.at(0), "square");
}

TEST(ReadGltf, no_material_is_half_and_white_is_the_largest_allowed)
{
    json document = square_document();
    document["materials"][0].erase("pbrMetallicRoughness");
    const LoadedScene white = read_document(document);
    EXPECT_EQ(white.scene.materials[0].reflectance, Rgb{0.95});
    EXPECT_THAT(white.report.warnings, Contains("material glow: a reflectance of 1 is used as 0.95"));
    document["meshes"][0]["primitives"][0].erase("material");
    SceneOptions options;
    options.emitters["default"] = Rgb{1.0};
    EXPECT_EQ(read_document(document, options).scene.materials[0].reflectance, Rgb{0.5});
    document = square_document();
    for (const double bad : {1.5, -0.25}) {
        document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][1] = bad;
        EXPECT_THAT(error_of_document(document), MatchesRegex("material: scene.gltf: material glow: reflectance .*"));
    }
}

TEST(ReadGltf, double_sided_materials_are_two_surfaces)
{
    json document = square_document();
    document["materials"][0]["doubleSided"] = true;
    EXPECT_EQ(read_document(document).scene.surfaces.size(), 2U);
}

TEST(ReadGltf, nodes_place_their_meshes)
{
    json document = square_document();
    const double half = std::sqrt(0.5);
    // Scaled by (2, 1, 1), turned by 90° about x (z becomes −y), moved; then the child by a matrix.
    document["nodes"] = {
        {{"children", {1}}, {"translation", {10, 20, 30}}, {"rotation", {half, 0, 0, half}}, {"scale", {2, 1, 1}}},
        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 0, 1}}}};
    const LoadedScene loaded = read_document(document);
    EXPECT_NEAR(loaded.scene.surfaces[0].area, 8, 1e-12);
    EXPECT_NEAR(glm::distance(normal_of(loaded), Vec3{0, -1, 0}), 0, 1e-14);
    // The square's middle (1, 1, 0) → child (2, 2, 0) → scaled (4, 2, 0) → turned (4, 0, 2) → moved (14, 20, 32).
    EXPECT_NEAR(glm::distance(loaded.scene.center, Vec3{14, 20, 32}), 0, 1e-12);
}

TEST(ReadGltf, a_mirrored_node_keeps_the_front_in_front)
{
    json document = square_document();
    document["nodes"][0]["scale"] = {-1, 1, 1};
    EXPECT_EQ(normal_of(read_document(document)), (Vec3{0, 0, 1}));
    document["nodes"][0]["scale"] = {1, 1, -1};
    EXPECT_EQ(normal_of(read_document(document)), (Vec3{0, 0, -1}));
}

TEST(ReadGltf, cameras_are_views)
{
    json document = square_document();
    document["cameras"] = {
        {{"type", "perspective"},
         {"name", "front"},
         {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0.1}}}}};
    document["nodes"].push_back({{"camera", 0}, {"translation", {1, 1, 8}}});
    document["nodes"].push_back({{"camera", 1}, {"name", "flat"}});
    document["scenes"][0]["nodes"] = {0, 1, 2};
    SceneOptions options;
    options.unit = 0.5;
    const LoadedScene loaded = read_document(document, options);
    ASSERT_EQ(loaded.scene.views.size(), 1U);
    const View& view = loaded.scene.views[0];
    EXPECT_EQ(view.name, "front");
    EXPECT_NEAR(view.vertical_fov, 0.7 * 180 / std::numbers::pi, 1e-12);
    EXPECT_EQ(view.aspect, 1.5);
    EXPECT_NEAR(glm::distance(view.from + loaded.scene.center, Vec3{0.5, 0.5, 4}), 0, 1e-14);
    EXPECT_EQ(view.forward, (Vec3{0, 0, -1}));
    EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("camera flat is ignored")));
}

TEST(ReadGltf, strips_and_fans_are_triangles)
{
    json document = square_document();
    auto& primitive = document["meshes"][0]["primitives"][0];
    primitive.erase("indices");
    primitive["mode"] = 6;
    EXPECT_NEAR(read_document(document).scene.surfaces[0].area, 4, 1e-14);
    primitive["mode"] = 5;  // over 0, 1, 3, 2
    primitive["indices"] = 1;
    document["accessors"][1]["count"] = 4;
    const std::string bytes = square_bytes.substr(0, 48) + bytes_of<std::uint16_t>({0, 1, 3, 2, 0, 0});
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
    const LoadedScene strip = read_document(document);
    ASSERT_EQ(strip.scene.surfaces.size(), 1U) << "both triangles have the same front";
    EXPECT_NEAR(strip.scene.surfaces[0].area, 4, 1e-14);
    primitive["mode"] = 1;
    EXPECT_THAT(error_of_document(document), StartsWith("empty: "));
}

// Found by fuzzing: its corners were looked for as a list's, of as many triangles as a strip has.
TEST(ReadGltf, a_mode_that_glTF_does_not_have_is_refused)
{
    json document = square_document();
    document["meshes"][0]["primitives"][0]["mode"] = 7;
    EXPECT_THAT(error_of_document(document), HasSubstr("has no known mode: 7"));
}

TEST(ReadGltf, a_rotated_room_in_single_precision_is_still_joined)
{
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
    for (const Polygon& p : room_with_lamp()) {
        const auto first = static_cast<std::uint32_t>(positions.size() / 3);
        for (const Vec3& corner : p.corners) {
            for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(rotated(corner)[k]));
        }
        for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) indices.push_back(first + k);
    }
    tinygltf::Model model;
    model.asset.version = "2.0";
    const std::string bytes = bytes_of(positions) + bytes_of(indices);
    model.buffers.resize(1);
    model.buffers[0].data.assign(bytes.begin(), bytes.end());
    model.bufferViews.resize(2);
    model.bufferViews[0].buffer = model.bufferViews[1].buffer = 0;
    model.bufferViews[0].byteLength = model.bufferViews[1].byteOffset = positions.size() * sizeof(float);
    model.bufferViews[1].byteLength = indices.size() * sizeof(std::uint32_t);
    model.accessors.resize(2);
    model.accessors[0].bufferView = 0;
    model.accessors[0].componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    model.accessors[0].type = TINYGLTF_TYPE_VEC3;
    model.accessors[0].count = positions.size() / 3;
    model.accessors[1].bufferView = 1;
    model.accessors[1].componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    model.accessors[1].type = TINYGLTF_TYPE_SCALAR;
    model.accessors[1].count = indices.size();
    tinygltf::Primitive primitive;
    primitive.attributes["POSITION"] = 0;
    primitive.indices = 1;
    primitive.material = 0;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    model.meshes.resize(1);
    model.meshes[0].primitives = {primitive};
    model.materials.resize(1);
    model.materials[0].name = "wall";
    model.materials[0].pbrMetallicRoughness.baseColorFactor = {0.7, 0.7, 0.7, 1};
    model.materials[0].emissiveFactor = {1, 1, 1};
    model.nodes.resize(1);
    model.nodes[0].mesh = 0;
    model.scenes.resize(1);
    model.scenes[0].nodes = {0};
    model.defaultScene = 0;
    const TemporaryFolder folder;
    for (const std::string name : {"room.glb", "room.gltf"}) {
        const std::string file = (folder.path() / name).string();
        tinygltf::TinyGLTF writer;
        ASSERT_TRUE(writer.WriteGltfSceneToFile(&model, file, true, true, true, name == "room.glb"));
        const LoadedScene loaded = read_scene(file);
        expect_sound(loaded);
        EXPECT_EQ(loaded.scene.surfaces.size(), 6U) << "the lamp is of the ceiling's material here";
        EXPECT_TRUE(loaded.scene.closed);
    }
}

TEST(ReadGltf, files_that_lie_are_refused_at_once)
{
    const TemporaryFolder folder;
    const auto start = std::chrono::steady_clock::now();
    const auto error_of_bytes = [&](const std::string& bytes) {
        const auto file = folder.write("scene.glb", bytes);
        return error_of([&] { read_scene(file); });
    };
    json document = square_document();
    document["buffers"][0].erase("uri");
    const std::string good = glb(document.dump(), square_bytes);
    EXPECT_EQ(error_of_bytes(good), "no error");
    for (std::size_t length = 0; length < good.size(); length += 7) {
        EXPECT_THAT(error_of_bytes(good.substr(0, length)), StartsWith("gltf: scene.glb: ")) << length;
    }
    for (const std::size_t place : {12U, 8U}) {
        std::string claims = good;
        const std::uint32_t huge = 4'000'000'000U;
        std::memcpy(claims.data() + place, &huge, 4);
        EXPECT_THAT(error_of_bytes(claims), HasSubstr("claims 4000000000 bytes"));
    }
    const auto broken = [&](const std::function<void(json&)>& change) {
        json changed = square_document();
        change(changed);
        return error_of_document(changed);
    };
    EXPECT_THAT(broken([](json& d) { d["accessors"][0]["count"] = 4'000'000'000U; }),
                HasSubstr("claims 4000000000 elements"));
    EXPECT_THAT(broken([](json& d) { d["accessors"][1]["count"] = 7; }), HasSubstr("accessor 1 claims 7 elements"));
    EXPECT_THAT(broken([](json& d) { d["accessors"][0]["byteOffset"] = 4; }), HasSubstr("accessor 0 claims"));
    EXPECT_THAT(broken([](json& d) { d["accessors"][0]["type"] = "VEC2"; }), StartsWith("gltf: "));
    EXPECT_THAT(broken([](json& d) { d["accessors"][0]["bufferView"] = 9; }), StartsWith("gltf: "));
    EXPECT_THAT(broken([](json& d) { d["bufferViews"][0]["byteLength"] = 4'000'000'000U; }),
                HasSubstr("ends past its buffer"));
    EXPECT_THAT(broken([](json& d) { d["bufferViews"][0]["buffer"] = 3; }), HasSubstr("buffer 3 of 1"));
    EXPECT_THAT(broken([](json& d) { d["buffers"][0]["byteLength"] = 4'000'000'000U; }), StartsWith("gltf: "));
    EXPECT_THAT(broken([](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 77; }),
                StartsWith("gltf: "));
    EXPECT_THAT(broken([](json& d) { d["meshes"][0]["primitives"][0]["material"] = 5; }), HasSubstr("material 5 of 1"));
    EXPECT_THAT(broken([](json& d) { d["nodes"][0]["mesh"] = 5; }), StartsWith("gltf: "));
    EXPECT_THAT(broken([](json& d) { d["scenes"][0]["nodes"] = {5}; }), StartsWith("gltf: "));
    EXPECT_THAT(broken([](json& d) { d["asset"]["version"] = "1.0"; }), HasSubstr("version 1.0"));
    EXPECT_THAT(broken([](json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
                HasSubstr("KHR_draco"));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 5) << "some 200 files: each is refused in a few milliseconds";
}

TEST(ReadGltf, indices_past_the_end_and_bad_coordinates)
{
    json document = square_document();
    std::string bytes = square_bytes;
    const auto put = [&] { document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes); };
    bytes[48 + 4] = 99;
    put();
    EXPECT_EQ(error_of_document(document),
              "index: scene.gltf: mesh 0 (), primitive 0: index 2 refers to vertex 99 of 4");
    bytes = square_bytes;
    const float bad = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 4, &bad, 4);
    put();
    EXPECT_THAT(error_of_document(document), MatchesRegex("nonfinite: scene.gltf: vertex 1 is not finite"));
}

TEST(ReadGltf, cycles_and_shared_children_are_refused)
{
    json document = square_document();
    document["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
    EXPECT_THAT(error_of_document(document), HasSubstr("two parents or lies in a cycle"));
    document.erase("scenes");
    document.erase("scene");
    EXPECT_THAT(error_of_document(document), HasSubstr("two parents or lies in a cycle"));
    document["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
    EXPECT_THAT(error_of_document(document), HasSubstr("two parents or lies in a cycle"));
}

TEST(ReadGltf, deep_nesting_and_rubbish_are_refused)
{
    const TemporaryFolder folder;
    const auto error_of_text = [&](const std::string& text) {
        const auto file = folder.write("scene.gltf", text);
        return error_of([&] { read_scene(file); });
    };
    EXPECT_THAT(error_of_text(std::string(1'000'000, '[')), HasSubstr("nested too deeply"));
    EXPECT_THAT(error_of_text("[1, 2]"), HasSubstr("not a glTF file"));
    EXPECT_THAT(error_of_text(""), HasSubstr("not a glTF file"));
    const std::string good = square_document().dump();
    EXPECT_THAT(error_of_text(good.substr(0, good.size() / 2)), StartsWith("gltf: scene.gltf: not a glTF file"));
    EXPECT_THAT(error_of_text("{\"asset\":{\"version\":\"2.0\"},\"buffers\":7}"),
                HasSubstr("\"buffers\" is not an array"));
}

TEST(ReadGltf, changed_bytes_end_in_an_error_not_in_a_crash)
{
    json document = square_document();
    document["buffers"][0].erase("uri");
    const std::string good = glb(document.dump(), square_bytes);
    const TemporaryFolder folder;
    std::mt19937 random(5);
    int read = 0;
    for (int round = 0; round < 1500; ++round) {
        std::string bytes = good;
        for (int k = 0; k < 1 + round % 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
        try {
            expect_sound(read_scene(folder.write("scene.glb", bytes)));
            ++read;
        } catch (const SceneError&) {}
    }
    EXPECT_GT(read, 0) << "some changes do no harm";
}

TEST(ReadGltf, buffers_and_images_outside_the_folder_are_never_opened)
{
    const TemporaryFolder outside;
    outside.write("secret.bin", square_bytes);
    const TemporaryFolder folder;
    std::filesystem::create_symlink(outside.path() / "secret.bin", folder.path() / "link.bin");
    const std::string up = "../" + outside.path().filename().string() + "/secret.bin";
    const std::string encoded = "%2e%2e/" + outside.path().filename().string() + "/secret.bin";
    for (const std::string& uri :
         {up, encoded, (outside.path() / "secret.bin").string(), std::string("link.bin"),
          "file://" + (outside.path() / "secret.bin").string(), std::string("https://host/secret.bin")}) {
        json document = square_document();
        // A second square whose buffer lies outside: it is left out, the first is read.
        document["buffers"].push_back({{"byteLength", 60}, {"uri", uri}});
        document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 48}});
        document["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
        document["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 2}}}, {"material", 0}}}}});
        document["nodes"].push_back({{"mesh", 1}, {"translation", {9, 9, 9}}});
        document["scenes"][0]["nodes"] = {0, 1};
        document["images"] = {{{"uri", uri}}};
        document["textures"] = {{{"source", 0}}};
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
        const LoadedScene loaded = read_scene(folder.write("scene.gltf", document.dump()));
        EXPECT_EQ(loaded.scene.surfaces.size(), 1U) << uri;
        EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("is outside the scene's folder and was not opened")))
            << uri;
        EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("base colour texture is ignored"))) << uri;
        EXPECT_EQ(loaded.scene.materials[0].reflectance, (Rgb{0.5, 0.25, 0.125})) << uri;
    }
    json document = square_document();
    document["buffers"][0]["uri"] = "my buffer.bin";
    folder.write("my buffer.bin", square_bytes);
    EXPECT_EQ(read_scene(folder.write("scene.gltf", document.dump())).scene.surfaces.size(), 1U);
    document["buffers"][0]["uri"] = "gone.bin";
    const auto file = folder.write("scene.gltf", document.dump());
    EXPECT_EQ(error_of([&] { read_scene(file); }), "gltf: scene.gltf: buffer 0: gone.bin is missing");
}

TEST(ReadGltf, textures_count_as_their_mean_colour)
{
    // 2 × 1 pixels, black and white, sRGB: linear mean one half.
    const std::string png =
        "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR4nGNgYGD4//8/AAYBAv4CsjmuAAAAAElFTkSuQmCC";
    json document = square_document();
    document["images"] = {{{"uri", "data:image/png;base64," + png}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    const LoadedScene loaded = read_document(document);
    EXPECT_NEAR(glm::distance(loaded.scene.materials[0].reflectance, 0.5 * Rgb{0.5, 0.25, 0.125}), 0, 1e-15);
    EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("counts as its mean colour 0.500 0.500 0.500")));
    std::string huge = "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\rIHDR\0\1\0\0\0\1\0\0\x08\x02\0\0\0", 21);
    document["images"][0]["uri"] = "data:image/png;base64," + base64(huge);
    EXPECT_THAT(read_document(document).report.warnings, Contains(HasSubstr("65536 × 65536 pixels")));
}
