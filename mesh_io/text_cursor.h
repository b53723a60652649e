// Walks through the bytes of a text file word by word and line by line.
//
// Lines end with LF, CR LF or CR. Blanks are spaces, tabs, vertical tabs and form feeds. The text must outlive the
// cursor. Cost: linear in what is passed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace drape
{
class TextCursor
{
public:
    // Starts at byte `start` of the text, after a UTF-8 byte order mark if one is there.
    explicit TextCursor(const std::string& text, std::size_t start = 0);

    std::size_t place() const { return m_place; }
    // Returns the number of the current line, counted from 1 at `start`.
    std::size_t line() const { return m_line; }
    bool atEnd() const { return m_place == m_text.size(); }
    bool atLineEnd() const { return atEnd() || m_text[m_place] == '\n' || m_text[m_place] == '\r'; }

    // Moves past blanks within the line.
    void skipBlanks();
    // Moves past blanks and line ends.
    void skipSpace();
    // Moves to the start of the next line, or to the end of the text.
    void nextLine();
    // Moves past blanks and the word behind them, and returns the word; empty at the end of the line.
    std::string_view word();
    // Moves past blanks and line ends and the word behind them; empty at the end of the text.
    std::string_view wordOfAnyLine();

private:
    const std::string& m_text;
    std::size_t m_place;
    std::size_t m_line = 1;
};

// Reads a decimal number in the syntax of C, or of Fortran, whose exponents may begin with D; nan and inf are numbers,
// too. The byte behind the word must be part of the
// same string, as it is for the words of a TextCursor. Returns "" or the reason why the word is not a number.
std::string readNumber(std::string_view word, double& value);
// Reads a whole number without fraction or exponent; otherwise equal to readNumber().
std::string readInteger(std::string_view word, long long& value);

// Returns a number for a message: whole numbers without decimals, others with up to 17 digits.
std::string numberText(double value);

// Returns the word in quotes for a message, cut after 32 bytes, unprintable bytes as '?'.
std::string quoted(std::string_view word);

// Returns true if two words are equal apart from upper and lower case of ASCII letters.
bool sameWord(std::string_view a, std::string_view b);
}  // namespace drape
