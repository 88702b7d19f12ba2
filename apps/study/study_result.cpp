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

std::string name_of(ReferenceKind kind)
{
    switch (kind) {
    case ReferenceKind::none:
        return "none";
    case ReferenceKind::path_traced:
        return "path-traced";
    case ReferenceKind::solution:
        return "solution";
    case ReferenceKind::run:
        return "run";
    case ReferenceKind::points:
        return "points";
    case ReferenceKind::furnace:
        return "furnace";
    }
    return "unknown";
}

}  // namespace patchlight
