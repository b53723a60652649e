// The body of a PLY file as a sequence of numbers, whatever its encoding.
#pragma once

#include <memory>
#include <string>

#include "mesh_io/ply_header.h"

namespace drape
{
class PlyNumbers
{
public:
    virtual ~PlyNumbers() = default;
    // Called before and after each element. Return "" or the error of its extent.
    virtual std::string startElement() = 0;
    virtual std::string endElement() = 0;
    // Reads the next number. Returns "" or why there is none.
    virtual std::string next(NumberType type, double& value) = 0;
    // Returns true if `count` elements of at least the given size fit into the rest of the file. Keeps memory within
    // the file's size.
    virtual bool canHold(std::uint64_t count, std::size_t smallestSize) const = 0;
    // Describes what follows the last element: empty for nothing.
    virtual std::string rest() = 0;
    // Returns true if nothing may follow the last element.
    virtual bool mustEnd() const = 0;
};

// Both arguments must outlive the result.
std::unique_ptr<PlyNumbers> makePlyNumbers(const std::string& bytes, const PlyHeader& header);
}  // namespace drape
