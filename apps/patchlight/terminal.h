#pragma once

#include <string>
#include <string_view>

namespace patchlight {

/// Standard error: messages, in colour on a terminal that wants it (NO_COLOR is honoured). Never fails: where
/// nobody listens, nothing is said.
class Messages {
public:
    explicit Messages(bool quiet = false);

    void set_quiet(bool quiet) { quiet_ = quiet; }
    bool quiet() const { return quiet_; }
    bool terminal() const { return terminal_; }

    void error(std::string_view code, std::string_view text) const;
    void warning(std::string_view text) const;
    /// Left out with --quiet.
    void note(std::string_view text) const;
    void raw(std::string_view text) const;

private:
    std::string colored(const char* color, std::string_view text) const;

    bool quiet_ = false;
    bool terminal_ = false;
    bool color_ = false;
};

/// Takes the places of standard descriptors that the caller closed, so that no file of ours is opened there and
/// written into by a message.
void keep_standard_descriptors();

/// Writes results to standard output. Throws PipeClosed when the reader has gone, OutputError when it can't be
/// written for another reason.
void write_result(std::string_view text);

}  // namespace patchlight
