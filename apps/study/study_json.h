#pragma once

#include "apps/run/run_options.h"
#include "apps/study/collect.h"

#include <string>

namespace patchlight {

/// study.json: what a study came to. Nothing in it depends on clock or machine, nor on where files are.
std::string study_json(const StudyPlan& plan, const StudyResult& result);

/// timing.json: the wall seconds of each cell's cycles from its beginning.
std::string study_timing_json(const StudyResult& result);

}  // namespace patchlight
