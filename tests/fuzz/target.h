#pragma once

#include "tests/temporary_folder.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// What a fuzzer calls with its bytes. An exception that comes out is a mistake of ours, as a crash is: targets catch
/// those that the reader's documentation names, and no others.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace patchlight::testing {

inline std::string text_of(const std::uint8_t* data, std::size_t size)
{
    return {reinterpret_cast<const char*>(data), size};
}

/// Where a target's files are: one folder a process.
inline const TemporaryFolder& fuzz_folder()
{
    static const TemporaryFolder folder;
    return folder;
}

/// Choices made from bytes: where there are no more, 0.
class Choices {
public:
    Choices(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}

    bool any_left() const { return next_ != end_; }
    std::uint8_t byte() { return any_left() ? *next_++ : std::uint8_t{0}; }
    std::size_t below(std::size_t n) { return byte() % n; }
    std::uint64_t number(int bytes)
    {
        std::uint64_t value = 0;
        for (int k = 0; k < bytes; ++k) value |= std::uint64_t{byte()} << (8 * k);
        return value;
    }
    std::string text(std::size_t most)
    {
        std::string taken;
        while (any_left() && taken.size() < most) taken.push_back(static_cast<char>(byte()));
        return taken;
    }
    std::string rest() { return text(static_cast<std::size_t>(end_ - next_)); }

private:
    const std::uint8_t* next_;
    const std::uint8_t* end_;
};

}  // namespace patchlight::testing
