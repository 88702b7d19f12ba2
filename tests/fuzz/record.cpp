#include "apps/run/run_record.h"
#include "meshing/scene_error.h"
#include "tests/fuzz/target.h"

#include <stdexcept>

using namespace patchlight;

namespace {

/// What other commands take from a run's options.
void read_options(const Json& options)
{
    const auto part = [&](const char* name) { return options.is_object() ? options.value(name, Json()) : Json(); };
    const auto tried = [](const auto& read) {
        try {
            read();
        } catch (const SceneError&) {}
    };
    tried([&] { adaptive_options_in(part("solve")); });
    tried([&] { scene_options_in(part("scene")); });
    tried([&] { view_in(part("for_view")); });
}

std::string written(const RunRecord& record)
{
    return json_of(record).dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

/// A run.json. What is written of what was read is read as the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    RunRecord record;
    try {
        record = run_record_in(testing::text_of(data, size)).record;
    } catch (const SceneError&) {
        return 0;
    }
    read_options(record.identity.options);
    const std::string text = written(record);
    if (written(run_record_in(text).record) != text) throw std::logic_error("a record changes by being read");
    return 0;
}
