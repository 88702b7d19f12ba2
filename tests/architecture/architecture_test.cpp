#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Source {
    std::string path;                   ///< relative to the repository, as in "meshing/scene.h"
    std::vector<std::string> includes;  ///< as written between quotes or angle brackets
    std::size_t lines = 0;
    bool pragma_once = false;
};

Source read_source(const fs::path& root, const fs::path& file)
{
    Source source{.path = fs::relative(file, root).generic_string(), .includes = {}};
    static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::ifstream in(file);
    for (std::string line; std::getline(in, line); ++source.lines) {
        if (line.rfind("#pragma once", 0) == 0) source.pragma_once = true;
        if (std::smatch match; std::regex_search(line, match, include)) source.includes.push_back(match[1]);
    }
    return source;
}

const std::vector<std::string> top_rooms{"meshing", "formfactor", "solver", "apps", "tests"};

/// All C++ sources of the repository, by path.
const std::vector<Source>& sources()
{
    static const std::vector<Source> all = [] {
        const fs::path root(PATCHLIGHT_SOURCE);
        std::vector<Source> found;
        for (const std::string& room : top_rooms) {
            for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
                const std::string extension = entry.path().extension().string();
                if (extension == ".h" || extension == ".cpp" || extension == ".hpp" || extension == ".cc")
                    found.push_back(read_source(root, entry.path()));
            }
        }
        std::ranges::sort(found, {}, &Source::path);
        return found;
    }();
    return all;
}

bool starts_with(const std::string& text, const std::string& prefix)
{
    return text.rfind(prefix, 0) == 0;
}

/// "meshing", "apps/run", …: the folder whose rules hold for a path; empty for what isn't ours.
std::string room_of(const std::string& path)
{
    for (const std::string& room : top_rooms) {
        if (!starts_with(path, room + "/")) continue;
        if (room != "apps") return room;
        const std::size_t end = path.find('/', 5);
        return end == std::string::npos ? room : path.substr(0, end);
    }
    return {};
}

bool is_source_file(const std::string& path)
{
    return path.ends_with(".cpp") || path.ends_with(".cc");
}

using Recogniser = std::function<bool(const std::string&)>;

/// All files outside the tests (they may use anything) that include a header that `is_theirs` recognises.
std::vector<const Source*> users(const Recogniser& is_theirs)
{
    std::vector<const Source*> found;
    for (const Source& source : sources())
        if (room_of(source.path) != "tests" && std::ranges::any_of(source.includes, is_theirs))
            found.push_back(&source);
    return found;
}

/// The files, and all that include them, directly or through others.
std::set<std::string> reached_from(const std::vector<const Source*>& start)
{
    std::set<std::string> reached;
    for (const Source* source : start) reached.insert(source->path);
    for (std::size_t before = 0; before != reached.size();) {
        before = reached.size();
        for (const Source& source : sources())
            if (std::ranges::any_of(source.includes, [&](const std::string& h) { return reached.contains(h); }))
                reached.insert(source.path);
    }
    return reached;
}

bool is_in(const std::string& path, const std::vector<std::string>& rooms)
{
    return std::ranges::any_of(rooms, [&](const std::string& room) { return starts_with(path, room + "/"); });
}

/// A header of a room may bring the library in, as long as nobody outside the rooms comes by it.
void expect_stays_in(const Recogniser& is_theirs, std::vector<std::string> rooms)
{
    rooms.emplace_back("tests");
    for (const std::string& path : reached_from(users(is_theirs)))
        EXPECT_TRUE(is_in(path, rooms)) << path << " comes by a library of another room";
}

/// Heavier, or touchier: no header may bring it in at all.
void expect_only_in_sources_of(const Recogniser& is_theirs, const std::string& room)
{
    for (const Source* source : users(is_theirs)) {
        EXPECT_TRUE(is_in(source->path, {room})) << source->path << " includes a library of " << room;
        EXPECT_TRUE(is_source_file(source->path)) << source->path << " is a header and brings in a library";
    }
}

Recogniser header_in(const std::string& folder)
{
    return [folder](const std::string& header) { return starts_with(header, folder); };
}

TEST(Architecture, SourcesAreFound)
{
    // The other tests pass on nothing: this one sees that there is something.
    for (const char* room : {"meshing", "formfactor", "solver", "apps/run", "apps/patchlight", "tests"})
        EXPECT_TRUE(std::ranges::any_of(sources(), [&](const Source& s) { return room_of(s.path) == room; })) << room;
    const bool any_include = std::ranges::any_of(sources(), [](const Source& s) { return !s.includes.empty(); });
    EXPECT_TRUE(any_include);
}

