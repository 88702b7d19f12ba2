#pragma once

#include <stdexcept>
#include <string>

namespace patchlight {

/// What the user asked for can't be meant (exit 2). `code` is the short word of `error[code]: …`.
class UsageError : public std::runtime_error {
public:
    UsageError(std::string code, const std::string& message) : std::runtime_error(message), code_(std::move(code)) {}
    const std::string& code() const { return code_; }

private:
    std::string code_;
};

/// More than the machine holds was asked for (exit 5); nothing has been allocated.
class LimitError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Whoever read our standard output has gone (exit 141, without a word).
class PipeClosed : public std::runtime_error {
public:
    PipeClosed() : std::runtime_error("closed pipe") {}
};

}  // namespace patchlight
