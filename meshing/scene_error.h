#pragma once

#include <stdexcept>
#include <string>

namespace patchlight {

/// A scene that can't be solved (exit 3). `what()` reads `room.obj:7: vertex 4 is not finite`; `code` is the
/// short word printed before it, as in `error[nonfinite]: …`.
class SceneError : public std::runtime_error {
public:
    SceneError(std::string code, const std::string& message) : std::runtime_error(message), code_(std::move(code)) {}
    const std::string& code() const { return code_; }

private:
    std::string code_;
};

}  // namespace patchlight
