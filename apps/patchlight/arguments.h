#pragma once

#include "apps/imaging/lightmap.h"
#include "apps/imaging/picture.h"
#include "apps/imaging/quantity.h"
#include "apps/imaging/value_scale.h"
#include "apps/run/run_folder.h"
#include "formfactor/pair_factor.h"
#include "meshing/read_scene.h"
#include "solver/adaptive.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace patchlight {

/// How a scene's file is to be read.
struct SceneArguments {
    std::string file;
    SceneOptions options;
    std::string view;  ///< a camera's name or a file; empty: the scene's first
    std::string unit_name = "m";
};

struct PictureArguments {
    bool pictures = true;
    std::optional<std::pair<int, int>> size;  ///< unset: 640 high, as wide as the camera says
    std::vector<int> snapshots;
};

struct SolveCommand {
    SceneArguments scene;
    std::string run;
    AdaptiveOptions options;
    PictureArguments pictures;
    std::string mesh_of;       ///< a run whose last mesh is solved on; empty: a mesh of its own
    std::string mesh_sha256;   ///< of the solution that holds that mesh, once it is read
    std::string for_view;      ///< a camera's name or a file: refined for what it sees; empty: for everything
    std::optional<View> goal;  ///< that camera, once the scene is read
    bool keep_factors = false;
    bool quiet = false;
    bool json = false;
    bool demo = false;
    double memory = 0;          ///< bytes; 0: default_memory()
    double time = 0;            ///< seconds; 0: no limit
    int threads = 0;            ///< 0: as many as there are
    std::string configuration;  ///< a file of options, already among these; empty: none
};

struct DemoCommand {
    std::string folder = "patchlight-demo";
    bool quiet = false;
    bool json = false;
    int threads = 0;
};

struct InspectCommand {
    SceneArguments scene;
    bool lines = false;
    bool json = false;
};

struct FalseColorArguments {
    std::optional<Quantity> quantity;                ///< unset: light as it is
    std::optional<std::pair<double, double>> range;  ///< unset: chosen
    ScaleKind scale = ScaleKind::linear;
    int isolines = 0;
};

struct RenderCommand {
    std::string run;
    std::string image;
    WhichCycle cycle;
    std::string view;
    std::optional<Vec3> from, to;  ///< in the scene file's units
    Vec3 up{0, 1, 0};
    std::optional<double> vertical_fov;
    std::optional<std::pair<int, int>> size;
    Shade shade = Shade::gouraud;
    bool wireframe = false;
    std::optional<double> exposure;  ///< unset: auto
    FalseColorArguments false_color;
};

/// What --fail-above can hold a comparison to.
enum class Metric { flip, flip_p95, flip_max, rmse, l2 };

struct CompareLimit {
    Metric metric = Metric::flip;
    std::string name;
    double value = 0;
};

struct CompareCommand {
    std::string a, b;  ///< RUN, RUN@N, RUN@first, RUN@last
    std::string folder;
    std::string view;
    std::optional<std::pair<int, int>> size;
    std::optional<double> exposure;  ///< unset: auto
    FalseColorArguments false_color;
    std::size_t points = 0;
    std::uint64_t seed = 1;
    std::vector<CompareLimit> limits;
    bool json = false;
};

enum class Animated { cycles, shots, path };

inline constexpr int most_frames = 1000;

struct AnimateCommand {
    std::string run;     ///< as CompareCommand's
    std::string output;  ///< a .png, or a folder for frames
    Animated what = Animated::cycles;
    std::string path;  ///< file of cameras
    int frames = 48;   ///< of a path
    int delay = 0;     ///< ms a frame
    std::string view;
    std::optional<std::pair<int, int>> size;
    std::optional<double> exposure;  ///< unset: auto
    bool wireframe = false;
};

struct ProbeCommand {
    std::string run;
    std::string points;
    std::string output;  ///< empty: standard output
    WhichCycle cycle;
};

struct ExportCommand {
    std::string run;
    std::string format;
    std::string output;
    WhichCycle cycle;
    LightmapOptions lightmap;
    LightmapQuantity quantity = LightmapQuantity::radiosity;
};

struct FormFactorsCommand {
    SceneArguments scene;
    FormFactorMethod method = FormFactorMethod::exact;
    std::optional<std::pair<std::string, std::string>> between;  ///< objects; unset: all patches of the uniform mesh
    PairOptions pair;
    FormFactorOptions matrix;
    MeshingOptions meshing;
    std::string output;   ///< .csv or .bin; empty: the matrix isn't kept
    std::string patches;  ///< CSV that tells what the rows are; empty: none
    bool repair = false;
    double memory = 0;  ///< bytes; 0: default_memory()
    bool quiet = false;
    bool json = false;
    int threads = 0;
};

struct ValidateCommand {
    std::optional<FormFactorMethod> method;  ///< unset: all
    std::uint64_t seed = 1;
    bool quiet = false;
    bool json = false;
    int threads = 0;
};

struct VerifyCommand {
    std::string run;
    WhichCycle cycle;
    bool all_cycles = false;  ///< the others beside the last
    std::size_t points = 2000;
    std::uint32_t most_paths = 4096;  ///< from each point
    std::uint64_t seed = 1;
    bool files_only = false;
    bool traces_study = false;  ///< --points was given: a study's cells are path-traced, too
    bool quiet = false;
    bool json = false;
    int threads = 0;
};

struct RerunCommand {
    std::string run;
    std::string output;  ///< new folder, or one to resume
    bool quiet = false;
    bool json = false;
    double memory = 0;  ///< bytes; 0: default_memory()
    int threads = 0;    ///< 0: as many as there are
};

/// How a command that writes a page was asked to end.
struct PageOutput {
    std::string file;
    bool json = false;  ///< tell in JSON what was written
    bool open = false;  ///< show it
};

struct ReportCommand {
    std::string run;
    PageOutput page;
};

/// What a study would do, and what that would need.
struct StudyCheckCommand {
    std::string study;
    int jobs = 1;  ///< cells at a time
    bool json = false;
};

struct StudyCellCommand {
    std::string study;
    std::string folder;                ///< empty: STEM-study in the working directory
    std::optional<std::size_t> index;  ///< in the whole grid; unset: the reference
    bool reference = false;
    bool quiet = false;
    bool json = false;
    int threads = 0;
};

struct StudyRunCommand {
    std::string study;
    std::string folder;    ///< as StudyCellCommand's
    std::size_t jobs = 1;  ///< at once
    bool quiet = false;
    bool json = false;
    int threads = 0;  ///< of all jobs together
};

struct StudyTableCommand {
    std::string study;
    std::string folder;         ///< as StudyCellCommand's
    std::string format = "md";  ///< md, csv, json, tex
    bool seconds = false;
    bool cycles = false;
};

struct StudyReportCommand {
    std::string study;
    std::string folder;  ///< as StudyCellCommand's
    PageOutput page;
};

/// What only prints: --help and --version.
struct PrintCommand {
    std::string text;
};

using Command = std::variant<SolveCommand, DemoCommand, InspectCommand, RenderCommand, ProbeCommand, ExportCommand,
                             VerifyCommand, FormFactorsCommand, ValidateCommand, CompareCommand, AnimateCommand,
                             ReportCommand, RerunCommand, StudyCheckCommand, StudyCellCommand, StudyRunCommand,
                             StudyTableCommand, StudyReportCommand, PrintCommand>;

/// Throws UsageError ("usage") for whatever isn't exactly understood.
Command parse_arguments(int argc, const char* const* argv);

/// The metres in a unit; throws UsageError.
double metres_per(const std::string& unit);

}  // namespace patchlight
