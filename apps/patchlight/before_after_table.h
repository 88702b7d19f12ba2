#pragma once

#include "apps/run/run_record.h"

#include <string>

namespace patchlight {

/// The first and the last cycle of a run, a row each: elements, estimated error, seconds of work until the cycle was
/// solved (pictures not counted; "-" where `timing` doesn't know), and the part of the emitted power that the energy
/// balance doesn't account for. One row where there is one cycle, and nothing where there is none.
std::string before_after_table(const RunRecord& record, const Json& timing);

}  // namespace patchlight
