#pragma once

#include <cstddef>
#include <string>

namespace patchlight {

/// Where a stage of work stands, in words that fit a terminal.
struct ProgressText {
    double fraction = 0;
    int cycle = -1;  ///< -1: there are none
    std::string stage;
    std::size_t elements = 0;
    double rays_per_second = 0;
    double unshot = -1, residual = -1;  ///< -1: does not apply
    double seconds_left = -1;           ///< of the stage; -1: not known yet
};

/// A line of at most `width` columns; what matters least is left out first, the bar last of all.
std::string progress_line(const ProgressText& text, int width);

/// Seconds as people say them: "8 s", "3 min", "2 h"; "days" beyond two of them.
std::string time_in_words(double seconds);

/// Guesses how long a stage still takes from the fraction that is done, steadily: it counts down with the clock and
/// follows what it learns slowly. -1 until a twentieth, and a second, are done.
class TimeLeft {
public:
    /// At so many seconds after the stage's beginning.
    double after(double seconds, double fraction);

private:
    double ends_ = -1;  ///< seconds after the beginning
    double at_ = 0;
};

}  // namespace patchlight
