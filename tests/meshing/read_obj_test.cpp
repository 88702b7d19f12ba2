#include "written_scene.h"

#include <gmock/gmock.h>

#include <numbers>

using namespace patchlight;
using namespace patchlight::testing;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

namespace {

const std::string square = "mtllib scene.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string error_of_obj(const std::string& obj, const SceneOptions& options = {},
                         const std::string& mtl = three_materials)
{
    return error_of([&] { read_text(obj, options, mtl); });
}

const Material& material_named(const Scene& scene, const std::string& name)
{
    for (const Material& material : scene.materials) {
        if (material.name == name) return material;
    }
    throw std::runtime_error("no material " + name);
}

}  // namespace

TEST(ReadObj, files_that_are_not_there_or_no_files)
{
    const TemporaryFolder folder;
    const auto in = [&](const std::string& name) { return folder.path() / name; };
    EXPECT_THAT(error_of([&] { read_scene(in("none.obj")); }), MatchesRegex("file: .*none.obj: no such file"));
    std::filesystem::create_directory(in("folder.obj"));
    EXPECT_THAT(error_of([&] { read_scene(in("folder.obj")); }), MatchesRegex("file: .*folder.obj: is a folder"));
    folder.write("scene.xyz", "v 0 0 0");
    EXPECT_THAT(error_of([&] { read_scene(in("scene.xyz")); }),
                MatchesRegex("format: .*scene.xyz: unknown format .xyz.*"));
    EXPECT_THAT(error_of([&] { read_scene("/dev/null/x.obj"); }), StartsWith("file: "));
    std::filesystem::create_symlink("/dev/zero", in("endless.obj"));
    EXPECT_THAT(error_of([&] { read_scene(in("endless.obj")); }), HasSubstr("is not a regular file"));
}

TEST(ReadObj, what_has_no_faces_no_area_or_no_light_is_told_apart)
{
    EXPECT_EQ(error_of_obj(""), "empty: scene.obj: the scene has no faces");
    EXPECT_EQ(error_of_obj(square), "empty: scene.obj: the scene has no faces");
    EXPECT_EQ(error_of_obj(square + "f 1 2 1\nf 1 1 1\n"), "zeroarea: scene.obj: all 2 faces have no area");
    EXPECT_EQ(error_of_obj(square + "usemtl white\nf 1 2 3 4\n"),
              "dark: scene.obj: no emitter; set Ke or use --emitter MATERIAL=W");
    SceneOptions dark;
    dark.require_emitter = false;
    EXPECT_EQ(read_text(square + "usemtl white\nf 1 2 3 4\n", dark).scene.surfaces.size(), 1U);
}

TEST(ReadObj, indices_must_exist)
{
    EXPECT_EQ(error_of_obj(square + "f 1 2 99\n"), "index: scene.obj:7: face refers to vertex 99 of 4");
    EXPECT_EQ(error_of_obj(square + "\nf 1 2 3\nf 0 1 2\n"), "index: scene.obj:9: face refers to vertex 0 of 4");
    EXPECT_EQ(error_of_obj(square + "f 1 2 -5\n"), "index: scene.obj:7: face refers to vertex -5 of 4");
    EXPECT_THAT(error_of_obj(square + "f 1 2 4294967299\n"),
                StartsWith("index: scene.obj:7: face refers to vertex 4294967299"));
    EXPECT_THAT(error_of_obj(square + "f 1 2 three\n"), StartsWith("index: scene.obj:7: face refers to vertex three"));
    EXPECT_EQ(read_text(square + "f -4 -3 -2 -1\n").scene.surfaces.size(), 1U);
    EXPECT_EQ(read_text(square + "f 1/7/9 2//9 3/7 4\n").scene.surfaces.size(), 1U);
}

TEST(ReadObj, coordinates_must_be_finite_where_they_are_used)
{
    for (const std::string bad : {"nan 0 1", "0 inf 1", "0 0 1e999", "0 0", "0 0 zero", "-infinity 0 0", "0x1 0 0"}) {
        EXPECT_EQ(error_of_obj(square + "v " + bad + "\nf 1 2 5\n"), "nonfinite: scene.obj:7: vertex 5 is not finite")
            << bad;
        const LoadedScene unused = read_text(square + "v " + bad + "\nf 1 2 3\n");
        EXPECT_THAT(unused.report.warnings, Contains("scene.obj:7: vertex 5 is not finite, but no face uses it"))
            << bad;
    }
    EXPECT_EQ(read_text(square + "v 1e-999 +.5 -1.e0\nf 1 2 5\n").scene.surfaces.size(), 1U);
}

