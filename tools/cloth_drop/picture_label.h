// Writes a title and a remark into a panel of a picture, in capitals of five by seven dots.
#pragma once

#include <string>

#include "tools/cloth_drop/image.h"

namespace drape
{
// Draws into the top left corner of the panel that begins at column `left` and is `width` pixels wide. Letters of
// either case are drawn as capitals; characters other than A to Z, 0 to 9 and ( ) . , : - / leave a blank. What does
// not fit is cut off.
void drawLabel(const std::string& title, const std::string& remark, int left, int width, Image& image);
}  // namespace drape
