#pragma once

#include "apps/patchlight/child_process.h"

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace patchlight {

/// A piece of a study, as a command of its own.
struct StudyJob {
    std::string name;                    ///< for messages
    std::string id;                      ///< of the cell; empty: the references
    std::vector<std::string> arguments;  ///< of this program
    double seconds = 0;                  ///< wall limit; 0: none
};

/// How one ended.
struct StudyJobEnd {
    int exit_code = 0;
    bool over_time = false;
    std::string message;  ///< of the error, empty where there was none
    double seconds = 0;
};

/// Works through jobs, so many at once, in order. `on_begin` and `on_end` are told of each. When `stop` is asked for,
/// those that run are asked to stop and waited for, as long as the program itself may take: throws Interrupted.
void work_through(std::list<StudyJob> jobs, std::size_t at_once, const std::stop_token& stop,
                  const std::function<void(const StudyJob&)>& on_begin,
                  const std::function<void(const StudyJob&, const StudyJobEnd&)>& on_end);

/// The last error in what a program said, as `kind: …`; empty where there is none.
std::string error_in(const std::string& said);

}  // namespace patchlight
