#include "apps/report/report_payload.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace patchlight {

Json ReportPayload::add(const void* data, std::size_t size, std::size_t count, const char* type)
{
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const Json place = {{"at", bytes_.size()}, {"count", count}, {"type", type}};
    bytes_.append(static_cast<const char*>(data), size);
    return place;
}

Json ReportPayload::floats(std::span<const float> values)
{
    return add(values.data(), values.size_bytes(), values.size(), "float32");
}

Json ReportPayload::halves(std::span<const float> values)
{
    const float largest = values.empty() ? 0 : *std::ranges::max_element(values);
    std::vector<std::uint16_t> packed;
    packed.reserve(values.size());
    for (const float value : values) packed.push_back(largest > 0 ? glm::packHalf1x16(value / largest) : 0);
    Json place = add(packed.data(), packed.size() * sizeof(std::uint16_t), packed.size(), "float16");
    place["scale"] = largest;
    return place;
}

Json ReportPayload::rounded_points(std::span<const Vec3> points)
{
    Vec3 low(points.empty() ? Vec3(0.0) : points.front()), high = low;
    for (const Vec3& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const Vec3 size = high - low;
    std::vector<std::uint16_t> packed;
    packed.reserve(points.size() * 3);
    for (const Vec3& p : points)
        for (int k = 0; k < 3; ++k)
            packed.push_back(size[k] > 0 ? static_cast<std::uint16_t>(std::lround((p[k] - low[k]) / size[k] * 65535))
                                         : 0);
    Json place = add(packed.data(), packed.size() * sizeof(std::uint16_t), packed.size(), "unorm16");
    place["low"] = {low.x, low.y, low.z};
    place["size"] = {size.x, size.y, size.z};
    return place;
}

Json ReportPayload::integers(std::span<const std::uint32_t> values)
{
    return add(values.data(), values.size_bytes(), values.size(), "uint32");
}

Json ReportPayload::indices(std::span<const std::uint32_t> values)
{
    if (std::ranges::any_of(values, [](std::uint32_t v) { return v > 0xffffU; })) return integers(values);
    const std::vector<std::uint16_t> narrow(values.begin(), values.end());
    return add(narrow.data(), narrow.size() * sizeof(std::uint16_t), narrow.size(), "uint16");
}

std::string base64(std::string_view bytes)
{
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < here ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) out += k <= here ? digits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return out;
}

std::string script_json(const Json& json)
{
    std::string out;
    // ASCII only: U+2028 and U+2029 are escaped with all others. <, > and & stand in strings alone.
    for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
        if (c == '<')
            out += "\\u003c";
        else if (c == '>')
            out += "\\u003e";
        else if (c == '&')
            out += "\\u0026";
        else
            out += c;
    }
    return out;
}

}  // namespace patchlight
