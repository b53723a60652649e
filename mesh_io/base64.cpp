#include "mesh_io/base64.h"

#include <cstdint>

namespace drape
{
bool decodeBase64(std::string_view text, std::string& bytes)
{
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::uint32_t pending = 0;
    int pendingBits = 0;
    bytes.clear();
    bytes.reserve(text.size() / 4 * 3);
    for (const char c : text)
    {
        if (c == '=' || c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        const std::size_t digit = digits.find(c);
        if (digit == std::string_view::npos) return false;
        pending = (pending << 6 | static_cast<std::uint32_t>(digit)) & 0xffffu;
        pendingBits += 6;
        if (pendingBits < 8) continue;
        pendingBits -= 8;
        bytes.push_back(static_cast<char>(pending >> pendingBits & 0xffu));
    }
    return true;
}
}  // namespace drape
