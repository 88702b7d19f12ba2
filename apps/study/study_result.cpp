#include "apps/study/study_result.h"

namespace patchlight {

std::string name_of(CellStatus status)
{
    switch (status) {
    case CellStatus::waiting:
        return "waiting";
    case CellStatus::unfinished:
        return "unfinished";
    case CellStatus::over_time:
        return "over-time";
    case CellStatus::failed:
        return "failed";
    case CellStatus::not_converged:
        return "not-converged";
    case CellStatus::done:
        return "done";
    }
    return "unknown";
}

}  // namespace patchlight
