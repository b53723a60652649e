#include "mesh_io/text_cursor.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>

namespace drape
{
namespace
{
bool isBlank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool isLineEnd(char c)
{
    return c == '\n' || c == '\r';
}
}  // namespace

TextCursor::TextCursor(const std::string& text, std::size_t start) : m_text(text), m_place(start)
{
    if (start == 0 && text.compare(0, 3, "\xef\xbb\xbf") == 0) m_place = 3;
}

void TextCursor::skipBlanks()
{
    while (m_place < m_text.size() && isBlank(m_text[m_place]))
        ++m_place;
}

void TextCursor::skipSpace()
{
    for (skipBlanks(); !atEnd() && atLineEnd(); skipBlanks())
        nextLine();
}

void TextCursor::nextLine()
{
    while (!atLineEnd())
        ++m_place;
    if (atEnd()) return;
    const bool two = m_text[m_place] == '\r' && m_place + 1 < m_text.size() && m_text[m_place + 1] == '\n';
    m_place += two ? 2 : 1;
    ++m_line;
}

std::string_view TextCursor::word()
{
    skipBlanks();
    const std::size_t start = m_place;
    while (m_place < m_text.size() && !isBlank(m_text[m_place]) && !isLineEnd(m_text[m_place]))
        ++m_place;
    return std::string_view(m_text).substr(start, m_place - start);
}

std::string_view TextCursor::wordOfAnyLine()
{
    skipSpace();
    return word();
}

std::string readNumber(std::string_view word, double& value)
{
    // strtod would take a hexadecimal number, which readers of mesh files do not agree on.
    const bool plain = !word.empty() && word.find_first_of("xX") == std::string_view::npos;
    char* end = nullptr;
    if (plain) value = std::strtod(word.data(), &end);
    if (plain && end == word.data() + word.size()) return "";
    const std::size_t exponent = word.find_first_of("dD");
    if (plain && exponent != std::string_view::npos && end == word.data() + exponent && exponent > 0)
    {
        std::string text(word);
        text[exponent] = 'e';
        value = std::strtod(text.c_str(), &end);
        if (end == text.c_str() + text.size()) return "";
    }
    return quoted(word) + " is not a decimal number";
}

std::string readInteger(std::string_view word, long long& value)
{
    char* end = nullptr;
    if (!word.empty()) value = std::strtoll(word.data(), &end, 10);
    return end == word.data() + word.size() && !word.empty() ? "" : quoted(word) + " is not a whole number";
}

std::string numberText(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

std::string quoted(std::string_view word)
{
    std::string text(word.substr(0, 32));
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, '?');
    return "'" + text + "'";
}

bool sameWord(std::string_view a, std::string_view b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}
}  // namespace drape