TEST(ReadObj, scenes_too_large_or_small_for_arithmetic_are_refused)
{
    const auto square_of = [](const std::string& side) {
        return "usemtl lamp\nmtllib scene.mtl\nv 0 0 0\nv " + side + " 0 0\nv " + side + " " + side + " 0\nf 1 2 3\n";
    };
    EXPECT_EQ(error_of_obj(square_of("1e30")),
              "size: scene.obj: the scene is 1.41e+30 m across, but 1e-15 … 1e+15 m is "
              "what can be computed with; give its coordinates in another unit");
    EXPECT_THAT(error_of_obj(square_of("1e-30")), StartsWith("size: scene.obj: the scene is 1.41e-30 m across"));
    for (const std::string side : {"1e200", "1e308"}) EXPECT_THAT(error_of_obj(square_of(side)), StartsWith("size: "));
    EXPECT_THAT(error_of_obj(square_of("1e-200")), StartsWith("zeroarea: "));
    EXPECT_EQ(error_of_obj(square_of("1e-14")), "no error");
    EXPECT_EQ(error_of_obj(square_of("1e14")), "no error");
}

TEST(ReadObj, numbers_are_read_to_the_last_bit)
{
    const LoadedScene loaded =
        read_text("mtllib scene.mtl\nusemtl lamp\nv 0 0 0\nv 0.123456789012345678 0 0\nv 0 0.5488 0\nf 1 2 3\n");
    EXPECT_EQ(loaded.scene.center.x, 0.5 * 0.123456789012345678);
    EXPECT_EQ(loaded.scene.center.y, 0.5 * 0.5488);
}

TEST(ReadObj, line_numbers_survive_continued_lines_and_line_ends)
{
    EXPECT_EQ(error_of_obj(square + "f 1 \\\n 2 3\nf 1 2 9\n"), "index: scene.obj:9: face refers to vertex 9 of 4");
    EXPECT_EQ(error_of_obj("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nf 1 2 9\r\n"),
              "index: scene.obj:4: face refers to vertex 9 of 3");
    EXPECT_EQ(error_of_obj("v 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 9\r"), "index: scene.obj:4: face refers to vertex 9 of 3");
    EXPECT_EQ(read_text("\xEF\xBB\xBF" + square + "f 1 2 \\\n 3 4").scene.surfaces.size(), 1U);
}

TEST(ReadObj, reflectances_outside_the_range_name_the_material)
{
    const auto with_Kd = [&](const std::string& Kd) {
        return error_of_obj(square + "f 1 2 3\nusemtl odd\nf 1 3 4\n", {},
                            three_materials + "newmtl odd\nKd " + Kd + "\n");
    };
    EXPECT_THAT(with_Kd("1.2 .5 .5"), MatchesRegex("material: scene.obj: material odd: reflectance 1.2 is not in .*"));
    EXPECT_THAT(with_Kd(".5 -0.1 .5"), HasSubstr("material odd: reflectance -0.1"));
    EXPECT_THAT(with_Kd("nan 0 1"), HasSubstr("scene.mtl:9: material odd: \"nan\""));
    EXPECT_THAT(with_Kd("0 1e999 1"), HasSubstr("material odd: \"1e999\""));
    EXPECT_THAT(with_Kd("0 0 1\nKe -3 0 0"), HasSubstr("material odd: exitance"));
    EXPECT_EQ(with_Kd(".97 .5 .5"), "no error");
}

TEST(ReadObj, a_reflectance_of_one_is_used_as_the_largest_allowed)
{
    SceneOptions options;
    options.max_reflectance = 0.9;
    const LoadedScene loaded = read_text(square + "f 1 2 3 4\n", options, "newmtl lamp\nKd 1 1 .5\nKe 1 1 1\n");
    EXPECT_EQ(loaded.scene.materials[0].reflectance, (Rgb{0.9, 0.9, 0.5}));
    EXPECT_THAT(loaded.report.warnings, Contains("material lamp: a reflectance of 1 is used as 0.9"));
}

TEST(ReadObj, emitted_radiance_becomes_exitance)
{
    const Scene scene = read_text(square + "f 1 2 3 4\n").scene;
    EXPECT_EQ(material_named(scene, "lamp").emission, Rgb{10 * std::numbers::pi});
    EXPECT_EQ(material_named(scene, "lamp").reflectance, Rgb{0.0});
}

TEST(ReadObj, options_name_emitters_and_two_sided_materials)
{
    SceneOptions options;
    options.emitters["white"] = {5, 6, 7};
    EXPECT_EQ(material_named(read_text(square + "usemtl white\nf 1 2 3 4\n", options).scene, "white").emission,
              (Rgb{5, 6, 7}));
    options.emitters = {{"lmap", {1, 1, 1}}};
    EXPECT_EQ(error_of_obj(square + "f 1 2 3 4\n", options),
              "material: scene.obj: no material named lmap, the scene has: lamp, red, white");
    options.emitters.clear();
    options.two_sided = {"paper"};
    EXPECT_THAT(error_of_obj(square + "f 1 2 3 4\n", options), HasSubstr("no material named paper"));
}

TEST(ReadObj, faces_without_a_material_have_half_reflectance)
{
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    SceneOptions options;
    options.emitters["default"] = Rgb{1.0};
    const LoadedScene loaded = read_text(obj, options);
    EXPECT_EQ(loaded.scene.materials[0].reflectance, Rgb{0.5});
    EXPECT_THAT(loaded.report.warnings, Contains("scene.obj: faces without a material have reflectance 0.5"));
    EXPECT_THAT(read_text(square + "f 1 2 3\nusemtl nowhere\nf 1 3 4").report.warnings,
                Contains("material nowhere is not defined, reflectance 0.5 is used"));
}

