// Base64 as in data URIs (RFC 4648, section 4). White space and padding are optional. Returns false for other bytes.
#pragma once

#include <string>
#include <string_view>

namespace drape
{
bool decodeBase64(std::string_view text, std::string& bytes);
}  // namespace drape
