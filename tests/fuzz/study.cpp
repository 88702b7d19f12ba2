#include "apps/study/study.h"
#include "apps/patchlight/study_options.h"
#include "apps/patchlight/usage_error.h"
#include "tests/fuzz/target.h"

using namespace patchlight;

/// A study: read, expanded, and each cell's command understood.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const OptionNames names = solve_option_names();
    try {
        const Study study = read_study(testing::text_of(data, size), "fuzzed.toml", names);
        int commands = 0;
        for (const StudyCell& cell : expand(study)) {
            reference_options(study, cell);
            // Parsing a command line takes a millisecond.
            if (++commands <= 4) solve_command_of(cell.scene, "run", cell.options, study.file);
        }
    } catch (const StudyError&) {
    } catch (const StudyLimitError&) {
    } catch (const UsageError&) {}
    return 0;
}
