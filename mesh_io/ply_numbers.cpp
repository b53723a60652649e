#include "mesh_io/ply_numbers.h"

#include "mesh_io/mesh_file.h"
#include "mesh_io/text_cursor.h"

namespace drape
{
namespace
{
class BinaryNumbers : public PlyNumbers
{
public:
    BinaryNumbers(const std::string& bytes, const PlyHeader& header)
        : m_bytes(bytes), m_place(header.m_bodyStart), m_bigEndian(header.m_encoding == PlyEncoding::BigEndian)
    {
    }

    std::string startElement() override { return ""; }
    std::string endElement() override { return ""; }
    std::string next(NumberType type, double& value) override
    {
        const std::size_t size = numberSize(type);
        if (size > m_bytes.size() - m_place) return "the file ends too early";
        value = decodeNumber(type, m_bytes.data() + m_place, m_bigEndian);
        m_place += size;
        return "";
    }
    bool canHold(std::uint64_t count, std::size_t smallestSize) const override
    {
        return smallestSize == 0 || count <= (m_bytes.size() - m_place) / smallestSize;
    }
    std::string rest() override { return m_place == m_bytes.size() ? "" : counted(m_bytes.size() - m_place, "byte"); }
    bool mustEnd() const override { return false; }

private:
    const std::string& m_bytes;
    std::size_t m_place;
    bool m_bigEndian;
};

// Reads text with one element a line; the rest of a line is skipped. A few writers break lines elsewhere. If there are
// fewer lines than elements, or the first line is too short, line ends count as blanks. The numbers must then be as
// many as the header says.
class TextNumbers : public PlyNumbers
{
public:
    TextNumbers(const std::string& bytes, const PlyHeader& header)
        : m_bytes(bytes), m_cursor(bytes, header.m_bodyStart), m_headerLines(header.m_lines)
    {
        std::uint64_t elements = 0, lines = 0;
        std::size_t needed = 0, words = 0;  // numbers that the first element has at least; words of the first line
        for (const PlyElement& element : header.m_elements)
        {
            if (element.m_properties.empty() || element.m_count == 0) continue;
            if (elements == 0) needed = element.m_properties.size();
            elements += element.m_count;
        }
        TextCursor cursor = m_cursor;
        for (cursor.skipSpace(); !cursor.atEnd() && lines < elements; cursor.skipSpace(), ++lines)
        {
            while (lines == 0 && !cursor.word().empty())
                ++words;
            cursor.nextLine();
        }
        m_byLines = lines >= elements && words >= needed;
        m_isStrict = header.m_unknownLines > 0;
    }

    std::string startElement() override
    {
        m_cursor.skipSpace();
        return "";
    }
    std::string endElement() override
    {
        if (!m_byLines) return "";
        m_cursor.skipBlanks();
        if (m_isStrict && !m_cursor.atLineEnd())
            return place() + "more numbers than the PLY header says, which has a line that is none of its keywords";
        m_cursor.nextLine();
        return "";
    }
    std::string next(NumberType, double& value) override
    {
        const std::string_view word = m_byLines ? m_cursor.word() : m_cursor.wordOfAnyLine();
        if (word.empty()) return m_cursor.atEnd() ? "the file ends too early" : place() + "the line ends too early";
        const std::string problem = readNumber(word, value);
        return problem.empty() ? "" : place() + problem;
    }
    bool canHold(std::uint64_t count, std::size_t smallestSize) const override
    {
        return smallestSize == 0 || count <= m_bytes.size() - m_cursor.place();
    }
    std::string rest() override
    {
        m_cursor.skipSpace();
        if (m_cursor.atEnd()) return "";
        std::size_t lines = 0;
        for (; !m_cursor.atEnd(); m_cursor.skipSpace(), ++lines)
            m_cursor.nextLine();
        return counted(lines, "line");
    }
    bool mustEnd() const override { return !m_byLines; }

private:
    std::string place() const { return "line " + std::to_string(m_headerLines + m_cursor.line()) + ": "; }

    const std::string& m_bytes;
    TextCursor m_cursor;
    std::size_t m_headerLines;
    bool m_byLines = true;
    bool m_isStrict = false;
};
}  // namespace

std::unique_ptr<PlyNumbers> makePlyNumbers(const std::string& bytes, const PlyHeader& header)
{
    if (header.m_encoding == PlyEncoding::Text) return std::make_unique<TextNumbers>(bytes, header);
    return std::make_unique<BinaryNumbers>(bytes, header);
}
}  // namespace drape