TEST(ReadObj, material_files_outside_the_folder_are_never_opened)
{
    const TemporaryFolder outside;
    outside.write("secret.mtl", "newmtl lamp\nKe 1 1 1\n");
    const std::string absolute = (outside.path() / "secret.mtl").string();
    const TemporaryFolder folder;
    std::filesystem::create_symlink(outside.path() / "secret.mtl", folder.path() / "link.mtl");
    std::filesystem::create_directory_symlink(outside.path(), folder.path() / "linked");
    const std::string up = "../" + outside.path().filename().string() + "/secret.mtl";
    for (const std::string& name : {absolute, up, std::string("link.mtl"), std::string("linked/secret.mtl"),
                                    "x/../" + up, std::string("https://host/secret.mtl"), "..\\" + up.substr(3)}) {
        folder.write("scene.obj", "mtllib " + name + "\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
        SceneOptions options;
        options.require_emitter = false;
        const LoadedScene loaded = read_scene(folder.path() / "scene.obj", options);
        EXPECT_FALSE(loaded.scene.materials[0].emits()) << name;
        EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("outside the scene's folder and was not opened")))
            << name;
    }
}

TEST(ReadObj, material_files_inside_the_folder_are_read)
{
    const TemporaryFolder folder;
    const auto emits = [&](const std::string& name) {
        folder.write("scene.obj", "mtllib " + name + "\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
        SceneOptions options;
        options.require_emitter = false;
        const LoadedScene loaded = read_scene(folder.path() / "scene.obj", options);
        if (!loaded.scene.materials[0].emits()) {
            EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("is missing")));
        }
        return loaded.scene.materials[0].emits();
    };
    folder.write("materials/a b.mtl", three_materials);
    folder.write("ü.mtl", three_materials);
    EXPECT_TRUE(emits("materials/a b.mtl"));
    EXPECT_TRUE(emits("materials\\a b.mtl"));
    EXPECT_TRUE(emits("ü.mtl"));
    EXPECT_TRUE(emits("missing.mtl ü.mtl"));
    EXPECT_FALSE(emits("missing.mtl"));
}

TEST(ReadObj, what_is_left_out_is_told)
{
    const LoadedScene loaded = read_text(square + "f 1 2 3 4\nl 1 2\np 3\n", {},
                                         "newmtl lamp\nKe 1 1 1\nKd .5 .5 .5\nmap_Kd ../../wood.png\nd .5\n");
    EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("texture ../../wood.png is not read")));
    EXPECT_THAT(loaded.report.warnings, Contains(HasSubstr("transparency is ignored")));
    EXPECT_THAT(loaded.report.warnings, Contains("scene.obj: 2 lines and points are ignored"));
}

TEST(ReadObj, objects_and_groups_name_surfaces)
{
    const auto name_of = [&](const std::string& statements) {
        const Scene scene = read_text(square + statements + "f 1 2 3 4\n").scene;
        return scene.objects[scene.surfaces[0].object.value];
    };
    EXPECT_EQ(name_of("o table top \n"), "table top");
    EXPECT_EQ(name_of("g shelf back\n"), "shelf");
    EXPECT_EQ(name_of("o chair\ng leg\n"), "chair");
    EXPECT_EQ(name_of(""), "");
}

TEST(ReadObj, rubbish_ends_in_an_error_not_in_a_crash)
{
    std::mt19937 random(3);
    const std::string alphabet = "vf o0123456789.-/\\\n\r\t eEgnaul#mtis\xFF";
    std::uniform_int_distribution<std::size_t> pick(0, alphabet.size());
    for (int round = 0; round < 300; ++round) {
        std::string text = round % 2 ? square + "f 1 2 3 4\n" : "";
        for (int k = 0; k < 200; ++k) {
            const std::size_t i = pick(random);
            text.push_back(i == alphabet.size() ? '\0' : alphabet[i]);
        }
        try {
            expect_sound(read_text(text));
        } catch (const SceneError& error) {
            EXPECT_THAT(error.what(), HasSubstr("scene.obj"));
        }
    }
}

TEST(ReadObj, a_polygon_may_have_a_thousand_corners)
{
    Polygon disc{{}, "lamp", "disc"};
    for (int k = 0; k < 1000; ++k) {
        const double angle = 2 * std::numbers::pi * k / 1000;
        disc.corners.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    const LoadedScene loaded = load({disc});
    expect_sound(loaded);
    ASSERT_EQ(loaded.scene.surfaces.size(), 1U);
    EXPECT_EQ(loaded.scene.surfaces[0].loops[0].size(), 1000U);
    EXPECT_NEAR(loaded.scene.surfaces[0].area, 500 * std::sin(2 * std::numbers::pi / 1000), 1e-12);
}
