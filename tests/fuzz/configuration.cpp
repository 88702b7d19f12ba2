#include "apps/patchlight/study_options.h"
#include "apps/patchlight/usage_error.h"
#include "tests/fuzz/target.h"

using namespace patchlight;

/// A file for solve --config: read, and its options understood.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const OptionNames names = solve_option_names();
    try {
        const auto options = read_configuration(testing::text_of(data, size), "fuzzed.toml", names);
        solve_command_of("scene.obj", "run", options, "fuzzed.toml");
    } catch (const StudyError&) {
    } catch (const UsageError&) {}
    return 0;
}
