#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace patchlight {

/// A study or configuration file that can't be meant (exit 2). what() reads `study.toml:14:3: cause`.
class StudyError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A study of more cells than its limit (exit 5); nothing has been expanded.
class StudyLimitError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Line and column in a text file, from 1; 0: nowhere.
struct TextPlace {
    int line = 0, column = 0;
};

/// An option of `solve` in a file: its name as the command line has it, without dashes in front (max-elements; files
/// may write max_elements), and its value as a word of the command line: numbers in full precision, lists of numbers
/// joined by commas, "true" or "false" for flags. A list of texts is an option given again and again: joined by line
/// feeds, which no text holds. Paths are as written: relative to the file.
struct OptionText {
    std::string name;
    std::string value;
    TextPlace place;
};

/// One dimension of the grid. An empty value leaves the option out.
struct StudyAxis {
    std::string name;                ///< of the option, or "scene"
    std::vector<OptionText> values;  ///< scenes as written
};

/// Cells that have all of these values are left out.
struct StudySkip {
    std::vector<OptionText> all;
};

/// What errors are measured against.
enum class ReferenceKind {
    none,         ///< estimates only
    path_traced,  ///< `paths` paths from each of `points` points
    solution,     ///< a finer solution of our own: the base options with `options` over them
    run,          ///< the last cycle of a stored run of the same surfaces
    points,       ///< a CSV of points with their radiosity: x,y,z[,nx,ny,nz],Br,Bg,Bb
    furnace       ///< closed form of a closed room that emits and reflects alike all over: B = E/(1 − ρ)
};

/// As a study file has it.
std::string name_of(ReferenceKind kind);

struct StudyReference {
    ReferenceKind kind = ReferenceKind::none;
    std::size_t points = 2000;  ///< area-uniform over all reflecting surface; not of ReferenceKind::points
    std::string seen_from;      ///< a camera, as --view names it: the points are what it sees, uniform over its picture
    std::uint32_t paths = 4096;       ///< path_traced: from each point
    std::vector<OptionText> options;  ///< solution
    std::filesystem::path file;       ///< run, points: as the scenes' paths
    TextPlace place;
};

/// What must hold, or the study exits with 4. Each is checked for every cell but min_rate: for every series.
struct StudyGates {
    std::optional<double> min_rate;                          ///< of a series' fitted order: error ~ elements^−rate
    std::optional<double> max_error;                         ///< of the last cycle
    std::optional<double> max_energy_residual;               ///< relative
    std::optional<double> max_effectivity, min_effectivity;  ///< estimated over measured error
};

/// Cells at the same elements, seconds or error.
struct StudyComparison {
    enum class At { elements, seconds, error } at = At::elements;
    std::vector<double> values;
};

struct StudyView {
    std::string view;  ///< as --view names it, a file's path as the scenes'; empty: the scene's first
};

struct StudyPictures {
    std::vector<StudyView> views;    ///< none: no pictures of the study's own
    std::optional<double> exposure;  ///< stops, one for all; unset: chosen from the first cell
    std::pair<int, int> size{480, 480};
};

/// For each cell.
struct StudyLimits {
    double seconds = 0;  ///< wall; 0: none. A cell that is stopped goes on when the study is run again
    std::string memory;  ///< as --memory; empty: its default
    TextPlace memory_place;
    std::size_t cells = 1000;  ///< more are refused before anything is expanded
};

/// A study file as it was read.
struct Study {
    std::filesystem::path file;       ///< as given
    std::string name;                 ///< `title`, or the file's stem
    std::vector<OptionText> scenes;   ///< paths, absolute or relative to the working directory; ≥ 1
    std::vector<OptionText> options;  ///< of all cells
    std::vector<StudyAxis> axes;      ///< in the file's order; the last varies fastest; "scene" first with several
    std::vector<StudySkip> skips;
    StudyReference reference;
    std::string along;             ///< the axis along which rates are fitted and series run; empty: none
    std::filesystem::path probes;  ///< a CSV of points; empty: none
    StudyGates gates;
    std::vector<StudyComparison> comparisons;
    StudyPictures pictures;
    StudyLimits limits;
};

/// One combination of the grid.
struct StudyCell {
    std::size_t index = 0;            ///< in the whole grid, before skipping
    std::string name;                 ///< "refine=both max-elements=500"; the study's where nothing varies
    std::vector<std::string> values;  ///< one an axis
    std::string scene;                ///< as in Study::scenes
    std::vector<OptionText> options;  ///< the base's with the axes' over them, each name once
};

/// What options may be called, so that others are refused with the nearest of them: the long names of solve's. A study
/// refuses on its own those that are its own business.
using OptionNames = std::vector<std::string>;

/// The text of a study or configuration file. Throws StudyError for what can't be read and for more than a megabyte.
std::string text_of_study(const std::filesystem::path& file);

/// Reads a study. Throws StudyError with file, line and column for what isn't TOML, an unknown key ("did you mean"), a
/// value of another type or outside its range, an axis without values, a name that is varied twice. What options mean
/// is not looked at, nor whether files exist.
Study read_study(std::string_view text, const std::filesystem::path& file, const OptionNames& options);

/// A configuration file: solve's options alone. Throws StudyError.
std::vector<OptionText> read_configuration(std::string_view text, const std::filesystem::path& file,
                                           const OptionNames& options);

/// Number of combinations of the axes' values, skipped ones included; saturates.
std::uint64_t grid_size(const Study& study);

/// The cells. Throws StudyLimitError when grid_size() is over the study's limit (before expanding), StudyError when no
/// cell is left.
std::vector<StudyCell> expand(const Study& study);

/// The options of the reference solution of a scene: the base's with the reference's over them, each name once.
std::vector<OptionText> reference_options(const Study& study);
/// Those of the reference that a cell is held to: what the cell's scene is, its unit, lamps and sides, is the cell's.
std::vector<OptionText> reference_options(const Study& study, const StudyCell& cell);

}  // namespace patchlight
