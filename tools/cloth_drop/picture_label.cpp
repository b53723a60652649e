#include "tools/cloth_drop/picture_label.h"

#include <cctype>

namespace drape
{
namespace
{
constexpr int kColumns = 5, kRows = 7;
constexpr int kAdvance = kColumns + 1;          // dots from one character to the next
constexpr int kTitleDot = 4, kRemarkDot = 3;    // pixels a dot
constexpr int kIndent = 24;                     // pixels from the panel's left and upper edge
constexpr int kRemarkTop = kIndent + 44;        // pixels; below the title
constexpr std::uint8_t kInk[3] = {40, 42, 46};  // against the sky, which is light

struct Glyph
{
    char m_character;
    const char* m_dots[kRows];
};

constexpr Glyph kGlyphs[] = {
    {'A', {" ### ", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"}},
    {'B', {"#### ", "#   #", "#   #", "#### ", "#   #", "#   #", "#### "}},
    {'C', {" ### ", "#   #", "#    ", "#    ", "#    ", "#   #", " ### "}},
    {'D', {"#### ", "#   #", "#   #", "#   #", "#   #", "#   #", "#### "}},
    {'E', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#####"}},
    {'F', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#    "}},
    {'G', {" ### ", "#   #", "#    ", "# ###", "#   #", "#   #", " ### "}},
    {'H', {"#   #", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"}},
    {'I', {" ### ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    {'J', {"  ###", "   # ", "   # ", "   # ", "   # ", "#  # ", " ##  "}},
    {'K', {"#   #", "#  # ", "# #  ", "##   ", "# #  ", "#  # ", "#   #"}},
    {'L', {"#    ", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"}},
    {'M', {"#   #", "## ##", "# # #", "# # #", "#   #", "#   #", "#   #"}},
    {'N', {"#   #", "##  #", "##  #", "# # #", "#  ##", "#  ##", "#   #"}},
    {'O', {" ### ", "#   #", "#   #", "#   #", "#   #", "#   #", " ### "}},
    {'P', {"#### ", "#   #", "#   #", "#### ", "#    ", "#    ", "#    "}},
    {'Q', {" ### ", "#   #", "#   #", "#   #", "# # #", "#  # ", " ## #"}},
    {'R', {"#### ", "#   #", "#   #", "#### ", "# #  ", "#  # ", "#   #"}},
    {'S', {" ####", "#    ", "#    ", " ### ", "    #", "    #", "#### "}},
    {'T', {"#####", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  "}},
    {'U', {"#   #", "#   #", "#   #", "#   #", "#   #", "#   #", " ### "}},
    {'V', {"#   #", "#   #", "#   #", "#   #", "#   #", " # # ", "  #  "}},
    {'W', {"#   #", "#   #", "#   #", "# # #", "# # #", "## ##", "#   #"}},
    {'X', {"#   #", "#   #", " # # ", "  #  ", " # # ", "#   #", "#   #"}},
    {'Y', {"#   #", "#   #", " # # ", "  #  ", "  #  ", "  #  ", "  #  "}},
    {'Z', {"#####", "    #", "   # ", "  #  ", " #   ", "#    ", "#####"}},
    {'0', {" ### ", "#   #", "#  ##", "# # #", "##  #", "#   #", " ### "}},
    {'1', {"  #  ", " ##  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    {'2', {" ### ", "#   #", "    #", "   # ", "  #  ", " #   ", "#####"}},
    {'3', {" ### ", "#   #", "    #", "  ## ", "    #", "#   #", " ### "}},
    {'4', {"   # ", "  ## ", " # # ", "#  # ", "#####", "   # ", "   # "}},
    {'5', {"#####", "#    ", "#### ", "    #", "    #", "#   #", " ### "}},
    {'6', {" ### ", "#    ", "#    ", "#### ", "#   #", "#   #", " ### "}},
    {'7', {"#####", "    #", "   # ", "   # ", "  #  ", "  #  ", "  #  "}},
    {'8', {" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### "}},
    {'9', {" ### ", "#   #", "#   #", " ####", "    #", "    #", " ### "}},
    {'(', {"   # ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "   # "}},
    {')', {" #   ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", " #   "}},
    {'.', {"     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "}},
    {',', {"     ", "     ", "     ", "     ", " ##  ", "  #  ", " #   "}},
    {':', {"     ", " ##  ", " ##  ", "     ", " ##  ", " ##  ", "     "}},
    {'-', {"     ", "     ", "     ", "#####", "     ", "     ", "     "}},
    {'/', {"    #", "    #", "   # ", "  #  ", " #   ", "#    ", "#    "}},
};

const Glyph* glyphOf(char character)
{
    const char capital = static_cast<char>(std::toupper(static_cast<unsigned char>(character)));
    for (const Glyph& glyph : kGlyphs)
        if (glyph.m_character == capital) return &glyph;
    return nullptr;
}

void drawDot(int left, int top, int size, Image& image)
{
    for (int y = top; y < top + size && y < image.m_height; ++y)
        for (int x = left; x < left + size && x < image.m_width; ++x)
            for (int axis = 0; axis < 3; ++axis)
                image.at(x, y)[axis] = kInk[axis];
}

void drawText(const std::string& text, int left, int right, int top, int dot, Image& image)
{
    for (const char character : text)
    {
        if (left + kColumns * dot > right) return;
        const Glyph* glyph = glyphOf(character);
        for (int row = 0; glyph != nullptr && row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column)
                if (glyph->m_dots[row][column] == '#') drawDot(left + column * dot, top + row * dot, dot, image);
        left += kAdvance * dot;
    }
}
}  // namespace

void drawLabel(const std::string& title, const std::string& remark, int left, int width, Image& image)
{
    const int right = left + width;
    drawText(title, left + kIndent, right, kIndent, kTitleDot, image);
    drawText(remark, left + kIndent, right, kRemarkTop, kRemarkDot, image);
}
}  // namespace drape
