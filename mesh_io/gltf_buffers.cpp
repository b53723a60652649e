#include "mesh_io/gltf_buffers.h"

#include <algorithm>
#include <cstdlib>

#include "mesh_io/base64.h"

namespace drape
{
namespace
{
// The component types of glTF, which are those of OpenGL.
bool findType(const Json& object, NumberType& type)
{
    std::size_t code = 0;
    if (!readCount(object, "componentType", 0, code)) return false;
    constexpr NumberType types[] = {NumberType::Int8,  NumberType::Uint8,  NumberType::Int16,  NumberType::Uint16,
                                    NumberType::Int32, NumberType::Uint32, NumberType::Float32};
    constexpr std::size_t first = 5120;
    if (code < first || code >= first + std::size(types) || types[code - first] == NumberType::Int32) return false;
    type = types[code - first];
    return true;
}

// Returns the divisor of a normalized number; 1 for floats. Specification: glTF 2.0, section 3.11.
double largestOf(NumberType type)
{
    switch (type)
    {
        case NumberType::Int8:
            return 127;
        case NumberType::Uint8:
            return 255;
        case NumberType::Int16:
            return 32767;
        case NumberType::Uint16:
            return 65535;
        default:
            return 1;
    }
}

int hexDigit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// Replaces the escapes of a URI (RFC 3986, section 2.1).
std::string decodePercents(const std::string& uri)
{
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i)
    {
        const bool escape =
            uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
        text.push_back(escape ? static_cast<char>(16 * hexDigit(uri[i + 1]) + hexDigit(uri[i + 2])) : uri[i]);
        if (escape) i += 2;
    }
    return text;
}
}  // namespace

GltfBuffers::GltfBuffers(const Json& content, const std::string* binary, const FindBuffer& findBuffer,
                         std::size_t mostRows)
    : m_content(content), m_binary(binary), m_findBuffer(findBuffer), m_mostRows(mostRows)
{
}

std::string GltfBuffers::read(const Json& reference, const char* type, std::size_t columns, GltfNumbers& numbers)
{
    const Json& accessor = follow(at(m_content, "accessors"), reference);
    const std::string problem =
        accessor.is_object() ? readAccessor(accessor, type, columns, numbers) : "does not exist";
    return problem.empty() ? ""
                           : "accessor " + reference.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 64) +
                                 ": " + problem;
}

std::string GltfBuffers::readAccessor(const Json& accessor, const char* type, std::size_t columns, GltfNumbers& numbers)
{
    Layout layout;
    if (at(accessor, "type") != type) return std::string("is not ") + type;
    if (!findType(accessor, layout.m_type)) return "has an unknown componentType";
    if (!readCount(accessor, "count", 0, layout.m_count) || !readCount(accessor, "byteOffset", 0, layout.m_offset) ||
        !readCount(accessor, "byteStride", 0, layout.m_stride))  // glTF 1.0 has the stride here
        return "has a count, byteOffset or byteStride that is not a whole number";
    layout.m_columns = numbers.m_columns = columns;
    numbers.m_values.clear();
    const Json& view = at(accessor, "bufferView");
    std::string problem;
    if (!view.is_null())
        problem = readView(view, layout, numbers.m_values);
    else if (at(accessor, "sparse").is_null())
        problem = "has no data, unless in an extension that is not read";
    else if (layout.m_count > m_mostRows)
        problem = "has " + std::to_string(layout.m_count) + " elements without data";
    else
        numbers.m_values.assign(layout.m_count * columns, 0.0);
    if (problem.empty() && at(accessor, "normalized") == true)
    {
        const double largest = largestOf(layout.m_type);
        for (double& value : numbers.m_values)
            value = std::max(value / largest, -1.0);
    }
    return problem.empty() ? readSparse(accessor, numbers) : problem;
}

// Replaces some of the rows. Specification: glTF 2.0, section 3.6.2.3.
std::string GltfBuffers::readSparse(const Json& accessor, GltfNumbers& numbers)
{
    const Json& sparse = at(accessor, "sparse");
    if (sparse.is_null()) return "";
    Layout layout, indexLayout;
    const Json &indices = at(sparse, "indices"), &rows = at(sparse, "values");
    if (!readCount(sparse, "count", 0, layout.m_count) || !findType(accessor, layout.m_type) ||
        !findType(indices, indexLayout.m_type) || !readCount(rows, "byteOffset", 0, layout.m_offset) ||
        !readCount(indices, "byteOffset", 0, indexLayout.m_offset))
        return "has sparse values that cannot be read";
    indexLayout.m_count = layout.m_count;
    layout.m_columns = numbers.m_columns;
    std::vector<double> places, values;
    std::string problem = readView(at(indices, "bufferView"), indexLayout, places);
    if (problem.empty()) problem = readView(at(rows, "bufferView"), layout, values);
    if (!problem.empty()) return "sparse values: " + problem;
    const double largest = at(accessor, "normalized") == true ? largestOf(layout.m_type) : 1;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        if (!(places[i] >= 0 && places[i] < static_cast<double>(numbers.rows())))
            return "has a sparse index that is out of range";
        for (std::size_t column = 0; column < numbers.m_columns; ++column)
            numbers.m_values[static_cast<std::size_t>(places[i]) * numbers.m_columns + column] =
                values[i * numbers.m_columns + column] / largest;
    }
    return "";
}

