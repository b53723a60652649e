#include "drape/version.h"

namespace drape
{
const char* libraryVersion() noexcept
{
    return DRAPE_VERSION_STRING;
}

int libraryVersionNumber() noexcept
{
    return DRAPE_VERSION_NUMBER;
}
}  // namespace drape
