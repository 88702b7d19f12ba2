#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace patchlight {

/// Standard error: messages, in colour on a terminal that wants it (NO_COLOR is honoured). Never fails: where
/// nobody listens, nothing is said. On a terminal a status may stand below the messages: the last line, replaced by the
/// next status and gone before anything else is written. Any thread may write.
class Messages {
public:
    explicit Messages(bool quiet = false);

    void set_quiet(bool quiet) { quiet_ = quiet; }
    bool quiet() const { return quiet_; }
    /// Whether a status can be shown: on a terminal that knows how to erase a line, unless quiet.
    bool shows_status() const { return terminal_ && !quiet_; }

    void error(std::string_view code, std::string_view text) const;
    void warning(std::string_view text) const;
    /// Left out with --quiet.
    void note(std::string_view text) const;

    /// One line, not wider than columns() less one; empty: none. Only where shows_status().
    void status(std::string_view text) const;
    /// Erases the status for good and says a last note: before the program leaves by another door than main's. Doesn't
    /// wait for a writer that is stuck.
    void close(std::string_view last_note) const;

    /// `text` in a colour, as in "1;31", where colours are wanted.
    std::string colored(const char* color, std::string_view text) const;

private:
    void say(std::string_view text) const;
    std::string erased() const;

    mutable std::timed_mutex writing_;
    mutable bool has_status_ = false;
    mutable bool closed_ = false;
    bool quiet_ = false;
    bool terminal_ = false;
    bool color_ = false;
};

/// Of the terminal that messages go to, now; COLUMNS, or 80, where it doesn't say.
int terminal_columns();

/// Takes the places of standard descriptors that the caller closed, so that no file of ours is opened there and
/// written into by a message.
void keep_standard_descriptors();

/// Writes results to standard output. Throws PipeClosed when the reader has gone, OutputError when it can't be
/// written for another reason.
void write_result(std::string_view text);

}  // namespace patchlight