std::string GltfBuffers::readView(const Json& reference, Layout layout, std::vector<double>& values)
{
    const Json& view = follow(at(m_content, "bufferViews"), reference);
    if (!view.is_object()) return "refers to a bufferView that does not exist";
    const std::string* bytes = nullptr;
    const std::string problem = findBytes(at(view, "buffer"), bytes);
    if (!problem.empty()) return problem;
    std::size_t start = 0, length = 0, stride = 0;
    if (!readCount(view, "byteOffset", 0, start) || start > bytes->size() ||
        !readCount(view, "byteLength", bytes->size() - start, length) || !readCount(view, "byteStride", 0, stride))
        return "has a bufferView that is not within its buffer of " + counted(bytes->size(), "byte");
    if (length > bytes->size() - start)
        return "has a bufferView that ends at byte " + std::to_string(start + length) + " of a buffer of " +
               counted(bytes->size(), "byte");
    const std::size_t size = numberSize(layout.m_type), rowSize = size * layout.m_columns;
    if (layout.m_stride != 0) stride = layout.m_stride;
    if (stride == 0) stride = rowSize;
    // Rows that overlap are not allowed; with them a short buffer could hold any number.
    if (stride < rowSize) return "has rows that overlap";
    if (layout.m_count == 0) return "";
    if (layout.m_offset > length || rowSize > length - layout.m_offset ||
        layout.m_count - 1 > (length - layout.m_offset - rowSize) / stride)
        return counted(layout.m_count, "element") + " do not fit into a bufferView of " + counted(length, "byte");
    values.reserve(layout.m_count * layout.m_columns);
    for (std::size_t row = 0; row < layout.m_count; ++row)
        for (std::size_t column = 0; column < layout.m_columns; ++column)
            values.push_back(decodeNumber(
                layout.m_type, bytes->data() + start + layout.m_offset + row * stride + column * size, false));
    return "";
}

std::string GltfBuffers::findBytes(const Json& reference, const std::string*& bytes)
{
    const std::string key = reference.dump(-1, ' ', true, Json::error_handler_t::replace);
    const auto known = m_buffers.find(key);
    std::string loaded;
    const std::string problem = known == m_buffers.end() ? loadBuffer(reference, loaded) : "";
    if (!problem.empty()) return "buffer " + key.substr(0, 64) + ": " + problem;
    bytes = known == m_buffers.end() ? &m_buffers.emplace(key, std::move(loaded)).first->second : &known->second;
    return "";
}

std::string GltfBuffers::loadBuffer(const Json& reference, std::string& bytes)
{
    const Json& buffer = follow(at(m_content, "buffers"), reference);
    if (!buffer.is_object()) return "does not exist";
    const Json& uri = at(buffer, "uri");
    // The binary chunk is the first buffer without a URI; glTF 1.0 names it.
    const bool named = reference.is_string() && reference == "binary_glTF";
    std::string problem;
    if (m_binary != nullptr && (uri.is_null() || named))
        bytes = *m_binary;
    else if (!uri.is_string())
        return "has neither a URI nor a binary chunk";
    else
    {
        const std::string& text = uri.get_ref<const std::string&>();
        const std::size_t data = text.find(";base64,");
        if (text.rfind("data:", 0) != 0)
            problem = m_findBuffer(decodePercents(text), bytes);
        else if (data == std::string::npos || !decodeBase64(std::string_view(text).substr(data + 8), bytes))
            problem = "has a data URI that is not base64";
    }
    std::size_t length = 0;
    if (!problem.empty()) return problem;
    if (!readCount(buffer, "byteLength", bytes.size(), length)) return "has a byteLength that is not a whole number";
    if (length > bytes.size())
        return "says " + counted(length, "byte") + " where there are " + std::to_string(bytes.size());
    m_loadedBytes += bytes.size();
    return "";
}
}  // namespace drape