TEST(Architecture, IncludesRunDownwardsOnly)
{
    const std::vector<std::string> core{"meshing", "formfactor", "solver"};
    const std::map<std::string, std::vector<std::string>> may_include{
        {"meshing", {}},
        {"formfactor", {"meshing"}},
        {"solver", {"meshing", "formfactor"}},
        {"apps/imaging", core},
        {"apps/run", core},
        {"apps/verification", {"meshing", "formfactor"}},
        {"apps/study", {"meshing", "formfactor", "solver", "apps/imaging", "apps/run", "apps/verification"}},
        {"apps/report", {"meshing", "formfactor", "solver", "apps/imaging", "apps/run", "apps/study"}},
        {"apps/python", {"meshing", "formfactor", "solver", "apps/imaging", "apps/run"}},
        {"apps/patchlight", {"meshing", "formfactor", "solver", "apps"}},
        {"tests", {"meshing", "formfactor", "solver", "apps"}},
    };
    for (const Source& source : sources()) {
        const std::string room = room_of(source.path);
        const auto rule = may_include.find(room);
        ASSERT_NE(rule, may_include.end()) << source.path << " lies in a room that the design doesn't know";
        for (const std::string& header : source.includes) {
            const std::string target = room_of(header);
            if (target.empty() || target == room) continue;
            const bool allowed = std::ranges::any_of(
                rule->second, [&](const std::string& r) { return target == r || starts_with(target, r + "/"); });
            EXPECT_TRUE(allowed) << source.path << " includes " << header;
        }
    }
}

TEST(Architecture, VerifyingSharesNothingWithWhatItVerifies)
{
    const std::set<std::string> shared{"formfactor/ray_caster.h", "formfactor/random_numbers.h",
                                       "formfactor/scrambled_points.h", "formfactor/work_monitor.h"};
    for (const Source& source : sources()) {
        if (room_of(source.path) != "apps/verification") continue;
        for (const std::string& header : source.includes) {
            const bool is_theirs = room_of(header) == "formfactor" || starts_with(header, "meshing/patch");
            EXPECT_TRUE(!is_theirs || shared.contains(header)) << source.path << " includes " << header;
        }
    }
}

TEST(Architecture, OurIncludesNameTheirFolder)
{
    // An include without its folder would slip past the rules above. The tests may include what they like.
    const fs::path root(PATCHLIGHT_SOURCE);
    for (const Source& source : sources()) {
        if (room_of(source.path) == "tests") continue;
        const fs::path folder = (root / source.path).parent_path();
        for (const std::string& header : source.includes) {
            EXPECT_FALSE(room_of(header).empty() && fs::exists(folder / header)) << source.path << ": " << header;
            EXPECT_EQ(header.find(".."), std::string::npos) << source.path << ": " << header;
        }
    }
}

TEST(Architecture, IncludesHaveNoCycle)
{
    std::map<std::string, const Source*> by_path;
    for (const Source& source : sources()) by_path[source.path] = &source;
    enum class Mark { open, done };
    std::map<std::string, Mark> marks;
    std::function<void(const Source&, const std::string&)> visit = [&](const Source& source, const std::string& trail) {
        const auto [mark, is_new] = marks.try_emplace(source.path, Mark::open);
        EXPECT_TRUE(is_new || mark->second == Mark::done) << "a circle: " << trail << source.path;
        if (!is_new) return;
        for (const std::string& header : source.includes)
            if (const auto next = by_path.find(header); next != by_path.end())
                visit(*next->second, trail + source.path + " > ");
        marks[source.path] = Mark::done;
    };
    for (const Source& source : sources()) visit(source, "");
}

TEST(Architecture, ThirdPartyLibrariesStayInTheirRooms)
{
    expect_only_in_sources_of(header_in("CGAL/"), "meshing");
    expect_only_in_sources_of(header_in("embree"), "formfactor");
    expect_only_in_sources_of(header_in("OpenImageIO/"), "apps/imaging");
    expect_only_in_sources_of(header_in("stb/"), "apps/imaging");
    expect_only_in_sources_of(header_in("openssl/"), "apps/run");
    expect_stays_in(header_in("OpenMesh/"), {"meshing"});
    expect_stays_in(header_in("CLI/"), {"apps/patchlight"});
    expect_stays_in(header_in("toml++/"), {"apps/study"});
    expect_stays_in(header_in("pybind11/"), {"apps/python"});
    expect_stays_in(header_in("nlohmann/"), {"meshing", "apps"});
    for (const char* reader : {"tiny_obj_loader", "tiny_gltf"})
        expect_stays_in([&](const std::string& h) { return h.find(reader) != h.npos; }, {"meshing", "apps/run"});
}

TEST(Architecture, RayCasterAndImageFilesAreOneSourceEach)
{
    EXPECT_EQ(users(header_in("embree")).size(), 1U);
    EXPECT_EQ(users(header_in("OpenImageIO/")).size(), 1U);
}

TEST(Architecture, NothingIsNamedAfterNothing)
{
    const std::set<std::string> refused{"utils", "util", "common", "helpers", "helper", "misc"};
    const fs::path root(PATCHLIGHT_SOURCE);
    std::vector<std::string> rooms = top_rooms;
    rooms.emplace_back("data");
    for (const std::string& room : rooms)
        for (const auto& entry : fs::recursive_directory_iterator(root / room))
            EXPECT_FALSE(refused.contains(entry.path().stem().string())) << entry.path();
}

TEST(Architecture, FilesFitOneHead)
{
    for (const Source& source : sources()) EXPECT_LE(source.lines, 450U) << source.path;
}

TEST(Architecture, HeadersAreGuardedByPragmaOnce)
{
    for (const Source& source : sources()) {
        EXPECT_TRUE(is_source_file(source.path) || source.pragma_once) << source.path;
    }
}

}  // namespace
