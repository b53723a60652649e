// Codes numbers and triangles so that they deflate well, for replay pages; viewer/decode.js is the other side.
//
// Numbers are zigzag varints: 0, -1, 1, -2 … become 0, 1, 2, 3 …, seven bits a byte, the low ones first, the top bit
// set in all bytes but the last.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drape
{
void appendNumber(std::string& bytes, std::int64_t value);

// Rounds values to multiples of `step` (> 0), at most 2^29 of them. Where a value is not finite, the one `width` places
// before it stands in its place, or 0 at the beginning.
std::vector<std::int32_t> quantise(const std::vector<float>& values, std::size_t width, double step);

// Codes rows of `width` numbers (> 0; the size is a multiple of it). A row begins with its mode, a byte: order + 3 ×
// chained. Order 0 codes the numbers, 1 the differences from the row before, 2 those from the line through both rows
// before. If chained, each of these is coded as its difference from the one before in the row. The mode with the
// smallest numbers is chosen.
std::string codeRows(const std::vector<std::int32_t>& values, std::size_t width);

// Codes triangles as a walk over edges, one number for each edge that the walk meets, and numbers vertices in the order
// in which it meets them. `order` gets the vertices' old indices in their new order, unused ones last.
//
// The walk begins with a triangle's three vertices, then takes the edge that was met last: 0 if no further triangle has
// it, else the third vertex of that triangle. A vertex is coded as 1 if it is new, else as 2 + how many others are
// newer. When no edge is left, another triangle begins.
std::string codeTriangles(const std::vector<std::int32_t>& triangles, std::size_t vertexCount,
                          std::vector<std::int32_t>& order);

// Returns the bytes as a zlib stream. Throws std::bad_alloc.
std::string deflated(const std::string& bytes);

// Returns the bytes in base64 (RFC 4648, section 4).
std::string encodeBase64(const std::string& bytes);
}  // namespace drape
