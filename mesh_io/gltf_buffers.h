// The buffers and accessors of a glTF file: arrays of numbers.
//
// Every offset and length is checked against what is there. Each buffer is read once, when it is first needed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mesh_io/binary_number.h"
#include "mesh_io/json_access.h"
#include "mesh_io/readers.h"

namespace drape
{
// A rectangle of numbers: rows of `m_columns`.
struct GltfNumbers
{
    std::size_t m_columns = 1;
    std::vector<double> m_values;

    std::size_t rows() const { return m_values.size() / m_columns; }
};

class GltfBuffers
{
public:
    // `binary` is the binary chunk of a GLB file, or null. All arguments must outlive this object. `mostRows` bounds an
    // accessor that says how long it is without data that shows it.
    GltfBuffers(const Json& content, const std::string* binary, const FindBuffer& findBuffer, std::size_t mostRows);

    // Reads an accessor of a type such as "VEC3". Numbers that are normalized are divided by their largest value.
    // Returns "" or the reason, which names the accessor.
    std::string read(const Json& reference, const char* type, std::size_t columns, GltfNumbers& numbers);

    // Returns the size of all buffers that have been read.
    std::size_t loadedBytes() const { return m_loadedBytes; }

private:
    struct Layout
    {
        NumberType m_type = NumberType::Float32;
        std::size_t m_offset = 0, m_stride = 0, m_count = 0, m_columns = 1;
    };

    std::string readAccessor(const Json& accessor, const char* type, std::size_t columns, GltfNumbers& numbers);
    std::string readSparse(const Json& accessor, GltfNumbers& numbers);
    std::string readView(const Json& reference, Layout layout, std::vector<double>& values);
    std::string findBytes(const Json& reference, const std::string*& bytes);
    std::string loadBuffer(const Json& reference, std::string& bytes);

    const Json& m_content;
    const std::string* m_binary;
    const FindBuffer& m_findBuffer;
    std::size_t m_mostRows;
    std::map<std::string, std::string> m_buffers;  // by reference
    std::size_t m_loadedBytes = 0;
};
}  // namespace drape
